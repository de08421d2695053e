//! No arrow between crates leads up to a higher floor, and those between the files of a crate make no circle.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod circles;
mod files;
mod map;
mod names;
mod platforms;
mod real_robot;
mod security;
mod source;

use std::{collections::BTreeMap, path::Path, process::Command};

use serde_json::Value;

/// The floors of `crates/`, from the lowest up. A crate needs only its neighbours and those below.
const FLOORS: [&str; 8] = [
    "base", "world", "record", "robot", "run", "data", "window", "test",
];

/// The crates that may name Rapier.
const WITH_RAPIER: [&str; 5] = [
    "tabletop_demonstrator",
    "tabletop_drive",
    "tabletop_physics",
    "tabletop_robot",
    "tabletop_scene",
];

/// The crates that may draw or open windows.
const WITH_WINDOW: [&str; 4] = [
    "tabletop_gui",
    "tabletop_input",
    "tabletop_view",
    "tabletop_window",
];

/// Features of Bevy that draw or open windows.
const WINDOW_FEATURES: [&str; 12] = [
    "2d",
    "3d",
    "3d_api",
    "bevy_asset",
    "bevy_camera",
    "bevy_core_pipeline",
    "bevy_gizmos_render",
    "bevy_pbr",
    "bevy_render",
    "bevy_window",
    "bevy_winit",
    "default",
];

fn metadata(arguments: &[&str]) -> Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .args(arguments)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

fn strings(list: &Value) -> impl Iterator<Item = &str> {
    list.as_array()
        .unwrap()
        .iter()
        .map(|item| item.as_str().unwrap())
}

/// The number of a package's floor; the facade and what is made of it are above all.
fn floor_of(package: &Value) -> usize {
    let manifest = Path::new(package["manifest_path"].as_str().unwrap());
    let folders: Vec<_> = manifest.iter().rev().skip(2).take(2).collect();
    match folders[..] {
        [floor, crates] if crates == "crates" => FLOORS
            .iter()
            .position(|known| floor == *known)
            .unwrap_or_else(|| panic!("{floor:?} is no floor of {FLOORS:?}")),
        _ => FLOORS.len(),
    }
}

#[test]
fn crates_need_only_their_neighbours_and_those_below() {
    let metadata = metadata(&["--no-deps"]);
    let packages = metadata["packages"].as_array().unwrap();
    let floors: BTreeMap<_, _> = packages
        .iter()
        .map(|package| (package["name"].as_str().unwrap(), floor_of(package)))
        .collect();
    assert!(
        FLOORS
            .iter()
            .enumerate()
            .all(|(floor, _)| floors.values().any(|it| *it == floor))
    );
    for package in packages {
        let needing = package["name"].as_str().unwrap();
        let (rapier, window) = (
            WITH_RAPIER.contains(&needing),
            WITH_WINDOW.contains(&needing),
        );
        for dependency in package["dependencies"].as_array().unwrap() {
            let name = dependency["name"].as_str().unwrap();
            let for_tests = dependency["kind"] == "dev";
            let arrow = format!("{needing} -> {name}");
            if let Some(floor) = floors.get(name).filter(|_| !for_tests) {
                assert!(*floor <= floors[needing], "{arrow} leads up");
            }
            if name.starts_with("bevy_rapier") && !for_tests {
                assert!(rapier, "{arrow}: only physics and its users name Rapier");
            }
            let is_allowed = needing == "tabletop_mesh" && name == "parry3d";
            assert!(
                name != "rapier3d" && (name != "parry3d" || is_allowed),
                "{arrow}: only through bevy_rapier3d, or two of them are linked"
            );
            if name == "bevy_egui" {
                assert!(window, "{arrow}: only what shows may have panels");
            }
            for feature in strings(&dependency["features"]) {
                assert!(
                    window || !WINDOW_FEATURES.contains(&feature),
                    "{arrow} with {feature}: only view, gui and the root draw"
                );
            }
        }
    }
}

#[test]
fn the_headless_program_has_no_renderer_and_no_window_library() {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--package", "tabletop", "--no-default-features"])
        .args(["--edges", "normal,build", "--prefix", "none"])
        .args(["--locked", "--offline"])
        .output()
        .unwrap();
    let tree = String::from_utf8(output.stdout).unwrap();
    assert!(tree.contains("bevy_rapier3d"), "{tree}");
    for banned in [
        "wgpu",
        "winit",
        "bevy_render",
        "bevy_window",
        "egui",
        "naga",
        "x11",
    ] {
        let found = tree.lines().find(|line| line.starts_with(banned));
        assert_eq!(found, None);
    }
}
