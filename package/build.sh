#!/usr/bin/env bash
# What can be installed without Rust, into dist/: the wheel, a .deb with man pages and completions, and a static program. With each
# its licences; sizes are printed at the end. `build.sh [wheel] [deb] [static]`; all three if none is named.
set -euo pipefail
cd "$(dirname "$0")/.."
dist="$PWD/dist"
target="${CARGO_TARGET_DIR:-$PWD/target}"
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
# The wheel's build puts the program there.
program="$PWD/target/wheel/scripts/darkroot"
mkdir -p "$dist"

build_wheel() {
    [ -x target/wheel-tools/bin/pip ] || python3 -m venv target/wheel-tools
    target/wheel-tools/bin/pip wheel . --quiet --no-deps -w "$dist"
}

build_deb() {
    [ -x "$program" ] || python3 python/build/darkroot_build.py
    tree=$(mktemp -d)
    trap 'rm -rf "$tree"' RETURN
    share="$tree/usr/share"
    mkdir -p "$tree/DEBIAN" "$tree/usr/bin" "$share/man/man1" "$share/doc/darkroot" \
        "$share/bash-completion/completions" "$share/zsh/vendor-completions" "$share/fish/vendor_completions.d"
    install -m 755 "$program" "$tree/usr/bin/darkroot"
    "$program" man "$share/man/man1"
    gzip -9n "$share"/man/man1/*
    "$program" completions bash >"$share/bash-completion/completions/darkroot"
    "$program" completions zsh >"$share/zsh/vendor-completions/_darkroot"
    "$program" completions fish >"$share/fish/vendor_completions.d/darkroot.fish"
    { cat COPYING.LESSER crates/lens/NOTICE crates/chart/NOTICE profiles/NOTICE; python3 package/licences.py; } >"$share/doc/darkroot/copyright"
    libc=$(objdump -T "$program" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1 | cut -d_ -f2)
    cat >"$tree/DEBIAN/control" <<CONTROL
Package: darkroot
Version: $version
Architecture: $(dpkg --print-architecture)
Maintainer: The Darkroot project <darkroot@localhost>
Installed-Size: $(du -sk "$tree/usr" | cut -f1)
Depends: libc6 (>= $libc), libgcc-s1
Section: graphics
Priority: optional
Description: Develops raw photographs
 Reads NEF, DNG and the raw files of other makers, interpolates and corrects them in linear light, and writes JPEG, PNG, TIFF,
 WebP, AVIF, OpenEXR or JPEG XL, one file or folders of any size.
CONTROL
    dpkg-deb --root-owner-group --build "$tree" "$dist/darkroot_${version}_$(dpkg --print-architecture).deb" >/dev/null
}

# Against musl where Rust has that target (`rustup target add x86_64-unknown-linux-musl`), else against a static glibc.
build_static() {
    triple=x86_64-unknown-linux-musl
    flags=""
    if ! [ -d "$(rustc --print sysroot)/lib/rustlib/$triple/lib" ]; then
        echo "note: Rust has no $triple here; the static program is linked to glibc"
        triple=x86_64-unknown-linux-gnu
        flags="-C target-feature=+crt-static"
    fi
    # One library is C (libwebp). Without musl's own compiler the system's serves, kept from the C library's own checks.
    if [[ $triple == *musl ]] && ! command -v musl-gcc >/dev/null; then
        export CC_x86_64_unknown_linux_musl="${CC:-cc}" CFLAGS_x86_64_unknown_linux_musl="-U_FORTIFY_SOURCE"
    fi
    RUSTFLAGS="$flags" cargo build --release --locked -p darkroot-cli --target "$triple"
    name="darkroot-$version-static-x86_64"
    rm -rf "${dist:?}/$name"
    mkdir -p "$dist/$name"
    install -m 755 -s "$target/$triple/release/darkroot" "$dist/$name/darkroot"
    cp COPYING COPYING.LESSER "$dist/$name"
    { cat crates/lens/NOTICE crates/chart/NOTICE profiles/NOTICE; python3 package/licences.py; } >"$dist/$name/THIRD-PARTY.txt"
    tar -C "$dist" --owner=0 --group=0 -czf "$dist/$name.tar.gz" "$name"
    rm -rf "${dist:?}/$name"
}

[ $# -gt 0 ] || set -- wheel deb static
for what in "$@"; do
    "build_$what"
done
ls -l "$dist" | awk 'NR > 1 { printf "%6.1f MB  %s\n", $5 / 1e6, $9 }'
