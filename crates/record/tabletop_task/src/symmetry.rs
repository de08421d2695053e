//! Symmetry: the rotations that leave a shape's look unchanged.

mod boxes;
mod likeness;

use bevy::math::{Quat, Vec3};
use serde::{Deserialize, Serialize};
use tabletop_core::Shape;
use tabletop_geometry::{Pose, Primitive, Solid};

use crate::rotation::{angle_between, twist_about};
use likeness::{SAME_LENGTH, looks_the_same};

/// The symmetry of a shape: the rotations about its centre, in its own frame, after which its solids and their colours look the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Symmetry {
    /// The point that every rotation leaves in place, in the shape's frame.
    pub centre: Vec3,
    /// The rotations.
    pub turns: Turns,
}

/// A group of rotations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Turns {
    /// A finite group whose first member is the identity: 24 rotations for a cube, 4 for a brick.
    Finite(Vec<Quat>),
    /// All rotations about an axis, as for a cone.
    About {
        /// The axis, a unit vector.
        axis: Vec3,
        /// True if its ends look the same, as for a cylinder.
        ends_alike: bool,
    },
    /// All rotations, as for a ball.
    Any,
}

impl Symmetry {
    /// The symmetry of a shape.
    pub fn of(shape: &Shape) -> Self {
        let solids = shape.drawn();
        let centre = centre_of(&solids);
        let turns = if let Some(axis) = common_axis(&solids, centre) {
            match axis {
                CommonAxis::All => Turns::Any,
                CommonAxis::Along(axis) => Turns::About {
                    axis,
                    ends_alike: looks_the_same(&solids, centre, half_turn_across(axis)),
                },
            }
        } else {
            Turns::Finite(finite(&solids, centre))
        };
        Self { centre, turns }
    }

    /// The symmetry of a shape that has none.
    pub fn none() -> Self {
        Self {
            centre: Vec3::ZERO,
            turns: Turns::Finite(vec![Quat::IDENTITY]),
        }
    }

    /// Number of orientations that look the same; `None` if there are infinitely many.
    pub fn order(&self) -> Option<usize> {
        match &self.turns {
            Turns::Finite(turns) => Some(turns.len()),
            Turns::About { .. } | Turns::Any => None,
        }
    }

    /// The pose that looks like `pose` and is turned least from `near`.
    pub fn nearest(&self, pose: Pose, near: Pose) -> Pose {
        // The turn for which `pose * turn` is closest to `near`.
        let wanted = pose.rotation.inverse() * near.rotation;
        let turn = match &self.turns {
            Turns::Finite(turns) => turns
                .iter()
                .copied()
                .min_by(|a, b| {
                    let [a, b] = [a, b].map(|turn| angle_between(*turn, wanted));
                    a.total_cmp(&b)
                })
                .unwrap_or(Quat::IDENTITY),
            Turns::About { axis, ends_alike } => {
                let same_end = twist_about(wanted, *axis);
                let flip = half_turn_across(*axis);
                let other_end = flip * twist_about(flip.inverse() * wanted, *axis);
                let is_nearer =
                    angle_between(other_end, wanted) < angle_between(same_end, wanted) - 1e-6;
                if *ends_alike && is_nearer {
                    other_end
                } else {
                    same_end
                }
            }
            Turns::Any => wanted,
        };
        self.turned(pose, turn)
    }

    /// The difference between two poses: the displacement of the centre, in units, and the least angle, in rad, that makes the shape look as in the
    /// other pose.
    pub fn difference(&self, a: Pose, b: Pose) -> (f32, f32) {
        let like_b = self.nearest(a, b);
        (
            (a * self.centre).distance(b * self.centre),
            angle_between(like_b.rotation, b.rotation),
        )
    }

    /// Poses that look like this one: at least all that differ for a gripper that opens along X or Y.
    pub fn variants(&self, pose: Pose) -> Vec<Pose> {
        let steps_about = |axis: Vec3| {
            (0..8).map(move |i| Quat::from_axis_angle(axis, i as f32 * std::f32::consts::FRAC_PI_4))
        };
        let turns: Vec<_> = match &self.turns {
            Turns::Finite(turns) => turns.clone(),
            Turns::About { axis, ends_alike } => {
                let flip = half_turn_across(*axis);
                let ends = [Quat::IDENTITY, flip];
                let ends = &ends[..if *ends_alike { 2 } else { 1 }];
                ends.iter()
                    .flat_map(|end| steps_about(*axis).map(move |turn| *end * turn))
                    .collect()
            }
            Turns::Any => steps_about(Vec3::Z).collect(),
        };
        turns
            .into_iter()
            .map(|turn| self.turned(pose, turn))
            .collect()
    }

    /// The pose after a turn about the centre in the shape's own frame.
    fn turned(&self, pose: Pose, turn: Quat) -> Pose {
        let rotation = (pose.rotation * turn).normalize();
        Pose::new(pose * self.centre - rotation * self.centre, rotation)
    }
}

fn half_turn_across(axis: Vec3) -> Quat {
    Quat::from_axis_angle(axis.any_orthonormal_vector(), std::f32::consts::PI)
}

fn centre_of(solids: &[Primitive]) -> Vec3 {
    let volume: f32 = solids.iter().map(|solid| solid.solid.volume()).sum();
    let moment: Vec3 = solids
        .iter()
        .map(|solid| solid.pose.location * solid.solid.volume())
        .sum();
    match volume > 0.0 {
        true => moment / volume,
        false => Vec3::ZERO,
    }
}

/// The common axis of solids that are balls and cylinders on one line.
enum CommonAxis {
    All,
    Along(Vec3),
}

fn common_axis(solids: &[Primitive], centre: Vec3) -> Option<CommonAxis> {
    let mut axis = None;
    for solid in solids {
        let own = match solid.solid {
            Solid::Cylinder { .. } => Some(solid.pose.rotation * Vec3::Y),
            Solid::Ball(_) => (solid.pose.location - centre).try_normalize(),
            Solid::Polyhedron(ref polyhedron) => Some(solid.pose.rotation * polyhedron.axis()?),
            Solid::Cuboid(_) => return None,
        };
        axis = axis.or(own);
    }
    let Some(axis) = axis else {
        return (!solids.is_empty()).then_some(CommonAxis::All);
    };
    let is_on_axis = solids.iter().all(|solid| {
        let across = (solid.pose.location - centre).cross(axis).length();
        let is_along = match solid.solid {
            Solid::Cylinder { .. } => (solid.pose.rotation * Vec3::Y).cross(axis).length() < 1e-3,
            Solid::Polyhedron(ref polyhedron) => polyhedron
                .axis()
                .is_some_and(|own| (solid.pose.rotation * own).cross(axis).length() < 1e-3),
            Solid::Ball(_) | Solid::Cuboid(_) => true,
        };
        across < SAME_LENGTH && is_along
    });
    is_on_axis.then_some(CommonAxis::Along(axis))
}

/// The rotations of a shape with finitely many: those of the cube, and those of prisms with up to 36 sides, about the axes of the
/// shape's frame.
fn finite(solids: &[Primitive], centre: Vec3) -> Vec<Quat> {
    const MOST: usize = 120;
    let quarter = |axis: Vec3| Quat::from_axis_angle(axis, std::f32::consts::FRAC_PI_2);
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut found = vec![Quat::IDENTITY];
    for a in cube_turns(axes.map(quarter)) {
        if looks_the_same(solids, centre, a) {
            add(&mut found, a);
        }
    }
    for axis in axes {
        let sides = [36, 32, 24, 20, 18, 16, 12, 10, 9, 8, 7, 6, 5, 3];
        let turn = |sides| Quat::from_axis_angle(axis, std::f32::consts::TAU / sides as f32);
        let first = sides
            .into_iter()
            .map(turn)
            .find(|&turn| looks_the_same(solids, centre, turn));
        if let Some(turn) = first {
            add(&mut found, turn);
        }
    }
    // Products of the turns.
    let mut next = 1;
    while next < found.len() && found.len() < MOST {
        for i in 1..=next {
            let both = [found[next] * found[i], found[i] * found[next]];
            both.into_iter().for_each(|turn| add(&mut found, turn));
        }
        next += 1;
    }
    found
}

fn cube_turns(quarters: [Quat; 3]) -> Vec<Quat> {
    let mut found = vec![Quat::IDENTITY];
    let mut next = 0;
    while next < found.len() {
        for quarter in quarters {
            let turn = quarter * found[next];
            add(&mut found, turn);
        }
        next += 1;
    }
    found
}

fn add(turns: &mut Vec<Quat>, turn: Quat) {
    let turn = turn.normalize();
    if turns.iter().all(|known| angle_between(*known, turn) > 1e-2) {
        turns.push(turn);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use tabletop_core::Part;
    use tabletop_geometry::Rgb;

    use super::*;

    fn block(x: f32, y: f32, z: f32) -> Shape {
        Shape::Block {
            span: Vec3::new(x, y, z),
            color: Rgb::RED,
        }
    }

    fn part(shape: Shape, at: Vec3, degrees: Vec3) -> Part {
        Part {
            pointable: false,
            id: String::new(),
            pose: Pose::from_degrees(at, degrees),
            shape,
        }
    }

    /// A ring of blocks about Z.
    fn ring(sides: u16) -> Shape {
        let parts = (0..sides).map(|i| {
            let degrees = Vec3::Z * 360.0 * f32::from(i) / f32::from(sides);
            let at = tabletop_geometry::quat_from_degrees(degrees) * Vec3::X;
            part(block(0.3, 0.5, 0.4), at, degrees)
        });
        Shape::Composite {
            parts: parts.collect(),
        }
    }

    fn shapes() -> Vec<(Shape, Option<usize>)> {
        let cylinder = Shape::Cylinder {
            radius: 1.0,
            yspan: 2.0,
            color: Rgb::RED,
        };
        let hammer = Shape::Composite {
            parts: vec![
                part(block(0.5, 0.5, 3.0), Vec3::ZERO, Vec3::ZERO),
                part(block(2.0, 0.5, 0.5), Vec3::Z * 1.5, Vec3::ZERO),
            ],
        };
        let pin = Shape::Composite {
            parts: vec![
                part(cylinder.clone(), Vec3::ZERO, Vec3::ZERO),
                part(
                    Shape::Sphere {
                        radius: 0.5,
                        color: Rgb::RED,
                    },
                    Vec3::Y,
                    Vec3::ZERO,
                ),
            ],
        };
        let container = Shape::Box {
            span: Vec3::new(3.0, 2.0, 1.0),
            thickness: 0.1,
            color: Rgb::RED,
        };
        let frustum = |radius_top, sides| Shape::Frustum {
            radius_top,
            radius_bottom: 1.0,
            zspan: 2.0,
            sides,
            color: Rgb::RED,
        };
        // As those of `hanoi.xml`: square, of long blocks and short ones.
        let square_ring = Shape::Composite {
            parts: vec![
                part(block(0.6, 1.8, 0.4), Vec3::X * 0.6, Vec3::ZERO),
                part(block(0.6, 1.8, 0.4), Vec3::X * -0.6, Vec3::ZERO),
                part(block(0.6, 0.6, 0.4), Vec3::Y * 0.6, Vec3::ZERO),
                part(block(0.6, 0.6, 0.4), Vec3::Y * -0.6, Vec3::ZERO),
            ],
        };
        let smooth_ring = Shape::Ring {
            radius_outer: 1.0,
            radius_inner: 0.5,
            zspan: 0.4,
            sides: 32,
            color: Rgb::RED,
        };
        vec![
            (frustum(0.5, 6), Some(6)),
            (frustum(1.0, 6), Some(12)),
            (frustum(0.5, 32), None),
            (smooth_ring, None),
            (block(1.0, 1.0, 1.0), Some(24)),
            (block(1.0, 1.0, 2.0), Some(8)),
            (block(1.0, 2.0, 3.0), Some(4)),
            (container, Some(2)),
            (square_ring, Some(8)),
            (hammer, Some(2)),
            (ring(8), Some(16)),
            (ring(5), Some(10)),
            (pin, None),
            (cylinder, None),
            (
                Shape::Sphere {
                    radius: 1.0,
                    color: Rgb::RED,
                },
                None,
            ),
        ]
    }

    #[test]
    fn a_cube_has_24_orientations_and_a_brick_4() {
        for (shape, order) in shapes() {
            assert_eq!(Symmetry::of(&shape).order(), order, "{shape:?}");
        }
    }

    #[test]
    fn a_coloured_face_is_seen() {
        let mark = Shape::Block {
            span: Vec3::new(0.5, 0.5, 0.1),
            color: Rgb::BLUE,
        };
        let marked = Shape::Composite {
            parts: vec![
                part(block(1.0, 1.0, 1.0), Vec3::ZERO, Vec3::ZERO),
                part(mark, Vec3::Z * 0.5, Vec3::ZERO),
            ],
        };
        assert_eq!(Symmetry::of(&marked).order(), Some(4));
    }

    fn pose() -> impl Strategy<Value = Pose> {
        let angle = || -180.0..180.0_f32;
        let length = || -5.0..5.0_f32;
        ((length(), length(), length()), (angle(), angle(), angle()))
            .prop_map(|(at, degrees)| Pose::from_degrees(Vec3::from(at), Vec3::from(degrees)))
    }

    fn shape() -> impl Strategy<Value = Shape> {
        proptest::sample::select(shapes()).prop_map(|(shape, _)| shape)
    }

    proptest! {
        #[test]
        fn to_look_the_same_is_an_equivalence(shape in shape(), a in pose(), b in pose(), c in pose()) {
            let symmetry = Symmetry::of(&shape);
            let between = |a, b| symmetry.difference(a, b);
            let (ab, ba) = (between(a, b), between(b, a));
            prop_assert!(between(a, a).0 < 1e-5 && between(a, a).1 < 1e-3);
            prop_assert!((ab.0 - ba.0).abs() < 1e-4 && (ab.1 - ba.1).abs() < 2e-3, "{ab:?} {ba:?}");
            let (bc, ac) = (between(b, c), between(a, c));
            prop_assert!(ac.0 <= ab.0 + bc.0 + 1e-4 && ac.1 <= ab.1 + bc.1 + 2e-3);
        }

        #[test]
        fn variants_look_the_same(shape in shape(), pose in pose()) {
            let symmetry = Symmetry::of(&shape);
            for variant in symmetry.variants(pose) {
                let (moved, turned) = symmetry.difference(pose, variant);
                prop_assert!(moved < 1e-3 && turned < 2e-3, "{moved} {turned}");
            }
        }

        #[test]
        fn the_angle_is_no_larger_than_without_symmetry(shape in shape(), a in pose(), b in pose()) {
            let symmetry = Symmetry::of(&shape);
            let (_, angle) = symmetry.difference(a, b);
            prop_assert!(angle <= angle_between(a.rotation, b.rotation) + 2e-3);
            let near = symmetry.nearest(a, b);
            prop_assert!((angle_between(near.rotation, b.rotation) - angle).abs() < 1e-3);
            prop_assert!(symmetry.difference(a, near).1 < 2e-3);
        }
    }
}
