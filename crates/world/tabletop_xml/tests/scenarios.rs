//! The scenarios in `tablesetup/`: they have the right content, and nothing overlaps at the start.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on panics")]

use std::path::Path;

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, SceneItem, SceneSpec, Shape, Table};
use tabletop_geometry::{Pose, Primitive, Solid};
use tabletop_xml::read_task;

const NAMES: [&str; 15] = [
    "chain",
    "chains",
    "cylinders",
    "default",
    "drawer",
    "empty",
    "gates",
    "hammer",
    "letters",
    "lidbox",
    "logs",
    "shapes",
    "tower",
    "trapdoor",
    "walls",
];

fn scenario(name: &str) -> SceneSpec {
    let folder = Path::new("../../../tablesetup");
    let task = read_task(&folder.join(name).with_extension("xml")).unwrap();
    assert_eq!(task.faults, []);
    task.scene
}

fn objects(name: &str) -> Vec<ObjectSpec> {
    scenario(name)
        .items
        .into_iter()
        .filter_map(|item| match item {
            SceneItem::Object(object) => Some(object),
            SceneItem::Chain(_) | SceneItem::LidBox(_) | SceneItem::Jointed(_) => None,
        })
        .collect()
}

#[test]
fn the_program_starts_with_two_cubes() {
    let scene = scenario("default");
    assert_eq!(scene.table, Table::default());
    let cube = |id: &str, x, turn, color: &str| {
        SceneItem::Object(ObjectSpec {
            id: id.into(),
            pose: Pose::from_degrees(Vec3::new(x, 0.0, 1.0), Vec3::Z * turn),
            mass: 1.0,
            shape: Shape::Block {
                span: Vec3::splat(2.0),
                color: color.parse().unwrap(),
            },
            dynamics: Default::default(),
            descriptions: vec![],
        })
    };
    assert_eq!(
        scene.items,
        [
            cube("RedBlock", 2.0, -15.0, "red"),
            cube("GreenBlock", -2.0, 45.0, "green")
        ]
    );
}

#[test]
fn every_element_of_the_language_is_shown() {
    let objects: Vec<_> = NAMES.into_iter().flat_map(objects).collect();
    let parts: Vec<_> = objects
        .iter()
        .flat_map(|object| object.shape.simple_parts())
        .collect();
    for name in ["block", "cylinder", "sphere", "box"] {
        assert!(parts.iter().any(|part| part.shape.name() == name), "{name}");
    }
    let hammer = &objects
        .iter()
        .find(|object| object.id == "hammer")
        .unwrap()
        .shape;
    let Shape::Composite { parts } = hammer else {
        panic!("{hammer:?}")
    };
    assert_eq!(parts[0].shape.name(), "composite");
    assert!(objects.iter().any(ObjectSpec::is_fixed));
    assert!(objects.iter().any(|object| !object.descriptions.is_empty()));
    let items: Vec<_> = NAMES
        .into_iter()
        .flat_map(|name| scenario(name).items)
        .collect();
    assert!(items.iter().any(|item| matches!(item, SceneItem::Chain(_))));
    assert!(
        items
            .iter()
            .any(|item| matches!(item, SceneItem::LidBox(_)))
    );
    assert_eq!(scenario("letters").table.xspan, 30.0);
    assert!(scenario("empty").items.is_empty());
}

#[test]
fn nothing_overlaps_at_the_start() {
    for name in NAMES {
        let scene = scenario(name);
        let bodies: Vec<Vec<Primitive>> = scene.items.iter().flat_map(bodies).collect();
        for (index, body) in bodies.iter().enumerate() {
            for solid in body {
                let lowest = -reach(solid, -Vec3::Z);
                assert!(lowest > -1e-3, "{name}: {solid:?} is in the table");
                for other in bodies[..index].iter().flatten() {
                    assert!(
                        are_apart(solid, other),
                        "{name}: {solid:?} overlaps {other:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn overlaps_are_found() {
    let at = |x, solid: &Solid| Primitive {
        pose: Pose::at(Vec3::X * x),
        solid: solid.clone(),
        color: tabletop_geometry::Rgb::GRAY,
    };
    let cube = Solid::Cuboid(Vec3::ONE);
    assert!(are_apart(&at(0.0, &cube), &at(1.0, &cube)));
    assert!(!are_apart(&at(0.0, &cube), &at(0.99, &cube)));
    let log = Solid::Cylinder {
        radius: 0.5,
        yspan: 3.0,
    };
    assert!(are_apart(&at(0.0, &log), &at(1.001, &log)));
    assert!(!are_apart(&at(0.0, &log), &at(0.99, &log)));
}

/// The bodies of an item, each as its solids. Neighbours in a chain may overlap, so a chain is one body.
fn bodies(item: &SceneItem) -> Vec<Vec<Primitive>> {
    match item {
        SceneItem::Object(object) => vec![placed(&object.shape, object.pose)],
        SceneItem::LidBox(lidbox) => {
            let height = (lidbox.span.z + lidbox.thickness) / 2.0;
            let on_top = lidbox.pose * Pose::at(Vec3::Z * height);
            vec![
                placed(&lidbox.container(), lidbox.pose),
                placed(&lidbox.lid(), on_top),
            ]
        }
        SceneItem::Jointed(jointed) => {
            let objects = jointed.placed();
            vec![
                objects
                    .iter()
                    .flat_map(|object| placed(&object.shape, object.pose))
                    .collect(),
            ]
        }
        SceneItem::Chain(chain) => {
            let axis = chain.end - chain.start;
            let turn = bevy::math::Quat::from_rotation_arc(Vec3::Y, axis.normalize());
            let link = Shape::Block {
                span: chain.link_span,
                color: chain.color,
            };
            let links = (0..chain.links()).flat_map(|index| {
                let part = (index as f32 + 0.5) / chain.links() as f32;
                placed(&link, Pose::new(chain.start + axis * part, turn))
            });
            vec![links.collect()]
        }
    }
}

fn placed(shape: &Shape, pose: Pose) -> Vec<Primitive> {
    let mut solids = shape.colliding();
    for solid in &mut solids {
        solid.pose = pose * solid.pose;
    }
    solids
}

/// Extent of a solid from the origin along a direction.
fn reach(solid: &Primitive, direction: Vec3) -> f32 {
    let local = solid.pose.rotation.inverse() * direction;
    let reach = match solid.solid {
        Solid::Cuboid(span) => (span / 2.0).dot(local.abs()),
        Solid::Cylinder { radius, yspan } => {
            radius * local.with_y(0.0).length() + yspan / 2.0 * local.y.abs()
        }
        Solid::Ball(radius) => radius * local.length(),
        Solid::Polyhedron(ref polyhedron) => {
            let ends = [local, -local].map(|way| polyhedron.farthest(way).dot(way));
            ends[0].max(ends[1])
        }
    };
    reach + solid.pose.location.dot(direction)
}

/// True if one of many directions shows a gap between two solids. If none does they may still be apart.
fn are_apart(left: &Primitive, right: &Primitive) -> bool {
    let axes = |solid: &Primitive| Vec3::AXES.map(|axis| solid.pose.rotation * axis);
    let (of_left, of_right) = (axes(left), axes(right));
    let between = right.pose.location - left.pose.location;
    let mut directions = vec![between];
    directions.extend(of_left.iter().chain(&of_right));
    for axis in of_left {
        directions.extend(of_right.map(|other| axis.cross(other)));
        directions.push(between.reject_from(axis));
    }
    directions
        .into_iter()
        .flat_map(|direction| [direction, -direction])
        .filter_map(Vec3::try_normalize)
        .any(|direction| reach(left, direction) + reach(right, -direction) < 1e-4)
}
