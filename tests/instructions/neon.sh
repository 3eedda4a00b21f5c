#!/usr/bin/env bash
# Whether every stage gives the same to the bit on another kind of processor: AArch64 with NEON, under QEMU.
# On Debian: `rustup target add aarch64-unknown-linux-gnu`, `apt install gcc-aarch64-linux-gnu qemu-user`.
set -euo pipefail
cd "$(dirname "$0")/../.."
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
build=(cargo build --release -p darkroot-develop --example instructions)
"${build[@]}"
"${build[@]}" --target aarch64-unknown-linux-gnu
target=${CARGO_TARGET_DIR:-target}
here="$target/release/examples/instructions"
there=(qemu-aarch64 -L /usr/aarch64-linux-gnu "$target/aarch64-unknown-linux-gnu/release/examples/instructions")
unlike=0
while read -r stage; do
    a=$("$here" "$stage" 1)
    b=$("${there[@]}" "$stage" 1)
    [ "$a" = "$b" ] && said="the same" || { said="NOT the same"; unlike=1; }
    printf '%-20s %s here, %s with NEON: %s\n' "$stage" "$a" "$b" "$said"
done < <("$here")
exit $unlike
