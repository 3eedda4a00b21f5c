//! Profiles from tables of patches that were measured elsewhere.

use darkroot_colour::Xyz;

use super::*;

/// The patches of the classic chart: the simulated camera's RGB in units of a 16-bit file, and XYZ under a light.
fn rows(shot: &Spectrum, measured: &Spectrum) -> Vec<(&'static str, [f64; 3], Xyz)> {
    let camera = Camera::simulated_one();
    let names = darkroot_simulate::chart::PATCHES.iter().map(|(name, _)| *name);
    let reflectances = darkroot_simulate::chart::reflectances();
    let patch = |(name, s): (&'static str, &Spectrum)| {
        (name, camera.response(s, shot).map(|v| 20_000.0 * v), s.reflected_xyz(measured))
    };
    names.zip(&reflectances).map(patch).collect()
}

fn csv(rows: &[(&str, [f64; 3], Xyz)]) -> String {
    let line = |(name, [r, g, b], Xyz { x, y, z }): &(&str, [f64; 3], Xyz)| {
        format!("{name},{r},{g},{b},{x},{y},{z}\n")
    };
    "patch,R,G,B,X,Y,Z\n".to_owned() + &rows.iter().map(line).collect::<String>()
}

const CAMERA: [&str; 4] = ["--make", "Darkroot", "--camera-model", "Simulated One"];

fn run(desk: &Desk, arguments: &[&str]) -> Run {
    desk.run(&[&["profile"], arguments, &CAMERA].concat())
}

#[test]
fn a_table_makes_the_profile_that_a_shot_makes() {
    let desk = Desk::new();
    let d50 = light("D50");
    desk.put("chart.csv", csv(&rows(&d50, &d50)));
    let of_table = figures(&run(&desk, &["chart.csv", "--light", "D50", "--json"]));
    assert!(mean(&of_table, of_table["model"].as_str().unwrap()) < mean(&of_table, "linear"));
    let text = String::from_utf8(desk.read("chart.toml")).unwrap();
    assert!(
        text.contains("Simulated One") && text.contains("1 table of patches") && text.contains("chart.csv"),
        "{text}"
    );
    // Argyll's form of the same.
    let ti3: String = rows(&d50, &d50).iter().fold(String::new(), |all, (name, rgb, xyz)| {
        let [r, g, b] = rgb.map(|v| v / 400.0);
        all + &format!("\"{name}\" {r} {g} {b} {} {} {}\n", 100.0 * xyz.x, 100.0 * xyz.y, 100.0 * xyz.z)
    });
    let head = "CTI3\nBEGIN_DATA_FORMAT\nSAMPLE_LOC RGB_R RGB_G RGB_B XYZ_X XYZ_Y XYZ_Z\nEND_DATA_FORMAT\nBEGIN_DATA\n";
    desk.put("scan.ti3", format!("{head}{ti3}END_DATA\n"));
    let of_ti3 = figures(&run(&desk, &["scan.ti3", "--light", "D50", "--json"]));
    assert!((mean(&of_ti3, "root-2") - mean(&of_table, "root-2")).abs() < 1e-3);
    // The profile serves the shots of that camera.
    desk.put("shot.dng", shot(&daylight()));
    let developed = desk.run(&["develop", "shot.dng", "--profile", "chart.toml", "-o", "shot.png"]);
    assert_eq!(developed.code, 0, "{}", developed.err);
}

#[test]
fn a_table_can_be_kept_as_a_camera_that_knows_every_light() {
    let desk = Desk::new();
    let d50 = light("D50");
    desk.put("chart.csv", csv(&rows(&d50, &d50)));
    let made = run(&desk, &["chart.csv", "--light", "D50", "--as-camera"]);
    assert!(made.code == 0 && made.err.contains("the camera under D50, left out"), "{}", made.err);
    let text = String::from_utf8(desk.read("chart.toml")).unwrap();
    assert!(text.contains("[sensitivities]") && text.contains("the camera by 1 table of patches"), "{text}");
    desk.put("shot.dng", shot(&daylight()));
    let developed = desk.run(&[
        "develop",
        "shot.dng",
        "--profile",
        "chart.toml",
        "--illuminant",
        "FL11",
        "-o",
        "shot.png",
    ]);
    assert_eq!(developed.code, 0, "{}", developed.err);
    // What was seen in one light tells of no other.
    let again = ["chart.csv", "--light", "D50", "--as-camera", "--measured-in-light", "--overwrite"];
    let refused = run(&desk, &again);
    assert!(refused.code != 0 && refused.err.contains("--measured-in-light"), "{}", refused.err);
}

#[test]
fn colours_measured_in_the_light_are_taken_as_they_are() {
    let desk = Desk::new();
    desk.put("lamp.csv", csv(&rows(&light("A"), &light("A"))));
    let table = |arguments: &[&str]| {
        figures(&run(&desk, &[&["lamp.csv", "--light", "A", "--json", "--overwrite"], arguments].concat()))
    };
    let (right, wrong) = (table(&["--measured-in-light"]), table(&[]));
    assert!(mean(&right, "root-2") < 0.7 * mean(&wrong, "root-2"), "{right} {wrong}");
}

#[test]
fn what_is_wrong_with_a_table_is_said() {
    let desk = Desk::new();
    let d50 = light("D50");
    desk.put("chart.csv", csv(&rows(&d50, &d50)));
    desk.put("lab.csv", "name,R,G,B,L,a,b\nA1,1,2,3,50,0,0\n");
    desk.put("plain.csv", "name,X,Y,Z\nA1,0.2,0.2,0.2\n");
    desk.put("shot.dng", shot(&daylight()));
    for (arguments, words) in [
        (vec!["plain.csv"], "has no camera RGB: its columns are name, X, Y, Z"),
        (vec!["lab.csv", "--measured-in-light"], "has no XYZ"),
        (vec!["lab.csv"], "only 1 of 1 patches"),
        (vec!["chart.csv", "--exclude", "mauve"], "has no patch mauve to exclude"),
        (vec!["chart.csv", "shot.dng"], "shot.dng: is no table of patches"),
        (vec!["chart.csv", "--report", "r.html"], "--report needs raw shots"),
        (vec!["chart.csv", "--flat", "shot.dng"], "--flat"),
        (vec!["shot.dng"], "raw shots tell it themselves"),
    ] {
        let run = run(&desk, &[&arguments[..], &["--light", "D50"]].concat());
        assert!(run.code != 0 && run.err.contains(words), "{words}: {}", run.err);
    }
    let unnamed = desk.run(&["profile", "chart.csv", "--light", "D50"]);
    assert!(unnamed.code == 2 && unnamed.err.contains("--camera-model"), "{}", unnamed.err);
}
