//! A drag: where an object is to be while the mouse moves it in its plane.

use bevy::{math::primitives::InfinitePlane3d, prelude::*};

/// An object is being dragged. The point where it was taken stays under the mouse cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drag {
    /// The object.
    pub object: Entity,
    /// The location to which the cursor drags it.
    pub goal: Vec3,
    /// A point of the plane.
    anchor: Vec3,
    /// The direction at right angles to the plane.
    normal: Vec3,
    /// From the place under the cursor to the object's origin.
    offset: Vec3,
}

impl Drag {
    /// Takes an object at this location, in the plane through it with this normal. Nothing can be dragged where the line
    /// of sight does not meet the plane.
    pub fn start(object: Entity, location: Vec3, normal: Vec3, ray: Ray3d) -> Option<Self> {
        Some(Self {
            object,
            goal: location,
            anchor: location,
            normal,
            offset: location - meeting_point(ray, location, normal)?,
        })
    }

    /// The drag after the cursor has moved, where the plane through the object, which is at this location, now has this
    /// normal. The drag ends where the line of sight misses the square of the upright plane around the place where it began, and waits
    /// where it misses that of the level one: the horizon.
    pub fn follow(self, ray: Ray3d, location: Vec3, normal: Vec3, side: f32) -> Option<Self> {
        let drag = self.in_plane(location, normal, ray)?;
        match drag.goal_for(ray, side) {
            Some(goal) => Some(Self { goal, ..drag }),
            None => drag.is_level().then_some(drag),
        }
    }

    /// The drag in a plane that is higher by so many units.
    pub fn raised(self, by: f32, ray: Ray3d) -> Self {
        let raised = Self::start(self.object, self.goal + Vec3::Z * by, self.normal, ray);
        raised.unwrap_or(self)
    }

    /// True if the object is dragged in the level plane.
    pub fn is_level(&self) -> bool {
        self.normal.z > 0.5
    }

    /// True if the object is dragged in the same plane as in another drag, but for its height.
    pub fn is_parallel_to(&self, other: &Self) -> bool {
        self.normal == other.normal
    }

    /// Goes on from this location in another plane, if it is another.
    fn in_plane(self, location: Vec3, normal: Vec3, ray: Ray3d) -> Option<Self> {
        if normal == self.normal {
            Some(self)
        } else {
            Self::start(self.object, location, normal, ray)
        }
    }

    /// The location of the object for this line of sight.
    fn goal_for(&self, ray: Ray3d, side: f32) -> Option<Vec3> {
        let goal = meeting_point(ray, self.anchor, self.normal)? + self.offset;
        let from_anchor = goal - self.anchor;
        let (along, across) = match self.is_level() {
            true => (Vec3::X, Vec3::Y),
            false => (self.normal.cross(Vec3::Z), Vec3::Z),
        };
        let distance = from_anchor
            .dot(along)
            .abs()
            .max(from_anchor.dot(across).abs());
        (distance <= side / 2.0).then_some(goal)
    }
}

/// The point in which a line of sight meets a plane in front of the eye.
fn meeting_point(ray: Ray3d, anchor: Vec3, normal: Vec3) -> Option<Vec3> {
    let plane = InfinitePlane3d {
        normal: Dir3::new(normal).ok()?,
    };
    ray.plane_intersection_point(anchor, plane)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYE: Vec3 = Vec3::new(0.0, -10.0, 5.0);
    const SIDE: f32 = 80.0;

    fn towards(point: Vec3) -> Ray3d {
        Ray3d::new(EYE, Dir3::new(point - EYE).unwrap())
    }

    fn drag(location: Vec3, taken_at: Vec3) -> Drag {
        Drag::start(Entity::PLACEHOLDER, location, Vec3::Y, towards(taken_at)).unwrap()
    }

    fn assert_near(actual: Option<Vec3>, expected: Vec3) {
        assert!(
            actual.is_some_and(|actual| actual.distance(expected) < 1e-4),
            "{actual:?} is not {expected}"
        );
    }

    #[test]
    fn the_object_keeps_its_place_under_the_cursor() {
        let location = Vec3::new(2.0, 1.0, 1.0);
        let taken_at = Vec3::new(2.4, 1.0, 1.7);
        let drag = drag(location, taken_at);
        assert_near(drag.goal_for(towards(taken_at), SIDE), location);
        let moved = Vec3::new(-3.0, 0.0, 4.0);
        assert_near(
            drag.goal_for(towards(taken_at + moved), SIDE),
            location + moved,
        );
    }

    #[test]
    fn the_object_stays_in_its_plane() {
        let location = Vec3::new(2.0, 1.0, 1.0);
        let drag = drag(location, Vec3::new(2.4, 0.0, 1.7));
        for x in [-5.0, 0.0, 5.0] {
            let target = drag.goal_for(towards(Vec3::new(x, -3.0, 3.0)), SIDE);
            assert!((target.unwrap().y - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn it_ends_where_the_line_of_sight_misses_the_plane() {
        let drag = drag(Vec3::Z, Vec3::Z);
        let behind = Ray3d::new(EYE, Dir3::NEG_Y);
        let along = Ray3d::new(EYE, Dir3::X);
        let far_up = towards(Vec3::Z * 100.0);
        for ray in [behind, along, far_up] {
            assert_eq!(drag.goal_for(ray, SIDE), None);
        }
        assert_eq!(
            Drag::start(Entity::PLACEHOLDER, Vec3::Z, Vec3::Y, behind),
            None
        );
    }

    #[test]
    fn it_goes_on_in_another_plane_from_where_the_object_is() {
        let (from, now) = (Vec3::Z, Vec3::new(1.0, 0.0, 1.0));
        let slanted = Ray3d::new(EYE, Dir3::new(Vec3::new(2.0, 10.0, -3.0)).unwrap());
        let drag = drag(from, from);
        assert_eq!(drag.in_plane(now, Vec3::Y, slanted), Some(drag));
        let other = drag.in_plane(now, Vec3::X, slanted).unwrap();
        assert_near(other.goal_for(slanted, SIDE), now);
        let further = Ray3d::new(EYE, Dir3::new(Vec3::new(2.0, 11.0, -3.0)).unwrap());
        let target = other.goal_for(further, SIDE).unwrap();
        assert!((target.x - now.x).abs() < 1e-4 && target.y > now.y);
    }

    #[test]
    fn in_the_level_plane_it_keeps_its_height_and_waits_at_the_horizon() {
        let location = Vec3::new(2.0, 1.0, 1.0);
        let drag = Drag::start(Entity::PLACEHOLDER, location, Vec3::Z, towards(location)).unwrap();
        let moved = Vec3::new(-3.0, 4.0, 0.0);
        let follow = |drag: Drag, ray| drag.follow(ray, location, Vec3::Z, SIDE).unwrap();
        let there = follow(drag, towards(location + moved));
        assert_near(Some(there.goal), location + moved);
        let above = Ray3d::new(EYE, Dir3::Y);
        assert_near(Some(follow(there, above).goal), location + moved);
        let ray = towards(location + moved);
        let raised = follow(there.raised(0.5, ray), ray);
        assert_near(Some(raised.goal), location + moved + Vec3::Z * 0.5);
    }
}
