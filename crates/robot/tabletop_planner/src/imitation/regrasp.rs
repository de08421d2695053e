//! Regrasps: an object goes to its goal by way of another place, for another arm or another grasp.

use std::f32::consts::FRAC_PI_4;

use bevy::math::{Quat, Vec3};
use tabletop_controller::{SeenObject, Sight};
use tabletop_geometry::Pose;
use tabletop_task::Symmetry;

use super::Imitator;
use crate::{
    failure::PlanFailure,
    free_spot::free_spots,
    goals::{Candidate, Placement},
    grasp::GraspSide,
    stage::PlanningStage,
    standing::sides,
    transfer::Transfer,
};

/// Which of the free places, the nearest first, are tried to put something down on another side.
const SPOTS: [usize; 3] = [0, 4, 9];

impl Imitator<'_> {
    /// Puts an object down where every limb reaches it. Returns false if there is no such place.
    pub(super) fn put_halfway(
        &self,
        stage: &mut dyn PlanningStage,
        id: &str,
        near: Vec3,
        i: usize,
    ) -> Result<bool, PlanFailure> {
        let sight = stage.sight().clone();
        let Some(object) = sight.objects.get(id) else {
            return Ok(false);
        };
        let all: Vec<_> = (0..self.body.limbs.len()).collect();
        let kept = self.kept(&sight, i);
        let spots = free_spots(
            self.body,
            &sight,
            id,
            object.pose.rotation,
            near,
            &all,
            &kept,
        );
        // The orientations in which it may be grasped there.
        let turned = |pose: Pose| {
            [0.0_f32, 0.8, -0.8, 1.6].map(|turn| {
                let rotation = Quat::from_rotation_z(turn) * pose.rotation;
                Candidate::new(Pose::new(pose.location, rotation), turn.abs() * 0.2)
            })
        };
        let spots: Vec<_> = spots.into_iter().flat_map(turned).collect();
        if spots.is_empty() {
            return Ok(false);
        }
        self.by_some_limb_from(stage, GraspSide::Above, id, near, |transfer, stage| {
            transfer.carry_out(stage, &spots)
        })?;
        Ok(true)
    }

    /// Puts an object down, on another side if need be, so that a limb can then take it as its goals ask for. Returns false if there is no such
    /// place.
    pub(super) fn put_for_tipping(
        &self,
        stage: &mut dyn PlanningStage,
        id: &str,
        near: Vec3,
        goals: &[Candidate],
        i: usize,
    ) -> Result<bool, PlanFailure> {
        let sight = stage.sight().clone();
        let Some(place) = self.turning_place(&sight, id, near, goals, i) else {
            return Ok(false);
        };
        self.by_some_limb_from(stage, GraspSide::Any, id, near, |transfer, stage| {
            transfer.carry_out(stage, &[place])
        })?;
        Ok(true)
    }

    /// A place that an object can be brought to, and from which it can be brought to its goals.
    fn turning_place(
        &self,
        sight: &Sight,
        id: &str,
        near: Vec3,
        goals: &[Candidate],
        i: usize,
    ) -> Option<Candidate> {
        let object = sight.objects.get(id)?;
        let kept = self.kept(sight, i);
        let limbs = || 0..self.body.limbs.len();
        let mut spots = Vec::new();
        for rotation in different_turns(object) {
            for limb in limbs() {
                let free = free_spots(self.body, sight, id, rotation, near, &[limb], &kept);
                spots.push((limb, free));
            }
        }
        let mut places = SPOTS.iter().flat_map(|&number| {
            spots.iter().filter_map(move |(limb, spots)| {
                let place = Candidate {
                    pose: *spots.get(number)?,
                    cost: 0.0,
                    placement: Placement::Tipped,
                };
                Some((*limb, place))
            })
        });
        let found = places.find(|(limb, place)| {
            let mut there = sight.clone();
            if let Some(object) = there.objects.get_mut(id) {
                object.pose = place.pose;
            }
            let transfer = |limb| self.transfer(limb, id, GraspSide::Any);
            transfer(*limb).is_possible(&there, goals)
                && limbs().any(|limb| transfer(limb).is_possible(sight, &[*place]))
        });
        found.map(|(_, place)| place)
    }

    /// A limb's transfer of an object.
    pub(super) fn transfer<'a>(
        &'a self,
        limb: usize,
        id: &'a str,
        side: GraspSide,
    ) -> Transfer<'a> {
        Transfer {
            body: self.body,
            limb,
            object: id,
            load: self.load_of(id),
            side,
            seed: self.seed,
        }
    }
}

/// Orientations in which an object lies on one of its sides and looks different: those on its present side first.
fn different_turns(object: &SeenObject) -> Vec<Quat> {
    let symmetry = Symmetry::of(&object.shape);
    let looks_like = |a: Quat, b: Quat| {
        let [a, b] = [a, b].map(|rotation| Pose::new(Vec3::ZERO, rotation));
        symmetry.difference(a, b).1 < 0.1
    };
    let own = std::iter::once(object.pose.rotation);
    let sides = own.chain(sides(&object.shape));
    let mut found = Vec::<Quat>::new();
    for side in sides {
        for eighth in 0..8_u16 {
            let rotation = Quat::from_rotation_z(FRAC_PI_4 * f32::from(eighth)) * side;
            if !found.iter().any(|known| looks_like(*known, rotation)) {
                found.push(rotation);
            }
        }
    }
    found
}
