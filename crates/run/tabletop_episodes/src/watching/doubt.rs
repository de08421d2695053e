//! Doubts: when a watcher is not sure of an object.

use tabletop_core::SimTick;
use tabletop_geometry::Pose;

/// A time in which a watcher is not sure of an object, so that what it tells of it may be wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Doubt {
    /// Id of the object.
    pub object: String,
    /// The tick of the first picture in which it was not sure.
    pub from: SimTick,
    /// The tick of the picture in which it was sure again, or of the last picture.
    pub to: SimTick,
    /// True if it was never sure.
    pub is_never_seen: bool,
}

/// How certain an object is in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Certainty {
    /// It is surely seen here; moved from where it was surely seen before, or there.
    Sure { pose: Pose, has_moved: bool },
    /// The picture is as it would be with the object where it was surely seen before, whatever hides it now.
    Explained,
    /// It may be anywhere; most likely here.
    Unsure(Option<Pose>),
}

/// Number of ticks that an act takes at least: what a hand puts down lies still for 45 (as in `tabletop_task`), and takes a picture each to come and to go. A shorter
/// time hides none.
const LEAST_ACT: u64 = 75;

/// The distance, in units, within which two places are the same.
const SAME_PLACE: f32 = 0.1;

/// The doubts about an object, from how certain it was in each picture.
///
/// Where it was surely seen before and after, at the same place, it was there in between as well, as far as that matters.
pub(super) fn doubts(object: &str, certainties: &[(SimTick, Certainty)]) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    let mut since: Option<SimTick> = None;
    // Where it may have been since then.
    let mut places: Vec<Option<Pose>> = Vec::new();
    let mut was_seen = false;
    let doubt = |from: SimTick, to: SimTick, was_seen: bool| Doubt {
        object: object.to_owned(),
        from,
        to,
        is_never_seen: !was_seen,
    };
    for &(tick, certainty) in certainties {
        match certainty {
            Certainty::Unsure(place) => {
                since.get_or_insert(tick);
                places.push(place);
            }
            Certainty::Sure { pose, has_moved } => {
                let is_there = |place: &Option<Pose>| {
                    place.is_some_and(|at| at.location.distance(pose.location) < SAME_PLACE)
                };
                let is_long = |from: SimTick| !was_seen || tick.0 - from.0 >= LEAST_ACT;
                let was_elsewhere = has_moved && !places.iter().all(is_there);
                let from = since.take().filter(|from| was_elsewhere && is_long(*from));
                places.clear();
                was_seen = true;
                doubts.extend(from.map(|from| doubt(from, tick, true)));
            }
            Certainty::Explained => {
                since = None;
                places.clear();
            }
        }
    }
    let last = certainties.last().map(|(tick, _)| *tick);
    let open = since.zip(last);
    doubts.extend(open.map(|(from, last)| doubt(from, last, was_seen)));
    doubts
}

#[cfg(test)]
mod tests {
    use super::*;

    const THERE: Certainty = Certainty::Sure {
        pose: Pose::IDENTITY,
        has_moved: false,
    };
    const MOVED: Certainty = Certainty::Sure {
        pose: Pose::IDENTITY,
        has_moved: true,
    };
    const UNSURE: Certainty = Certainty::Unsure(None);
    const PERHAPS_THERE: Certainty = Certainty::Unsure(Some(Pose::IDENTITY));

    /// The doubts about an object, from how certain it is in one picture after the other, four a second: from when to when, and whether it was never seen.
    fn found(certainties: &[Certainty]) -> Vec<(u64, u64, bool)> {
        let ticks = (0..).step_by(15).map(SimTick);
        let certainties: Vec<_> = ticks.zip(certainties.iter().copied()).collect();
        let doubts = doubts("it", &certainties).into_iter();
        doubts
            .map(|doubt| (doubt.from.0, doubt.to.0, doubt.is_never_seen))
            .collect()
    }

    #[test]
    fn what_stands_where_it_stood_was_there_in_between() {
        assert_eq!(found(&[MOVED, UNSURE, UNSURE, UNSURE, UNSURE, THERE]), []);
        assert_eq!(
            found(&[MOVED, Certainty::Explained, UNSURE, Certainty::Explained]),
            []
        );
    }

    #[test]
    fn what_is_elsewhere_after_a_while_may_have_been_anywhere() {
        let far = [MOVED, UNSURE, UNSURE, UNSURE, UNSURE, UNSURE, MOVED, THERE];
        assert_eq!(found(&far), [(15, 90, false)]);
        // It was tipped.
        assert_eq!(found(&[MOVED, UNSURE, UNSURE, MOVED, THERE]), []);
    }

    #[test]
    fn what_is_not_seen_in_the_end_or_never_is_told() {
        assert_eq!(found(&[MOVED, UNSURE, UNSURE]), [(15, 30, false)]);
        assert_eq!(found(&[UNSURE, UNSURE]), [(0, 15, true)]);
        assert_eq!(found(&[UNSURE, MOVED, THERE]), [(0, 15, false)]);
        assert_eq!(found(&[PERHAPS_THERE, MOVED, THERE]), []);
    }
}
