//! Swept solids: whether the way of a moving solid is free.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::{
        bounding_volume::{Aabb, BoundingVolume},
        query::Contact,
    },
    rapier::prelude as rapier,
};
use tabletop_geometry::Pose;

use super::{
    approach::Approach,
    limits::{MARGIN, SAME_DEPTH, TOUCHING},
};
use crate::{
    geometry::{Convex, to_rapier},
    workarounds::contact::contact,
};

/// A convex solid that moves from one pose to another, or stays.
#[derive(Clone, Debug)]
pub struct SweptSolid<Owner> {
    /// Its owner.
    pub owner: Owner,
    shape: rapier::SharedShape,
    from: Pose,
    to: Pose,
    bounds: Aabb,
}

impl<Owner: Copy> SweptSolid<Owner> {
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

    /// The solid where it is before it moves, in the table's frame.
    pub fn part(&self) -> Convex {
        Convex {
            pose: self.from,
            shape: self.shape.clone(),
        }
    }

    /// True if the two would come closer than the margin, or deeper into each other than the first one gives, in units.
    pub fn collides_with<Other: Copy>(&self, other: &SweptSolid<Other>, give: f32) -> bool {
        if !are_near(&self.bounds, &other.bounds) {
            return false;
        }
        let Some(ahead) = self.gap(self.to, other, other.to, MARGIN) else {
            return false;
        };
        let is_too_near = give == 0.0 || ahead < -give;
        is_too_near
            && self
                .gap(self.from, other, other.from, MARGIN)
                .is_none_or(|here| ahead < here - SAME_DEPTH)
    }

    /// The approach of this solid to a free object's that stays, in a tick; `None` if it comes no nearer.
    pub fn approach<Other: Copy>(&self, free: &SweptSolid<Other>) -> Option<Approach> {
        let reach = self.from.location.distance(self.to.location)
            + self.from.rotation.angle_between(self.to.rotation) * self.extent();
        let here = self.contact(free, reach + TOUCHING)?;
        let ahead = self.gap(self.to, free, free.to, reach + TOUCHING)?;
        let approach = Approach {
            gap: here.dist,
            way: here.dist - ahead,
            direction: here.normal1,
            retreat: 0.0,
        };
        (approach.way > 0.0).then_some(approach)
    }

    /// Depth of this solid inside another, in units, before they move.
    pub fn depth_in<Other: Copy>(&self, other: &SweptSolid<Other>) -> f32 {
        let gap = self.gap(self.from, other, other.from, 0.0);
        gap.map_or(0.0, |gap| -gap)
    }

    /// The same of two solids that stay, if this one were shifted.
    pub(super) fn depth_if_shifted<Other: Copy>(&self, by: Vec3, other: &SweptSolid<Other>) -> f32 {
        let bounds = Aabb::new(self.bounds.mins + by, self.bounds.maxs + by);
        if !are_near(&bounds, &other.bounds) {
            return 0.0;
        }
        let mut from = self.from;
        from.location += by;
        let gap = self.gap(from, other, other.from, 0.0);
        gap.map_or(0.0, |gap| -gap)
    }

    /// The point of this solid nearest to another before they move, if the gap is at most `most`, in units.
    pub fn contact<Other: Copy>(&self, other: &SweptSolid<Other>, most: f32) -> Option<Contact> {
        let [here, there] = [self.from, other.from].map(to_rapier);
        contact(&here, &*self.shape, &there, &*other.shape, most)
    }

    /// True if the two solids are nearer to each other than `distance`, in units, before they move.
    pub fn is_within(&self, distance: f32, other: &Self) -> bool {
        self.gap(self.from, other, other.from, distance).is_some()
    }

    /// True if it passes the box on its way.
    pub fn passes(&self, bounds: &Aabb) -> bool {
        let start = self.shape.compute_aabb(&to_rapier(self.from));
        are_near(&self.bounds.merged(&start), bounds)
    }

    /// The box around it at the end of its way.
    pub const fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Radius of the ball about the solid's origin that encloses it.
    fn extent(&self) -> f32 {
        let ball = self.shape.compute_local_bounding_sphere();
        ball.center().length() + ball.radius()
    }

    /// Gap between the solids at these poses, in units, negative inside; `None` if larger than `most`.
    fn gap<Other: Copy>(
        &self,
        at: Pose,
        other: &SweptSolid<Other>,
        other_at: Pose,
        most: f32,
    ) -> Option<f32> {
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

/// True if two boxes are no farther apart than the margin.
pub fn are_near(a: &Aabb, b: &Aabb) -> bool {
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
        let table = SweptSolid::resting(slab, ());
        let cylinder = Convex {
            pose: Pose::IDENTITY,
            shape: rapier::SharedShape::cylinder(1.0, 0.6),
        };
        let [from, to] = [from, to].map(|z| Pose::from_degrees(Vec3::Z * z, Vec3::X * 90.0));
        SweptSolid::moving(&[cylinder], (), from, to).any(|it| it.collides_with(&table, 0.0))
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
            let solid = SweptSolid::moving(&[block(0.0)], (), from, to).next();
            let approach = solid
                .unwrap()
                .approach(&SweptSolid::resting(block(0.0), ()));
            approach.map_or(1.0, |approach| approach.part(0.0))
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
