#!/bin/bash
# One value everywhere: holds the frames of tests/golden/values.txt, on 1, 2, 3 and 8 threads, against what
# other builds make of them.
#
#   tests/matrix.sh          all builds that this machine can make and run; says what is missing
#   tests/matrix.sh NAME...  only these
#
# Targets come from `rustup target add NAME`; aarch64 also wants gcc-aarch64-linux-gnu, libc6-dev-arm64-cross
# and qemu-user, musl wants musl-tools.
set -uo pipefail
cd "$(dirname "$0")/.."
all=(release sse2 fma native unoptimised packed musl aarch64)
case ${1:-} in
    "") wanted=("${all[@]}") ;;
    *) wanted=("$@") ;;
esac
target=target/matrix
failed=0

# Runs `lab values` in a build: name, flags, and more arguments for cargo.
build() {
    local name=$1 flags=$2 start=$SECONDS
    shift 2
    if RUSTFLAGS=$flags cargo run -q --locked -p luc-lab --target-dir "$target/$name" "$@" -- values; then
        echo "-- $name: equal, $((SECONDS - start)) s"
    else
        echo "-- $name: DIFFERENT"
        failed=1
    fi
}

# Whether a compiled standard library and a command are there.
has() {
    local triple=$1 tool=$2
    [ -d "$(rustc --print sysroot)/lib/rustlib/$triple/lib" ] || { echo "-- no library for $triple"; return 1; }
    command -v "$tool" >/dev/null || { echo "-- no $tool"; return 1; }
}

for name in "${wanted[@]}"; do
    echo "== $name"
    case $name in
        release) build release "-Ctarget-feature=+avx2" --release ;;
        sse2) build sse2 "" --release ;;
        fma) build fma "-Ctarget-feature=+avx2,+fma" --release ;;
        native) build native "-Ctarget-cpu=native" --release ;;
        unoptimised)
            build unoptimised "-Ctarget-feature=+avx2" --config profile.dev.opt-level=0 \
                --config profile.dev.package.luc-core.opt-level=0 ;;
        packed)
            if [ -x target/pack/luc ]; then
                LUC_BIN=target/pack/luc cargo test -q --locked --test determinism executable && echo "-- packed: equal" ||
                    { echo "-- packed: DIFFERENT"; failed=1; }
            else
                echo "-- no target/pack/luc: run cargo pack first"
            fi
            ;;
        musl)
            has x86_64-unknown-linux-musl musl-gcc || continue
            CC_x86_64_unknown_linux_musl=musl-gcc build musl "-Ctarget-feature=+avx2" --release \
                --target x86_64-unknown-linux-musl ;;
        aarch64)
            has aarch64-unknown-linux-gnu aarch64-linux-gnu-gcc && has aarch64-unknown-linux-gnu qemu-aarch64 || continue
            CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
            CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu" \
                build aarch64 "" --release --target aarch64-unknown-linux-gnu ;;
        *) echo "no build of this name: ${all[*]}"; exit 2 ;;
    esac
done
exit $failed
