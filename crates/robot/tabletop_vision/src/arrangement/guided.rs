//! Guided objects: where a joint lets them be.

use tabletop_geometry::Pose;

use super::ObjectArrangement;
use crate::{
    known::StandingPose,
    refine::Refinement,
    residual::{OUTLIER, TriedFit},
};

/// Distance, in units, of the displacements that are tried first, the number of those that are refined, and the least step of that.
const STEP: f32 = 0.2;
const REFINED: usize = 3;
const LEAST_STEP: f32 = 0.000_4;

impl ObjectArrangement<'_, '_> {
    /// The objects that move with one since it guides them, or what guides them, and their poses.
    pub(super) fn parts(&self, object: usize) -> Vec<(usize, Pose)> {
        let is_guided = |part: usize| {
            let by = |i: &usize| self.objects[*i].guide().map(|guide| guide.by);
            let guides = std::iter::successors(by(&part), by);
            guides.take(self.objects.len()).any(|it| it == object)
        };
        let parts = (0..self.objects.len()).filter(|&i| i != object && is_guided(i));
        let placed = parts.filter_map(|i| Some((i, self.objects[i].pose(&self.placements[i]?))));
        placed.collect()
    }

    /// Places what an object guides: it must be somewhere along its guide.
    pub(super) fn place_guided(&mut self, object: usize) {
        for part in 0..self.objects.len() {
            let by = self.objects[part].guide().map(|guide| guide.by);
            if by == Some(object) && self.placements[part].is_none() {
                let placement = self.along_guide(part).map(|(placement, _)| placement);
                self.place(part, placement);
                self.place_guided(part);
            }
        }
    }

    /// The best placement of an object that its guide allows.
    pub(super) fn along_guide(&mut self, object: usize) -> Option<(StandingPose, TriedFit)> {
        let known = &self.objects[object];
        let guide = known.guide()?;
        let other = self.objects[guide.by].pose(&self.placements[guide.by]?);
        let at = |displacement: f32| known.placement(guide.pose(other, displacement));
        let by_length = |length: f32| guide.by_length(length, known.stances()[0].radius);
        let first = guide.displacements(by_length(STEP));
        let windows = first.filter_map(|it| self.window_at(object, &at(it)));
        let around = windows.reduce(|one, other| one.joined(&other))?;
        self.keep_others(object, &around.widened(1, self.residual.size()));
        let mut refinement = Refinement {
            residual: &mut self.residual,
            object: known,
            is_free: false,
        };
        let mut fit = |displacement: f32| refinement.try_at(&at(displacement), OUTLIER);
        let first = guide.displacements(by_length(STEP));
        let mut tried: Vec<_> = first.map(|it| (it, fit(it))).collect();
        tried.sort_by(|a, b| a.1.gain.total_cmp(&b.1.gain));
        tried.truncate(REFINED);
        for (displacement, best) in &mut tried {
            let mut step = by_length(STEP / 2.0);
            while step > by_length(LEAST_STEP) {
                let sides = [step, -step].map(|by| guide.within(*displacement + by));
                let tried = sides.map(|next| (next, fit(next)));
                let better = tried.into_iter().find(|(_, next)| next.gain < best.gain);
                match better {
                    Some(better) => (*displacement, *best) = better,
                    None => step *= 0.5,
                }
            }
        }
        let best = tried.into_iter();
        let best = best.min_by(|a, b| a.1.gain.total_cmp(&b.1.gain))?;
        Some((at(best.0), best.1))
    }
}
