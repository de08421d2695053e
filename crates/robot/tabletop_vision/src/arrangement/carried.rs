//! Carried along: what stood on or in something that has moved, and moves with it, even if nothing shows it any more.

use super::{BETTER, ObjectArrangement};
use crate::{known::StandingPose, support};

/// The distance from its support, in units, at which an object stands on it.
const STANDING: f32 = 0.05;

impl ObjectArrangement<'_, '_> {
    /// Moves what stood on or in something that has moved since the last picture with it, where that explains the picture as well.
    pub(super) fn carry_along(&mut self, before: &[Option<StandingPose>]) {
        let height = |i: usize| before[i].map_or(f32::INFINITY, |was| was.location.z);
        let mut order: Vec<_> = (0..self.objects.len()).collect();
        order.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
        for object in order {
            if let Some(carried) = self.carried(object, before) {
                let here = self.remember();
                self.place(object, Some(carried));
                if self.loss() > here.loss + BETTER {
                    self.restore(&here);
                }
            }
        }
    }

    /// Where an object is if it has moved with what it stood on or in.
    fn carried(&self, object: usize, before: &[Option<StandingPose>]) -> Option<StandingPose> {
        let known = &self.objects[object];
        if known.is_fixed() || known.guide().is_some() {
            return None;
        }
        let was = before[object]?;
        let carrier = (0..self.objects.len()).find(|&other| {
            let stood = || {
                let other_was = before[other].as_ref();
                let other_was = other_was.map(|at| (&self.objects[other], at));
                let table = -known.stance(&was).low;
                let heights = support::heights(known, &was, other_was);
                let mut seats = heights.iter().filter(|height| **height > table);
                seats.any(|height| (height - was.location.z).abs() < STANDING)
            };
            other != object
                && before[other].is_some()
                && self.placements[other].is_some()
                && before[other] != self.placements[other]
                && stood()
        })?;
        let other = &self.objects[carrier];
        let [from, to] = [before[carrier]?, self.placements[carrier]?].map(|at| other.pose(&at));
        Some(known.placement(to * from.inverse() * known.pose(&was)))
    }
}
