//! Which profile gives the colours, and that it is said.

use super::*;

/// A root polynomial of order 2 whose terms sum to the white of D50.
pub(super) fn profile(make: &str, model: &str) -> String {
    format!(
        r#"format = "darkroot profile"
version = 1

[camera]
make = "{make}"
model = "{model}"

[origin]
summary = "written by hand for a test"

[[calibration]]
light = "D55"
xy = [0.3324, 0.3474]
model = "root-2"

[calibration.terms]
r = [0.68, 0.3, 0.02]
g = [0.16, 0.72, -0.02]
b = [0.1, -0.04, 0.8]
"(rg)^1/2" = [0.06, 0.05, -0.03]
"(gb)^1/2" = [-0.05, 0.02, 0.05]
"(rb)^1/2" = [0.0142, -0.05, 0.0049]
"#
    )
}

/// Develops to a PNG; its bytes and what was said.
fn developed(desk: &Desk, arguments: &[&str]) -> (Vec<u8>, String) {
    let run = desk.develop(&[&["a.dng", "-o", "o.png", "--overwrite"], arguments].concat());
    (desk.read("o.png"), run.err)
}

#[test]
fn the_colours_of_the_files_own_matrix_are_said() {
    let desk = Desk::with_dng();
    desk.put("b.nef", small_nef());
    assert!(desk.develop(&["a.dng", "--profile", "matrix"]).err.contains("colours: matrix in the file"));
    let nef = desk.develop(&["b.nef", "--profile", "matrix"]).err;
    assert!(nef.contains("colours: camera matrix"), "{nef}");
}

#[test]
fn a_profile_file_for_the_camera_gives_the_colours() {
    let desk = Desk::with_dng();
    desk.put("my.toml", profile("Darkroot", "Simulated One"));
    let (matrix, _) = developed(&desk, &[]);
    let (own, err) = developed(&desk, &["--profile", "my.toml"]);
    assert!(own != matrix);
    assert!(err.contains("profile for Darkroot Simulated One (D55), my.toml"), "{err}");
}

#[test]
fn a_profile_for_another_camera_is_refused_and_both_are_named() {
    let desk = Desk::with_dng();
    desk.put("my.toml", profile("Nikon", "D700"));
    let arguments = ["develop", "a.dng", "--profile", "my.toml"];
    desk.fails(1, &arguments, &["my.toml", "Nikon D700", "Darkroot Simulated One", "a.dng", "aliases"]);
    assert_eq!(desk.names(), ["a.dng", "my.toml"]);
}

#[test]
fn an_alias_makes_a_profile_fit() {
    let desk = Desk::with_dng();
    let text = profile("Nikon", "D700")
        .replace("model = \"D700\"", "model = \"D700\"\naliases = [\"DARKROOT Simulated one\"]");
    desk.put("my.toml", text);
    let (_, err) = developed(&desk, &["--profile", "my.toml"]);
    assert!(err.contains("profile for Nikon D700"), "{err}");
}

#[test]
fn a_profile_file_that_is_broken_says_where() {
    let desk = Desk::with_dng();
    let good = profile("Darkroot", "Simulated One");
    let breaks: [(&str, &str, &str); 6] = [
        ("[camera]", "[camera", "profile"),
        ("version = 1", "version = 7", "version 7"),
        ("\"(rb)^1/2\" = [0.0142, -0.05, 0.0049]\n", "", "missing"),
        ("0.68", "nan", "not a finite number"),
        ("origin", "orgin", "orgin"),
        ("root-2", "root-7", "root-7"),
    ];
    for (from, to, word) in breaks {
        assert!(good.contains(from));
        desk.put("my.toml", good.replacen(from, to, 1));
        desk.fails(1, &["develop", "a.dng", "--profile", "my.toml"], &["my.toml", word]);
    }
    desk.put("my.toml", [0xff, 0xfe, 0x00]);
    desk.fails(1, &["develop", "a.dng", "--profile", "my.toml"], &["my.toml"]);
    desk.fails(1, &["develop", "a.dng", "--profile", "none.toml"], &["none.toml", "no such file"]);
    assert_eq!(desk.names(), ["a.dng", "my.toml"]);
}

#[test]
fn a_camera_without_a_profile_is_estimated_from_its_matrix() {
    let desk = Desk::with_dng();
    let (matrix, _) = developed(&desk, &["--profile", "matrix"]);
    let (estimated, err) = developed(&desk, &[]);
    assert!(estimated != matrix);
    assert!(err.contains("colours: estimated from the camera's matrix (expected dE2000 "), "{err}");

    // What develop used can be kept, shown, exported and used again: the same picture comes of it.
    let made = desk.run(&["profile", "from-matrix", "a.dng", "-o", "own.toml"]);
    assert!(
        made.code == 0 && made.err.contains("expected dE2000") && made.err.contains("by itself"),
        "{}",
        made.err
    );
    let (again, err) = developed(&desk, &["--profile", "own.toml"]);
    assert!(err.contains("(its sensitivities)"), "{err}");
    assert!(again == estimated);
    let shown = desk.run(&["profile", "show", "own.toml"]).out;
    assert!(shown.contains("for they are an estimate") && shown.contains("D65: xy"), "{shown}");
    for (to, light, file) in
        [("icc", "FL11", "o.icc"), ("cube", "3000K", "o.cube"), ("clf", "LED-B3", "o.clf")]
    {
        let run = desk.run(&["profile", "export", "own.toml", "--to", to, "--light", light, "-o", file]);
        assert_eq!(run.code, 0, "{to}: {}", run.err);
    }

    let named = desk.run(&["profile", "from-matrix", "nikon d90", "-o", "d90.toml"]);
    assert!(named.code == 0 && named.err.contains("Nikon D90"), "{}", named.err);
    let unknown = desk.run(&["profile", "from-matrix", "Nikon D9999", "-o", "x.toml"]);
    assert!(unknown.code > 0 && unknown.err.contains("profile list --all"), "{}", unknown.err);
    let all = desk.run(&["profile", "list", "--all"]).out;
    assert!(all.lines().count() > 700 && all.contains("Nikon D90"), "{}", all.lines().count());
}

#[test]
fn a_profile_in_the_users_folder_is_found_by_its_camera() {
    let desk = Desk::with_dng();
    let (matrix, _) = developed(&desk, &["--profile", "matrix"]);
    let folder = desk.data.path().join("darkroot/profiles/any/depth");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("other.toml"), profile("Nikon", "D700")).unwrap();
    std::fs::write(folder.join("mine.toml"), profile("Darkroot", "Simulated One")).unwrap();
    let (own, err) = developed(&desk, &[]);
    assert!(own != matrix);
    assert!(err.contains("profile for Darkroot Simulated One") && err.contains("mine.toml"), "{err}");
    let inspected = desk.run(&["inspect", "a.dng"]).out;
    assert!(inspected.contains("mine.toml"), "{inspected}");

    let (by_matrix, err) = developed(&desk, &["--profile", "matrix"]);
    assert!(by_matrix == matrix && err.contains("matrix in the file"), "{err}");
}

#[test]
fn a_dcp_in_the_users_folder_serves_its_camera_after_profiles_of_darkroots_own() {
    let desk = Desk::with_dng();
    let (matrix, _) = developed(&desk, &[]);
    desk.put("p.toml", profile("Darkroot", "Simulated One"));
    let export = ["profile", "export", "p.toml", "--to", "dcp", "--for", "a.dng", "-o", "p.dcp"];
    assert_eq!(desk.run(&export).code, 0);
    let folder = desk.data.path().join("darkroot/profiles/adobe");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("Simulated One.DCP"), desk.read("p.dcp")).unwrap();
    let (by_dcp, err) = developed(&desk, &[]);
    assert!(by_dcp != matrix && err.contains("Simulated One.DCP"), "{err}");
    assert!(desk.run(&["profile", "list"]).out.contains("Simulated One.DCP"));

    std::fs::write(folder.join("z.toml"), profile("Darkroot", "Simulated One")).unwrap();
    let (_, err) = developed(&desk, &[]);
    assert!(err.contains("z.toml") && !err.contains(".DCP"), "{err}");

    std::fs::write(folder.join("broken.dcp"), "no DCP").unwrap();
    let (_, err) = developed(&desk, &[]);
    assert!(err.contains("warning: ") && err.contains("broken.dcp") && err.contains("not used"), "{err}");
}

#[test]
fn the_folder_under_the_home_serves_where_no_data_folder_is_named() {
    let desk = Desk::with_dng();
    let folder = desk.data.path().join(".local/share/darkroot/profiles");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("mine.toml"), profile("Darkroot", "Simulated One")).unwrap();
    // The specification has empty and relative paths ignored.
    for data in [None, Some(""), Some("relative")] {
        let mut command = desk.command(&["develop", "a.dng", "--overwrite"]);
        match data {
            Some(path) => command.env("XDG_DATA_HOME", path),
            None => command.env_remove("XDG_DATA_HOME"),
        };
        let run = Run::of(&command.output().unwrap(), &["develop"]);
        assert!(run.code == 0 && run.err.contains("mine.toml"), "{data:?}: {}", run.err);
    }
}

#[test]
fn a_broken_profile_in_the_users_folder_is_said_and_left_out() {
    let desk = Desk::with_dng();
    let folder = desk.data.path().join("darkroot/profiles");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("broken.toml"), "version = ").unwrap();
    std::fs::write(folder.join("readme.txt"), "no profile").unwrap();
    let (_, err) = developed(&desk, &[]);
    assert!(err.contains("warning: ") && err.contains("broken.toml") && err.contains("not used"), "{err}");
    assert!(!err.contains("readme.txt") && err.contains("the camera's matrix"), "{err}");
}

#[test]
fn a_profile_of_the_user_wins_over_one_that_is_built_in() {
    let store = darkroot::ProfileStore::builtin();
    let built_in = store.all().first().copied().unwrap();
    let camera = built_in.profile.camera();
    let mut capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &Exposure::default());
    (capture.camera.make, capture.camera.model) = (camera.make.clone(), camera.model.clone());
    let desk = Desk::new();
    desk.put("a.dng", dng::write(&capture, dng::Storage::JpegStrip));
    let (before, err) = developed(&desk, &[]);
    assert!(err.contains("built in") && err.contains(&camera.name()), "{err}");
    let folder = desk.data.path().join("darkroot/profiles");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("mine.toml"), profile(&camera.make, &camera.model)).unwrap();
    let (after, err) = developed(&desk, &[]);
    assert!(err.contains("mine.toml") && !err.contains("built in") && before != after, "{err}");
}

#[test]
fn a_profile_that_was_made_for_another_light_is_told() {
    let desk = Desk::with_dng();
    desk.put("my.toml", profile("Darkroot", "Simulated One"));
    let (_, near) = developed(&desk, &["--profile", "my.toml", "--white-balance", "5200K"]);
    assert!(!near.contains("the profile is for"), "{near}");
    let (_, far) = developed(&desk, &["--profile", "my.toml", "--white-balance", "2700K"]);
    assert!(far.contains("the profile is for D55") && far.contains("has 2700 K"), "{far}");
    // Who names the light knows.
    let (_, named) =
        developed(&desk, &["--profile", "my.toml", "--white-balance", "2700K", "--illuminant", "A"]);
    assert!(!named.contains("the profile is for"), "{named}");
}

#[test]
fn the_light_of_the_colours_can_be_named() {
    let desk = Desk::with_dng();
    let (by_white, _) = developed(&desk, &[]);
    let (tube, said) = developed(&desk, &["--illuminant", "FL11"]);
    assert!(tube != by_white && said.contains("for F11"), "{said}");
    // The same lamp measured: what is written down needs no file.
    let fl11 = darkroot_colour::illuminant::Illuminant::by_name("FL11").unwrap().spectrum();
    let column = |i: usize| (380 + 5 * i).to_string();
    let (nm, powers): (Vec<String>, Vec<String>) =
        (0..81).map(|i| (column(i), fl11.0[i].to_string())).unzip();
    desk.put("lamp.csv", format!("name,{}\nshop,{}\n", nm.join(","), powers.join(",")));
    let (measured, said) = developed(&desk, &["--illuminant", "lamp.csv"]);
    assert!(said.contains("for shop"), "{said}");
    let pixels = |png: &[u8]| image::load_from_memory(png).unwrap().to_rgb8().into_raw();
    let off = pixels(&measured).iter().zip(pixels(&tube)).map(|(a, b)| a.abs_diff(b)).max();
    assert!(off <= Some(1), "{off:?}");
    let recipe = desk.run(&["recipe", "--illuminant", "lamp.csv"]);
    desk.put("shop.toml", recipe.out);
    std::fs::remove_file(desk.path("lamp.csv")).unwrap();
    assert!(developed(&desk, &["--recipe", "shop.toml"]).0 == measured);
    let lost = desk.run(&["develop", "a.dng", "--overwrite", "--illuminant", "lamp.csv"]);
    assert!(lost.code != 0 && lost.err.contains("there is no such file"), "{}", lost.err);
    let refused =
        desk.run(&["develop", "a.dng", "--overwrite", "--profile", "matrix", "--illuminant", "FL11"]);
    assert!(refused.code != 0 && refused.err.contains("F11 needs a profile"), "{}", refused.err);
    let no_light = desk.run(&["develop", "a.dng", "--overwrite", "--illuminant", "moon"]);
    assert!(no_light.code != 0 && no_light.err.contains("`moon` is no illuminant"), "{}", no_light.err);
}
