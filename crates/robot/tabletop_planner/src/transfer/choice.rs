//! The choice of a grasp: one that is free, from which a goal can be reached, at the least cost.

use std::{cell::Cell, collections::BTreeMap};

use bevy::math::Vec3;
use tabletop_controller::{Angles, SeenObject, Sight};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::angle_between;

use super::{BESIDE, PAIRS, Transfer, above_place};
use crate::{
    clearance::Margins,
    failure::PlanFailure,
    goals::Candidate,
    grasp::{Grasp, grasps},
    path::{Path, largest_turn},
    sight::Solids as _,
    transit::WaySearch,
};

/// Openings of the fingers before a grasp, in units beyond the object's width. The first that has room is used.
const OPENINGS: [f32; 3] = [0.35, 0.18, 0.1];
/// Number of grasps that are examined at a time, the best first.
const GRASPS: usize = 24;
/// Number of pairs of grasp and goal whose paths are searched for.
const SEARCHED_PAIRS: usize = 4;

/// A feasible grasp.
#[derive(Clone, Copy)]
pub(super) struct Taking {
    pub grasp: Grasp,
    pub opening: f32,
    pub at: Angles,
}

/// A grasp, and the paths to it.
pub(super) type Plan = (Taking, [Path; 2]);

impl Taking {
    /// The cost of the grasp from this posture.
    fn cost(&self, here: &Angles) -> f32 {
        let turns = largest_turn(&self.at, here) as f32 / 3.0;
        let tightness = 2.0 * (OPENINGS[0] + self.grasp.width - self.opening);
        turns + self.grasp.off + tightness
    }
}

/// The number of plans whose paths are searched for.
const fn most_tries(search: WaySearch) -> usize {
    match search {
        WaySearch::Simple => PAIRS,
        WaySearch::Trying(_) => SEARCHED_PAIRS,
    }
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
    /// A grasp from which one of the goals can be reached, and the paths of that transfer.
    pub(super) fn plan(&self, sight: &Sight, goals: &[Candidate]) -> Result<Plan, PlanFailure> {
        self.choose(sight, |takings, search, found| {
            self.best(sight, takings, goals, search, found)
        })
    }

    /// A grasp with which the object can be slid by so much, and the paths to it.
    pub(super) fn plan_slide(&self, sight: &Sight, by: Vec3) -> Result<Plan, PlanFailure> {
        self.choose(sight, |takings, search, found| {
            self.best_to_slide(sight, takings, by, search, found)
        })
    }

    /// The first plan of grasps that are looked into some at a time: without a search for paths, then with one.
    fn choose(
        &self,
        sight: &Sight,
        best: impl Fn(&[Taking], WaySearch, &Cell<Obstructions>) -> Option<Plan>,
    ) -> Result<Plan, PlanFailure> {
        let object = self.seen(sight)?;
        let all = self.grasps(object);
        if all.is_empty() {
            return Err(PlanFailure::NoGrasp(self.object.to_owned()));
        }
        let found = Cell::default();
        let mut looked_into = Vec::new();
        for some in all.chunks(GRASPS) {
            let takings = self.takings(sight, object, some, &found);
            if let Some(plan) = best(&takings, WaySearch::Simple, &found) {
                return Ok(plan);
            }
            looked_into.push(takings);
        }
        let search = WaySearch::Trying(self.seed);
        let searched = looked_into
            .iter()
            .find_map(|takings| best(takings, search, &found));
        searched.ok_or_else(|| self.failure(sight, found.get()))
    }

    /// True if a way to one of the goals is found without a search.
    pub fn is_possible(&self, sight: &Sight, goals: &[Candidate]) -> bool {
        let Ok(object) = self.seen(sight) else {
            return false;
        };
        let found = Cell::default();
        self.grasps(object).chunks(GRASPS).any(|some| {
            let takings = self.takings(sight, object, some, &found);
            let plan = self.best(sight, &takings, goals, WaySearch::Simple, &found);
            plan.is_some()
        })
    }

    fn failure(&self, sight: &Sight, found: Obstructions) -> PlanFailure {
        let object = self.object.to_owned();
        match found {
            Obstructions { reached: false, .. } => match self.reach(sight) {
                Ok(()) => PlanFailure::Enclosed(object),
                Err(failure) => failure,
            },
            Obstructions {
                free: true,
                put: false,
                ..
            } => PlanFailure::PlaceOutOfReach(object),
            Obstructions { free: false, .. } | Obstructions { put: true, .. } => {
                PlanFailure::NoWay(object)
            }
        }
    }

    /// Whether a grasp of the object is within reach, obstacles aside.
    pub fn reach(&self, sight: &Sight) -> Result<(), PlanFailure> {
        let object = self.seen(sight)?;
        let here = sight.limbs[self.limb].angles;
        let grasps = self.grasps(object);
        let is_reached = |grasp: &Grasp| {
            let pose = object.pose * grasp.end_effector;
            self.body.reach(self.limb, pose, &here).is_some()
        };
        match grasps.iter().any(is_reached) {
            true => Ok(()),
            false if grasps.is_empty() => Err(PlanFailure::NoGrasp(self.object.to_owned())),
            false => Err(PlanFailure::OutOfReach(self.object.to_owned())),
        }
    }

    /// Whether the arm reaches one of these goals with the object in its fingers, obstacles aside.
    pub fn reaches(&self, sight: &Sight, goals: &[Candidate]) -> bool {
        let Ok(object) = self.seen(sight) else {
            return false;
        };
        let here = sight.limbs[self.limb].angles;
        let grasps = self.grasps(object);
        goals.iter().any(|goal| {
            let is_reached = |grasp: &Grasp| {
                let pose = above_place(*goal, grasp.end_effector.inverse());
                self.body.reach(self.limb, pose, &here).is_some()
            };
            grasps.iter().any(is_reached)
        })
    }

    /// The ways to take the object, the best first.
    fn grasps(&self, object: &SeenObject) -> Vec<Grasp> {
        let limb = &self.body.limbs[self.limb];
        let (finger, widest) = (limb.finger, limb.widest);
        let mut all = grasps(
            &object.shape,
            object.pose.rotation,
            self.side,
            finger,
            widest,
        );
        all.sort_by(|a, b| a.off.total_cmp(&b.off));
        all
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
        let own = object.solids();
        let mut free = self.taking(sight, object);
        let here = free.here();
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
    ) -> Option<Plan> {
        let object = self.seen(sight).ok()?;
        let here = sight.limbs[self.limb].angles;
        let mut pairs = Vec::new();
        for (i, taking) in takings.iter().enumerate() {
            let taken = object.pose * taking.grasp.end_effector;
            for goal in goals {
                let put = goal.pose * taking.grasp.end_effector;
                let turned = angle_between(taken.rotation, put.rotation) / 1.5;
                let cost = taking.cost(&here) + turned + goal.cost;
                pairs.push((cost, i, *goal));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut approaches = BTreeMap::new();
        let mut lifts = BTreeMap::new();
        let mut tries = most_tries(search);
        for (_, i, goal) in pairs {
            let taking = &takings[i];
            let grip = taking.grasp.end_effector.inverse();
            let upright = self.upright(&taking.at, goal.placement);
            let holding = self.holding(sight, object, grip, taking.grasp.width, upright);
            let end = above_place(goal, grip);
            // A tipped object has many goals that look the same.
            let put = match goal.is_tipped() {
                true => holding.reach_soon(end, &taking.at),
                false => holding.reach(end, &taking.at),
            };
            let Some(put) = put else {
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

    /// The first grasp, by its cost, with which the object can be slid by so much, and the paths to it.
    fn best_to_slide(
        &self,
        sight: &Sight,
        takings: &[Taking],
        by: Vec3,
        search: WaySearch,
        found: &Cell<Obstructions>,
    ) -> Option<Plan> {
        let here = sight.limbs[self.limb].angles;
        let mut sorted: Vec<_> = takings.iter().collect();
        sorted.sort_by(|a, b| a.cost(&here).total_cmp(&b.cost(&here)));
        let slid = sorted.into_iter().filter(|taking| {
            let width = taking.grasp.width;
            let Some(way) = self.way_along(sight, &taking.at, by) else {
                return false;
            };
            found.set(Obstructions {
                put: true,
                ..found.get()
            });
            self.release_along(sight, &taking.at, &way, width, by)
                .is_some()
        });
        slid.take(most_tries(search)).find_map(|taking| {
            let approach = self.approach(sight, taking, search)?;
            Some((*taking, approach))
        })
    }

    /// True if fingers at this opening are beside the object, not inside another part of it.
    fn fits(&self, object: &[PlacedSolid], end_effector: Pose, opening: f32) -> bool {
        let fingers = self.body.fingers(self.limb, end_effector, opening);
        let is_apart =
            |finger: &PlacedSolid| object.iter().all(|solid| !finger.is_within(0.02, solid));
        fingers.iter().all(is_apart)
    }
}
