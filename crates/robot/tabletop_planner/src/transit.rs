//! Collision-free paths of an arm.

use tabletop_controller::Angles;
use tabletop_geometry::Pose;

use crate::{
    clearance::{Clearance, Margins},
    path::{Path, even, largest_turn, lift, line},
    rrt::connect,
};

/// Heights at which an arm crosses the table, in units and hand sizes; and those in units, for a small robot among large things.
const TRAVERSES: [f32; 4] = [2.6, 3.4, 4.2, 5.0];

/// The search for a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WaySearch {
    /// Even turns of the joints, or a crossing at some height.
    Simple,
    /// These first, then random search with this seed.
    Trying(u64),
}

/// A free path from one posture to another.
pub(crate) fn transit(
    clearance: &Clearance,
    from: &Angles,
    to: &Angles,
    search: WaySearch,
) -> Option<Path> {
    let ends_are_free = |margins| {
        [from, to]
            .into_iter()
            .all(|end| clearance.is_free(end, margins))
    };
    let margins = [Margins::WIDE, Margins::TIGHT, Margins::LEAVING]
        .into_iter()
        .find(|margins| ends_are_free(*margins))?;
    simple(clearance, from, to, margins).or_else(|| match search {
        WaySearch::Simple => None,
        WaySearch::Trying(seed) => connect(clearance, from, to, margins, seed),
    })
}

fn simple(clearance: &Clearance, from: &Angles, to: &Angles, margins: Margins) -> Option<Path> {
    let is_free = |path: &Path| clearance.is_way_free(path, margins);
    let direct = even(from, to);
    if is_free(&direct) {
        return Some(direct);
    }
    let ends = [from, to].map(|angles| clearance.end_effector(angles));
    let hand = clearance.hand_size();
    let scaled = TRAVERSES.map(|height| height * hand);
    let unscaled = TRAVERSES.into_iter().filter(|_| hand < 1.0);
    for height in scaled.into_iter().chain(unscaled) {
        let raised = |angles: &Angles, end: &Pose| match end.location.z > height - 0.05 {
            true => Some(Path::new()),
            false => lift(clearance, angles, height - end.location.z),
        };
        let (Some(up), Some(down)) = (raised(from, &ends[0]), raised(to, &ends[1])) else {
            continue;
        };
        let [above, beyond] =
            [(&up, from), (&down, to)].map(|(path, end)| *path.last().unwrap_or(end));
        let descent: Path = match down.is_empty() {
            true => Path::new(),
            false => down.iter().rev().skip(1).chain([to]).copied().collect(),
        };
        let join = |across: Path| [up.clone(), across, descent.clone()].concat();
        let path = join(even(&above, &beyond));
        if is_free(&path) {
            return Some(path);
        }
        let far = clearance.end_effector(&beyond);
        if let Some(mut across) = line(clearance, &above, far) {
            let last = *across.last().unwrap_or(&above);
            if largest_turn(&last, &beyond) < 1.5 {
                across.extend(even(&last, &beyond));
                let path = join(across);
                if is_free(&path) {
                    return Some(path);
                }
            }
        }
    }
    None
}
