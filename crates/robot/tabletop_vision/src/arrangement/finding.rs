//! Finding: the placements of objects that may be anywhere, one after the other, best explained first.

use super::{HIGHEST, LEAST_SCORE, ObjectArrangement};
use crate::{
    guess::{Guess, PoseCandidate},
    known::StandingPose,
    residual::{OUTLIER, loss},
    support,
};

impl<'a, 'p> ObjectArrangement<'a, 'p> {
    /// Finds all objects without a placement, the one that explains most of its pixels first.
    pub(super) fn find_all(&mut self, chance: &mut impl FnMut() -> f32) {
        for object in 0..self.objects.len() {
            if self.placements[object].is_some() {
                self.place_guided(object);
            }
        }
        let mut candidates: Vec<Option<Option<PoseCandidate>>> = vec![None; self.objects.len()];
        while let Some((object, placement)) = self.next_found(&mut candidates, chance) {
            self.place(object, Some(placement));
            self.place_guided(object);
            let window = self.windows[object].clone().unwrap_or_default();
            let wide = window.widened(4, self.residual.size());
            for (i, candidate) in candidates.iter_mut().enumerate() {
                let is_stale = candidate.as_ref().is_some_and(|candidate| {
                    self.colors[i] == self.colors[object]
                        || candidate.as_ref().is_none_or(|candidate| {
                            !candidate.window.intersection(&wide).is_empty()
                        })
                });
                if is_stale {
                    *candidate = None;
                }
            }
        }
    }

    /// The object to be placed next: the first one that is well explained, beginning with those of which most is seen; else the best.
    fn next_found(
        &mut self,
        candidates: &mut [Option<Option<PoseCandidate>>],
        chance: &mut impl FnMut() -> f32,
    ) -> Option<(usize, StandingPose)> {
        let open = (0..self.objects.len()).filter(|&i| {
            // Of objects that look the same, the first one is looked for.
            let is_alike = |j: usize| self.objects[j].looks_like(&self.objects[i]);
            self.placements[i].is_none()
                && self.objects[i].guide().is_none()
                && !(0..i).any(|j| self.placements[j].is_none() && is_alike(j))
        });
        let open: Vec<_> = open.collect();
        let mut order: Vec<_> = open
            .into_iter()
            .filter_map(|i| Some((i, self.guess(i)?.promise() * chance())))
            .collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut best: Option<(usize, StandingPose, f32)> = None;
        for (i, _) in order {
            if candidates[i].is_none() {
                candidates[i] = Some(self.guess(i).and_then(|mut guess| guess.best()));
            }
            let Some(candidate) = candidates[i].as_ref().and_then(Option::as_ref) else {
                continue;
            };
            if candidate.score > self.enough {
                return Some((i, candidate.placement));
            }
            let score = candidate.score * chance();
            if score > LEAST_SCORE && best.is_none_or(|best| score > best.2) {
                best = Some((i, candidate.placement, score));
            }
        }
        best.map(|(object, placement, _)| (object, placement))
    }

    /// The search for an object among those that are placed; `None` if no pixel may show it.
    pub(super) fn guess(&mut self, object: usize) -> Option<Guess<'_, 'a, 'p>> {
        let blobs = self.open_blobs(object).into_iter().map(|blob| {
            let losses = blob.pixels.iter().map(|&i| loss(self.squares[i], OUTLIER));
            let open = losses.sum();
            (blob, open)
        });
        let blobs: Vec<_> = blobs.collect();
        if blobs.is_empty() {
            return None;
        }
        let others = (0..self.objects.len()).filter(|&i| i != object);
        let placed = others.clone().filter_map(|i| {
            let (placement, window) = (self.placements[i]?, self.windows[i].clone()?);
            let mut solids = Vec::new();
            self.objects[i].draw(&placement, i as u32 + 1, &mut solids);
            Some((window, solids))
        });
        let taken = others.clone().filter_map(|i| {
            let placement = self.placements[i]?;
            Some(self.objects[i].touched(&placement))
        });
        let taken = taken.flatten();
        let known = &self.objects[object];
        let own_seats = known.seats();
        let neighbours = others.clone().filter_map(|i| {
            let placement = self.placements[i]?;
            let foot = placement.location.z + self.objects[i].stance(&placement).low;
            let above = self.objects[i].seats().into_iter().map(|seat| foot + seat);
            let below = own_seats.iter().map(|seat| foot - seat);
            let heights = above.chain(below).filter(|height| *height > -0.05);
            Some((placement, heights.map(|height| height.max(0.0)).collect()))
        });
        Some(Guess {
            enough: self.enough,
            may_hover: self.is_following && !known.is_fixed(),
            others: placed.collect(),
            neighbours: match known.is_fixed() {
                true => Vec::new(),
                false => neighbours.collect(),
            },
            taken: taken.collect(),
            heights: match known.is_fixed() {
                true => vec![0.0],
                false => support::pile_heights(others.map(|i| &self.objects[i]), HIGHEST),
            },
            residual: &mut self.residual,
            object: known,
            blobs,
        })
    }
}
