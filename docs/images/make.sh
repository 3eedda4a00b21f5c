#!/bin/sh
# Makes the pictures of the guide from the samples. Run from the top of the repository. before.jpg, after.jpg and window-*.jpg are
# made by tests/window/pictures.py, in a browser.
set -eu
darkroot="${1:-target/release/darkroot}"
develop() { "$darkroot" develop -q --overwrite --quality 80 --chroma 420 "$@"; }
develop samples/still-life.dng -o docs/images/neutral.jpg
develop samples/still-life.dng --look vivid -o docs/images/vivid.jpg
develop samples/still-life.dng --look flat -o docs/images/flat.jpg
develop samples/still-life.dng --white-balance 3200K -o docs/images/3200K.jpg
develop samples/still-life.dng --resize long:360 -o docs/images/level.jpg
develop samples/still-life.dng --straighten 5 --crop 3:2 --resize long:360 -o docs/images/straighten.jpg
develop samples/still-life.dng --perspective vertical:12%,5%,18%,95%,88%,5%,82%,95% --resize long:360 \
    -o docs/images/perspective.jpg
# A shot that is two and a half stops too bright.
bright=$(mktemp -d)
cargo run --release -q -p darkroot-simulate --example make_raw -- --format dng --width 720 --height 480 --stops 2.5 \
    --out "$bright/bright.dng"
develop "$bright/bright.dng" --exposure -2 --highlights keep -o docs/images/highlights-keep.jpg
develop "$bright/bright.dng" --exposure -2 --highlights rebuild -o docs/images/highlights-rebuild.jpg
# One that is five stops too dark.
cargo run --release -q -p darkroot-simulate --example make_raw -- --format dng --width 1440 --height 960 --stops -5 \
    --out "$bright/dark.dng"
for denoise in off auto; do
    develop "$bright/dark.dng" --exposure 5 --denoise $denoise --sharpen off --crop 620,600,360,240 -o docs/images/noise-$denoise.jpg
done
rm -r "$bright"
