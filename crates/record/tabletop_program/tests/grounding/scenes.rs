//! Tables for tests.

use bevy::math::{Vec2, Vec3};
use tabletop_core::{JointKind, JointSpec, ObjectSpec, Shape};
use tabletop_geometry::{Pose, Rgb};
use tabletop_program::{ConcreteStep, Impossible, ProgramRun, TableScene, TaskProgram};

/// A cube of this edge on the table.
pub fn cube(id: &str, color: Rgb, edge: f32, x: f32, y: f32) -> ObjectSpec {
    let span = Vec3::splat(edge);
    let shape = Shape::Block { span, color };
    ObjectSpec::new(id, Pose::at(Vec3::new(x, y, edge / 2.0)), 1.0, shape)
}

/// An open box on the table.
pub fn container(id: &str, color: Rgb, span: Vec3, x: f32, y: f32) -> ObjectSpec {
    let thickness = 0.1;
    let shape = Shape::Box {
        span,
        thickness,
        color,
    };
    ObjectSpec::new(id, Pose::at(Vec3::new(x, y, span.z / 2.0)), 2.0, shape)
}

/// A plate on the table, which a description calls so.
pub fn plate(id: &str, color: Rgb, width: f32, x: f32, y: f32) -> ObjectSpec {
    let span = Vec3::new(width, width, 0.2);
    let shape = Shape::Block { span, color };
    let mut plate = ObjectSpec::new(id, Pose::at(Vec3::new(x, y, 0.1)), 1.0, shape);
    plate.descriptions.push(("shape".into(), "plate".into()));
    plate
}

/// The object on top of another one.
pub fn on(mut object: ObjectSpec, base: &ObjectSpec) -> ObjectSpec {
    let height = |object: &ObjectSpec| {
        let Shape::Block { span, .. } = object.shape else {
            panic!("{} is no block", object.id);
        };
        span.z
    };
    let up = (height(base) + height(&object)) / 2.0;
    object.pose.location = base.pose.location + Vec3::Z * up;
    object
}

pub fn scene(objects: impl IntoIterator<Item = ObjectSpec>) -> TableScene {
    TableScene {
        objects: objects.into_iter().collect(),
        ..TableScene::default()
    }
}

/// A closed box with a sliding lid.
pub fn chest(id: &str, color: Rgb, x: f32, y: f32) -> (Vec<ObjectSpec>, JointSpec) {
    let span = Vec3::new(3.0, 2.6, 1.8);
    let holder = container(&format!("{id}-box"), color, span, x, y);
    let plate = Vec3::new(3.0, 2.6, 0.2);
    let shape = Shape::Lid {
        span: plate,
        color,
        handle_span: Vec3::new(0.6, 1.0, 0.6),
        handle_thickness: 0.1,
        handle_color: color,
    };
    let at = Pose::at(Vec3::new(x, y, span.z + plate.z / 2.0));
    let lid = ObjectSpec::new(format!("{id}-lid"), at, 1.0, shape);
    let joint = JointSpec {
        objects: [holder.id.clone(), lid.id.clone()],
        frames: [
            Pose::at(Vec3::Z * span.z / 2.0),
            Pose::at(Vec3::NEG_Z * plate.z / 2.0),
        ],
        kind: JointKind::Slider {
            min: 0.0,
            max: span.x,
            friction: 0.0,
            damping: 0.0,
        },
        collides: false,
    };
    (vec![holder, lid], joint)
}

/// Places that are far enough from each other.
pub fn spread(count: usize) -> Vec<Vec2> {
    (0..count)
        .map(|i| Vec2::new((i % 3) as f32 * 2.5 - 5.0, (i / 3) as f32 * -2.0 - 0.5))
        .collect()
}

pub fn rehearsed(
    text: &str,
    scene: &TableScene,
) -> (Vec<ConcreteStep>, TableScene, Option<Impossible>) {
    let program: TaskProgram = text
        .parse()
        .unwrap_or_else(|fault| panic!("{text}: {fault}"));
    ProgramRun::rehearsed(&program, scene)
}

/// The steps of a program in words, and the table after them.
pub fn done(text: &str, scene: &TableScene) -> (Vec<String>, TableScene) {
    let program: TaskProgram = text
        .parse()
        .unwrap_or_else(|fault| panic!("{text}: {fault}"));
    let (steps, after, reason) = ProgramRun::rehearsed(&program, scene);
    assert_eq!(reason, None, "{text}");
    let mut now = scene.clone();
    let words = steps.iter().map(|step| {
        let words = step.sentence(&now);
        now = now.after(step);
        words
    });
    (words.collect(), after)
}

/// The reason why a program cannot be done.
pub fn refused(text: &str, scene: &TableScene) -> Impossible {
    rehearsed(text, scene)
        .2
        .unwrap_or_else(|| panic!("{text} is done"))
}

/// Three pegs, and so many rings on the first one.
pub fn hanoi(count: u8) -> TableScene {
    let ring = |id: &str, radius: f32, level: f32| {
        let shape = Shape::Ring {
            radius_outer: radius,
            radius_inner: 0.3,
            zspan: 0.4,
            sides: 32,
            color: Rgb::RED,
        };
        ObjectSpec::new(
            id,
            Pose::at(Vec3::new(-4.0, -2.0, 0.2 + 0.4 * level)),
            1.0,
            shape,
        )
    };
    let peg = |id: &str, x: f32| {
        let span = Vec3::new(0.3, 0.3, 3.0);
        let shape = Shape::Block {
            span,
            color: Rgb::BROWN,
        };
        ObjectSpec::new(id, Pose::at(Vec3::new(x, -2.0, 1.5)), 0.0, shape)
    };
    let rings =
        (0..count).map(|i| ring(&format!("Ring{i}"), 1.2 - 0.12 * f32::from(i), f32::from(i)));
    let pegs = [peg("PegA", -4.0), peg("PegB", 0.0), peg("PegC", 4.0)];
    scene(pegs.into_iter().chain(rings))
}
