//! Where two solids on their ways are nearest.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::query::{ContactManifold, PersistentQueryDispatcher as _},
    rapier::prelude::{Pose, Shape},
};

use super::free_flight::FreeFlight;
use crate::workarounds::{contact::contact, rolling::Rolling};

/// Gap, in units, of solids that touch.
pub(super) const TOUCHING: f32 = 1e-4;

/// Most looks at the solids. A touch needs some four, since the gap of convex solids on straight ways closes ever more slowly.
const MOST_LOOKS: usize = 24;

/// Duration, in s, within which a time is known: 0.1 mm at 100 units/s.
const EXACT: f32 = 1e-5;

/// Distance, in units, from the nearest points in which a face has contacts, too.
const DEPTH: f32 = 0.2;

/// Distance, in units, in which the nearest points are looked for.
const FARTHEST: f32 = 100.0;

/// A convex solid on its way.
pub(super) struct FlyingSolid<'a> {
    pub shape: &'a dyn Shape,
    /// Its pose at first.
    pub first: Pose,
    pub way: FreeFlight,
}

impl FlyingSolid<'_> {
    pub fn at(&self, time: f32) -> Pose {
        self.way.pose(&self.first, time)
    }
}

/// Where two solids are nearest.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearestApproach {
    /// The time, in s.
    pub time: f32,
    /// In units.
    pub gap: f32,
    /// Direction from the first solid to the second one.
    pub normal: Vec3,
    /// The nearest point of each, at that time.
    pub points: [Vec3; 2],
}

/// The first touch of two solids, or their nearest approach, up to a time.
pub(super) fn nearest_approach(movers: &[FlyingSolid; 2], latest: f32) -> Option<NearestApproach> {
    let (mut early, mut late) = (None, None::<NearestApproach>);
    let mut time = 0.0;
    for _ in 0..MOST_LOOKS {
        let (now, closing) = look(movers, time)?;
        let approaches = now.gap > 0.0 && closing > 0.0;
        if now.gap.abs() <= TOUCHING || approaches && time == latest {
            return Some(now);
        }
        match approaches {
            true => early = Some(now),
            false => late = Some(now),
        }
        let end = late.map_or(latest, |late| late.time);
        let start = early.map_or(0.0, |early: NearestApproach| early.time);
        if end - start <= EXACT {
            break;
        }
        let next = time + now.gap / closing;
        time = match approaches && next < end {
            true => next,
            false if late.is_some() => 0.5 * (start + end),
            false => latest,
        };
    }
    // Solids that pass each other are beside each other as soon as they no longer approach.
    let passed = late.filter(|late| late.gap > 0.0);
    passed.or(early)
}

/// Where two solids are nearest after a time, and the speed at which their gap closes.
pub(super) fn look(movers: &[FlyingSolid; 2], time: f32) -> Option<(NearestApproach, f32)> {
    let [first, second] = movers;
    let at = [first.at(time), second.at(time)];
    let found = contact(&at[0], first.shape, &at[1], second.shape, FARTHEST)?;
    let mut nearest = NearestApproach {
        time,
        gap: found.dist,
        normal: found.normal1,
        points: [found.point1, found.point2],
    };
    // The manifold knows the true normal of a round side, and that of a face in spite of rounding.
    if let Some(manifold) = manifold(movers, nearest)
        && let Some(point) = manifold.points.first()
    {
        nearest.gap = point.dist;
        nearest.normal = at[0].rotation * manifold.local_n1;
        nearest.points = [at[0] * point.local_p1, at[1] * point.local_p2];
    }
    let [own, other] = nearest.points;
    let velocity = first.way.velocity(own, time) - second.way.velocity(other, time);
    Some((nearest, velocity.dot(nearest.normal)))
}

/// The contacts of two solids where they are nearest, the nearest points first. `None` if their normal is another one: Parry looks along the normals of
/// faces only, and between edges it finds no plane as wide as the gap.
pub(super) fn manifold(
    movers: &[FlyingSolid; 2],
    nearest: NearestApproach,
) -> Option<ContactManifold<(), ()>> {
    let [first, second] = movers;
    let mut found = ContactManifold::new();
    let known = Rolling.contact_manifold_convex_convex(
        &first.at(nearest.time).inv_mul(&second.at(nearest.time)),
        first.shape,
        second.shape,
        None,
        None,
        nearest.gap.max(0.0) + DEPTH,
        &mut found,
    );
    known.ok()?;
    found
        .points
        .sort_by(|one, other| one.dist.total_cmp(&other.dist));
    let gap = found.points.first()?.dist;
    (gap >= nearest.gap - TOUCHING).then_some(found)
}

#[cfg(test)]
mod tests {
    use bevy_rapier3d::rapier::prelude::{Ball, Cuboid, RigidBodyBuilder};

    use super::*;

    fn mover<'a>(shape: &'a dyn Shape, at: Vec3, velocity: Vec3) -> FlyingSolid<'a> {
        let body = RigidBodyBuilder::dynamic()
            .translation(at)
            .linvel(velocity)
            .build();
        FlyingSolid {
            shape,
            first: Pose::from_translation(at),
            way: FreeFlight::of(&body, Vec3::ZERO),
        }
    }

    #[test]
    fn balls_touch_where_their_centres_are_two_radii_apart() {
        let ball = Ball::new(0.5);
        let movers = [
            mover(&ball, Vec3::new(-3.0, 0.8, 0.0), Vec3::X * 50.0),
            mover(&ball, Vec3::ZERO, Vec3::ZERO),
        ];
        let time = nearest_approach(&movers, 1.0).unwrap().time;
        assert!((time * 50.0 - 2.4).abs() < 1e-3, "{time}");
    }

    #[test]
    fn a_ball_that_misses_is_nearest_beside_the_other() {
        let (ball, cube) = (Ball::new(0.5), Cuboid::new(Vec3::splat(0.5)));
        for shape in [&ball as &dyn Shape, &cube] {
            let movers = [
                mover(&ball, Vec3::new(-3.0, 1.001, 0.0), Vec3::X * 50.0),
                mover(shape, Vec3::ZERO, Vec3::ZERO),
            ];
            let nearest = nearest_approach(&movers, 1.0).unwrap();
            assert!((nearest.gap - 0.001).abs() < 1e-4, "{nearest:?}");
        }
    }

    #[test]
    fn solids_that_do_not_meet_in_time_are_nearest_last() {
        let ball = Ball::new(0.5);
        let movers = [
            mover(&ball, Vec3::new(-3.0, 0.0, 0.0), Vec3::X),
            mover(&ball, Vec3::ZERO, Vec3::ZERO),
        ];
        assert_eq!(nearest_approach(&movers, 0.5).unwrap().time, 0.5);
    }
}
