#!/bin/bash
# Runs each fuzz target for a while, one after the other: fuzz/run.sh [SECONDS] [TARGET...].
#
# Builds with libFuzzer's counters by the stable compiler, so without the address sanitizer; `cargo +nightly
# fuzz run TARGET` has that too. Findings are left in fuzz/artifacts, what was learnt in fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:-300}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(shapes command_line models decoders packer)
flags="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4"
flags+=" -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table"
flags+=" -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1 -Ctarget-feature=+avx2"
host=$(rustc -vV | sed -n 's/^host: //p')
# With a target named, build scripts and macros are built without the counters.
RUSTFLAGS=$flags cargo build --release --target "$host"
for target in "${targets[@]}"; do
    mkdir -p "corpus/$target" "artifacts/$target"
    echo "== $target, $seconds s"
    "target/$host/release/$target" "corpus/$target" "-artifact_prefix=artifacts/$target/" \
        "-max_total_time=$seconds" -max_len=4096 -print_final_stats=1 -verbosity=0
done
