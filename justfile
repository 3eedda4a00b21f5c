# What is done often. `just` alone lists it; without `just`, the lines can be typed as they stand.

default:
    @just --list

# Everything that must pass before a change lands.
check:
    bash .ci/run

# The README's tests.
test *args:
    cargo test --workspace {{args}}

# Golden pictures: compare, or with `just golden-update` take today's pictures as the new ones.
golden:
    cargo test -p darkroot-tests --test golden

golden-update:
    UPDATE_GOLDEN=1 cargo test -p darkroot-tests --test golden

# Stages on one thread, the core, and whole jobs.
bench *args:
    cargo bench -p darkroot-develop -p darkroot {{args}}

# Every fuzz target for so many seconds (nightly, cargo-fuzz).
fuzz-all seconds="600":
    bash fuzz/run.sh {{seconds}}

# Damaged raw files against both decoders: 6000 mutants of each sample.
fuzz mutants="6000":
    DARKROOT_MUTANTS={{mutants}} cargo test --release -p darkroot-raw --test mutations

# The data of the project, made again: sample files and built-in profiles.
data:
    cargo run --release -p darkroot-simulate --example make_samples
    bash profiles/make.sh

# The Python package: the wheel, with the program in it, into dist/.
wheel:
    pip wheel . --no-deps -w dist

# Its tests, on what `cargo test` compiled.
python:
    bash .ci/run python

# What can be installed without Rust, into dist/: wheel, .deb, static program.
package *what:
    bash package/build.sh {{what}}

# Each of them tried in a clean root (as root, with debootstrap), and taken away again.
package-try *root:
    bash package/try.sh {{root}}
