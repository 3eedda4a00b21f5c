#!/usr/bin/env bash
# Runs every target, one after the other, and adds a line for each to fuzz/counts.csv: target, executions, seconds, edges.
#
#   bash fuzz/run.sh SECONDS [TARGET...]
#
# Needs a nightly toolchain and `cargo install cargo-fuzz --locked`. The first inputs are made from the project's fixtures.
# With PLAIN=1 without the address sanitizer and without a look at what is compared: panics, wrong sums, endless loops and
# memory are still seen, and it is a few times as fast.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=$1
shift
all=(screen flashraw rawloader develop exif opcodes preview profile dcp icc cube clf cgats cxf layout cht spectra recipe
    journal worker picture delivered xmp iptc lut)
[ $# -gt 0 ] || set -- "${all[@]}"

[ -d fuzz/corpus ] || cargo run -q -p darkroot-tests --example fuzz_corpora -- fuzz/corpus
how=()
[ -z "${PLAIN:-}" ] || how=(--sanitizer none --no-trace-compares)
cargo +nightly fuzz build "${how[@]}"
for target in "$@"; do
    dictionary=text
    case $target in screen | flashraw | rawloader | develop | exif | opcodes | preview | dcp | delivered) dictionary=tiff ;; esac
    log=$(mktemp)
    # An input may take 20 s and 2 GB here, where everything is slower by the sanitizer.
    cargo +nightly fuzz run "${how[@]}" "$target" -- -dict="fuzz/$dictionary.dict" -max_total_time="$seconds" -timeout=20 \
        -rss_limit_mb=2048 -malloc_limit_mb=1024 -max_len=65536 -print_final_stats=1 -print_funcs=0 2>"$log" ||
        echo "$target: a finding; see fuzz/artifacts/$target" >&2
    count=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -1)
    edges=$(grep -o 'cov: [0-9]*' "$log" | tail -1 | cut -d' ' -f2)
    echo "$target,${count:-0},$seconds,${edges:-0}" | tee -a fuzz/counts.csv
done
