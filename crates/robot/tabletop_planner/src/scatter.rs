//! Scattering: a scene whose objects are moved to random places.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use bevy::math::{Quat, Vec3};
use tabletop_core::{Random, Shape, Table};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::Arrangement;

use crate::{
    body::RobotBody,
    grasp::{GraspSide, grasps},
};

/// A group of objects that is moved as one.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The ids of its objects.
    pub ids: Vec<String>,
    /// Their solids.
    pub solids: Vec<PlacedSolid>,
    /// Point about which it is turned.
    pub centre: Vec3,
    /// Points of it that the robot must reach: all of a group with the same limb.
    pub reached: Vec<Vec<Vec3>>,
}

impl Piece {
    /// The height at which it stands, in units.
    fn foot(&self) -> f32 {
        let feet = self.solids.iter().map(|solid| solid.heights()[0]);
        feet.reduce(f32::min).unwrap_or_default().max(0.0)
    }
}

/// Least distance between pieces, seen from above, in units.
const GAP: f32 = 0.3;
/// Number of tries to find a place.
const TRIES: u32 = 3000;
/// Distance of pieces from the table's edges, in units.
const EDGE: f32 = 0.05;
/// Height from which on things are taken from beside, in units: no arm has room above them.
const HIGH: f32 = 4.0;
/// Room above the holds in which things are carried, in units and hand sizes: over a tower of all others, or as high as this.
const MOST_ROOM: f32 = 2.5;
/// From what is carried to the top of that tower, in units and hand sizes.
const CLEAR: f32 = 0.8;
/// Height of a hold above a point that is to be reached, in units and hand sizes.
const HOLD: f32 = 0.3;

/// Motions that bring all pieces to random places, turned by random angles. `is_reached` must hold of each group of points that has to be reached, and of
/// the height at which their piece stands.
/// Pieces that stand on, in or around others move with them. Nothing comes near the solids `kept` free. `None` if there is
/// no room.
pub fn scatter(
    pieces: &[Piece],
    arrangement: &Arrangement,
    table: &Table,
    kept: &[PlacedSolid],
    is_reached: impl Fn(&[Vec3], f32) -> bool,
    seed: u64,
) -> Option<Vec<Pose>> {
    let groups = groups(pieces, arrangement);
    let mut random = Random::new(seed);
    let mut placed = kept.to_vec();
    let mut motions = vec![Pose::IDENTITY; pieces.len()];
    let half = Vec3::new(table.xspan, table.yspan, 0.0) / 2.0 - EDGE;
    for group in groups {
        let centre = pieces[group[0]].centre.with_z(0.0);
        let mut found = None;
        for _ in 0..TRIES {
            let at = Vec3::new(
                random.between((-half.x, half.x)),
                random.between((-half.y, half.y)),
                0.0,
            );
            let turn = Quat::from_rotation_z(random.between((-PI, PI)));
            let motion = Pose::new(at - turn * centre, turn);
            let solids: Vec<_> = group
                .iter()
                .flat_map(|&piece| &pieces[piece].solids)
                .map(|solid| PlacedSolid {
                    pose: motion * solid.pose,
                    solid: solid.solid.clone(),
                })
                .collect();
            let reach = |solid: &PlacedSolid, way: Vec3| solid.farthest(way).dot(way);
            let is_on_table = solids.iter().all(|solid| {
                reach(solid, Vec3::X) < half.x
                    && reach(solid, Vec3::NEG_X) < half.x
                    && reach(solid, Vec3::Y) < half.y
                    && reach(solid, Vec3::NEG_Y) < half.y
            });
            let is_apart = || {
                solids
                    .iter()
                    .all(|solid| placed.iter().all(|other| solid.gap_from_above(other) > GAP))
            };
            let all_are_reached = || {
                group.iter().map(|&piece| &pieces[piece]).all(|piece| {
                    piece.reached.iter().all(|points| {
                        let points: Vec<_> = points.iter().map(|point| motion * *point).collect();
                        is_reached(&points, piece.foot())
                    })
                })
            };
            if is_on_table && is_apart() && all_are_reached() {
                found = Some((motion, solids));
                break;
            }
        }
        let (motion, solids) = found?;
        placed.extend(solids);
        for piece in group {
            motions[piece] = motion;
        }
    }
    Some(motions)
}

impl RobotBody {
    /// The room above these pieces, in units, in which it carries them.
    pub fn carrying_room(&self, pieces: &[Piece]) -> f32 {
        let heights = pieces.iter().map(|piece| {
            let tops = piece.solids.iter().map(|solid| solid.heights()[1]);
            tops.fold(0.0, f32::max) - piece.foot()
        });
        let [tower, least] = heights.fold([0.0, f32::INFINITY], |[tower, least], height| {
            [tower + height, height.min(least)]
        });
        let hand = self.hand_size();
        (tower - least + CLEAR * hand).clamp(0.0, MOST_ROOM * hand.max(1.0))
    }

    /// The point of an object, in its frame, that has to be reached to take it from above where it fits best between the fingers; its origin, if it fits
    /// nowhere.
    pub fn hold(&self, shape: &Shape, pose: Pose) -> Vec3 {
        let limb = self.limbs.first();
        let all = limb.map_or(Vec::new(), |limb| {
            let (finger, widest) = (limb.finger, limb.widest);
            grasps(shape, pose.rotation, GraspSide::Above, finger, widest)
        });
        let best = all.iter().min_by(|a, b| a.off.total_cmp(&b.off));
        best.map_or(Vec3::ZERO, |best| {
            let hold = pose * best.end_effector.location - Vec3::Z * HOLD * self.hand_size();
            pose.inverse() * hold
        })
    }

    /// True if one limb reaches all points, and so much room above them, in units, from above, with its fingers turned in any direction; or, if they are
    /// too high for that, from the same side.
    pub fn reaches(&self, points: &[Vec3], room: f32) -> bool {
        let are_high = points.iter().all(|point| point.z > HIGH);
        let mut limbs = 0..self.limbs.len();
        limbs.any(|limb| match are_high {
            true => self.limb_reaches_from_beside(limb, points),
            false => {
                let mut points = points.iter();
                points.all(|&point| self.limb_reaches_from_above(limb, point, room))
            }
        })
    }

    fn limb_reaches_from_beside(&self, limb: usize, points: &[Vec3]) -> bool {
        let home = self.limbs[limb].home;
        let leans = [FRAC_PI_4, FRAC_PI_2].into_iter();
        let mut turns = leans.flat_map(|lean| {
            (0..8_u16).map(move |eighth| {
                Quat::from_rotation_z(FRAC_PI_4 * f32::from(eighth)) * Quat::from_rotation_x(lean)
            })
        });
        turns.any(|turn| {
            points.iter().all(|&point| {
                let pose = Pose::new(point + Vec3::Z * HOLD * self.hand_size(), turn);
                self.reach(limb, pose, &home).is_some()
            })
        })
    }

    fn limb_reaches_from_above(&self, limb: usize, point: Vec3, room: f32) -> bool {
        let home = self.limbs[limb].home;
        let there = |z: f32, turn: f32| {
            let pose = Pose::new(point.with_z(z), Quat::from_rotation_z(turn));
            self.reach(limb, pose, &home).is_some()
        };
        let low = point.z + HOLD * self.hand_size();
        [0.0, FRAC_PI_4, FRAC_PI_2, -FRAC_PI_4]
            .into_iter()
            .all(|turn| there(low, turn) && there(low + room, turn))
    }
}

/// Groups of pieces that stand on, in or around each other, by index.
fn groups(pieces: &[Piece], arrangement: &Arrangement) -> Vec<Vec<usize>> {
    let mut group_of: Vec<usize> = (0..pieces.len()).collect();
    for (i, piece) in pieces.iter().enumerate() {
        for id in &piece.ids {
            let carriers = [
                arrangement.supports(id),
                arrangement.containers(id),
                arrangement.posts(id),
            ]
            .concat();
            for (j, other) in pieces.iter().enumerate() {
                if other
                    .ids
                    .iter()
                    .any(|other| carriers.contains(&other.as_str()))
                {
                    let (old, new) = (group_of[i].max(group_of[j]), group_of[i].min(group_of[j]));
                    group_of
                        .iter_mut()
                        .filter(|group| **group == old)
                        .for_each(|group| *group = new);
                }
            }
        }
    }
    let firsts = (0..pieces.len()).filter(|&i| group_of[i] == i);
    firsts
        .map(|first| {
            (0..pieces.len())
                .filter(|&i| group_of[i] == first)
                .collect()
        })
        .collect()
}
