//! Settling: the placements of objects, refined together.

use tabletop_geometry::Pose;

use super::{HIGHEST, ObjectArrangement};
use crate::{
    known::StandingPose,
    refine::{FINE, Refinement, RefinementStage},
    residual::OUTLIER,
    support::{self, DEEP, has_room},
};

/// The distance of an object from its support, in units, in which no picture tells whether it touches.
const TOUCHING: f32 = 0.03;
/// How far from its best place least squares may leave an object, in units.
const UNPOLISHED: f32 = 0.02;

impl ObjectArrangement<'_, '_> {
    /// Refines an object among the others: along its guide, on what it stands on, or in the air. What it guides moves with it. Returns by how much, in
    /// units, it moved.
    pub(super) fn settle(
        &mut self,
        object: usize,
        stages: &[RefinementStage],
        is_last: bool,
    ) -> f32 {
        let Some(before) = self.placements[object] else {
            return 0.0;
        };
        if self.is_anchored[object] {
            return 0.0;
        }
        if self.objects[object].guide().is_some() {
            let Some((settled, _)) = self.along_guide(object) else {
                return 0.0;
            };
            self.place(object, Some(settled));
            return settled.location.distance(before.location);
        }
        let parts = self.parts(object);
        self.settle_among(object, before, &parts, stages, is_last);
        if !parts.is_empty() {
            // It may also have moved from under what it guides, which a joint rather than the picture moves with it.
            self.settle_parts(&parts);
            let together = self.remember();
            let here = self.placements[object].unwrap_or(before);
            self.settle_among(object, here, &[], stages, is_last);
            self.settle_parts(&parts);
            if self.loss() > together.loss {
                self.restore(&together);
            }
        }
        let settled = self.placements[object].unwrap_or(before);
        settled.location.distance(before.location) + (settled.yaw - before.yaw).abs()
    }

    fn settle_parts(&mut self, parts: &[(usize, Pose)]) {
        for &(part, _) in parts {
            if let Some((settled, _)) = self.along_guide(part) {
                self.place(part, Some(settled));
            }
        }
    }

    /// Refines an object without a guide, together with parts that move with it.
    fn settle_among(
        &mut self,
        object: usize,
        before: StandingPose,
        parts: &[(usize, Pose)],
        stages: &[RefinementStage],
        is_last: bool,
    ) {
        let with_parts = self.objects[object].carrying(
            &before,
            parts.iter().map(|&(i, pose)| (&self.objects[i], pose)),
        );
        let known = match parts.is_empty() {
            true => &self.objects[object],
            false => &with_parts,
        };
        let mut own = Vec::new();
        known.draw(&before, 1, &mut own);
        let Some(window) = self.residual.window_of(&own) else {
            return;
        };
        let is_own = |i: usize| i == object || parts.iter().any(|(part, _)| *part == i);
        self.keep_all_but(is_own, &window.widened(7, self.residual.size()));
        let eye = self.residual.eye();
        let good = self.good();
        let mut refinement = Refinement {
            residual: &mut self.residual,
            object: known,
            is_free: !known.is_fixed(),
        };
        let others = (self.objects.iter().zip(&self.placements).enumerate())
            .filter(|(i, _)| !is_own(*i))
            .filter_map(|(_, (other, placement))| Some((other, placement.as_ref()?)));
        refinement.is_free = false;
        let (mut settled, trial) = refinement.refined(before, stages);
        let stands = support::stands(known, &settled, others.clone());
        // What is movable and in the way may be in the wrong place, until the end.
        let taken: Vec<_> = others
            .clone()
            .filter(|(other, _)| is_last || other.is_fixed())
            .flat_map(|(other, placement)| other.touched(placement))
            .collect();
        let deep = if is_last { TOUCHING } else { DEEP };
        let has_room = |placement: &StandingPose| has_room(known, placement, &taken, deep);
        let is_good = stands && trial.misfit <= good * trial.pixels as f32 && has_room(&settled);
        if !known.is_fixed() && !is_good {
            let here = settled;
            refinement.is_free = true;
            let (mut free, mut free_trial) = refinement.refined(here, &FINE);
            refinement.is_free = false;
            let table = -known.stance(&free).low;
            if free.location.z < table {
                // Where the table would hide it.
                (free, free_trial) = refinement.refined(free.at_height(table, eye), &FINE);
            }
            // What is not seen may be hidden between it and a support.
            let unseen = self.objects.iter().zip(&self.placements).enumerate();
            let unseen = unseen.filter(|(i, (_, placement))| placement.is_none() && !is_own(*i));
            let hidden = support::pile_heights(unseen.map(|(_, (other, _))| other), HIGHEST);
            let supports = support::heights(known, &free, others);
            let mut heights = support::heights_over(&supports, &hidden);
            heights.sort_by(|a, b| {
                let [a, b] = [a, b].map(|height| (height - free.location.z).abs());
                a.total_cmp(&b)
            });
            let near = heights.into_iter().take(3);
            let standing =
                near.map(|height| refinement.refined(free.at_height(height, eye), &FINE));
            let standing = standing.filter(|(placement, _)| has_room(placement));
            let best = standing.min_by(|a, b| a.1.gain.total_cmp(&b.1.gain));
            // What it stands on may not be in its place yet.
            let (hovering, gain) = match !is_last
                && trial.gain < free_trial.gain + self.allowance * trial.gain.abs()
            {
                true => (here, trial.gain),
                false => (free, free_trial.gain),
            };
            let allowance = self.allowance * gain.abs() + 20.0 * self.noise.max(1.0);
            // Least squares may have stopped before the best place on a support, and only that tells whether the object hovers.
            let best = best.map(
                |(placement, standing)| match standing.gain <= gain + allowance {
                    true => (placement, standing),
                    false => refinement.polished(placement, UNPOLISHED),
                },
            );
            settled = match best {
                Some((placement, standing))
                    if standing.gain <= gain + allowance
                        || !has_room(&hovering)
                        || (placement.location.z - free.location.z).abs() < TOUCHING =>
                {
                    placement
                }
                _ => {
                    refinement.is_free = true;
                    hovering
                }
            };
        }
        if is_last {
            let trial = refinement.try_at(&settled, OUTLIER);
            let is_good = trial.misfit <= good * trial.pixels as f32;
            if !is_good {
                settled = refinement.shaken(settled).0;
            }
            settled = refinement.polished(settled, 0.004).0;
        }
        self.place(object, Some(settled));
        let motion = known.pose(&settled) * known.pose(&before).inverse();
        for &(part, pose) in parts {
            let moved = self.objects[part].placement(motion * pose);
            self.place(part, Some(moved));
        }
    }

    /// Settles all objects, in turn.
    pub(super) fn settle_all(&mut self, rounds: usize, is_end: bool) {
        let mut has_moved = vec![true; self.objects.len()];
        for round in 0..rounds {
            let is_last = is_end && round + 1 == rounds;
            // What stands on others comes after them.
            let mut order: Vec<_> = (0..self.objects.len()).collect();
            let lowest = |i: usize| {
                let placement = self.placements[i]?;
                Some(placement.location.z + self.objects[i].stance(&placement).low)
            };
            let height = |i: usize| lowest(i).unwrap_or(f32::INFINITY);
            order.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
            for i in order {
                let is_touched = (0..self.objects.len()).any(|j| {
                    let near = self.windows[i].as_ref().zip(self.windows[j].as_ref());
                    has_moved[j]
                        && near.is_some_and(|(own, other)| !own.intersection(other).is_empty())
                });
                if is_touched || is_last {
                    let stages = match (is_end, round) {
                        (false, _) => &FINE[..1],
                        (true, 0) => &FINE[..],
                        (true, _) => &FINE[1..],
                    };
                    has_moved[i] = self.settle(i, stages, is_last) > 1e-3;
                }
            }
        }
    }
}
