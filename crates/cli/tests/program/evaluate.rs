//! `darkroot evaluate`, on the simulated camera and its chart.

use darkroot_colour::Spectrum;
use darkroot_colour::illuminant::Illuminant;
use darkroot_simulate::levels::{Setting, files};

use super::profile_commands::{csv, desk};
use super::*;

#[test]
fn the_tables_of_the_papers_are_printed() {
    let desk = desk();
    let run = desk.run(&["evaluate", "--sensitivities", "camera.csv", "--set", "chart=chart.csv"]);
    assert_eq!(run.code, 0, "{}", run.err);
    // As tests/colour_correction/twenty_four.rs has it from numpy.
    let row = run.out.lines().find(|l| l.contains("root-2")).unwrap();
    let values: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(values, ["root-2", "0.77", "0.52", "2.43", "2.6"]);
    assert!(run.out.contains("exposure x1.5"));
    assert!(run.out.lines().any(|l| l.contains("polynomial-4") && l.contains("too few colours")));
    // The papers' own figures stand beside the papers' camera and light.
    std::fs::rename(desk.path("camera.csv"), desk.path("sony_dxc-930.csv")).unwrap();
    let run = desk.run(&["evaluate", "--sensitivities", "sony_dxc-930.csv", "--set", "SG=chart.csv"]);
    let row = run.out.lines().find(|l| l.contains("root-2")).unwrap();
    assert!(row.ends_with("2.8    1.8    8.7"), "{row}");
}

/// The numbers of a model's line.
fn numbers(text: &str, model: &str) -> Vec<f64> {
    let line =
        text.lines().find(|l| l.trim_start().starts_with(model)).unwrap_or_else(|| panic!("{model}: {text}"));
    line.split_whitespace().skip(1).map(|v| v.parse().unwrap()).collect()
}

#[test]
fn models_are_judged_under_the_levels_of_light_of_real_shots() {
    let desk = Desk::new();
    let names: Vec<String> =
        darkroot_simulate::chart::PATCHES.iter().map(|(name, _)| (*name).to_owned()).collect();
    let (camera, patches) = (Camera::simulated_one(), darkroot_simulate::chart::reflectances());
    let corners = [[60.0, 50.0], [420.0, 50.0], [420.0, 280.0], [60.0, 280.0]];
    let setting = Setting {
        camera: &camera,
        light: Illuminant::by_name("A").unwrap().spectrum(),
        names: &names,
        patches: &patches,
        columns: 6,
        gap: 0.15,
        size: Size { width: 488, height: 328 },
        corners,
    };
    for (name, bytes) in files(&setting) {
        desk.put(name, bytes);
    }
    let by_hand = corners.iter().flatten().map(|v| (v - 4.0).to_string()).collect::<Vec<_>>().join(",");
    let shots = ["evaluate", "--target", "classic24", "--corners", &by_hand, "--dark", "dark.dng", "--shots"];
    let run =
        desk.run(&[&shots[..], &["full.dng", "half.dng", "--measured", "full.csv", "half.csv"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let levels: Vec<&str> = run.out.split("\n\n").skip(1).collect();
    let [fixed, halved, brighter, brightest] = levels[..] else { panic!("{}", run.out) };
    assert!(halved.starts_with("half.dng: light x0.50, measured"), "{halved}");
    assert!(brightest.starts_with("light x1.2, simulated"), "{brightest}");
    // A root polynomial is as good at half the light, but for noise; a plain one is not. The paper's figures stand beside.
    let mean = |level: &str, model: &str| numbers(level, model)[0];
    assert!((mean(halved, "root-2") - mean(fixed, "root-2")).abs() < 0.1, "{}", run.out);
    assert!((mean(brighter, "root-2") - mean(fixed, "root-2")).abs() < 1e-9, "{}", run.out);
    assert!(mean(brightest, "polynomial-2") > mean(fixed, "polynomial-2") + 0.05, "{}", run.out);
    assert_eq!(numbers(halved, "root-2")[4..], [2.2, 1.6, 7.4, 8.8]);
    let one_table = desk.run(&[&shots[..], &["full.dng", "half.dng", "--measured", "full.csv"]].concat());
    assert!(one_table.code == 2 && one_table.err.contains("2 shots and 1 tables"), "{}", one_table.err);
}

#[test]
fn what_is_judged_is_held_out_of_what_models_rest_on() {
    let desk = desk();
    let camera = Camera::simulated_one().sensitivities;
    // Cameras whose curves lie elsewhere.
    let shifted = |by: isize| {
        camera.each_ref().map(|channel| {
            let at = |i: isize| channel.0[i.clamp(0, 80) as usize];
            Spectrum(std::array::from_fn(|i| 0.7 * at(i as isize + by) + 0.3 * at(i as isize - 1)))
        })
    };
    let put =
        |name: &str, channels: &[Spectrum; 3]| desk.put(name, csv(["r", "g", "b"].into_iter().zip(channels)));
    put("cam_one_maker_judged.csv", &camera);
    put("cam_two_maker_judged.csv", &shifted(0));
    put("cam_one_maker_a.csv", &shifted(-2));
    put("cam_one_maker_b.csv", &shifted(2));
    put("cam_one_maker_c.csv", &shifted(4));
    let chart = darkroot_simulate::chart::reflectances();
    let mix = |i: usize| Spectrum(std::array::from_fn(|k| 0.5 * (chart[i].0[k] + chart[(i + 7) % 24].0[k])));
    let mixed: Vec<Spectrum> = (0..24).map(mix).collect();
    let names: Vec<String> = (0..24).map(|i| format!("mixed {i}")).collect();
    desk.put("mixed.csv", csv(names.iter().map(String::as_str).zip(&mixed)));
    let run = |prior: &[&str]| {
        let run = desk.run(
            &[
                &["evaluate", "--held-out", "--light", "D65", "--sensitivities", "cam_one_maker_judged.csv"]
                    [..],
                &["--set", "mixed=mixed.csv", "--chart", "chart=chart.csv"],
                &["--reflectances", "chart.csv", "mixed.csv", "--prior", "cam_one_maker_a.csv"],
                prior,
            ]
            .concat(),
        );
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(
            run.err.contains("left out of the prior because they are judged on: 24 surfaces"),
            "{}",
            run.err
        );
        run.out
    };
    let honest = run(&["cam_one_maker_b.csv", "cam_one_maker_c.csv"]);
    // The camera itself, and the same one measured by another laboratory, change nothing.
    let twins = [
        "cam_one_maker_judged.csv",
        "cam_two_maker_judged.csv",
        "cam_one_maker_b.csv",
        "cam_one_maker_c.csv",
    ];
    assert_eq!(run(&twins), honest);
    assert!(numbers(&honest, "spectral")[0] < numbers(&honest, "linear")[0], "{honest}");
    let alone =
        desk.run(&["evaluate", "--held-out", "--sensitivities", "camera.csv", "--set", "mixed=mixed.csv"]);
    assert!(alone.code == 2 && alone.err.contains("--prior"), "{}", alone.err);
}
