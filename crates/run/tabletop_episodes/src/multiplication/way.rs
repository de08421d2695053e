//! The way of a hand, adapted to objects that are elsewhere.

use bevy::math::{Quat, Vec3};
use tabletop_core::{Hand, Manipulator, Shape, SimTick};
use tabletop_geometry::{PlacedSolid, Pose, Primitive};
use tabletop_recorder::TICKS_PER_FRAME;
use tabletop_task::{ActDeed, Demonstration, Reference, TaskStep, angle_between};

/// The way on which the object of a step was carried.
#[derive(Clone, Debug)]
pub(super) struct CarriedWay {
    /// Poses of the object, tick by tick, from before its grasp until its release.
    poses: Vec<Pose>,
    /// The hands that took it, each with the index of the pose after which it did.
    hands: Vec<(usize, Hand)>,
    /// Pose of the goal's reference.
    frame: Pose,
    /// Limits, in units and rad, on its motion in a tick, unless the demonstration was faster.
    limits: (f32, f32),
}

/// A point of a hand's way, reached in one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WayPoint {
    /// Pose of the object.
    pub pose: Pose,
    /// The hand that takes it.
    pub taken_by: Option<Hand>,
    /// Number of ticks since the grasp in the demonstration.
    pub shown: u64,
}

/// Distance from the first place, seen from above, within which an object counts as being lifted or lowered, in units.
const UPRIGHT: f32 = 0.3;
/// The part of the way that is blended if it is unclear where lifting ends and lowering begins.
const MIDDLE: (f32, f32) = (0.25, 0.75);
/// Least distance of a carried object from obstacles on its way, in units.
const GAP: f32 = 0.1;
/// Limits, in units and rad, on a hand's motion in a tick, unless the demonstration was faster.
const STEP: (f32, f32) = (0.15, 0.08);
/// The same with something on or in the object, which is to stay where it is.
const LOADED_STEP: (f32, f32) = (0.025, 0.015);

impl CarriedWay {
    /// The way of a step's object in a demonstration. `None` if the demonstration does not contain it.
    pub fn of(shown: &Demonstration, step: &TaskStep) -> Option<Self> {
        let track = &shown.named(&step.object)?.track;
        let first = step.grasp.0.saturating_sub(1);
        let poses: Option<Vec<_>> = (first..=step.release.0)
            .map(|tick| match shown.is_poses_only {
                true => track.smooth_at(SimTick(tick), TICKS_PER_FRAME),
                false => track.at(SimTick(tick)),
            })
            .collect();
        let poses = poses?;
        let taken = shown.acts.iter().filter_map(|act| {
            let is_meant = matches!(&act.deed, ActDeed::Grasp(id) if *id == step.object);
            let is_meanwhile = (step.grasp..=step.release).contains(&act.tick);
            let after = (act.tick.0 - first) as usize;
            (is_meant && is_meanwhile).then(|| (after, hand_of(shown, act.by)))
        });
        let reference = step.goal.as_ref().map(|goal| &goal.reference);
        let frame = match reference {
            None | Some(Reference::Table) => Pose::IDENTITY,
            Some(Reference::Itself) => poses[0],
            Some(Reference::Object { object }) => shown.named(object)?.track.at(step.release)?,
            Some(Reference::PlaceOf { object }) => shown.named(object)?.track.at(shown.start)?,
        };
        Some(Self {
            hands: taken.collect(),
            frame,
            limits: match step.load.is_empty() {
                true => STEP,
                false => LOADED_STEP,
            },
            poses,
        })
    }

    /// Pose before the grasp.
    pub fn first(&self) -> Pose {
        self.poses[0]
    }

    /// Pose at the release.
    pub fn last(&self) -> Pose {
        self.poses[self.poses.len() - 1]
    }

    /// The hand that takes it first.
    pub fn first_hand(&self) -> Option<Hand> {
        self.hands.first().map(|(_, hand)| *hand)
    }

    /// The way from the object's present pose to that of its goal's reference: it follows the object at the beginning and the reference at
    /// the end, and is blended in between. Without a reference, it follows the object all along. The middle is raised over obstacles.
    pub fn retargeted(
        &self,
        shape: &Shape,
        from: Pose,
        reference: Option<Pose>,
        obstacles: &[PlacedSolid],
    ) -> Vec<WayPoint> {
        let at_start = from * self.poses[0].inverse();
        let at_end = reference.map_or(at_start, |now| now * self.frame.inverse());
        let lengths = self.lengths();
        let [lifted, lowered] = self.middle(&lengths);
        let mut way = Vec::new();
        for (i, shown) in self.poses.iter().enumerate() {
            let span = lengths[lowered] - lengths[lifted];
            let part = match span > 0.0 {
                true => ((lengths[i] - lengths[lifted]) / span).clamp(0.0, 1.0),
                false => f32::from(u8::from(i >= lowered)),
            };
            way.push(blended(
                at_start * *shown,
                at_end * *shown,
                part * part * (3.0 - 2.0 * part),
            ));
        }
        let solids = shape.colliding();
        let lift = lift_over(&solids, &way[lifted..=lowered], obstacles);
        let mut moments = Vec::<WayPoint>::new();
        for (i, mut pose) in way.into_iter().enumerate() {
            if (lifted..=lowered).contains(&i) {
                pose.location.z += lift;
            }
            let longest = match i {
                0 => self.limits,
                _ => (
                    distance(self.poses[i - 1], self.poses[i]).max(self.limits.0),
                    angle_between(self.poses[i - 1].rotation, self.poses[i].rotation)
                        .max(self.limits.1),
                ),
            };
            if let Some(last) = moments.last().map(|moment| moment.pose) {
                moments.extend(between(last, pose, longest).map(|pose| WayPoint {
                    pose,
                    taken_by: None,
                    shown: (i as u64).saturating_sub(1),
                }));
            }
            let taken_by = self.hands.iter().skip(1).find(|(after, _)| *after == i);
            moments.push(WayPoint {
                pose,
                taken_by: taken_by.map(|(_, hand)| *hand),
                shown: i as u64,
            });
        }
        moments
    }

    /// Length of the way up to each pose, with a little added for every tick, so that it always ascends.
    fn lengths(&self) -> Vec<f32> {
        const OF_A_TICK: f32 = 1e-4;
        let mut length = 0.0;
        let mut lengths = vec![0.0];
        for pair in self.poses.windows(2) {
            length += distance(pair[0], pair[1]) + OF_A_TICK;
            lengths.push(length);
        }
        lengths
    }

    /// Indices of the pose at the end of lifting, and of that at the beginning of lowering.
    fn middle(&self, lengths: &[f32]) -> [usize; 2] {
        let last = self.poses.len() - 1;
        let across =
            |pose: &Pose, from: Pose| (pose.location - from.location).truncate().length() > UPRIGHT;
        let lifted = self
            .poses
            .iter()
            .position(|pose| across(pose, self.poses[0]));
        let lowered = self
            .poses
            .iter()
            .rposition(|pose| across(pose, self.poses[last]));
        if let (Some(lifted), Some(lowered)) = (lifted, lowered)
            && lengths[lifted] < lengths[lowered]
        {
            return [lifted, lowered];
        }
        let whole = lengths[last];
        let at = |part: f32| lengths.partition_point(|length| *length < part * whole);
        [at(MIDDLE.0).min(last), at(MIDDLE.1).min(last)]
    }
}

/// The hand that does what a hand or gripper has done: of several grippers, the last one by name is the right hand.
fn hand_of(shown: &Demonstration, by: Manipulator) -> Hand {
    let limb = |by: Manipulator| match by {
        Manipulator::Hand(_) => None,
        Manipulator::Gripper(limb) => Some(limb),
    };
    let last = shown.acts.iter().filter_map(|act| limb(act.by)).max();
    match by {
        Manipulator::Hand(hand) => hand,
        Manipulator::Gripper(limb) if Some(limb) == last => Hand::Right,
        Manipulator::Gripper(_) => Hand::Left,
    }
}

fn distance(a: Pose, b: Pose) -> f32 {
    a.location.distance(b.location)
}

fn blended(a: Pose, b: Pose, part: f32) -> Pose {
    Pose::new(
        a.location.lerp(b.location, part),
        slerp(a.rotation, b.rotation, part),
    )
}

fn slerp(a: Quat, b: Quat, part: f32) -> Quat {
    match part {
        0.0 => a,
        1.0 => b,
        part => a.slerp(b, part).normalize(),
    }
}

/// The poses between two, without these, such that no step exceeds the limits.
fn between(from: Pose, to: Pose, (length, angle): (f32, f32)) -> impl Iterator<Item = Pose> {
    let lengths = distance(from, to) / length;
    let angles = angle_between(from.rotation, to.rotation) / angle;
    let steps = (lengths.max(angles) - 1e-3).ceil().max(1.0) as u32;
    (1..steps).map(move |step| blended(from, to, step as f32 / steps as f32))
}

/// Height by which a way must be raised so that the carried solids meet nothing; 0 if that does not help.
fn lift_over(solids: &[Primitive], way: &[Pose], obstacles: &[PlacedSolid]) -> f32 {
    const STEP: f32 = 0.25;
    const MOST: u16 = 40;
    let meets = |pose: Pose| {
        let mut own = solids.iter().map(|solid| PlacedSolid::of(solid, pose));
        own.any(|own| {
            obstacles.iter().any(|other| {
                let apart = own.pose.location.distance(other.pose.location);
                apart < own.radius() + other.radius() + GAP && own.away_from(other).length() < GAP
            })
        })
    };
    let lifts = (0..MOST).map(|i| f32::from(i) * STEP);
    let is_free = |lift: &f32| {
        let mut lifted = way.iter().map(|pose| Pose {
            location: pose.location + Vec3::Z * *lift,
            ..*pose
        });
        !lifted.any(meets)
    };
    lifts.into_iter().find(is_free).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::{Rgb, Solid};

    use super::*;

    /// Up by 3, across by 6, down by 2, in steps of a tenth.
    fn carried() -> CarriedWay {
        let mut at = Vec3::new(0.0, 0.0, 0.5);
        let mut poses = vec![Pose::at(at)];
        for (way, steps) in [(Vec3::Z, 30), (Vec3::X, 60), (Vec3::NEG_Z, 20)] {
            for _ in 0..steps {
                at += way * 0.1;
                poses.push(Pose::at(at));
            }
        }
        CarriedWay {
            poses,
            hands: vec![(1, Hand::Left), (60, Hand::Right)],
            frame: Pose::at(Vec3::new(6.0, 0.0, 0.5)),
            limits: STEP,
        }
    }

    fn cube() -> Shape {
        Shape::Block {
            span: Vec3::ONE,
            color: Rgb::RED,
        }
    }

    fn turned(x: f32, y: f32, degrees: f32) -> Pose {
        Pose::from_degrees(Vec3::new(x, y, 0.5), Vec3::new(0.0, 0.0, degrees))
    }

    #[test]
    fn a_way_to_the_same_places_is_the_way_that_was_shown() {
        let carried = carried();
        let way = carried.retargeted(&cube(), carried.poses[0], Some(carried.frame), &[]);
        let poses: Vec<_> = way.iter().map(|moment| moment.pose).collect();
        assert_eq!(poses.len(), carried.poses.len());
        for (pose, shown) in poses.iter().zip(&carried.poses) {
            assert!(distance(*pose, *shown) < 1e-4);
        }
        assert_eq!(way[60].taken_by, Some(Hand::Right));
    }

    #[test]
    fn start_and_end_go_with_object_and_reference() {
        let carried = carried();
        let (from, to) = (turned(-4.0, 2.0, 30.0), turned(5.0, -3.0, 200.0));
        let way = carried.retargeted(&cube(), from, Some(to), &[]);
        let last = way.last().unwrap().pose;
        let shown = carried.poses.last().unwrap();
        let expected = to * carried.frame.inverse() * *shown;
        assert!(distance(last, expected) < 1e-4);
        assert!(angle_between(last.rotation, expected.rotation) < 1e-3);
        assert!(distance(way[0].pose, from) < 1e-5);
        // Straight up first, and straight down in the end.
        let is_above = |pose: Pose, other: Pose| {
            (pose.location - other.location).truncate().length() < UPRIGHT + 0.01
        };
        assert!(way[..30].iter().all(|moment| is_above(moment.pose, from)));
        let lowering = &way[way.len() - 20..];
        assert!(lowering.iter().all(|moment| is_above(moment.pose, last)));
        for pair in way.windows(2) {
            assert!(distance(pair[0].pose, pair[1].pose) < STEP.0 + 0.01);
            let turn = angle_between(pair[0].pose.rotation, pair[1].pose.rotation);
            assert!(turn < STEP.1 + 0.01);
        }
    }

    #[test]
    fn the_path_passes_above_an_obstacle() {
        let carried = carried();
        let tower = PlacedSolid {
            pose: Pose::at(Vec3::new(3.0, 0.0, 2.5)),
            solid: Solid::Cuboid(Vec3::new(1.0, 1.0, 5.0)),
        };
        let from = carried.poses[0];
        let obstacles = std::slice::from_ref(&tower);
        let way = carried.retargeted(&cube(), from, Some(carried.frame), obstacles);
        for moment in &way {
            let own = PlacedSolid {
                pose: moment.pose,
                solid: Solid::Cuboid(Vec3::ONE),
            };
            assert!(own.away_from(&tower).length() > GAP - 0.01, "{moment:?}");
        }
        let highest = way.iter().map(|moment| moment.pose.location.z);
        assert!(highest.fold(0.0, f32::max) < 6.5);
    }
}
