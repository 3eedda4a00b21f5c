#!/usr/bin/env bash
# Tries what build.sh made, each where nothing of ours is: `try.sh [ROOT]`. ROOT is a folder with a small Debian, which debootstrap
# makes if it is missing (as root). Each develops the sample, and is taken away without a trace.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$(realpath -m "${1:-target/clean-root}")
sample="$PWD/samples/still-life.nef"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Every file below a folder, but for what a package manager writes about itself.
listing() { (cd "$1" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./var/lib/dpkg -o -path ./var/cache -o -path ./var/log -o -path ./try \) -prune -o -print | sort); }

# A picture that is one, of the sample's size.
is_picture() { [ "$(od -An -tx1 -N2 "$1" | tr -d ' ')" = ffd8 ] && [ "$(stat -c %s "$1")" -gt 20000 ]; }

try_deb() {
    listing "$root" >"$scratch/before"
    mkdir -p "$root/try"
    cp dist/darkroot_*.deb "$sample" "$root/try"
    chroot "$root" sh -c 'dpkg -i /try/darkroot_*.deb >/dev/null'
    chroot "$root" sh -ec 'cd /try; darkroot --version; darkroot -q develop still-life.nef -o a.jpg; darkroot -q batch . -o out; test -s out/still-life.jpg
        test -s /usr/share/man/man1/darkroot-develop.1.gz; test -s /usr/share/bash-completion/completions/darkroot'
    is_picture "$root/try/a.jpg"
    chroot "$root" dpkg -P darkroot >/dev/null
    rm -rf "$root/try"
    listing "$root" >"$scratch/after"
    diff "$scratch/before" "$scratch/after"
    echo "deb: installed, developed, removed without a trace"
}

# The steps of package/Dockerfile, in that root.
try_image() {
    mkdir -p "$root/try"
    cp dist/darkroot_*.deb "$sample" "$root/try"
    chroot "$root" sh -ec 'dpkg -i /try/darkroot_*.deb >/dev/null; darkroot --version >/dev/null; mkdir -m 777 /try/out'
    chroot --userspec=65534:65534 "$root" darkroot -q batch /try -o /try/out --shard 1/1 --memory 1G
    is_picture "$root/try/out/still-life.jpg"
    chroot "$root" dpkg -P darkroot >/dev/null
    rm -rf "$root/try"
    echo "image: its steps run, and a job of nobody's develops"
}

# A root with nothing in it but the program.
try_static() {
    mkdir "$scratch/empty"
    tar -C "$scratch/empty" -xzf dist/darkroot-*-static-*.tar.gz --strip-components 1
    cp "$sample" "$scratch/empty"
    chroot "$scratch/empty" /darkroot -q develop /still-life.nef -o /a.jpg
    is_picture "$scratch/empty/a.jpg"
    echo "static: develops where there is nothing else at all"
}

try_wheel() {
    python3 -m venv "$scratch/venv"
    "$scratch/venv/bin/pip" install --quiet numpy
    # pip leaves folders that are shared by name (share/doc), empty.
    files() { (cd "$scratch/venv" && find . ! -type d ! -path '*/__pycache__/*' | sort); }
    files >"$scratch/before"
    "$scratch/venv/bin/pip" install --quiet --no-index --no-deps dist/darkroot-*.whl
    "$scratch/venv/bin/darkroot" -q develop "$sample" -o "$scratch/a.jpg"
    "$scratch/venv/bin/python" -c "
import sys, darkroot
darkroot.develop_file(sys.argv[1], sys.argv[2])
assert darkroot.batch(sys.argv[1], sys.argv[3]).done == 1" "$sample" "$scratch/b.jpg" "$scratch/out"
    cmp "$scratch/a.jpg" "$scratch/b.jpg"
    cmp "$scratch/a.jpg" "$scratch/out/still-life.jpg"
    is_picture "$scratch/a.jpg"
    "$scratch/venv/bin/pip" uninstall --quiet -y darkroot
    files >"$scratch/after"
    diff "$scratch/before" "$scratch/after"
    echo "wheel: installed, developed by program, function and batch, removed without a trace"
}

# In an `&&` list bash would not stop at what fails inside.
if compgen -G "dist/darkroot-*.whl" >/dev/null; then try_wheel; fi
if compgen -G "dist/darkroot_*.deb" >/dev/null; then
    [ -d "$root/usr" ] || debootstrap --variant=minbase stable "$root"
    # Programs that start workers find themselves there.
    mount -t proc proc "$root/proc"
    trap 'umount "$root/proc"; rm -rf "$scratch"' EXIT
    try_deb
    try_image
fi
if compgen -G "dist/darkroot-*-static-*.tar.gz" >/dev/null; then try_static; fi
