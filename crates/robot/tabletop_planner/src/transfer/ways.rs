//! The ways of a transfer: to the object, up with it, across, and down.

use bevy::math::{Quat, Vec3};
use tabletop_controller::{Angles, SeenObject, Sight};
use tabletop_geometry::{PlacedSolid, Pose};

use super::{BESIDE, Transfer, choice::Taking};
use crate::{
    clearance::{Clearance, Margins},
    goals::{Candidate, Placement},
    path::{Path, lift, withdraw},
    sight::{Solids as _, heights},
    transit::{WaySearch, transit},
};

/// Openings of the fingers for a release, in units beyond the held width. The first that has room is used.
const RELEASES: [f32; 5] = [0.35, 0.22, 0.14, 0.08, 0.05];
/// Distances by which an arm withdraws from a released object, in units, and for a small hand in hand sizes: rather more than less.
const BACK: [f32; 3] = [1.4, 1.0, 0.6];

/// A feasible way to put the held object down.
pub(super) struct Placing {
    /// Path to above the place.
    pub way: Path,
    pub down: Path,
    /// Opening of the fingers there, in units.
    pub opening: f32,
}

impl Transfer<'_> {
    /// Paths to where the object is taken from, and to it.
    pub(super) fn approach(
        &self,
        sight: &Sight,
        taking: &Taking,
        search: WaySearch,
    ) -> Option<[Path; 2]> {
        let object = self.seen(sight).ok()?;
        let near = self.taking(sight, object).opened(taking.opening);
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

    /// Rotation from the object, which the arm takes at these angles, to the end effector's frame; `None` if it may lean on its way.
    pub(super) fn upright(&self, at: &Angles, placement: Placement) -> Option<Quat> {
        match placement {
            Placement::Upright => Some(self.body.end_effector(self.limb, at).rotation.inverse()),
            Placement::Tipped | Placement::Dropped => None,
        }
    }

    /// The clearance of the arm that takes the object, or has let it go.
    pub(super) fn taking(&self, sight: &Sight, object: &SeenObject) -> Clearance<'_> {
        Clearance::new(self.body, sight, self.limb, &[self.object]).taking(object.solids())
    }

    /// The clearance of the arm that holds the object like this, with fingers at this opening.
    pub(super) fn holding(
        &self,
        sight: &Sight,
        object: &SeenObject,
        grip: Pose,
        opening: f32,
        upright: Option<Quat>,
    ) -> Clearance<'_> {
        let mut solids = object.solids_at(Pose::IDENTITY);
        solids.extend(self.load_at(sight, Pose::IDENTITY));
        let holding = Clearance::new(self.body, sight, self.limb, &self.moved())
            .holding(&solids, grip, upright)
            .opened(opening);
        match self.load.is_empty() {
            true => holding,
            false => holding.loaded(),
        }
    }

    /// The path up with the held object, until it is above everything around it.
    pub(super) fn lifted(
        &self,
        holding: &Clearance,
        sight: &Sight,
        from: &Angles,
        at: Pose,
    ) -> Option<Path> {
        let by = self.height(sight, at);
        self.heights_to_try(by).into_iter().find_map(|by| {
            let up = lift(holding, from, by)?;
            // At the beginning, the held object touches its support.
            holding
                .is_way_free(&up[1.min(up.len() - 1)..], Margins::NARROW)
                .then_some(up)
        })
    }

    /// Heights to which an object may be lifted, if this one passes over everything.
    fn heights_to_try(&self, by: f32) -> [f32; 3] {
        let hand = self.body.hand_size().min(1.0);
        [by, by + 0.5 * hand, (by - 0.4 * hand).max(0.3 * hand)]
    }

    /// Height, in units, to which an object must be lifted to pass over everything around this place of it.
    fn height(&self, sight: &Sight, at: Pose) -> f32 {
        let Some(object) = sight.objects.get(self.object) else {
            return 0.5;
        };
        let solids = object.solids_at(at);
        let [lowest, _] = heights(&solids);
        let others = sight.objects.iter().filter(|(id, _)| !self.moves(id));
        let near = others
            .flat_map(|(_, other)| other.solids())
            .filter(|other| {
                let is_near = |solid: &PlacedSolid| solid.gap_from_above(other) < 0.12;
                let is_within = (other.pose.location - at.location).truncate().length() < 0.3;
                is_within || solids.iter().any(is_near)
            });
        let hand = self.body.hand_size().min(1.0);
        let tops = near.map(|other| other.heights()[1] - lowest);
        tops.filter(|top| *top > 0.03)
            .fold(0.4 * hand, |by, top| by.max(top + 0.2 * hand))
    }

    /// Paths from where the object is lifted to above a goal, and down to these angles of the arm.
    pub(super) fn placing(
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
        let there = self.seen(sight).ok()?.solids_at(goal.pose);
        let released = Clearance::new(self.body, sight, self.limb, &self.moved())
            .taking(there)
            .beside(self.load_at(sight, goal.pose));
        let opening = self.release(released, put, holding.opening)?;
        let by = self.height(sight, goal.pose);
        self.heights_to_try(by).into_iter().find_map(|by| {
            let up = lift(holding, put, by)?;
            if !holding.is_way_free(&up, Margins::NARROW) {
                return None;
            }
            let way = transit(holding, lifted.last()?, up.last()?, search)?;
            let down = up.iter().rev().skip(1).chain([put]).copied().collect();
            Some(Placing { way, down, opening })
        })
    }

    /// Opening of the fingers, in units, at which the arm can let go of a part of this width and withdraw.
    pub(super) fn release(&self, released: Clearance, at: &Angles, width: f32) -> Option<f32> {
        let end = released.end_effector(at);
        let widest = self.body.limbs[self.limb].widest;
        let openings = RELEASES.map(|more| (width + more).min(widest));
        let opening = openings
            .into_iter()
            .find(|opening| released.has_room_for_fingers(end, *opening, BESIDE))?;
        back(&released.opened(opening), at).map(|_| opening)
    }
}

/// The way back from an object that has been let go, to where the arm is free to go on.
fn back(released: &Clearance, from: &Angles) -> Option<Path> {
    distances_back(released).find_map(|by| {
        let back = withdraw(released, from, by)?;
        let is_free = released.is_way_free(&back, Margins::BARE)
            && released.is_free(back.last()?, Margins::TIGHT);
        is_free.then_some(back)
    })
}

fn distances_back(released: &Clearance) -> impl Iterator<Item = f32> + use<> {
    let hand = released.hand_size();
    let small = BACK.into_iter().filter(move |_| hand < 1.0);
    BACK.into_iter().chain(small.map(move |by| by * hand))
}

/// The same, or without a free one any way that the arm can go.
pub(super) fn back_or_out(released: &Clearance, from: &Angles) -> Option<Path> {
    let any = || distances_back(released).find_map(|by| withdraw(released, from, by));
    back(released, from).or_else(any)
}
