#![no_main]

//! What workers and crew say to each other.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|line: &[u8]| darkroot_batch::fuzzing::line(line));
