//! Formats from recipes, and endings of outputs.

use super::*;

#[test]
fn each_file_has_the_format_of_its_own_recipe() {
    let desk = roll();
    desk.put("roll/b.nef", small_nef());
    desk.put("roll/c.dng", small_dng());
    desk.put("roll/darkroot.toml", "format = \"png\"");
    desk.put("roll/b.nef.darkroot.toml", "format = \"tiff\"");
    let files = ["roll/a.dng", "roll/b.nef", "roll/c.dng"];
    desk.develop(&[&files[..], &["-o", "out/"]].concat());
    assert_eq!(names(&desk.path("out")), ["a.png", "b.tif", "c.png"]);
    desk.develop(&[&files[..], &["-o", "out/{seq}.{ext}"]].concat());
    assert!(
        desk.read("out/0001.png").starts_with(b"\x89PNG") && desk.read("out/0002.tif").starts_with(b"II")
    );
    // With formats of their own, files of one stem do not collide.
    desk.put("roll/a.nef", small_nef());
    desk.put("roll/a.nef.darkroot.toml", "format = \"webp\"");
    desk.develop(&["roll/a.dng", "roll/a.nef", "-o", "both/"]);
    assert_eq!(names(&desk.path("both")), ["a.png", "a.webp"]);
    // Flags count more than the folder.
    desk.develop(&["roll/c.dng", "--format", "jpeg", "-o", "out/"]);
    desk.develop(&["roll/c.dng", "--format", "auto", "-o", "auto/"]);
    assert!(desk.path("out/c.jpg").exists() && desk.path("auto/c.jpg").exists());
}

#[test]
fn the_ending_of_the_output_counts_more_than_the_format_of_a_recipe_and_that_is_said() {
    let desk = roll();
    desk.put("roll/darkroot.toml", "format = \"png\"");
    for output in ["o.tif", "{stem}.tif"] {
        let run = desk.develop(&["roll/a.dng", "-o", output, "--overwrite"]);
        let note =
            "note: the output's ending counts more than the format png of roll/darkroot.toml: it is TIFF";
        assert!(run.err.contains(note), "{}", run.err);
    }
    assert!(desk.read("o.tif").starts_with(b"II") && desk.read("a.tif").starts_with(b"II"));
    let run = desk.develop(&["roll/a.dng", "-o", "o.png"]);
    assert!(!run.err.contains("note:"), "{}", run.err);
    // An ending that says nothing leaves it to the recipe.
    desk.develop(&["roll/a.dng", "-o", "o.bin"]);
    assert!(desk.read("o.bin").starts_with(b"\x89PNG"));
}
