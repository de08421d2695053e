//! Acts of hands, inferred where only poses are known.

use tabletop_core::{Hand, JointKind, Manipulator, SimTick};
use tabletop_geometry::Pose;
use tabletop_recorder::TICKS_PER_FRAME;

use crate::{
    demonstration::{ActDeed, Demonstration, ShownAct},
    rotation::angle_between,
    track::Track,
};

/// Ticks for which a held object stands still in the air at most, and for which one that was put down lies still at least.
const PAUSE: u64 = 45;
/// How far something has to be moved to have been in a hand, in units, or turned, in rad.
const MOVED: (f32, f32) = (0.3, 0.2);
/// How far something has to be lifted to have been in a hand when other things move, in units.
const LIFTED: f32 = 0.15;

/// How near something is to where it stays when no hand moves it any more, in units and rad.
const SETTLED: (f32, f32) = (0.05, 0.05);

/// A time in which an object moves.
#[derive(Clone, Debug)]
struct ShownMotion {
    object: String,
    from: SimTick,
    to: SimTick,
    lift: f32,
}

/// The acts of hands by which the objects may have moved as they did: an object is in a hand from the moment when it begins to move until
/// it stands still on something. An object that only moves while another one is carried was pushed.
pub(crate) fn inferred_acts(shown: &Demonstration) -> Vec<ShownAct> {
    let mut motions: Vec<_> = shown
        .objects
        .iter()
        .flat_map(|object| motions(shown, &object.spec.id))
        .collect();
    motions.sort_by_key(|motion| motion.from);
    let mut carried: Vec<_> = (0..motions.len())
        .filter(|&i| is_carried(shown, &motions, i))
        .map(|i| motions[i].clone())
        .collect();
    for i in 0..carried.len() {
        // A hand has let go of it before it takes what follows.
        let following = carried.iter().filter(|next| follows(next, &carried[i]));
        let next = following.map(|next| next.from).min();
        carried[i].to = next.map_or(carried[i].to, |next| next.min(carried[i].to));
    }
    let mut acts = Vec::new();
    let mut right_until = None;
    for motion in carried {
        // Two things at the same time are in two hands.
        let hand = match right_until {
            Some(until) if motion.from < until => Hand::Left,
            Some(_) | None => Hand::Right,
        };
        if hand == Hand::Right {
            right_until = Some(motion.to);
        }
        let by = Manipulator::Hand(hand);
        let act = |tick, deed| ShownAct { tick, by, deed };
        acts.push(act(motion.from, ActDeed::Grasp(motion.object.clone())));
        if motion.to < shown.end || stands(shown, &motion.object, motion.to) {
            acts.push(act(motion.to, ActDeed::Release(None)));
        }
    }
    acts.sort_by_key(|act| (act.tick, matches!(act.deed, ActDeed::Grasp(_))));
    acts
}

/// The times in which an object moves, with its pauses in the air.
fn motions(shown: &Demonstration, id: &str) -> Vec<ShownMotion> {
    let Some(track) = shown.named(id).map(|object| &object.track) else {
        return Vec::new();
    };
    let mut motions = Vec::<ShownMotion>::new();
    let mut entries = track.entries();
    let Some((mut since, _)) = entries.next() else {
        return motions;
    };
    for (tick, _) in entries {
        let gap = tick.0 - since.0;
        // An object whose first row after a rest is here began to move a frame ago at most.
        let began = SimTick(tick.0.saturating_sub(gap.min(TICKS_PER_FRAME)) + 1);
        let goes_on = motions
            .last()
            .is_some_and(|motion| gap <= PAUSE || !stands(shown, id, motion.to));
        match motions.last_mut() {
            Some(motion) if goes_on => motion.to = tick,
            Some(_) | None => motions.push(ShownMotion {
                object: id.to_owned(),
                from: began,
                to: tick,
                lift: 0.0,
            }),
        }
        since = tick;
    }
    let is_moved = |motion: &ShownMotion| {
        let before = SimTick(motion.from.0.saturating_sub(1));
        let (Some(start), Some(end)) = (track.at(before), track.at(motion.to)) else {
            return false;
        };
        let poses = track.between(before, motion.to);
        let farthest = poses.map(|pose| pose.location.distance(start.location));
        farthest.fold(0.0, f32::max) > MOVED.0
            || angle_between(start.rotation, end.rotation) > MOVED.1
    };
    motions.retain(is_moved);
    for motion in &mut motions {
        motion.to = settled(track, motion);
        let before = SimTick(motion.from.0.saturating_sub(1));
        let heights: Vec<_> = track
            .between(before, motion.to)
            .map(|pose| pose.location.z)
            .collect();
        let highest = heights.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        motion.lift = highest - heights.first().copied().unwrap_or(highest);
    }
    motions
}

/// The tick from which an object stays where it is at the end of a motion: it settles by itself, not by a hand.
fn settled(track: &Track, motion: &ShownMotion) -> SimTick {
    let Some(end) = track.at(motion.to) else {
        return motion.to;
    };
    let within = |(tick, _): &(SimTick, Pose)| (motion.from..=motion.to).contains(tick);
    let mut settled = motion.from;
    let mut is_there = false;
    for (tick, pose) in track.entries().filter(within) {
        let is_near = pose.location.distance(end.location) < SETTLED.0
            && angle_between(pose.rotation, end.rotation) < SETTLED.1;
        if is_near && !is_there {
            settled = tick;
        }
        is_there = is_near;
    }
    settled
}

/// Whether an object is in a hand while it moves, and not pushed or carried along.
fn is_carried(shown: &Demonstration, motions: &[ShownMotion], i: usize) -> bool {
    let own = &motions[i];
    let meanwhile = |other: &&ShownMotion| {
        let overlaps = other.from < own.to && own.from < other.to;
        other.object != own.object && overlaps && !follows(own, other)
    };
    let before = shown.at(SimTick(own.from.0.saturating_sub(1)));
    let below = [before.supports(&own.object), before.containers(&own.object)].concat();
    let mut others = motions.iter().filter(meanwhile);
    !others.any(|other| {
        let is_pushed = own.lift < LIFTED && other.lift >= LIFTED;
        let is_carried_along = below.contains(&other.object.as_str());
        is_pushed || is_carried_along
    })
}

/// Whether a motion may have begun after another one has ended, in the same frame. It lasts longer than that of something that was pushed.
fn follows(own: &ShownMotion, other: &ShownMotion) -> bool {
    other.from < own.from
        && own.from.0 + TICKS_PER_FRAME > other.to.0
        && own.to.0 > other.to.0 + PAUSE
}

/// Whether an object stands on something at the end of a tick, or hangs in a joint that leaves it one motion.
fn stands(shown: &Demonstration, id: &str, tick: SimTick) -> bool {
    let arrangement = shown.at(tick);
    let is_around = || !arrangement.presumed_bases(id).0.is_empty();
    arrangement.is_on_table(id)
        || !arrangement.supports(id).is_empty()
        || is_around()
        || hangs(shown, id)
}

/// Whether a joint with another object leaves an object one motion at most, so that it stays where it is let go.
fn hangs(shown: &Demonstration, id: &str) -> bool {
    let mut joints = shown.joints.iter();
    joints.any(|joint| joint.objects[1] == id && joint.kind != JointKind::Ball)
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::{JointSpec, ObjectSpec, Shape, Table};
    use tabletop_geometry::Rgb;

    use super::*;

    /// A block is lifted, carried and put down; in the last frame it only settles.
    const PUT: [(u64, Vec3); 5] = [
        (0, Vec3::new(0.0, 0.0, 0.5)),
        (15, Vec3::new(0.0, 0.0, 2.0)),
        (30, Vec3::new(2.0, 0.0, 2.0)),
        (45, Vec3::new(2.0, 0.0, 0.6)),
        (60, Vec3::new(2.0, 0.0, 0.5)),
    ];

    /// A block that is at these places from these ticks on.
    fn block(id: &str, places: &[(u64, Vec3)]) -> (ObjectSpec, Track) {
        let shape = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::RED,
        };
        let mut track = Track::default();
        for (tick, at) in places {
            track.push(SimTick(*tick), Pose::at(*at));
        }
        (
            ObjectSpec::new(id, Pose::at(places[0].1), 1.0, shape),
            track,
        )
    }

    #[test]
    fn a_hand_lets_go_before_it_takes_what_moves_from_the_same_frame_on() {
        let slide = [
            (0, Vec3::new(-4.0, 0.0, 0.5)),
            (60, Vec3::new(-4.1, 0.0, 0.5)),
            (75, Vec3::new(-5.0, 0.0, 0.5)),
            (120, Vec3::new(-6.0, 0.0, 0.5)),
        ];
        let objects = [block("put", &PUT), block("slid", &slide)];
        let shown = Demonstration::of_motions(Table::default(), objects, Vec::new(), SimTick(200));
        let deeds: Vec<_> = shown.acts.iter().map(|act| (act.by, &act.deed)).collect();
        let right = Manipulator::Hand(Hand::Right);
        let grasp = |id: &str| ActDeed::Grasp(id.into());
        assert_eq!(
            deeds,
            [
                (right, &grasp("put")),
                (right, &ActDeed::Release(None)),
                (right, &grasp("slid")),
                (right, &ActDeed::Release(None)),
            ]
        );
    }

    #[test]
    fn what_moves_briefly_as_another_thing_is_put_down_was_pushed() {
        let pushed = [
            (0, Vec3::new(3.0, 0.0, 0.5)),
            (60, Vec3::new(3.3, 0.0, 0.5)),
            (75, Vec3::new(3.4, 0.0, 0.5)),
        ];
        let objects = [block("put", &PUT), block("pushed", &pushed)];
        let shown = Demonstration::of_motions(Table::default(), objects, Vec::new(), SimTick(200));
        let taken = |act: &ShownAct| act.deed == ActDeed::Grasp("pushed".into());
        assert!(!shown.acts.iter().any(taken), "{:?}", shown.acts);
    }

    #[test]
    fn a_drawer_that_is_opened_and_closed_is_let_go_in_between() {
        let drawer = [
            (0, Vec3::new(4.0, 3.0, 1.0)),
            (15, Vec3::new(3.0, 3.0, 1.0)),
            (30, Vec3::new(2.0, 3.0, 1.0)),
            (200, Vec3::new(3.0, 3.0, 1.0)),
            (215, Vec3::new(4.0, 3.0, 1.0)),
        ];
        let put = PUT.map(|(tick, at)| (if tick == 0 { 0 } else { tick + 90 }, at));
        let objects = [block("drawer", &drawer), block("put", &put)];
        let joint = JointSpec {
            objects: ["cabinet".into(), "drawer".into()],
            frames: [Pose::IDENTITY; 2],
            kind: JointKind::Slider {
                min: 0.0,
                max: 3.0,
                friction: 0.0,
                damping: 0.0,
            },
            collides: false,
        };
        let shown = Demonstration::of_motions(Table::default(), objects, vec![joint], SimTick(300));
        let deeds: Vec<_> = shown.acts.iter().map(|act| &act.deed).collect();
        let grasp = |id: &str| ActDeed::Grasp(id.into());
        assert_eq!(
            deeds,
            [
                &grasp("drawer"),
                &ActDeed::Release(None),
                &grasp("put"),
                &ActDeed::Release(None),
                &grasp("drawer"),
                &ActDeed::Release(None),
            ]
        );
    }
}
