//! From shots of a chart to a profile, and a new shot against it.

use darkroot_colour::Spectrum;
use darkroot_colour::illuminant::Illuminant;

use super::*;

mod checks;
mod delivering;
mod finding;
mod making;
mod series;
mod tables;
mod target;
mod verifying;

const SIZE: Size = Size { width: 488, height: 328 };

/// Corners of the chart in the frame; four pixels are left out on each side of the developed picture.
const CORNERS: [[f64; 2]; 4] = [[60.0, 50.0], [420.0, 66.0], [410.0, 290.0], [70.0, 276.0]];

fn corners() -> String {
    CORNERS.iter().flatten().map(|v| (v - 4.0).to_string()).collect::<Vec<_>>().join(",")
}

/// A shot of the chart by the simulated camera.
fn shot(exposure: &Exposure) -> Vec<u8> {
    let scene = Scene::chart(SIZE, CORNERS, &darkroot_simulate::chart::reflectances(), 6, 0.15);
    dng::write(&expose(&scene, &Camera::simulated_one(), exposure), dng::Storage::Uncompressed)
}

fn light(name: &str) -> Spectrum {
    Illuminant::by_name(name).unwrap().spectrum()
}

fn daylight() -> Exposure {
    Exposure { light: light("D50"), noise: Some(7), ..Exposure::default() }
}

/// A desk with `chart.dng`.
fn desk(exposure: &Exposure) -> Desk {
    let desk = Desk::new();
    desk.put("chart.dng", shot(exposure));
    desk
}

fn profile(desk: &Desk, arguments: &[&str]) -> Run {
    let corners = corners();
    desk.run(&[&["profile", "chart.dng", "--light", "D50", "--corners", &corners], arguments].concat())
}

/// The JSON line of a run.
fn figures(run: &Run) -> serde_json::Value {
    assert_eq!(run.code, 0, "{}", run.err);
    serde_json::from_str(run.out.lines().next().unwrap()).unwrap()
}

fn mean(figures: &serde_json::Value, model: &str) -> f64 {
    let all = figures["models"].as_array().unwrap();
    all.iter().find(|m| m["model"] == model).unwrap()["leave_one_out"]["mean"].as_f64().unwrap()
}

/// A check by its name.
fn gate<'a>(gates: &'a serde_json::Value, name: &str) -> &'a serde_json::Value {
    gates.as_array().unwrap().iter().find(|g| g["name"] == name).unwrap_or_else(|| panic!("{name}: {gates}"))
}
