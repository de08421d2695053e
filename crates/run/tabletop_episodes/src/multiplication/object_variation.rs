//! Variation of single objects: their colours and widths, and objects that have nothing to do with a task.

use std::f32::consts::TAU;

use bevy::math::{Quat, Vec3};
use tabletop_core::{ObjectSpec, Random, SceneItem, SceneSpec, Shape};
use tabletop_geometry::{NAMED_COLORS, Pose, Rgb};

/// Number of colours that are drawn.
const COLORS: u32 = 100;
/// Largest difference in lightness between a colour and its name.
const SHADE: f32 = 0.12;
/// The largest height of a unit vector that counts as level, in units.
const LEVEL: f32 = 0.02;
/// The extents of distractors, in units.
const DISTRACTOR: (f32, f32) = (0.6, 1.6);

/// Gives an item another colour at random. An object stays as it is if it `may_be` none of a hundred.
pub fn recolor(item: &mut SceneItem, random: &mut Random, may_be: impl Fn(&ObjectSpec) -> bool) {
    for _ in 0..COLORS {
        let color = any_color(random);
        let mut varied = item.clone();
        match &mut varied {
            SceneItem::Object(spec) => {
                paint(&mut spec.shape, color);
                if !may_be(spec) {
                    continue;
                }
            }
            SceneItem::LidBox(spec) => spec.color = color,
            SceneItem::Chain(spec) => spec.color = color,
            SceneItem::Jointed(_) => {}
        }
        *item = varied;
        return;
    }
}

/// Makes a block or a cylinder narrower by up to a part of its widths, if it `may_be` so. Its height stays.
pub fn narrow(
    item: &mut SceneItem,
    part: f32,
    random: &mut Random,
    may_be: impl Fn(&ObjectSpec) -> bool,
) {
    let SceneItem::Object(spec) = item else {
        return;
    };
    let [first, second] = [(); 2].map(|()| 1.0 - random.between((0.0, part)));
    let mut varied = spec.clone();
    let rotation = spec.pose.rotation;
    let is_level = |axis: Vec3| (rotation * axis).z.abs() < LEVEL;
    match &mut varied.shape {
        Shape::Block { span, .. } => {
            let axes = [Vec3::X, Vec3::Y, Vec3::Z].into_iter();
            let level: Vec<_> = axes.filter(|axis| is_level(*axis)).collect();
            // A leaning object keeps its size, or it would stand otherwise.
            let [one, other] = level[..] else {
                return;
            };
            *span *= Vec3::ONE - one * (1.0 - first) - other * (1.0 - second);
        }
        Shape::Cylinder { radius, .. } if (rotation * Vec3::Y).z.abs() > 1.0 - LEVEL => {
            *radius *= first;
        }
        Shape::Cylinder { .. }
        | Shape::Sphere { .. }
        | Shape::Box { .. }
        | Shape::Prism { .. }
        | Shape::Frustum { .. }
        | Shape::Ring { .. }
        | Shape::Mesh { .. }
        | Shape::Link { .. }
        | Shape::Lid { .. }
        | Shape::Composite { .. }
        | Shape::Control(_)
        | Shape::BondPoint(_) => return,
    }
    if !spec.is_fixed() && may_be(&varied) {
        *spec = varied;
    }
}

/// A distractor, a block or a cylinder that has nothing to do with a task, apart from everything so that it is moved by itself. `None` if it `is_other` in none
/// of a hundred shapes and colours.
pub fn distractor(
    number: u32,
    random: &mut Random,
    is_other: impl Fn(&ObjectSpec) -> bool,
) -> Option<ObjectSpec> {
    (0..COLORS).find_map(|_| {
        let color = any_color(random);
        let [x, y, z] = [(); 3].map(|()| random.between(DISTRACTOR));
        let (shape, rotation, height) = match random.bits() % 2 {
            0 => {
                let span = Vec3::new(x, y, z);
                (Shape::Block { span, color }, Quat::IDENTITY, z)
            }
            _ => {
                let shape = Shape::Cylinder {
                    radius: x / 2.0,
                    yspan: z,
                    color,
                };
                (shape, Quat::from_rotation_x(TAU / 4.0), z)
            }
        };
        let at = Vec3::new(1000.0 + 10.0 * number as f32, 0.0, height / 2.0);
        let id = format!("Distractor{}", number + 1);
        let spec = ObjectSpec::new(&id, Pose::new(at, rotation), 1.0, shape);
        is_other(&spec).then_some(spec)
    })
}

/// A scene whose objects have exchanged their colours, as this seed decides.
pub fn with_colors_exchanged(mut scene: SceneSpec, seed: u64) -> SceneSpec {
    let mut random = Random::new(seed);
    let mut shapes: Vec<_> = scene
        .items
        .iter_mut()
        .filter_map(|item| match item {
            SceneItem::Object(spec) => Some(&mut spec.shape),
            SceneItem::LidBox(_) | SceneItem::Chain(_) | SceneItem::Jointed(_) => None,
        })
        .collect();
    let mut colors: Vec<_> = shapes
        .iter()
        .filter_map(|shape| Some(shape.drawn().first()?.color))
        .collect();
    for shape in &mut shapes {
        if !colors.is_empty() {
            let drawn = random.bits() % colors.len() as u64;
            paint(shape, colors.swap_remove(drawn as usize));
        }
    }
    scene
}

/// A colour with a name, or one near it.
fn any_color(random: &mut Random) -> Rgb {
    let (_, named) = NAMED_COLORS[(random.bits() % NAMED_COLORS.len() as u64) as usize];
    let shade = random.between((-SHADE, SHADE));
    let part = |part: f32| (part + shade).clamp(0.0, 1.0);
    Rgb::new(part(named.red), part(named.green), part(named.blue))
}

/// Paints a shape; of a composite, only the parts with the colour of the first.
fn paint(shape: &mut Shape, color: Rgb) {
    let Some(old) = shape.drawn().first().map(|solid| solid.color) else {
        return;
    };
    for own in shape.colors_mut() {
        if *own == old {
            *own = color;
        }
    }
}
