//! Figures of the robot in the world.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use bevy_rapier3d::{prelude::Collider, rapier::prelude::SharedShape};
use kit::Stage;
use tabletop_core::{Drive, Face, Figure, RobotCommand, RobotJoint, StepApp};
use tabletop_robot::{Description, DescriptionSource, RobotLink, RobotPlugin};

/// Triangles of every body that is seen, by name.
fn seen(stage: &mut Stage) -> Vec<(String, usize)> {
    let world = stage.app.world_mut();
    let mut bodies = world.query::<(&RobotLink, &Figure)>();
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
    stage.tell(RobotCommand::Show(false));
    stage.app.step(1);
    assert!(seen(&mut stage).is_empty());
    stage.tell(RobotCommand::Show(true));
    stage.app.step(1);
    assert_eq!(seen(&mut stage), shown);
}

/// An STL file of a corner of a cube, 0.2 m along its edges.
fn tetrahedron() -> String {
    let corners = ["0 0 0", "0.2 0 0", "0 0.2 0", "0 0 0.2"];
    let facet = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [a, b, c].map(|i| format!("vertex {}\n", corners[i]));
        format!("facet normal 0 0 1\nouter loop\n{a}{b}{c}endloop\nendfacet\n")
    };
    let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(facet);
    format!("solid a\n{}endsolid a\n", facets.concat())
}

#[test]
fn a_link_is_touched_by_the_hulls_of_its_meshes() {
    let folder = std::env::temp_dir().join(format!("tabletop-touched-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let box_of_torso = "<box size=\"0.31 0.3 0.23\"/>";
    let with_mesh = |mesh: &str| {
        let urdf = include_str!("../../../../assets/baxter/baxter.urdf");
        assert!(urdf.contains(box_of_torso));
        let mesh = format!("<mesh filename=\"{mesh}\"/>");
        let source = DescriptionSource {
            path: folder.join("my.urdf"),
            urdf: urdf.replacen(box_of_torso, &mesh, 1),
            layout: None,
            reach: None,
        };
        let mut stage = Stage::with(RobotPlugin {
            description: Some(Description::read(source).unwrap()),
            ..default()
        });
        let world = stage.app.world_mut();
        let mut bodies = world.query::<(&RobotLink, &Collider)>();
        let (_, torso) = bodies
            .iter(world)
            .find(|(body, _)| body.name == "torso")
            .unwrap();
        let extents = |shape: &SharedShape| shape.compute_local_aabb().extents();
        let parts = torso.raw.as_compound().unwrap().shapes();
        parts
            .iter()
            .map(|(_, part)| extents(part))
            .collect::<Vec<_>>()
    };
    std::fs::write(folder.join("whole.stl"), tetrahedron()).unwrap();
    let with_hull = with_mesh("whole.stl");
    let without = with_mesh("missing.stl");
    assert_eq!(without.len() + 1, with_hull.len());
    let hull = with_hull.iter().filter(|hull| !without.contains(hull));
    let [hull] = hull.collect::<Vec<_>>()[..] else {
        panic!("{with_hull:?}");
    };
    assert!(
        (hull - Vec3::splat(2.0)).abs().max_element() < 1e-4,
        "{hull}"
    );
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_face_changes_and_nothing_else() {
    let mut stage = Stage::new();
    let neutral = seen(&mut stage);
    stage.tell(RobotCommand::ShowFace(Face::Blank));
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
fn a_link_without_a_mesh_shows_its_collision_shape() {
    let urdf = include_str!("../../../../assets/baxter/baxter.urdf");
    let missing = "package://nowhere/wrist.stl";
    let urdf = urdf.replace("package://tabletop/wrist.shape.json", missing);
    let source = DescriptionSource {
        path: "my.urdf".into(),
        urdf,
        layout: None,
        reach: None,
    };
    let robot = RobotPlugin {
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

#[test]
fn a_link_that_touches_nothing_moves_with_its_arm() {
    let urdf = include_str!("../../../../assets/baxter/baxter.urdf");
    let touched_by = "<collision>
      <origin xyz=\"0 0 0.056\"/>
      <geometry><cylinder radius=\"0.06\" length=\"0.288\"/></geometry>
    </collision>";
    assert!(urdf.contains(touched_by));
    let source = DescriptionSource {
        path: "my.urdf".into(),
        urdf: urdf.replacen(touched_by, "", 1),
        layout: None,
        reach: None,
    };
    let robot = RobotPlugin {
        description: Some(Description::read(source).unwrap()),
        ..default()
    };
    let turned = |mut stage: Stage| {
        let drive = Drive::Velocity(1.0);
        stage.tell(RobotCommand::drive([(RobotJoint::LeftS1, drive)]));
        stage.app.step(20);
        let world = stage.app.world_mut();
        let mut links = world.query::<(&RobotLink, &Transform, Has<Collider>)>();
        let mut links = links.iter(world);
        let found = links.find(|(link, ..)| link.name == "left upper forearm");
        let (_, place, is_touched) = found.unwrap();
        (*place, is_touched)
    };
    let (there, is_touched) = turned(Stage::new());
    assert!(is_touched);
    assert_eq!(turned(Stage::with(robot)), (there, false));
}
