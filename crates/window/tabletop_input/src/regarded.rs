//! The object that the user regards: what the hand holds, what the keyboard has chosen, or what is under the cursor.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Hand, Hands, ObjectSpec};
use tabletop_geometry::Pose;
use tabletop_user::Chosen;

use crate::{pick::Pickable, pointer::Pointer};

/// The objects, and the user's attention.
#[derive(SystemParam)]
pub struct Regard<'w, 's> {
    hands: Res<'w, Hands>,
    chosen: Res<'w, Chosen>,
    pointer: Res<'w, Pointer>,
    pickable: Pickable<'w, 's>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
}

/// An object that the user regards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regarded<'a> {
    /// Its id.
    pub id: &'a str,
    /// Its pose on the table.
    pub pose: Pose,
    /// The hand that holds it.
    pub holder: Option<Hand>,
}

impl Regard<'_, '_> {
    /// The object that the user acts on, or else the one under the cursor.
    pub fn object(&self) -> Option<Regarded<'_>> {
        let held = self.hands.held_by(self.hands.selected);
        let acted_on = held
            .or(self.chosen.0)
            .and_then(|object| self.regarded(object));
        acted_on.or_else(|| self.hovered())
    }

    /// The object in the selected hand.
    pub fn held(&self) -> Option<Regarded<'_>> {
        self.regarded(self.hands.held_by(self.hands.selected)?)
    }

    /// The object under the cursor.
    pub fn hovered(&self) -> Option<Regarded<'_>> {
        let ray = self.pointer.ray.filter(|_| !self.pointer.is_panels)?;
        self.regarded(self.pickable.object_along(ray)?)
    }

    /// Place of the cursor in the window, in logical pixels.
    pub fn cursor(&self) -> Option<Vec2> {
        self.pointer.cursor
    }

    fn regarded(&self, object: Entity) -> Option<Regarded<'_>> {
        let (spec, place) = self.objects.get(object).ok()?;
        Some(Regarded {
            id: &spec.id,
            pose: place.into(),
            holder: self.hands.holder_of(object),
        })
    }
}

#[cfg(test)]
mod tests {
    use bevy::ecs::system::RunSystemOnce as _;

    use super::*;
    use crate::{mouse, test_world::TestWorld};

    fn regarded(test: &mut TestWorld) -> Option<(String, Option<Hand>)> {
        let look = |regard: Regard| {
            let object = regard.object()?;
            Some((object.id.to_owned(), object.holder))
        };
        test.app.world_mut().run_system_once(look).unwrap()
    }

    #[test]
    fn what_is_held_comes_before_what_is_chosen_and_that_before_what_is_under_the_cursor() {
        let mut test = TestWorld::new(mouse::plugin);
        assert_eq!(regarded(&mut test), None);
        test.block("hovered", Vec3::Z);
        test.point_at(Vec3::Z);
        assert_eq!(regarded(&mut test), Some(("hovered".into(), None)));
        let chosen = test.block("chosen", Vec3::new(5.0, 0.0, 1.0));
        test.app.insert_resource(Chosen(Some(chosen)));
        assert_eq!(regarded(&mut test), Some(("chosen".into(), None)));
        test.hold("held", Vec3::new(-5.0, 0.0, 1.0));
        assert_eq!(regarded(&mut test), Some(("held".into(), Some(Hand::Any))));
    }

    #[test]
    fn behind_a_panel_nothing_is_regarded() {
        let mut test = TestWorld::new(mouse::plugin);
        test.block("red", Vec3::Z);
        test.point_at(Vec3::Z);
        test.point_at_panel();
        assert_eq!(regarded(&mut test), None);
    }
}
