//! The arms: which does it, and where they wait meanwhile.

use bevy::math::Vec3;
use tabletop_geometry::Pose;

use super::Imitator;
use crate::{
    clearance::Clearance,
    failure::PlanFailure,
    grasp::GraspSide,
    motion::{follow, grip},
    path::{largest_turn, withdraw},
    stage::{PlanningStage, Stopped},
    transfer::Transfer,
    transit::{WaySearch, transit},
};

/// PlaceRange where limbs wait, out of each other's way: beside the table's front corners, in units.
const PARKED: Vec3 = Vec3::new(7.0, -6.0, 4.5);

impl Imitator<'_> {
    /// Lets a limb do it that takes the object from above; if none can, from beside.
    pub(super) fn by_some_limb(
        &self,
        stage: &mut dyn PlanningStage,
        id: &str,
        towards: Vec3,
        act: impl Fn(&Transfer, &mut dyn PlanningStage) -> Result<(), PlanFailure>,
    ) -> Result<(), PlanFailure> {
        let from_above = self.by_some_limb_from(stage, GraspSide::Above, id, towards, &act);
        self.or_from_beside(stage, from_above, |stage| {
            self.by_some_limb_from(stage, GraspSide::Beside, id, towards, &act)
        })
    }

    /// The result of an act from above or, if that is impossible, of the same act from beside.
    pub(super) fn or_from_beside(
        &self,
        stage: &mut dyn PlanningStage,
        from_above: Result<(), PlanFailure>,
        from_beside: impl FnOnce(&mut dyn PlanningStage) -> Result<(), PlanFailure>,
    ) -> Result<(), PlanFailure> {
        let is_held = |stage: &dyn PlanningStage| {
            let mut limbs = stage.sight().limbs.iter();
            limbs.any(|limb| !limb.holds.is_empty())
        };
        let may_be_done = from_above.as_ref().is_err_and(PlanFailure::is_of_planning);
        if !may_be_done || is_held(stage) {
            return from_above;
        }
        let outcome = from_beside(stage);
        let has_failed = outcome.as_ref().is_err_and(PlanFailure::is_of_planning);
        match from_above {
            // Whoever looks sees why it cannot be done from above.
            Err(PlanFailure::NoGrasp(_)) | Ok(()) => outcome,
            Err(_) if !has_failed => outcome,
            Err(_) => from_above,
        }
    }

    /// Lets the limb do it that is on the side of both ends; if it cannot, the others. They wait meanwhile.
    pub(super) fn by_some_limb_from(
        &self,
        stage: &mut dyn PlanningStage,
        side: GraspSide,
        id: &str,
        towards: Vec3,
        act: impl Fn(&Transfer, &mut dyn PlanningStage) -> Result<(), PlanFailure>,
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let object = sight
            .objects
            .get(id)
            .ok_or_else(|| PlanFailure::Gone(id.to_owned()))?;
        let middle = object.pose.location.midpoint(towards);
        let mut limbs: Vec<_> = (0..self.body.limbs.len()).collect();
        let distance = |limb: &usize| {
            let parked = self.body.end_effector(*limb, &self.parked[*limb]);
            parked.location.distance(middle)
        };
        limbs.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut failure = PlanFailure::NoGrasp(id.to_owned());
        for limb in limbs {
            for other in (0..self.body.limbs.len()).filter(|&other| other != limb) {
                self.try_to_park(stage, other)?;
            }
            let transfer = self.transfer(limb, id, side);
            match act(&transfer, stage) {
                Ok(()) => {
                    self.look(stage)?;
                    return Ok(());
                }
                Err(new) => {
                    let has_acted = matches!(
                        new,
                        PlanFailure::Blocked { .. }
                            | PlanFailure::NotHeld(_)
                            | PlanFailure::EmptyHand { .. }
                            | PlanFailure::Gone(_)
                    ) || stage.sight().limbs[limb]
                        .holds
                        .iter()
                        .any(|held| held == id);
                    failure = failure.or(new);
                    if failure == PlanFailure::Stopped {
                        return Err(failure);
                    }
                    if has_acted {
                        self.set_down(stage, limb)?;
                        return Err(failure);
                    }
                }
            }
        }
        Err(failure)
    }

    /// Opens a gripper that still holds something after a failure, and withdraws it.
    fn set_down(&self, stage: &mut dyn PlanningStage, limb: usize) -> Result<(), PlanFailure> {
        let widest = f64::from(self.body.limbs[limb].widest);
        grip(stage, limb, widest)?;
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, limb, &[]);
        if let Some(back) = withdraw(&clearance, &clearance.here(), 1.0) {
            // After other failures it stays where it is.
            if let Err(PlanFailure::Stopped) = follow(stage, self.body, limb, &back, 2.5, "") {
                return Err(PlanFailure::Stopped);
            }
        }
        Ok(())
    }

    pub(super) fn park_all(&mut self, stage: &mut dyn PlanningStage) -> Result<(), Stopped> {
        for (limb, seen) in stage.sight().limbs.iter().enumerate() {
            let side = self
                .body
                .end_effector(limb, &seen.angles)
                .location
                .x
                .signum();
            let place = Pose::at(PARKED * Vec3::new(side, 1.0, 1.0));
            let parked = self.body.reach(limb, place, &seen.angles);
            self.parked
                .push(parked.unwrap_or(self.body.limbs[limb].home));
        }
        for limb in 0..self.parked.len() {
            self.try_to_park(stage, limb)?;
        }
        Ok(())
    }

    /// Brings a limb to its waiting place if a path is free.
    pub(super) fn try_to_park(
        &self,
        stage: &mut dyn PlanningStage,
        limb: usize,
    ) -> Result<(), Stopped> {
        match self.park(stage, limb) {
            Err(PlanFailure::Stopped) => Err(Stopped),
            Ok(()) | Err(_) => Ok(()),
        }
    }

    /// Brings a limb to its waiting place.
    ///
    /// # Errors
    /// No path is free, or something stops the limb.
    fn park(&self, stage: &mut dyn PlanningStage, limb: usize) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, limb, &[]);
        let here = clearance.here();
        if largest_turn(&here, &self.parked[limb]) < 1e-3 {
            return Ok(());
        }
        let name = || format!("the {} arm", self.body.limbs[limb].name);
        let way = transit(
            &clearance,
            &here,
            &self.parked[limb],
            WaySearch::Trying(self.seed),
        );
        let way = way.ok_or_else(|| PlanFailure::NoWay(name()))?;
        follow(stage, self.body, limb, &way, 6.0, &name())
    }
}
