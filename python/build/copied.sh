#!/usr/bin/env bash
# Puts the package into a virtual environment as it was compiled for tests: `copied.sh VENV TARGET/debug`.
set -euo pipefail
sources=$(cd "$(dirname "$0")/../darkroot" && pwd)
packages=$("$1/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
rm -rf "$packages/darkroot"
cp -r "$sources" "$packages/darkroot"
cp "$2/libdarkroot_python.so" "$packages/darkroot/_core.abi3.so"
cp "$2/darkroot" "$1/bin/darkroot"
