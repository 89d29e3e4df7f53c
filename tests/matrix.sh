#!/bin/bash
# One value everywhere: holds the frames of tests/golden/values.txt, on 1, 2, 3 and 8 threads, against what
# other builds make of them.
#
#   tests/matrix.sh          all builds that this machine can make and run; says what is missing
#   tests/matrix.sh NAME...  only these
#
# Targets come from `rustup target add NAME`, or are made with the program by a compiler that has its library's source
# (rustup's rust-src, or Debian's rustc-web, cargo-web and rust-web-src). aarch64 also wants gcc-aarch64-linux-gnu,
# libc6-dev-arm64-cross and qemu-user, and takes a quarter of an hour; musl wants musl-tools.
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

# Whether there is a compiled standard library, and a command.
has_library() {
    [ -d "$(rustc --print sysroot)/lib/rustlib/$1/lib" ] || { echo "-- no library for $1"; return 1; }
}
has() {
    command -v "$1" >/dev/null || { echo "-- no $1"; return 1; }
}

# Where a compiler lies that has its library's source.
with_source() {
    local rustc root
    for rustc in rustc /usr/bin/rustc; do
        root=$("$rustc" --print sysroot 2>/dev/null) || continue
        [ -f "$root/lib/rustlib/src/rust/library/std/Cargo.toml" ] && echo "$root" && return
    done
    return 1
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
            has_library x86_64-unknown-linux-musl && has musl-gcc || continue
            CC_x86_64_unknown_linux_musl=musl-gcc build musl "-Ctarget-feature=+avx2" --release \
                --target x86_64-unknown-linux-musl ;;
        aarch64)
            has aarch64-linux-gnu-gcc && has qemu-aarch64 || continue
            export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
            export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu"
            if has_library aarch64-unknown-linux-gnu; then
                build aarch64 "" --release --target aarch64-unknown-linux-gnu
            elif root=$(with_source); then
                echo "-- made with the program by the compiler in $root"
                PATH=$root/bin:$PATH RUSTC=$root/bin/rustc RUSTC_BOOTSTRAP=1 build aarch64 "" --release \
                    -Zbuild-std=std,panic_abort --target aarch64-unknown-linux-gnu
            else
                echo "-- no source of a standard library"
            fi
            ;;
        *) echo "no build of this name: ${all[*]}"; exit 2 ;;
    esac
done
exit $failed
