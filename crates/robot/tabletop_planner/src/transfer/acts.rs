//! The acts of a transfer: an arm takes an object, carries it and lets it go.

use bevy::math::Vec3;
use tabletop_controller::Sight;
use tabletop_geometry::Pose;

use super::{
    PAIRS, STEADY, Transfer, above_place,
    choice::Taking,
    ways::{Placing, back_or_out},
};
use crate::{
    clearance::{Clearance, Margins},
    failure::PlanFailure,
    goals::{Candidate, Placement},
    motion::{follow, grip, wait},
    path::{Path, largest_turn, lift},
    stage::PlanningStage,
    transit::WaySearch,
};

/// Speed of an end effector, in units/s: on its way, and near the place of a grasp or release.
const FAST: f64 = 6.0;
const SLOW: f64 = 2.5;
/// Speed, in units/s, at which an object comes down on its support without pushing it away, and the number of last postures
/// at which it applies.
const GENTLE: f64 = 0.5;
const GENTLE_POSTURES: usize = 2;

impl Transfer<'_> {
    /// Grasps the object and puts it at one of these goals.
    pub fn carry_out(
        &self,
        stage: &mut dyn PlanningStage,
        goals: &[Candidate],
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        self.grasp(stage, &sight, goals)?;
        self.put(stage, goals)
    }

    /// Grasps the object and lifts it.
    pub fn pick_up(&self, stage: &mut dyn PlanningStage) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let object = self.seen(&sight)?;
        let there = Pose::new(object.pose.location + Vec3::Z, object.pose.rotation);
        self.grasp(stage, &sight, &[Candidate::new(there, 0.0)])?;
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, self.limb, &[self.object]);
        let up = lift(&clearance, &clearance.here(), 1.0).ok_or_else(|| self.no_way())?;
        follow(stage, self.body, self.limb, &up, SLOW, self.object)
    }

    /// Plans how to grasp the object for one of these goals, and grasps it.
    fn grasp(
        &self,
        stage: &mut dyn PlanningStage,
        sight: &Sight,
        goals: &[Candidate],
    ) -> Result<(), PlanFailure> {
        let (taking, approach) = self.plan(sight, goals)?;
        self.take(stage, &taking, &approach)
    }

    pub(super) fn take(
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
        let failure = self.check_hand(stage).err();
        self.retreat(stage)?;
        Err(failure.unwrap_or_else(|| PlanFailure::NotHeld(self.object.to_owned())))
    }

    /// Fails if the gripper says that it holds nothing.
    fn check_hand(&self, stage: &dyn PlanningStage) -> Result<(), PlanFailure> {
        match stage.sight().limbs[self.limb].says_it_grips {
            Some(false) => Err(PlanFailure::EmptyHand {
                limb: self.body.limbs[self.limb].name.clone(),
                object: self.object.to_owned(),
            }),
            Some(true) | None => Ok(()),
        }
    }

    /// Opens the gripper and withdraws it.
    fn retreat(&self, stage: &mut dyn PlanningStage) -> Result<(), PlanFailure> {
        let limb = &self.body.limbs[self.limb];
        grip(stage, self.limb, f64::from(limb.widest))?;
        self.withdraw(stage)
    }

    fn withdraw(&self, stage: &mut dyn PlanningStage) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let released = match self.seen(&sight) {
            Ok(object) => self.taking(&sight, object),
            Err(_) => Clearance::new(self.body, &sight, self.limb, &[]),
        };
        match back_or_out(&released, &released.here()) {
            Some(back) => follow(stage, self.body, self.limb, &back, SLOW, self.object),
            None => Ok(()),
        }
    }

    pub(super) fn let_go(
        &self,
        stage: &mut dyn PlanningStage,
        opening: f32,
    ) -> Result<(), PlanFailure> {
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
        let holding = |placement: Placement| {
            let upright = self.upright(&here, placement);
            self.holding(&sight, object, grip, seen.opening as f32, upright)
        };
        let lifted = self
            .lifted(&holding(Placement::Upright), &sight, &here, object.pose)
            .ok_or_else(|| self.no_way())?;
        let mut sorted: Vec<_> = goals
            .iter()
            .filter_map(|goal| {
                let holding = holding(goal.placement);
                let put = holding.reach(above_place(*goal, grip), &here)?;
                let cost = largest_turn(&put, &here) / 1.5 + f64::from(goal.cost);
                let is_free = holding.is_free(&put, Margins::NARROW);
                is_free.then_some((cost, *goal, put))
            })
            .collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let with = |search: WaySearch, pairs: usize| {
            let some = sorted.iter().take(pairs);
            some.into_iter().find_map(|(_, goal, put)| {
                self.placing(
                    &holding(goal.placement),
                    &sight,
                    &lifted,
                    *goal,
                    put,
                    search,
                )
            })
        };
        let placing = with(WaySearch::Simple, PAIRS)
            .or_else(|| with(WaySearch::Trying(self.seed), PAIRS))
            .ok_or_else(|| self.no_way())?;
        let Placing { way, down, opening } = placing;
        let [slow, fast] = match self.load.is_empty() {
            true => [SLOW, FAST],
            false => [STEADY; 2],
        };
        follow(stage, self.body, self.limb, &lifted, slow, self.object)?;
        self.check_hand(stage)?;
        follow(stage, self.body, self.limb, &way, fast, self.object)?;
        self.check_hand(stage)?;
        let (down, end) = down.split_at(down.len().saturating_sub(GENTLE_POSTURES));
        follow(stage, self.body, self.limb, down, slow, self.object)?;
        follow(stage, self.body, self.limb, end, GENTLE, self.object)?;
        self.let_go(stage, opening)
    }
}
