//! The neighborhood of a dragged object: the solids of all others but those that are joined to it.

use std::collections::BTreeSet;

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Joint, ObjectIndex, ObjectSpec};
use tabletop_geometry::{Bounds, Pose};
use tabletop_user::Neighborhood;

/// The objects on the table, and what joins them.
#[derive(SystemParam)]
pub(crate) struct Around<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<'w, 's, (Entity, &'static ObjectSpec, &'static Transform)>,
    joints: Query<'w, 's, &'static Joint>,
}

impl Around<'_, '_> {
    /// The neighborhood of an object.
    pub fn of(&self, object: Entity) -> Option<Neighborhood> {
        let (_, spec, place) = self.objects.get(object).ok()?;
        let joined = self.joined_to(object);
        let others = self.objects.iter_many(self.index.iter());
        let others = others.filter(|(other, ..)| !joined.contains(other));
        let solids = others.flat_map(|(_, spec, place)| {
            let pose = Pose::from(place);
            let solids = spec.shape.colliding();
            solids
                .into_iter()
                .map(move |solid| Bounds::of_primitive(&solid, pose))
        });
        Some(Neighborhood {
            here: place.translation,
            bounds: spec.shape.bounds(place.into()),
            others: solids.collect(),
        })
    }

    /// An object, and all that hang together with it.
    fn joined_to(&self, object: Entity) -> BTreeSet<Entity> {
        let mut joined = BTreeSet::from([object]);
        let mut found = vec![object];
        while let Some(object) = found.pop() {
            let joints = self.joints.iter().map(|joint| joint.objects);
            let of_object = joints.filter(|objects| objects.contains(&object));
            found.extend(of_object.flatten().filter(|&other| joined.insert(other)));
        }
        joined
    }
}

#[cfg(test)]
mod tests {
    use bevy::ecs::system::RunSystemOnce as _;
    use tabletop_core::JointKind;

    use super::*;
    use crate::test_world::block;

    #[test]
    fn the_neighborhood_is_all_others_but_what_is_joined() {
        let mut world = World::new();
        world.init_resource::<ObjectIndex>();
        let objects = [0.0, 3.0, 6.0, 9.0]
            .map(|x| block(&mut world, &format!("at {x}"), Vec3::new(x, 0.0, 1.0)));
        let [held, link, end, _] = objects;
        for objects in [[link, held], [link, end]] {
            world.spawn(Joint {
                objects,
                frames: default(),
                kind: JointKind::Fixed,
                collides: false,
            });
        }
        let around = world
            .run_system_once(move |around: Around| around.of(held))
            .unwrap()
            .unwrap();
        assert_eq!(around.here, Vec3::Z);
        assert_eq!(around.bounds, Bounds::around(Vec3::Z, Vec3::ONE));
        let other = Bounds::around(Vec3::new(9.0, 0.0, 1.0), Vec3::ONE);
        assert_eq!(around.others, [other]);
    }
}
