//! What is known of a lens, and how long it takes to find out:
//! `cargo run --release -p darkroot-lens --example lens -- MAKER MODEL LENS FOCAL [F-NUMBER [LENS-MAKER]]`.

#![allow(clippy::print_stdout, clippy::expect_used)] // An example.

use std::time::Instant;

use darkroot_lens::{Shot, find};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let text = |i: usize| words.get(i).map(String::as_str).filter(|word| !word.is_empty());
    let number = |i: usize| text(i).map(|word| word.parse().expect("a number"));
    let shot = Shot {
        lens_model: text(2),
        lens_make: text(5),
        aperture: number(4),
        ..Shot::new(text(0).expect("a maker"), text(1).expect("a model"), number(3).expect("a focal length"))
    };
    let mut times = Vec::new();
    for _ in 0..20 {
        let start = Instant::now();
        let found = find(&shot);
        times.push(start.elapsed().as_secs_f64() * 1e3);
        if times.len() == 1 {
            println!("{found:#?}");
        }
    }
    if let Some(found) = find(&shot) {
        let corrections = found.corrections((6000, 4000));
        let start = Instant::now();
        let mut sum = 0.0;
        for y in 0..1000 {
            for x in 0..1000 {
                let [red, green, blue] = corrections.place(f64::from(x), f64::from(y));
                sum += red.0 + blue.1 + corrections.gain(green.0, green.1);
            }
        }
        println!("{:.1} ns a place and its gain (sum {sum:.0})", start.elapsed().as_secs_f64() * 1e3);
    }
    println!(
        "first {:.2} ms, then {:.2} ms",
        times[0],
        times[1..].iter().copied().fold(f64::INFINITY, f64::min)
    );
}
