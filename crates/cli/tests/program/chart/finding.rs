//! Charts are found where they are, and nowhere else.

use super::*;

/// Corners of a chart in pixels of the developed picture, from `darkroot chart --json`.
fn found(desk: &Desk, file: &str) -> Vec<serde_json::Value> {
    let run = desk.run(&["chart", file, "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let line: serde_json::Value = serde_json::from_str(run.out.trim()).unwrap();
    line["charts"].as_array().unwrap().clone()
}

#[test]
fn a_chart_is_found_whichever_way_it_is_held() {
    let [a, b, c, d] = CORNERS;
    for (turned, corners) in [[a, b, c, d], [c, d, a, b]].into_iter().enumerate() {
        let scene = Scene::chart(SIZE, corners, &darkroot_simulate::chart::reflectances(), 6, 0.15);
        let desk = Desk::new();
        let capture = expose(&scene, &Camera::simulated_one(), &daylight());
        desk.put("chart.dng", dng::write(&capture, dng::Storage::Uncompressed));
        let charts = found(&desk, "chart.dng");
        assert_eq!(charts.len(), 1, "{turned}");
        for (found, expected) in charts[0]["corners"].as_array().unwrap().iter().zip(corners) {
            for (f, e) in found.as_array().unwrap().iter().zip(expected) {
                assert!((f.as_f64().unwrap() - (e - 4.0)).abs() < 1.0, "{turned}: {charts:?}");
            }
        }
        let centres = charts[0]["centres"].as_array().unwrap();
        assert_eq!((&charts[0]["grid"], centres.len()), (&serde_json::json!([6, 4]), 24));
        // Where the diagonals of the chart cross.
        let middle: f64 = [8, 9, 14, 15].iter().map(|i| centres[*i][0].as_f64().unwrap()).sum::<f64>() / 4.0;
        assert!((middle - (240.0 - 4.0)).abs() < 4.0, "{turned}: {middle}");
        // The profile needs no help either, and the developed picture can be searched as well.
        assert_eq!(desk.run(&["profile", "chart.dng", "--light", "D50", "-o", "p.toml"]).code, 0);
        desk.develop(&["chart.dng", "-o", "chart.jpg"]);
        assert_eq!(found(&desk, "chart.jpg").len(), 1);
        assert_eq!(desk.run(&["chart", "chart.dng", "--preview", "shown.png"]).code, 0);
        assert!(desk.read("shown.png").starts_with(b"\x89PNG"));
    }
}

#[test]
fn no_chart_is_invented_and_a_mirrored_one_is_refused() {
    let desk = Desk::new();
    let plain = expose(&Scene::gradient(SIZE), &Camera::simulated_one(), &daylight());
    desk.put("plain.dng", dng::write(&plain, dng::Storage::Uncompressed));
    let [a, b, c, d] = CORNERS;
    let mirrored = Scene::chart(SIZE, [b, a, d, c], &darkroot_simulate::chart::reflectances(), 6, 0.15);
    let mirrored = expose(&mirrored, &Camera::simulated_one(), &daylight());
    desk.put("mirrored.dng", dng::write(&mirrored, dng::Storage::Uncompressed));
    let run = desk.run(&["chart", "plain.dng", "mirrored.dng"]);
    assert_eq!(run.code, 1, "{}", run.err);
    let lines: Vec<&str> = run.out.lines().collect();
    assert!(lines[0].contains("no chart") && lines[1].contains("no chart"), "{lines:?}");
    assert!(lines[1].contains("mirrored"), "{lines:?}");
    let run = desk.run(&["profile", "plain.dng", "--light", "D50", "-o", "p.toml"]);
    assert!(run.code == 1 && run.err.contains("--corners"), "{}", run.err);
}
