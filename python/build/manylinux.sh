#!/usr/bin/env bash
# A wheel for every Linux on x86-64 with glibc 2.17 or later (manylinux2014): zig links against that version, so no old system and
# no container is needed. `manylinux.sh [FOLDER]`; the wheel goes to FOLDER (dist if not given).
set -euo pipefail
cd "$(dirname "$0")/../.."
out=$(realpath -m "${1:-dist}")
tools="$PWD/target/wheel-tools"
[ -x "$tools/bin/maturin" ] || { python3 -m venv "$tools" && "$tools/bin/pip" install --quiet 'maturin>=1.9.4,<2' ziglang cargo-zigbuild; }
export PATH="$tools/bin:$PATH"
target=x86_64-unknown-linux-gnu
cargo zigbuild --release --locked -p darkroot-cli --target "$target.2.17"
DARKROOT_PROGRAM="${CARGO_TARGET_DIR:-target}/$target/release/darkroot" python3 python/build/darkroot_build.py
maturin build --release --locked --zig --target "$target" --compatibility manylinux2014 --out "$out"
