//! The arrows between the crates are those of ARCHITECTURE.md, and those between the files of a crate make no circle.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod circles;
mod files;
mod names;
mod platforms;
mod source;

use std::{collections::BTreeSet, process::Command};

use serde_json::Value;

/// The crates of ours that each crate may depend on, and whether it may name Rapier and enable features that draw or open windows.
const RULES: [Rule; 43] = [
    Rule::new("tabletop_storage", &[]),
    Rule::new("tabletop_geometry", &[]),
    Rule::new("tabletop_core", &["tabletop_geometry"]),
    Rule::new("tabletop_mesh", &["tabletop_core", "tabletop_geometry"]),
    Rule::new(
        "tabletop_xml",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_mesh",
            "tabletop_storage",
        ],
    ),
    Rule::new("tabletop_history", &["tabletop_core", "tabletop_geometry"]),
    Rule::new(
        "tabletop_physics",
        &["tabletop_core", "tabletop_geometry", "tabletop_history"],
    )
    .with_rapier(),
    Rule::new("tabletop_assembly", &["tabletop_core", "tabletop_geometry"]),
    Rule::new(
        "tabletop_scene",
        &[
            "tabletop_assembly",
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_history",
            "tabletop_physics",
        ],
    )
    .with_rapier(),
    Rule::new(
        "tabletop_demonstrator",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_history",
            "tabletop_physics",
        ],
    )
    .with_rapier(),
    Rule::new(
        "tabletop_mechanism",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_history",
            "tabletop_physics",
        ],
    ),
    Rule::new("tabletop_kinematics", &[]),
    Rule::new(
        "tabletop_robot",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_history",
            "tabletop_kinematics",
            "tabletop_mesh",
            "tabletop_physics",
            "tabletop_storage",
        ],
    )
    .with_rapier(),
    Rule::new(
        "tabletop_drive",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_history",
            "tabletop_kinematics",
            "tabletop_physics",
            "tabletop_robot",
        ],
    )
    .with_rapier(),
    Rule::new("tabletop_bridge", &["tabletop_storage"]),
    Rule::new("tabletop_engine", &[]),
    Rule::new(
        "tabletop_script",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_perception",
            "tabletop_engine",
            "tabletop_storage",
        ],
    ),
    Rule::new(
        "tabletop_camera",
        &["tabletop_core", "tabletop_geometry", "tabletop_history"],
    ),
    Rule::new(
        "tabletop_vision",
        &["tabletop_camera", "tabletop_core", "tabletop_geometry"],
    ),
    Rule::new(
        "tabletop_recorder",
        &["tabletop_core", "tabletop_geometry", "tabletop_storage"],
    ),
    Rule::new(
        "tabletop_scenario",
        &["tabletop_core", "tabletop_geometry", "tabletop_storage"],
    ),
    Rule::new(
        "tabletop_task",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_recorder",
            "tabletop_storage",
        ],
    ),
    Rule::new(
        "tabletop_controller",
        &["tabletop_core", "tabletop_geometry", "tabletop_kinematics"],
    ),
    Rule::new(
        "tabletop_planner",
        &[
            "tabletop_controller",
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_kinematics",
            "tabletop_task",
        ],
    ),
    Rule::new(
        "tabletop_sim",
        &[
            "tabletop_assembly",
            "tabletop_camera",
            "tabletop_controller",
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_drive",
            "tabletop_demonstrator",
            "tabletop_history",
            "tabletop_mechanism",
            "tabletop_perception",
            "tabletop_physics",
            "tabletop_recorder",
            "tabletop_robot",
            "tabletop_scenario",
            "tabletop_scene",
            "tabletop_script",
            "tabletop_storage",
            "tabletop_xml",
        ],
    ),
    Rule::new(
        "tabletop_replay",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_history",
            "tabletop_physics",
            "tabletop_recorder",
            "tabletop_robot",
            "tabletop_sim",
            "tabletop_storage",
            "tabletop_task",
            "tabletop_xml",
        ],
    ),
    Rule::new(
        "tabletop_episodes",
        &[
            "tabletop_assembly",
            "tabletop_camera",
            "tabletop_controller",
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_kinematics",
            "tabletop_physics",
            "tabletop_planner",
            "tabletop_recorder",
            "tabletop_replay",
            "tabletop_robot",
            "tabletop_sim",
            "tabletop_storage",
            "tabletop_task",
            "tabletop_vision",
        ],
    ),
    Rule::new(
        "tabletop_perception",
        &[
            "tabletop_camera",
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_vision",
        ],
    ),
    Rule::new(
        "tabletop_real",
        &[
            "tabletop_bridge",
            "tabletop_controller",
            "tabletop_core",
            "tabletop_planner",
        ],
    ),
    Rule::new(
        "tabletop_policy",
        &[
            "tabletop_camera",
            "tabletop_controller",
            "tabletop_core",
            "tabletop_episodes",
            "tabletop_geometry",
            "tabletop_planner",
            "tabletop_storage",
            "tabletop_task",
        ],
    ),
    Rule::new(
        "tabletop_film",
        &[
            "tabletop_camera",
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_recorder",
            "tabletop_replay",
            "tabletop_robot",
            "tabletop_sim",
            "tabletop_task",
        ],
    ),
    Rule::new(
        "tabletop_environment",
        &[
            "tabletop_assembly",
            "tabletop_core",
            "tabletop_episodes",
            "tabletop_film",
            "tabletop_geometry",
            "tabletop_history",
            "tabletop_planner",
            "tabletop_recorder",
            "tabletop_replay",
            "tabletop_robot",
            "tabletop_scenario",
            "tabletop_sim",
        ],
    ),
    Rule::new(
        "tabletop_validation",
        &[
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_physics",
            "tabletop_sim",
        ],
    ),
    Rule::new("tabletop_python", &["tabletop"]),
    Rule::new(
        "tabletop_export",
        &[
            "tabletop_core",
            "tabletop_episodes",
            "tabletop_film",
            "tabletop_geometry",
            "tabletop_recorder",
            "tabletop_replay",
            "tabletop_robot",
            "tabletop_storage",
            "tabletop_task",
        ],
    ),
    Rule::new(
        "tabletop_report",
        &[
            "tabletop_core",
            "tabletop_export",
            "tabletop_geometry",
            "tabletop_recorder",
            "tabletop_task",
        ],
    ),
    Rule::new(
        "tabletop_dataset",
        &[
            "tabletop_assembly",
            "tabletop_camera",
            "tabletop_core",
            "tabletop_export",
            "tabletop_geometry",
            "tabletop_recorder",
            "tabletop_replay",
            "tabletop_sim",
            "tabletop_storage",
            "tabletop_task",
        ],
    ),
    Rule::new("tabletop_harness", &["tabletop_harness_macro"]),
    Rule::new("tabletop_harness_macro", &[]),
    Rule::new("tabletop_user", &["tabletop_core", "tabletop_geometry"]),
    Rule::new(
        "tabletop_view",
        &["tabletop_core", "tabletop_geometry", "tabletop_user"],
    )
    .with_window(),
    Rule::new(
        "tabletop_gui",
        &[
            "tabletop_camera",
            "tabletop_core",
            "tabletop_geometry",
            "tabletop_perception",
            "tabletop_storage",
            "tabletop_user",
        ],
    )
    .with_window(),
    Rule::new(
        "tabletop",
        &[
            "tabletop_assembly",
            "tabletop_controller",
            "tabletop_core",
            "tabletop_dataset",
            "tabletop_geometry",
            "tabletop_xml",
            "tabletop_physics",
            "tabletop_scene",
            "tabletop_drive",
            "tabletop_demonstrator",
            "tabletop_environment",
            "tabletop_export",
            "tabletop_episodes",
            "tabletop_film",
            "tabletop_report",
            "tabletop_mechanism",
            "tabletop_history",
            "tabletop_kinematics",
            "tabletop_mesh",
            "tabletop_robot",
            "tabletop_script",
            "tabletop_sim",
            "tabletop_camera",
            "tabletop_recorder",
            "tabletop_replay",
            "tabletop_scenario",
            "tabletop_storage",
            "tabletop_task",
            "tabletop_planner",
            "tabletop_policy",
            "tabletop_user",
            "tabletop_validation",
            "tabletop_view",
            "tabletop_perception",
            "tabletop_bridge",
            "tabletop_real",
            "tabletop_vision",
            "tabletop_gui",
        ],
    )
    .with_window(),
];

struct Rule {
    name: &'static str,
    ours: &'static [&'static str],
    rapier: bool,
    window: bool,
}

impl Rule {
    const fn new(name: &'static str, ours: &'static [&'static str]) -> Self {
        Self {
            name,
            ours,
            rapier: false,
            window: false,
        }
    }

    const fn with_rapier(mut self) -> Self {
        self.rapier = true;
        self
    }

    const fn with_window(mut self) -> Self {
        self.window = true;
        self
    }
}

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

#[test]
fn crates_depend_only_as_the_table_allows() {
    let metadata = metadata(&["--no-deps"]);
    let packages = metadata["packages"].as_array().unwrap();
    let names: BTreeSet<_> = packages
        .iter()
        .map(|package| package["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, RULES.iter().map(|rule| rule.name).collect());

    for rule in &RULES {
        let package = packages
            .iter()
            .find(|package| package["name"] == rule.name)
            .unwrap();
        for dependency in package["dependencies"].as_array().unwrap() {
            let name = dependency["name"].as_str().unwrap();
            let for_tests = dependency["kind"] == "dev";
            let arrow = format!("{} -> {name}", rule.name);
            if name.starts_with("tabletop") && !for_tests {
                assert!(rule.ours.contains(&name), "{arrow} is not in the table");
            }
            if name.starts_with("bevy_rapier") && !for_tests {
                assert!(
                    rule.rapier,
                    "{arrow}: only physics and its users name Rapier"
                );
            }
            let is_allowed = rule.name == "tabletop_mesh" && name == "parry3d";
            assert!(
                name != "rapier3d" && (name != "parry3d" || is_allowed),
                "{arrow}: only through bevy_rapier3d, or two of them are linked"
            );
            if name == "bevy_egui" {
                assert!(rule.window, "{arrow}: only what shows may have panels");
            }
            for feature in strings(&dependency["features"]) {
                assert!(
                    rule.window || !WINDOW_FEATURES.contains(&feature),
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
