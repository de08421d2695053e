//! Taking an object, and putting it somewhere.

use std::collections::BTreeMap;

use bevy::math::Vec3;
use tabletop_core::Pose;
use tabletop_task::Convex;

use crate::{
    body::{Angles, RobotBody, is_within},
    clearance::{Clearance, Margins},
    failure::Failure,
    goals::Candidate,
    grasp::{Grasp, grasps},
    motion::{follow, grip, wait},
    path::{Path, largest_turn, lift, line},
    sight::{SeenObject, Sight, heights},
    stage::Stage,
    transit::transit,
};

/// How fast an end effector goes on its way, in units/s, and near what it takes or puts.
const FAST: f64 = 6.0;
const SLOW: f64 = 2.5;
/// How fast something comes down on what it is put on, so that it does not push that away, in units/s, and for how many postures of
/// its way.
const GENTLE: f64 = 0.5;
const GENTLE_POSTURES: usize = 2;
/// How high above where it comes to rest something is let go of, in units.
const DROP: f32 = 0.02;
/// How much wider than what they take fingers are opened, in units: the most that has room.
const OPENINGS: [f32; 3] = [0.35, 0.18, 0.1];
/// How many pairs of grasp and goal are looked into.
const PAIRS: usize = 24;

/// What is to be moved by whom.
pub(crate) struct Transfer<'a> {
    pub body: &'a RobotBody,
    pub limb: usize,
    pub object: &'a str,
    /// Decides what is tried where a way has to be searched for.
    pub seed: u64,
}

/// A grasp that can be done.
#[derive(Clone, Copy)]
struct Taking {
    grasp: Grasp,
    opening: f32,
    at: Angles,
}

impl Transfer<'_> {
    /// Takes the object, and puts it to one of these places.
    pub fn carry_out(&self, stage: &mut dyn Stage, goals: &[Candidate]) -> Result<(), Failure> {
        let sight = stage.sight().clone();
        let (taking, approach) = self.plan(&sight, goals)?;
        self.take(stage, &taking, &approach)?;
        self.put(stage, goals)
    }

    /// Takes the object, and lifts it.
    pub fn pick_up(&self, stage: &mut dyn Stage) -> Result<(), Failure> {
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

    /// Takes the object, and moves it along a straight line by so much, as a joint lets it.
    pub fn slide(&self, stage: &mut dyn Stage, by: Vec3) -> Result<(), Failure> {
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
        self.let_go(stage)
    }

    fn seen<'s>(&self, sight: &'s Sight) -> Result<&'s SeenObject, Failure> {
        let object = sight.objects.get(self.object);
        object.ok_or_else(|| Failure::Gone(self.object.to_owned()))
    }

    fn no_way(&self) -> Failure {
        Failure::NoWay(self.object.to_owned())
    }

    /// A grasp from which one of the goals can be reached, and the way to it.
    fn plan(&self, sight: &Sight, goals: &[Candidate]) -> Result<(Taking, [Path; 2]), Failure> {
        let object = self.seen(sight)?;
        let limb = &self.body.limbs[self.limb];
        let all = grasps(
            &object.shape,
            object.pose.rotation,
            limb.finger.z,
            limb.widest,
        );
        if all.is_empty() {
            return Err(Failure::NoGrasp(self.object.to_owned()));
        }
        let mut free = Clearance::new(self.body, sight, self.limb, &[self.object]);
        let here = free.here();
        let own = object.solids();
        let mut takings = Vec::new();
        let mut is_reached = false;
        for grasp in all {
            let pose = object.pose * grasp.end_effector;
            let seeds = [here, limb.home];
            let postures = seeds.into_iter().filter_map(|seed| free.reach(pose, &seed));
            for at in postures.collect::<Vec<_>>() {
                is_reached = true;
                let opening = OPENINGS
                    .into_iter()
                    .map(|more| (grasp.width + more).min(limb.widest))
                    .find(|&opening| {
                        free.opening = opening;
                        free.is_free(&at, Margins::NARROW) && self.fits(&own, pose, opening)
                    });
                if let Some(opening) = opening {
                    takings.push(Taking { grasp, opening, at });
                    break;
                }
            }
        }
        if takings.is_empty() {
            let object = self.object.to_owned();
            return Err(match is_reached {
                true => Failure::NoWay(object),
                false => Failure::OutOfReach(object),
            });
        }
        let mut pairs = Vec::new();
        for (i, taking) in takings.iter().enumerate() {
            for goal in goals {
                let pose = goal.pose * taking.grasp.end_effector;
                let Some(put) = free.reach(pose, &taking.at) else {
                    continue;
                };
                let turns = largest_turn(&put, &taking.at) + 0.5 * largest_turn(&taking.at, &here);
                let width = f64::from(taking.opening - taking.grasp.width);
                let cost =
                    turns / 1.5 + f64::from(goal.cost + taking.grasp.off) + 2.0 * (0.35 - width);
                pairs.push((cost, i, *goal, put));
            }
        }
        if pairs.is_empty() {
            return Err(Failure::OutOfReach(self.object.to_owned()));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut approaches = BTreeMap::new();
        for (_, i, goal, put) in pairs.into_iter().take(PAIRS) {
            let taking = &takings[i];
            let approach = approaches
                .entry(i)
                .or_insert_with(|| self.approach(sight, taking));
            if let Some(approach) = approach
                && self.can_put(sight, taking, goal, &put)
            {
                return Ok((*taking, approach.clone()));
            }
        }
        Err(self.no_way())
    }

    /// Whether fingers that are open so far are beside the object, not in another part of it.
    fn fits(&self, object: &[Convex], end_effector: Pose, opening: f32) -> bool {
        let fingers = self.body.fingers(self.limb, end_effector, opening);
        let is_apart = |finger: &Convex| object.iter().all(|solid| !is_within(finger, solid, 0.02));
        fingers.iter().all(is_apart)
    }

    /// The ways to above the object, and down to it.
    fn approach(&self, sight: &Sight, taking: &Taking) -> Option<[Path; 2]> {
        let object = self.seen(sight).ok()?;
        let near =
            Clearance::new(self.body, sight, self.limb, &[self.object]).opened(taking.opening);
        let far = Clearance::new(self.body, sight, self.limb, &[]).opened(taking.opening);
        let [_, top] = heights(&object.solids());
        let ends =
            near.end_effector(&taking.at).location.z - self.body.limbs[self.limb].finger.z / 2.0;
        let above = top - ends + 0.15;
        let (up, way) = [above, above + 0.5, (above - 0.4).max(0.3)]
            .into_iter()
            .find_map(|by| {
                let up = lift(&near, &taking.at, by)?;
                if !near.is_way_free(&up, Margins::NARROW) {
                    return None;
                }
                let way = transit(&far, &far.here(), up.last()?, self.seed)?;
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

    /// Whether an object that is held like this can be put there.
    fn can_put(&self, sight: &Sight, taking: &Taking, goal: Candidate, put: &Angles) -> bool {
        let Ok(object) = self.seen(sight) else {
            return false;
        };
        let grip = taking.grasp.end_effector.inverse();
        let holding = self.holding(sight, object, grip).opened(taking.grasp.width);
        let Some(lifted) = self.lifted(&holding, sight, &taking.at, object.pose) else {
            return false;
        };
        self.lowering(&holding, sight, &lifted, goal, put, grip)
            .is_some()
    }

    fn holding(&self, sight: &Sight, object: &SeenObject, grip: Pose) -> Clearance<'_> {
        let solids = object.solids_at(Pose::IDENTITY);
        Clearance::new(self.body, sight, self.limb, &[self.object]).holding(&solids, grip)
    }

    /// The way up with what is held, until it is above what is around it.
    fn lifted(&self, holding: &Clearance, sight: &Sight, from: &Angles, at: Pose) -> Option<Path> {
        let by = self.height(sight, at);
        [by, by + 0.5, (by - 0.4).max(0.3)]
            .into_iter()
            .find_map(|by| {
                let up = lift(holding, from, by)?;
                // What is held touches what it stands on, in the beginning.
                holding
                    .is_way_free(&up[1.min(up.len() - 1)..], Margins::NARROW)
                    .then_some(up)
            })
    }

    /// How far an object has to be lifted to pass over what stands around this place of it, in units.
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
                let is_near = |solid: &Convex| solid.gap_from_above(other) < 0.12;
                let is_within = (other.pose.location - at.location).truncate().length() < 0.3;
                is_within || solids.iter().any(is_near)
            });
        let tops = near.map(|other| other.heights()[1] - lowest);
        tops.filter(|top| *top > 0.03)
            .fold(0.4, |by, top| by.max(top + 0.2))
    }

    /// The ways from where the object is lifted to above a goal, and down to it.
    fn lowering(
        &self,
        holding: &Clearance,
        sight: &Sight,
        lifted: &Path,
        goal: Candidate,
        put: &Angles,
        grip: Pose,
    ) -> Option<[Path; 2]> {
        let end =
            Pose::new(goal.pose.location + Vec3::Z * DROP, goal.pose.rotation) * grip.inverse();
        let put = holding.reach(end, put)?;
        if !holding.is_free(&put, Margins::NARROW) {
            return None;
        }
        let by = self.height(sight, goal.pose);
        [by, by + 0.5, (by - 0.4).max(0.3)]
            .into_iter()
            .find_map(|by| {
                let up = lift(holding, &put, by)?;
                if !holding.is_way_free(&up, Margins::NARROW) {
                    return None;
                }
                let way = transit(holding, lifted.last()?, up.last()?, self.seed)?;
                let down = up.iter().rev().skip(1).chain([&put]).copied().collect();
                Some([way, down])
            })
    }

    fn take(
        &self,
        stage: &mut dyn Stage,
        taking: &Taking,
        [way, down]: &[Path; 2],
    ) -> Result<(), Failure> {
        grip(stage, self.limb, f64::from(taking.opening))?;
        follow(stage, self.body, self.limb, way, FAST, self.object)?;
        follow(stage, self.body, self.limb, down, SLOW, self.object)?;
        grip(stage, self.limb, 0.0)?;
        let holds = &stage.sight().limbs[self.limb].holds;
        if holds.iter().any(|id| id == self.object) {
            return Ok(());
        }
        self.retreat(stage)?;
        Err(Failure::NotHeld(self.object.to_owned()))
    }

    /// Opens the gripper, and goes up.
    fn retreat(&self, stage: &mut dyn Stage) -> Result<(), Failure> {
        let limb = &self.body.limbs[self.limb];
        grip(stage, self.limb, f64::from(limb.widest))?;
        self.go_up(stage)
    }

    fn go_up(&self, stage: &mut dyn Stage) -> Result<(), Failure> {
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, self.limb, &[self.object]);
        let here = clearance.here();
        let by = [1.4, 1.0, 0.6]
            .into_iter()
            .find_map(|by| lift(&clearance, &here, by));
        match by {
            Some(up) => follow(stage, self.body, self.limb, &up, SLOW, self.object),
            None => Ok(()),
        }
    }

    fn let_go(&self, stage: &mut dyn Stage) -> Result<(), Failure> {
        let opening = stage.sight().limbs[self.limb].opening;
        let widest = f64::from(self.body.limbs[self.limb].widest);
        grip(stage, self.limb, (opening + 0.35).min(widest))?;
        self.go_up(stage)?;
        Ok(wait(stage, 15)?)
    }

    /// Puts what is held to one of these places: as it lies in the fingers now.
    fn put(&self, stage: &mut dyn Stage, goals: &[Candidate]) -> Result<(), Failure> {
        let sight = stage.sight().clone();
        let object = self.seen(&sight)?;
        let here = sight.limbs[self.limb].angles;
        let end_effector = self.body.end_effector(self.limb, &here);
        let grip = end_effector.inverse() * object.pose;
        let holding = self.holding(&sight, object, grip);
        let lifted = self
            .lifted(&holding, &sight, &here, object.pose)
            .ok_or_else(|| self.no_way())?;
        let mut sorted: Vec<_> = goals
            .iter()
            .filter_map(|goal| {
                let put = holding.reach(goal.pose * grip.inverse(), &here)?;
                Some((
                    largest_turn(&put, &here) / 1.5 + f64::from(goal.cost),
                    *goal,
                    put,
                ))
            })
            .collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ways = sorted
            .into_iter()
            .take(PAIRS)
            .find_map(|(_, goal, put)| self.lowering(&holding, &sight, &lifted, goal, &put, grip));
        let [way, down] = ways.ok_or_else(|| self.no_way())?;
        follow(stage, self.body, self.limb, &lifted, SLOW, self.object)?;
        follow(stage, self.body, self.limb, &way, FAST, self.object)?;
        let (down, end) = down.split_at(down.len().saturating_sub(GENTLE_POSTURES));
        follow(stage, self.body, self.limb, down, SLOW, self.object)?;
        follow(stage, self.body, self.limb, end, GENTLE, self.object)?;
        self.let_go(stage)
    }
}
