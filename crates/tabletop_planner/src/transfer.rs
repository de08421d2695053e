//! Transfer: grasping an object and putting it down elsewhere.

use std::{cell::Cell, collections::BTreeMap};

use bevy::math::Vec3;
use tabletop_core::Pose;
use tabletop_task::{PlacedSolid, angle_between};

use crate::{
    body::{Angles, RobotBody},
    clearance::{Clearance, Margins},
    failure::PlanFailure,
    goals::Candidate,
    grasp::{Grasp, GraspSide, grasps},
    motion::{follow, grip, wait},
    path::{Path, largest_turn, lift, line, withdraw},
    sight::{SeenObject, Sight, heights},
    stage::PlanningStage,
    transit::{WaySearch, transit},
};

/// Speed of an end effector, in units/s: on its way, and near the place of a grasp or release.
const FAST: f64 = 6.0;
const SLOW: f64 = 2.5;
/// Speed, in units/s, at which an object comes down on its support without pushing it away, and the number of last postures
/// at which it applies.
const GENTLE: f64 = 0.5;
const GENTLE_POSTURES: usize = 2;
/// Height above its goal at which an object is released, in units.
const DROP: f32 = 0.02;
/// Openings of the fingers before a grasp, in units beyond the object's width. The first that has room is used.
const OPENINGS: [f32; 3] = [0.35, 0.18, 0.1];
/// Openings of the fingers for a release, in units beyond the held width. The first that has room is used.
const RELEASES: [f32; 5] = [0.35, 0.22, 0.14, 0.08, 0.05];
/// Distance of opening fingers from neighbouring objects, in units.
const BESIDE: f32 = 0.012;
/// Number of grasps that are examined at a time, the best first.
const GRASPS: usize = 24;
/// Number of pairs of grasp and goal that are examined for each, and of those whose paths have to be searched for.
const PAIRS: usize = 24;
const SEARCHED_PAIRS: usize = 4;

/// A limb's transfer of an object.
pub(crate) struct Transfer<'a> {
    pub body: &'a RobotBody,
    pub limb: usize,
    pub object: &'a str,
    pub side: GraspSide,
    /// Seed of the search for paths.
    pub seed: u64,
}

/// A feasible grasp.
#[derive(Clone, Copy)]
struct Taking {
    grasp: Grasp,
    opening: f32,
    at: Angles,
}

/// A feasible way to put the held object down.
struct Placing {
    /// Path to above the place.
    way: Path,
    down: Path,
    /// Opening of the fingers there, in units.
    opening: f32,
}

/// The stages that a plan has passed, from which the reason of a failure follows.
#[derive(Clone, Copy, Debug, Default)]
struct Obstructions {
    /// A grasp is within reach.
    reached: bool,
    /// A grasp is free of collisions.
    free: bool,
    /// A place is within reach with such a grasp.
    put: bool,
}

impl Transfer<'_> {
    /// Grasps the object and puts it at one of these goals.
    pub fn carry_out(
        &self,
        stage: &mut dyn PlanningStage,
        goals: &[Candidate],
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let (taking, approach) = self.plan(&sight, goals)?;
        self.take(stage, &taking, &approach)?;
        self.put(stage, goals)
    }

    /// Grasps the object and lifts it.
    pub fn pick_up(&self, stage: &mut dyn PlanningStage) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let object = self.seen(&sight)?;
        let goal = Candidate {
            pose: Pose::new(object.pose.location + Vec3::Z, object.pose.rotation),
            cost: 0.0,
        };
        let (taking, approach) = self.plan(&sight, &[goal])?;
        self.take(stage, &taking, &approach)?;
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, self.limb, &[self.object]);
        let up = lift(&clearance, &clearance.here(), 1.0).ok_or_else(|| self.no_way())?;
        follow(stage, self.body, self.limb, &up, SLOW, self.object)
    }

    /// Grasps the object and moves it along a straight line, as a joint allows.
    pub fn slide(&self, stage: &mut dyn PlanningStage, by: Vec3) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let object = self.seen(&sight)?.clone();
        let goal = Candidate {
            pose: Pose::new(object.pose.location + by, object.pose.rotation),
            cost: 0.0,
        };
        let (taking, approach) = self.plan(&sight, &[goal])?;
        self.take(stage, &taking, &approach)?;
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, self.limb, &[self.object]);
        let here = clearance.here();
        let mut there = clearance.end_effector(&here);
        there.location += by;
        let way = line(&clearance, &here, there).ok_or_else(|| self.no_way())?;
        follow(stage, self.body, self.limb, &way, 1.5, self.object)?;
        let opening = stage.sight().limbs[self.limb].opening as f32 + RELEASES[0];
        self.let_go(stage, opening)
    }

    fn seen<'s>(&self, sight: &'s Sight) -> Result<&'s SeenObject, PlanFailure> {
        let object = sight.objects.get(self.object);
        object.ok_or_else(|| PlanFailure::Gone(self.object.to_owned()))
    }

    fn no_way(&self) -> PlanFailure {
        PlanFailure::NoWay(self.object.to_owned())
    }

    /// A grasp from which one of the goals can be reached, and the paths of that transfer.
    fn plan(&self, sight: &Sight, goals: &[Candidate]) -> Result<(Taking, [Path; 2]), PlanFailure> {
        let object = self.seen(sight)?;
        let limb = &self.body.limbs[self.limb];
        let mut all = grasps(
            &object.shape,
            object.pose.rotation,
            self.side,
            limb.finger.z,
            limb.widest,
        );
        if all.is_empty() {
            return Err(PlanFailure::NoGrasp(self.object.to_owned()));
        }
        all.sort_by(|a, b| a.off.total_cmp(&b.off));
        let found = Cell::default();
        let mut looked_into = Vec::new();
        for some in all.chunks(GRASPS) {
            let takings = self.takings(sight, object, some, &found);
            if let Some(plan) = self.best(sight, &takings, goals, WaySearch::Simple, &found) {
                return Ok(plan);
            }
            looked_into.push(takings);
        }
        let search = WaySearch::Trying(self.seed);
        let searched = looked_into
            .iter()
            .find_map(|takings| self.best(sight, takings, goals, search, &found));
        let found = found.get();
        searched.ok_or_else(|| match found {
            Obstructions {
                free: true,
                put: true,
                ..
            }
            | Obstructions {
                reached: true,
                free: false,
                ..
            } => self.no_way(),
            Obstructions { .. } => PlanFailure::OutOfReach(self.object.to_owned()),
        })
    }

    /// The feasible ones of some grasps.
    fn takings(
        &self,
        sight: &Sight,
        object: &SeenObject,
        grasps: &[Grasp],
        found: &Cell<Obstructions>,
    ) -> Vec<Taking> {
        let limb = &self.body.limbs[self.limb];
        let mut free = Clearance::new(self.body, sight, self.limb, &[self.object]);
        let here = free.here();
        let own = object.solids();
        let mut takings = Vec::new();
        for &grasp in grasps {
            let pose = object.pose * grasp.end_effector;
            let openings = OPENINGS.map(|more| (grasp.width + more).min(limb.widest));
            let mut fitting = openings.into_iter().filter(|&opening| {
                self.fits(&own, pose, opening) && free.has_room_for_fingers(pose, opening, BESIDE)
            });
            let Some(widest) = fitting.next() else {
                continue;
            };
            for seed in [here, limb.home] {
                let Some(at) = free.reach(pose, &seed) else {
                    break;
                };
                found.set(Obstructions {
                    reached: true,
                    ..found.get()
                });
                let mut openings = openings.into_iter().filter(|opening| *opening <= widest);
                let opening = openings.find(|&opening| {
                    free.opening = opening;
                    free.is_free(&at, Margins::NARROW)
                });
                if let Some(opening) = opening {
                    takings.push(Taking { grasp, opening, at });
                    break;
                }
            }
        }
        found.set(Obstructions {
            free: found.get().free || !takings.is_empty(),
            ..found.get()
        });
        takings
    }

    /// The first grasp, by the cost of grasp and goal together, with which a goal can be reached, and the paths of that transfer.
    fn best(
        &self,
        sight: &Sight,
        takings: &[Taking],
        goals: &[Candidate],
        search: WaySearch,
        found: &Cell<Obstructions>,
    ) -> Option<(Taking, [Path; 2])> {
        let object = self.seen(sight).ok()?;
        let here = sight.limbs[self.limb].angles;
        let mut pairs = Vec::new();
        for (i, taking) in takings.iter().enumerate() {
            let turns = largest_turn(&taking.at, &here) as f32 / 3.0;
            let taken = object.pose * taking.grasp.end_effector;
            let tightness = 2.0 * (OPENINGS[0] + taking.grasp.width - taking.opening);
            for goal in goals {
                let put = goal.pose * taking.grasp.end_effector;
                let turned = angle_between(taken.rotation, put.rotation) / 1.5;
                let cost = turns + turned + goal.cost + taking.grasp.off + tightness;
                pairs.push((cost, i, *goal));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut approaches = BTreeMap::new();
        let mut lifts = BTreeMap::new();
        let mut tries = match search {
            WaySearch::Simple => PAIRS,
            WaySearch::Trying(_) => SEARCHED_PAIRS,
        };
        for (_, i, goal) in pairs {
            let taking = &takings[i];
            let grip = taking.grasp.end_effector.inverse();
            let holding = self.holding(sight, object, grip, taking.grasp.width, &taking.at);
            let end = above_place(goal, grip);
            let Some(put) = holding.reach(end, &taking.at) else {
                continue;
            };
            found.set(Obstructions {
                put: true,
                ..found.get()
            });
            if !holding.is_free(&put, Margins::NARROW) {
                continue;
            }
            let approach = approaches
                .entry(i)
                .or_insert_with(|| self.approach(sight, taking, search));
            let Some(approach) = approach else {
                continue;
            };
            let lift = lifts
                .entry(i)
                .or_insert_with(|| self.lifted(&holding, sight, &taking.at, object.pose));
            let Some(lift) = lift else {
                continue;
            };
            if self
                .placing(&holding, sight, lift, goal, &put, search)
                .is_some()
            {
                return Some((*taking, approach.clone()));
            }
            tries -= 1;
            if tries == 0 {
                break;
            }
        }
        None
    }

    /// True if fingers at this opening are beside the object, not inside another part of it.
    fn fits(&self, object: &[PlacedSolid], end_effector: Pose, opening: f32) -> bool {
        let fingers = self.body.fingers(self.limb, end_effector, opening);
        let is_apart =
            |finger: &PlacedSolid| object.iter().all(|solid| !finger.is_within(0.02, solid));
        fingers.iter().all(is_apart)
    }

    /// Paths to where the object is taken from, and to it.
    fn approach(&self, sight: &Sight, taking: &Taking, search: WaySearch) -> Option<[Path; 2]> {
        let object = self.seen(sight).ok()?;
        let near =
            Clearance::new(self.body, sight, self.limb, &[self.object]).opened(taking.opening);
        let far = Clearance::new(self.body, sight, self.limb, &[]).opened(taking.opening);
        let end_effector = near.end_effector(&taking.at);
        let back = end_effector.rotation * Vec3::Z;
        let solids = object.solids();
        let reach = solids.iter().map(|solid| solid.farthest(back).dot(back));
        let reach = reach.fold(f32::NEG_INFINITY, f32::max);
        let ends = end_effector.location.dot(back) - self.body.limbs[self.limb].finger.z / 2.0;
        let away = reach - ends + 0.15;
        let (up, way) = [away, away + 0.5, (away - 0.4).max(0.3)]
            .into_iter()
            .find_map(|by| {
                let up = withdraw(&near, &taking.at, by)?;
                if !near.is_way_free(&up, Margins::NARROW) {
                    return None;
                }
                let way = transit(&far, &far.here(), up.last()?, search)?;
                Some((up, way))
            })?;
        let down = up
            .iter()
            .rev()
            .skip(1)
            .chain([&taking.at])
            .copied()
            .collect();
        Some([way, down])
    }

    /// The clearance of the arm that holds the object like this, with fingers at this opening; the arm held it first at the angles `at`.
    fn holding(
        &self,
        sight: &Sight,
        object: &SeenObject,
        grip: Pose,
        opening: f32,
        at: &Angles,
    ) -> Clearance<'_> {
        let solids = object.solids_at(Pose::IDENTITY);
        let upright = self.body.end_effector(self.limb, at).rotation.inverse();
        Clearance::new(self.body, sight, self.limb, &[self.object])
            .holding(&solids, grip, upright)
            .opened(opening)
    }

    /// The path up with the held object, until it is above everything around it.
    fn lifted(&self, holding: &Clearance, sight: &Sight, from: &Angles, at: Pose) -> Option<Path> {
        let by = self.height(sight, at);
        [by, by + 0.5, (by - 0.4).max(0.3)]
            .into_iter()
            .find_map(|by| {
                let up = lift(holding, from, by)?;
                // At the beginning, the held object touches its support.
                holding
                    .is_way_free(&up[1.min(up.len() - 1)..], Margins::NARROW)
                    .then_some(up)
            })
    }

    /// Height, in units, to which an object must be lifted to pass over everything around this place of it.
    fn height(&self, sight: &Sight, at: Pose) -> f32 {
        let Some(object) = sight.objects.get(self.object) else {
            return 0.5;
        };
        let solids = object.solids_at(at);
        let [lowest, _] = heights(&solids);
        let others = sight.objects.iter().filter(|(id, _)| *id != self.object);
        let near = others
            .flat_map(|(_, other)| other.solids())
            .filter(|other| {
                let is_near = |solid: &PlacedSolid| solid.gap_from_above(other) < 0.12;
                let is_within = (other.pose.location - at.location).truncate().length() < 0.3;
                is_within || solids.iter().any(is_near)
            });
        let tops = near.map(|other| other.heights()[1] - lowest);
        tops.filter(|top| *top > 0.03)
            .fold(0.4, |by, top| by.max(top + 0.2))
    }

    /// Paths from where the object is lifted to above a goal, and down to these angles of the arm.
    fn placing(
        &self,
        holding: &Clearance,
        sight: &Sight,
        lifted: &Path,
        goal: Candidate,
        put: &Angles,
        search: WaySearch,
    ) -> Option<Placing> {
        if !holding.is_free(put, Margins::NARROW) {
            return None;
        }
        let end = holding.end_effector(put);
        let widest = self.body.limbs[self.limb].widest;
        let opening = RELEASES
            .into_iter()
            .map(|more| (holding.opening + more).min(widest))
            .find(|opening| holding.has_room_for_fingers(end, *opening, BESIDE))?;
        let by = self.height(sight, goal.pose);
        [by, by + 0.5, (by - 0.4).max(0.3)]
            .into_iter()
            .find_map(|by| {
                let up = lift(holding, put, by)?;
                if !holding.is_way_free(&up, Margins::NARROW) {
                    return None;
                }
                let way = transit(holding, lifted.last()?, up.last()?, search)?;
                let down = up.iter().rev().skip(1).chain([put]).copied().collect();
                Some(Placing { way, down, opening })
            })
    }

    fn take(
        &self,
        stage: &mut dyn PlanningStage,
        taking: &Taking,
        [way, down]: &[Path; 2],
    ) -> Result<(), PlanFailure> {
        grip(stage, self.limb, f64::from(taking.opening))?;
        follow(stage, self.body, self.limb, way, FAST, self.object)?;
        follow(stage, self.body, self.limb, down, SLOW, self.object)?;
        grip(stage, self.limb, 0.0)?;
        let holds = &stage.sight().limbs[self.limb].holds;
        if holds.iter().any(|id| id == self.object) {
            return Ok(());
        }
        self.retreat(stage)?;
        Err(PlanFailure::NotHeld(self.object.to_owned()))
    }

    /// Opens the gripper and withdraws it.
    fn retreat(&self, stage: &mut dyn PlanningStage) -> Result<(), PlanFailure> {
        let limb = &self.body.limbs[self.limb];
        grip(stage, self.limb, f64::from(limb.widest))?;
        self.withdraw(stage)
    }

    fn withdraw(&self, stage: &mut dyn PlanningStage) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, self.limb, &[self.object]);
        let here = clearance.here();
        let by = [1.4, 1.0, 0.6]
            .into_iter()
            .find_map(|by| withdraw(&clearance, &here, by));
        match by {
            Some(up) => follow(stage, self.body, self.limb, &up, SLOW, self.object),
            None => Ok(()),
        }
    }

    fn let_go(&self, stage: &mut dyn PlanningStage, opening: f32) -> Result<(), PlanFailure> {
        let widest = self.body.limbs[self.limb].widest;
        grip(stage, self.limb, f64::from(opening.min(widest)))?;
        self.withdraw(stage)?;
        Ok(wait(stage, 15)?)
    }

    /// Puts the held object at one of these goals, as it now lies in the fingers.
    fn put(&self, stage: &mut dyn PlanningStage, goals: &[Candidate]) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let object = self.seen(&sight)?;
        let seen = &sight.limbs[self.limb];
        let here = seen.angles;
        let end_effector = self.body.end_effector(self.limb, &here);
        let grip = end_effector.inverse() * object.pose;
        let holding = self.holding(&sight, object, grip, seen.opening as f32, &here);
        let lifted = self
            .lifted(&holding, &sight, &here, object.pose)
            .ok_or_else(|| self.no_way())?;
        let mut sorted: Vec<_> = goals
            .iter()
            .filter_map(|goal| {
                let put = holding.reach(above_place(*goal, grip), &here)?;
                let cost = largest_turn(&put, &here) / 1.5 + f64::from(goal.cost);
                Some((cost, *goal, put))
            })
            .collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let with = |search: WaySearch, pairs: usize| {
            let some = sorted.iter().take(pairs);
            some.into_iter().find_map(|(_, goal, put)| {
                self.placing(&holding, &sight, &lifted, *goal, put, search)
            })
        };
        let placing = with(WaySearch::Simple, PAIRS)
            .or_else(|| with(WaySearch::Trying(self.seed), PAIRS))
            .ok_or_else(|| self.no_way())?;
        let Placing { way, down, opening } = placing;
        follow(stage, self.body, self.limb, &lifted, SLOW, self.object)?;
        follow(stage, self.body, self.limb, &way, FAST, self.object)?;
        let (down, end) = down.split_at(down.len().saturating_sub(GENTLE_POSTURES));
        follow(stage, self.body, self.limb, down, SLOW, self.object)?;
        follow(stage, self.body, self.limb, end, GENTLE, self.object)?;
        self.let_go(stage, opening)
    }
}

/// Pose of an end effector that releases an object held like this, so that it comes to rest at a goal.
fn above_place(goal: Candidate, grip: Pose) -> Pose {
    Pose::new(goal.pose.location + Vec3::Z * DROP, goal.pose.rotation) * grip.inverse()
}
