//! Clearance: whether the way of a moving solid is free.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::{
        bounding_volume::{Aabb, BoundingVolume},
        query::Contact,
    },
    rapier::prelude as rapier,
};
use tabletop_geometry::Pose;
use tabletop_physics::{Convex, contact, to_rapier};

/// Distance, in units, that is kept from obstacles.
pub(crate) const MARGIN: f32 = 0.01;

/// Depth to which a held object may enter its support, in units.
const GIVE: f32 = 0.03;

/// Largest change of distance, in units, that does not count as approach.
const APPROACH: f32 = 1e-5;

/// Distance, in units, at which a free object is touched, and pushed from the next tick on.
pub(crate) const TOUCHING: f32 = 0.01;

/// Depth, in units, to which a free object is squeezed before its pusher stops.
pub(crate) const SQUEEZE: f32 = 0.05;

/// Depth, in units, to which a free object is squeezed between its pusher and what does not move.
pub(crate) const PRESSED: f32 = 0.02;

/// The owner of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    /// An object or the table.
    Thing(Entity),
    /// A body of the robot, by its number.
    Body(usize),
}

/// A convex solid that moves from one pose to another, or stays.
#[derive(Clone, Debug)]
pub(crate) struct SweptSolid {
    /// Its owner.
    pub owner: Owner,
    shape: rapier::SharedShape,
    from: Pose,
    to: Pose,
    bounds: Aabb,
}

impl SweptSolid {
    /// The solids of a body that moves from one pose to another.
    pub fn moving(
        parts: &[Convex],
        owner: Owner,
        from: Pose,
        to: Pose,
    ) -> impl Iterator<Item = Self> {
        parts.iter().map(move |part| {
            let to = to * part.pose;
            Self {
                owner,
                shape: part.shape.clone(),
                from: from * part.pose,
                to,
                bounds: part.bounds_at(to),
            }
        })
    }

    /// A solid that stays in place, in the table's frame.
    pub fn resting(part: Convex, owner: Owner) -> Self {
        Self {
            owner,
            bounds: part.bounds_at(part.pose),
            shape: part.shape,
            from: part.pose,
            to: part.pose,
        }
    }

    /// Depth to which it may enter its support, in units: an object in a gripper gives way between the fingers.
    pub const fn give(&self) -> f32 {
        match self.owner {
            Owner::Thing(_) => GIVE,
            Owner::Body(_) => 0.0,
        }
    }

    /// True if the two would come closer than the margin, or deeper into each other than the first one gives.
    pub fn collides_with(&self, other: &Self, give: f32) -> bool {
        if !are_near(&self.bounds, &other.bounds) {
            return false;
        }
        let Some(ahead) = self.distance(self.to, other, other.to, MARGIN) else {
            return false;
        };
        let is_too_near = give == 0.0 || ahead < -give;
        is_too_near
            && self
                .distance(self.from, other, other.from, MARGIN)
                .is_none_or(|here| ahead < here - APPROACH)
    }

    /// The approach of this solid to a free object in a tick; `None` if it comes no nearer.
    pub fn approach(&self, free: &Self) -> Option<Approach> {
        let reach = self.from.location.distance(self.to.location)
            + self.from.rotation.angle_between(self.to.rotation) * self.extent();
        let here = self.contact(free, reach + TOUCHING)?;
        let ahead = self.distance(self.to, free, free.to, reach + TOUCHING)?;
        let approach = Approach {
            distance: here.dist,
            way: here.dist - ahead,
            direction: here.normal1,
        };
        (approach.way > 0.0).then_some(approach)
    }

    /// The solid, shifted.
    pub fn shifted(mut self, by: Vec3) -> Self {
        self.from.location += by;
        self.to.location += by;
        self.bounds.mins += by;
        self.bounds.maxs += by;
        self
    }

    /// Depth of this solid inside another, in units, before they move.
    pub fn depth_in(&self, other: &Self) -> f32 {
        let distance = self.distance(self.from, other, other.from, 0.0);
        distance.map_or(0.0, |distance| -distance)
    }

    /// The point of this solid nearest to another before they move, if the gap is at most `most`, in units.
    pub fn contact(&self, other: &Self, most: f32) -> Option<Contact> {
        let [here, there] = [self, other].map(|solid| to_rapier(solid.from));
        contact(&here, &*self.shape, &there, &*other.shape, most)
    }

    /// Radius of the ball about the solid's origin that encloses it.
    fn extent(&self) -> f32 {
        let ball = self.shape.compute_local_bounding_sphere();
        ball.center().length() + ball.radius()
    }

    /// True if the two solids are nearer to each other than `distance`, in units, before they move.
    pub fn is_within(&self, distance: f32, other: &Self) -> bool {
        self.distance(self.from, other, other.from, distance)
            .is_some()
    }

    /// True if it passes the box on its way.
    pub fn passes(&self, bounds: &Aabb) -> bool {
        let start = self.shape.compute_aabb(&to_rapier(self.from));
        are_near(&self.bounds.merged(&start), bounds)
    }

    /// The box around it on its whole way.
    pub const fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Gap between the solids at these poses, in units, negative inside; `None` if larger than `most`.
    fn distance(&self, at: Pose, other: &Self, other_at: Pose, most: f32) -> Option<f32> {
        contact(
            &to_rapier(at),
            &*self.shape,
            &to_rapier(other_at),
            &*other.shape,
            most,
        )
        .map(|contact| contact.dist)
    }
}

/// The approach of a solid to a free object in a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    /// Gap at the beginning of the tick, in units.
    distance: f32,
    /// Decrease of the gap by its end.
    way: f32,
    /// Normal of the contact, from the solid to the free object.
    pub direction: Vec3,
}

impl Approach {
    /// True if the physics engine already has the contact, so that one pushes the other.
    pub fn is_push(self) -> bool {
        self.distance <= TOUCHING
    }

    /// The part of its way that the solid can go: it reaches a free object in one tick and pushes it from the next one on,
    /// the slower the more it squeezes the object.
    pub fn part(self) -> f32 {
        if self.is_push() {
            part_left(-self.distance)
        } else {
            ((self.distance - TOUCHING / 2.0) / self.way).min(1.0)
        }
    }

    /// The part of its way that the solid can go on pushing a free object that cannot give way and is squeezed to this depth, in units.
    pub fn part_pressing(self, depth: f32) -> f32 {
        let room = PRESSED - depth + self.distance.min(0.0);
        (room / self.way).clamp(0.0, 1.0)
    }
}

/// The part of a push that is left at this depth of squeezing, in units.
pub(crate) fn part_left(depth: f32) -> f32 {
    (1.0 - depth / SQUEEZE).clamp(0.0, 1.0)
}

/// True if two boxes are no farther apart than the margin.
pub(crate) fn are_near(a: &Aabb, b: &Aabb) -> bool {
    a.mins.cmple(b.maxs + MARGIN).all() && a.maxs.cmpge(b.mins - MARGIN).all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_blocked(from: f32, to: f32) -> bool {
        let slab = Convex {
            pose: Pose::at(Vec3::NEG_Z * 2.0),
            shape: rapier::SharedShape::cuboid(10.0, 6.0, 2.0),
        };
        let table = SweptSolid::resting(slab, Owner::Body(0));
        let cylinder = Convex {
            pose: Pose::IDENTITY,
            shape: rapier::SharedShape::cylinder(1.0, 0.6),
        };
        let [from, to] = [from, to].map(|z| Pose::from_degrees(Vec3::Z * z, Vec3::X * 90.0));
        SweptSolid::moving(&[cylinder], Owner::Body(1), from, to)
            .any(|it| it.collides_with(&table, 0.0))
    }

    #[test]
    fn nothing_comes_nearer_than_the_margin() {
        assert!(!is_blocked(2.0, 1.02));
        assert!(is_blocked(2.0, 1.005));
        assert!(is_blocked(2.0, 0.5));
    }

    #[test]
    fn something_free_is_reached_then_pushed_and_not_squeezed() {
        let block = |z: f32| {
            let shape = rapier::SharedShape::cuboid(0.5, 0.5, 0.5);
            let pose = Pose::at(Vec3::Z * z);
            Convex { pose, shape }
        };
        let push = |from: f32| {
            let [from, to] = [from, from - 0.1].map(|z| Pose::at(Vec3::Z * z));
            let solid = SweptSolid::moving(&[block(0.0)], Owner::Body(0), from, to).next();
            let approach = solid
                .unwrap()
                .approach(&SweptSolid::resting(block(0.0), Owner::Body(1)));
            approach.map_or(1.0, Approach::part)
        };
        assert_eq!(push(1.5), 1.0);
        assert!((push(1.055) - 0.5).abs() < 1e-3);
        assert_eq!(push(1.005), 1.0);
        assert!((push(0.98) - 0.6).abs() < 1e-3);
        assert_eq!(push(0.9), 0.0);
    }

    #[test]
    fn a_solid_that_is_too_near_may_leave_and_not_come_nearer() {
        assert!(!is_blocked(1.0, 1.005));
        assert!(is_blocked(1.0, 0.99));
        assert!(!is_blocked(0.5, 0.6));
        assert!(is_blocked(0.5, 0.4));
    }
}
