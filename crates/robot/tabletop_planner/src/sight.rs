//! The seen world as the planner reads it: solids, what stands on what, what is in the way.

use std::collections::BTreeSet;

use bevy::math::Vec3;
use tabletop_controller::{SeenObject, Sight};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::Arrangement;

/// Depth to which a part that is above an object may be in it, in units.
const PLAY: f32 = 0.05;

/// Height above its place at which an object meets nothing that carries it, in units.
const RAISED: f32 = 0.02;

/// The solids of an object.
pub trait Solids {
    /// Its solids at its present pose.
    fn solids(&self) -> Vec<PlacedSolid>;

    /// Its solids at another pose.
    fn solids_at(&self, pose: Pose) -> Vec<PlacedSolid>;
}

impl Solids for SeenObject {
    fn solids(&self) -> Vec<PlacedSolid> {
        self.solids_at(self.pose)
    }

    fn solids_at(&self, pose: Pose) -> Vec<PlacedSolid> {
        let solids = self.shape.colliding();
        solids
            .iter()
            .map(|solid| PlacedSolid::of(solid, pose))
            .collect()
    }
}

/// The arrangement of the objects of a sight.
pub trait Arranged {
    /// The arrangement of the objects.
    fn arrangement(&self) -> Arrangement;

    /// The arrangement of the objects if one of them were at this pose.
    fn arrangement_with(&self, moved: &str, pose: Pose) -> Arrangement;

    /// True if a part of one object is above another one.
    fn covers(&self, one: &str, other: &str) -> bool;

    /// An object, none of these, that is where another one would be at this pose.
    fn occupant(&self, id: &str, pose: Pose, except: &[&str]) -> Option<String>;

    /// Ids of the objects that stand on an object, directly or on each other. Each comes before the one it stands on; of objects that
    /// stand on each other in turn, one comes first.
    fn stack_above(&self, id: &str) -> Vec<String>;
}

impl Arranged for Sight {
    fn arrangement(&self) -> Arrangement {
        let objects = self.objects.iter();
        Arrangement::new(objects.map(|(id, object)| (id.as_str(), &object.shape, object.pose)))
    }

    fn arrangement_with(&self, moved: &str, pose: Pose) -> Arrangement {
        let objects = self.objects.iter().map(|(id, object)| match id == moved {
            true => (id.as_str(), &object.shape, pose),
            false => (id.as_str(), &object.shape, object.pose),
        });
        Arrangement::new(objects)
    }

    fn covers(&self, one: &str, other: &str) -> bool {
        let (Some(one), Some(other)) = (self.objects.get(one), self.objects.get(other)) else {
            return false;
        };
        is_above(&one.solids(), &other.solids())
    }

    fn occupant(&self, id: &str, pose: Pose, except: &[&str]) -> Option<String> {
        let raised = Pose::new(pose.location + Vec3::Z * RAISED, pose.rotation);
        let solids = self.objects.get(id)?.solids_at(raised);
        let mut others = self.objects.iter();
        let occupant = others.find(|(other, seen)| {
            let theirs = seen.solids();
            let meets = |solid: &PlacedSolid| {
                let solid = solid.shrunk(0.01);
                theirs.iter().any(|other| solid.is_within(1e-3, other))
            };
            *other != id && !except.contains(&other.as_str()) && solids.iter().any(meets)
        });
        occupant.map(|(other, _)| other.clone())
    }

    fn stack_above(&self, id: &str) -> Vec<String> {
        let arrangement = self.arrangement();
        let above = |id: &str| arrangement.standing_on(id).into_iter();
        let mut visited = BTreeSet::from([id]);
        let mut stack = Vec::new();
        // From the object upwards, each with the objects above it that are yet to be visited.
        let mut way = vec![(id, above(id))];
        while let Some((below, unvisited)) = way.last_mut() {
            match unvisited.find(|other| visited.insert(other)) {
                Some(other) => way.push((other, above(other))),
                None => {
                    stack.push((*below).to_owned());
                    way.pop();
                }
            }
        }
        stack.retain(|other| other != id);
        stack
    }
}

/// True if one of these solids is above all of the others.
pub(crate) fn is_above(solids: &[PlacedSolid], below: &[PlacedSolid]) -> bool {
    let [_, top] = heights(below);
    solids.iter().any(|part| {
        let is_over = |solid: &PlacedSolid| part.gap_from_above(solid) <= 0.0;
        part.heights()[0] > top - PLAY && below.iter().any(is_over)
    })
}

/// Lowest and highest Z of solids.
pub(crate) fn heights(solids: &[PlacedSolid]) -> [f32; 2] {
    let all = solids.iter().map(PlacedSolid::heights);
    all.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)])
        .unwrap_or_default()
}

/// Angle by which an orientation leans from another one about level axes, in rad.
pub(crate) fn lean(rotation: bevy::math::Quat) -> f32 {
    (rotation * Vec3::Z).angle_between(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Part, Shape};
    use tabletop_geometry::Rgb;

    use super::*;

    fn block(span: Vec3) -> Shape {
        let color = Rgb::RED;
        Shape::Block { span, color }
    }

    /// Two cubes, of which the second is beside the first and one higher.
    fn step() -> Shape {
        let cube = |x: f32, z: f32| Part::new("", Pose::at(Vec3::new(x, 0.0, z)), block(Vec3::ONE));
        Shape::Composite {
            parts: vec![cube(-0.51, 0.5), cube(0.51, 1.51)],
        }
    }

    fn sight(objects: &[(&str, Shape, Pose)]) -> Sight {
        let objects = objects.iter().map(|(id, shape, pose)| {
            let seen = SeenObject {
                shape: shape.clone(),
                pose: *pose,
                is_fixed: false,
            };
            ((*id).to_owned(), seen)
        });
        Sight {
            objects: objects.collect(),
            ..Sight::default()
        }
    }

    fn at(x: f32, z: f32) -> Pose {
        Pose::at(Vec3::new(x, 0.0, z))
    }

    #[test]
    fn a_stack_is_listed_from_the_top() {
        let bar = block(Vec3::new(3.0, 1.0, 1.0));
        let cube = block(Vec3::ONE);
        // The bar leans on a tower and on a pillar, both on the base.
        let sight = sight(&[
            ("a base", block(Vec3::new(5.0, 1.0, 1.0)), at(0.0, 0.5)),
            ("a pillar", block(Vec3::new(1.0, 1.0, 2.0)), at(-1.0, 2.0)),
            ("b tower", cube.clone(), at(1.0, 1.5)),
            ("c tower", cube.clone(), at(1.0, 2.5)),
            ("bar", bar, at(0.0, 3.5)),
            ("beside", cube, at(4.0, 0.5)),
        ]);
        let expected = ["bar", "a pillar", "c tower", "b tower"];
        assert_eq!(sight.stack_above("a base"), expected);
        assert!(sight.stack_above("bar").is_empty());
        assert!(sight.stack_above("nothing").is_empty());
    }

    #[test]
    fn objects_that_stand_on_each_other_come_once() {
        let turned = Pose::new(
            Vec3::ZERO,
            bevy::math::Quat::from_rotation_z(std::f32::consts::PI),
        );
        let sight = sight(&[
            ("a", step(), Pose::IDENTITY),
            ("b", step(), turned),
            ("lid", block(Vec3::new(2.0, 1.0, 0.5)), at(0.0, 2.26)),
        ]);
        assert_eq!(sight.arrangement().supports("a"), ["b"]);
        assert_eq!(sight.arrangement().supports("b"), ["a"]);
        assert_eq!(sight.stack_above("a"), ["lid", "b"]);
        assert_eq!(sight.stack_above("b"), ["lid", "a"]);
        assert_eq!(sight.stack_above("lid"), [""; 0]);
    }
}
