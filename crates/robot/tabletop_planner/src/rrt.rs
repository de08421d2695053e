//! Random search for a path: two trees that grow towards each other (Kuffner and LaValle: RRT-Connect, 2000).

use tabletop_controller::Angles;
use tabletop_core::Random;

use crate::{
    clearance::{Clearance, Margins},
    path::{Path, even, largest_turn},
};

/// Number of times that a tree grows.
const TRIES: u32 = 60;
/// Length of a branch, in rad of its fastest joint.
const BRANCH: f64 = 0.5;
/// Number of tries to shorten a path.
const SHORTCUTS: u32 = 40;

struct Tree(Vec<(Angles, usize)>);

impl Tree {
    fn nearest(&self, to: &Angles) -> usize {
        let distance = |angles: &Angles| -> f64 {
            angles.iter().zip(to).map(|(a, b)| (a - b) * (a - b)).sum()
        };
        let all = self.0.iter().enumerate();
        let nearest = all.min_by(|a, b| distance(&a.1.0).total_cmp(&distance(&b.1.0)));
        nearest.map_or(0, |(i, _)| i)
    }

    /// Grows towards a posture, by one branch or as far as it is free. Returns the last branch, and whether it has arrived.
    fn grow(
        &mut self,
        clearance: &Clearance,
        to: &Angles,
        margins: Margins,
        all_the_way: bool,
    ) -> (usize, bool) {
        let mut at = self.nearest(to);
        loop {
            let from = self.0[at].0;
            let way = largest_turn(&from, to);
            if way < 1e-9 {
                return (at, true);
            }
            let part = (BRANCH / way).min(1.0);
            let next: Angles = std::array::from_fn(|i| from[i] + (to[i] - from[i]) * part);
            if !clearance.is_way_free(&even(&from, &next), margins) {
                return (at, false);
            }
            self.0.push((next, at));
            at = self.0.len() - 1;
            if part >= 1.0 {
                return (at, true);
            }
            if !all_the_way {
                return (at, false);
            }
        }
    }

    fn way_from_root(&self, mut at: usize) -> Vec<Angles> {
        let mut way = vec![self.0[at].0];
        while at != 0 {
            at = self.0[at].1;
            way.push(self.0[at].0);
        }
        way.reverse();
        way
    }
}

/// A free path from one posture to another, if one is found.
pub(crate) fn connect(
    clearance: &Clearance,
    from: &Angles,
    to: &Angles,
    margins: Margins,
    seed: u64,
) -> Option<Path> {
    let mut random = Random::new(seed);
    let mut trees = [from, to].map(|root| Tree(vec![(*root, 0)]));
    let limits = clearance.body.limbs[clearance.limb].limits();
    for turn in 0..TRIES {
        let sample: Angles = std::array::from_fn(|i| {
            let [least, most] = limits.get(i).copied().unwrap_or_default();
            let share = f64::from(random.between((0.0, 1.0)));
            match turn % 3 {
                0 => least + (most - least) * share,
                // Random angles around the middle of the path.
                _ => (f64::midpoint(from[i], to[i]) + 2.4 * (share - 0.5)).clamp(least, most),
            }
        });
        let (growing, other) = if turn % 2 == 0 { (0, 1) } else { (1, 0) };
        let (tip, _) = trees[growing].grow(clearance, &sample, margins, false);
        let reached = trees[growing].0[tip].0;
        let (meeting, met) = trees[other].grow(clearance, &reached, margins, true);
        if met {
            let tips = if growing == 0 {
                [tip, meeting]
            } else {
                [meeting, tip]
            };
            let mut way = trees[0].way_from_root(tips[0]);
            way.extend(trees[1].way_from_root(tips[1]).into_iter().rev().skip(1));
            return Some(shortened(clearance, way, margins, &mut random));
        }
    }
    None
}

fn shortened(
    clearance: &Clearance,
    mut way: Vec<Angles>,
    margins: Margins,
    random: &mut Random,
) -> Path {
    for _ in 0..SHORTCUTS {
        if way.len() < 3 {
            break;
        }
        let mut pick = || (random.bits() % way.len() as u64) as usize;
        let (a, b) = (pick(), pick());
        let (a, b) = (a.min(b), a.max(b));
        if b - a > 1 && clearance.is_way_free(&even(&way[a], &way[b]), margins) {
            way.drain(a + 1..b);
        }
    }
    way.windows(2)
        .flat_map(|pair| even(&pair[0], &pair[1]))
        .collect()
}
