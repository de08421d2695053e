//! What is seen of the robot in the world.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::Stage;
use tabletop_baxter::{BaxterPlugin, Description, RobotBody, Source};
use tabletop_core::{Face, Figure, SimCommand, StepApp};

/// Triangles of every body that is seen, by name.
fn seen(stage: &mut Stage) -> Vec<(String, usize)> {
    let world = stage.app.world_mut();
    let mut bodies = world.query::<(&RobotBody, &Figure)>();
    let mut seen: Vec<_> = bodies
        .iter(world)
        .map(|(body, figure)| (body.name.clone(), figure.fine.indices.len()))
        .collect();
    seen.sort();
    seen
}

#[test]
fn the_robot_is_seen_while_it_is_shown() {
    let mut stage = Stage::new();
    let shown = seen(&mut stage);
    assert!(shown.len() > 20, "{shown:?}");
    let triangles: usize = shown.iter().map(|(_, triangles)| triangles).sum();
    assert!((10_000..40_000).contains(&triangles), "{triangles}");
    stage.tell(SimCommand::ShowRobot(false));
    stage.app.step(1);
    assert!(seen(&mut stage).is_empty());
    stage.tell(SimCommand::ShowRobot(true));
    stage.app.step(1);
    assert_eq!(seen(&mut stage), shown);
}

#[test]
fn the_face_changes_and_nothing_else() {
    let mut stage = Stage::new();
    let neutral = seen(&mut stage);
    stage.tell(SimCommand::ShowFace(Face::Blank));
    stage.app.step(1);
    let blank = seen(&mut stage);
    let changed: Vec<_> = neutral
        .iter()
        .zip(&blank)
        .filter(|(a, b)| a != b)
        .map(|((name, _), _)| name.as_str())
        .collect();
    assert_eq!(changed, ["screen"]);
}

#[test]
fn what_has_no_mesh_is_shown_by_what_it_is_touched_by() {
    let urdf = include_str!("../../../assets/baxter/baxter.urdf");
    let missing = "package://nowhere/wrist.stl";
    let urdf = urdf.replace("package://tabletop/wrist.shape.json", missing);
    let source = Source {
        path: "my.urdf".into(),
        urdf,
    };
    let robot = BaxterPlugin {
        description: Some(Description::read(source).unwrap()),
        ..default()
    };
    let mut usual = Stage::new();
    let mut stage = Stage::with(robot);
    let [usual, found] = [seen(&mut usual), seen(&mut stage)];
    let changed: Vec<_> = usual
        .iter()
        .zip(&found)
        .filter(|(a, b)| a != b)
        .map(|(_, (name, _))| name.as_str())
        .collect();
    assert_eq!(changed, ["left wrist", "right wrist"]);
}
