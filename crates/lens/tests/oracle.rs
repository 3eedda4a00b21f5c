//! The corrections are those of lensfun 0.3.4 itself, whose numbers stand in `oracle/table.tsv` (`oracle/make.py` makes
//! it, with the database of lensfunpy 1.18.0).

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // Clippy takes the helpers of tests for production code.

use darkroot_lens::{Corrections, Match, Shot, find};

/// As far as places may be from those of lensfun in a picture of 6000 x 4000, in pixels.
const PLACE: f64 = 0.1;

/// As far as factors may be from those of lensfun, as a part of them.
const GAIN: f64 = 0.005;

/// What lensfun says of one shot.
struct Said<'a> {
    fields: Vec<&'a str>,
    places: Vec<Vec<f64>>,
    gains: Vec<Vec<f64>>,
}

impl Said<'_> {
    fn number(&self, index: usize) -> f64 {
        self.fields[index].parse().unwrap()
    }

    fn shot(&self) -> Shot<'_> {
        Shot {
            lens_make: Some(self.fields[3]).filter(|maker| !maker.is_empty()),
            lens_model: Some(self.fields[4]),
            aperture: Some(self.number(6)),
            distance: Some(self.number(7)),
            ..Shot::new(self.fields[1], self.fields[2], self.number(5))
        }
    }

    fn has(&self, what: char) -> bool {
        self.fields[8].contains(what)
    }

    /// The parts that lensfun has.
    fn parts(&self, found: &Match, size: (usize, usize)) -> Corrections {
        let all = found.corrections(size);
        let all = if self.has('d') { all } else { all.without_distortion() };
        if self.has('t') { all } else { all.without_tca() }
    }

    /// By how many pixels places differ at most, and by what part of them factors.
    fn difference(&self, found: &Match) -> (f64, f64) {
        let corrections = self.parts(found, (6000, 4000));
        let place = self.places.iter().map(|numbers| {
            let ours = corrections.place(numbers[0], numbers[1]);
            let theirs = numbers[2..].chunks(2);
            ours.iter().zip(theirs).map(|(o, t)| (o.0 - t[0]).hypot(o.1 - t[1])).fold(0.0, f64::max)
        });
        let corrections = self.parts(found, (600, 400));
        let gain = self.gains.iter().map(|numbers| {
            let ours = corrections.gain(numbers[0], numbers[1]);
            (ours / numbers[2] - 1.0).abs()
        });
        (place.fold(0.0, f64::max), gain.fold(0.0, f64::max))
    }
}

fn read(table: &str) -> Vec<Said<'_>> {
    let mut said: Vec<Said> = Vec::new();
    for line in table.lines() {
        let fields: Vec<&str> = line.split('\t').collect();
        let numbers = || fields[1..].iter().map(|n| n.parse().unwrap()).collect();
        match fields[0] {
            "shot" => said.push(Said { fields, places: Vec::new(), gains: Vec::new() }),
            "place" => said.last_mut().unwrap().places.push(numbers()),
            "gain" => said.last_mut().unwrap().gains.push(numbers()),
            other => panic!("{other}"),
        }
    }
    said
}

#[test]
fn places_and_factors_are_those_of_lensfun() {
    let said = read(include_str!("oracle/table.tsv"));
    let mut lenses: Vec<&str> = said.iter().map(|s| s.fields[4]).collect();
    lenses.dedup();
    assert!(lenses.len() >= 20, "{}", lenses.len());
    let mut wrong = Vec::new();
    for said in &said {
        let Some(found) = find(&said.shot()) else {
            wrong.push(format!("not found: {:?}", said.fields));
            continue;
        };
        let has = [('d', found.has_distortion()), ('t', found.has_tca()), ('v', found.has_vignetting())];
        let lacks = has.iter().any(|(what, has)| said.has(*what) && !has);
        let (place, gain) = said.difference(&found);
        if lacks || place > PLACE || gain > GAIN {
            wrong.push(format!("{:?} {has:?}: {place:.3} px, {gain:.4}", &said.fields[1..]));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// How many shots of a larger table differ: `DARKROOT_LENS_TABLE=FILE cargo test -p darkroot-lens --test oracle --
/// --ignored --nocapture`.
#[test]
#[ignore = "needs a table that oracle/make.py --all prints"]
fn a_larger_table() {
    let path = std::env::var_os("DARKROOT_LENS_TABLE").expect("DARKROOT_LENS_TABLE names a table");
    let text = std::fs::read_to_string(path).unwrap();
    let said = read(&text);
    let (mut missing, mut other, mut lacking, mut places, mut gains) = (0, 0, 0, 0, 0);
    for said in &said {
        let Some(found) = find(&said.shot()) else {
            println!("not found\t{}", said.fields.join("\t"));
            missing += 1;
            continue;
        };
        if !found.lens.to_lowercase().ends_with(&said.fields[4].to_lowercase()) {
            println!("other name\t{}\t{}", said.fields.join("\t"), found.lens);
            other += 1;
        }
        let has = [('d', found.has_distortion()), ('t', found.has_tca()), ('v', found.has_vignetting())];
        let (place, gain) = said.difference(&found);
        if let Some((what, _)) = has.iter().find(|(what, has)| said.has(*what) && !has) {
            println!("lacks {what}\t{}", said.fields.join("\t"));
            lacking += 1;
        } else if place > PLACE {
            println!("place {place:.3}\t{}", said.fields.join("\t"));
            places += 1;
        } else if gain > GAIN {
            println!("gain {gain:.4}\t{}", said.fields.join("\t"));
            gains += 1;
        }
    }
    println!(
        "{} shots: {missing} not found, {other} of another name, {lacking} lack a correction, {places} with other places, \
         {gains} with other gains",
        said.len()
    );
}
