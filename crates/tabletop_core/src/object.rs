//! Objects on the table: what each one is, and how to find it.

use std::collections::BTreeMap;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{Pose, Rollback, Shape};

/// What an object is: everything that physics, pictures and recordings need to know of it.
///
/// As a component it marks the entity of an object on the table; the entity's `Transform` is where the object is now,
/// while [`pose`](Self::pose) stays where it was put.
#[derive(Component, Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[component(immutable)]
#[require(Transform, Rollback)]
#[reflect(Component)]
pub struct ObjectSpec {
    /// Its id. In a [`SceneSpec`](crate::SceneSpec) it is the id that the file asks for (empty: any), on the table it is unique.
    pub id: String,
    /// Where it is put: the pose of its centre (for a composite: its reference point), which is also its centre of mass.
    pub pose: Pose,
    /// Mass in kg; 0 makes it immovable.
    pub mass: f32,
    /// Its geometry and colours.
    pub shape: Shape,
    /// How it slides, bounces and begins to move.
    #[serde(default, skip_serializing_if = "Dynamics::is_default")]
    pub dynamics: Dynamics,
    /// Symbolic properties for recordings, as name and value, in the order of the file.
    pub descriptions: Vec<(String, String)>,
}

/// How an object slides, bounces and begins to move, where that is not as for all objects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, Reflect)]
#[serde(default)]
pub struct Dynamics {
    /// Coulomb friction of its surface. Two surfaces in contact have the product of theirs.
    pub friction: Option<f32>,
    /// The share of the speed of an impact with which it bounces back, 0 to 1. Two surfaces in contact have the mean of theirs.
    pub restitution: Option<f32>,
    /// Its velocity when it appears, in units/s.
    pub velocity: Vec3,
}

impl Dynamics {
    /// Whether it is as for all objects, and at rest.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl ObjectSpec {
    /// An object without descriptions; `mass` in kg.
    pub fn new(id: impl Into<String>, pose: Pose, mass: f32, shape: Shape) -> Self {
        Self {
            id: id.into(),
            pose,
            mass,
            shape,
            dynamics: Dynamics::default(),
            descriptions: Vec::new(),
        }
    }

    /// Whether nothing moves it.
    pub fn is_fixed(&self) -> bool {
        self.mass == 0.0
    }

    /// The properties that a recording lists: `shape` first, then the others in the order of the file.
    /// A description named `shape` replaces the shape's own name.
    pub fn all_descriptions(&self) -> Vec<(&str, &str)> {
        let shape = if let Shape::Mesh { mesh, .. } = &self.shape {
            mesh.name()
        } else {
            self.shape.name()
        };
        let mut all = vec![("shape", shape)];
        for (name, value) in &self.descriptions {
            match name.as_str() {
                "shape" => all[0].1 = value,
                _ => all.push((name, value)),
            }
        }
        all
    }
}

/// The objects on the table: by id, and in the order in which they were created.
#[derive(Resource, Clone, Debug, Default, Reflect)]
#[reflect(Resource)]
pub struct ObjectIndex {
    by_id: BTreeMap<String, Entity>,
    in_order: Vec<Entity>,
}

impl ObjectIndex {
    /// The object of this id.
    pub fn get(&self, id: &str) -> Option<Entity> {
        self.by_id.get(id).copied()
    }

    /// The objects in the order of their creation.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Entity> + '_ {
        self.in_order.iter().copied()
    }

    /// The ids, in alphabetical order.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.by_id.keys().map(String::as_str)
    }

    /// How many objects there are.
    pub fn len(&self) -> usize {
        self.in_order.len()
    }

    /// Whether the table is empty.
    pub fn is_empty(&self) -> bool {
        self.in_order.is_empty()
    }

    /// Notes a new object. An id that is already there is taken over by the new object.
    pub fn insert(&mut self, id: impl Into<String>, object: Entity) {
        if let Some(previous) = self.by_id.insert(id.into(), object) {
            self.in_order.retain(|&entity| entity != previous);
        }
        self.in_order.push(object);
    }

    /// Forgets an object, and returns its entity.
    pub fn remove(&mut self, id: &str) -> Option<Entity> {
        let object = self.by_id.remove(id)?;
        self.in_order.retain(|&entity| entity != object);
        Some(object)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rgb;

    #[test]
    fn a_description_named_shape_takes_the_first_place() {
        let mut spec = ObjectSpec {
            id: "ball".into(),
            pose: Pose::IDENTITY,
            mass: 1.0,
            shape: Shape::Sphere {
                radius: 1.0,
                color: Rgb::GRAY,
            },
            dynamics: Dynamics::default(),
            descriptions: vec![("use".into(), "toy".into())],
        };
        assert_eq!(
            spec.all_descriptions(),
            [("shape", "sphere"), ("use", "toy")]
        );
        spec.descriptions.push(("shape".into(), "globe".into()));
        assert_eq!(
            spec.all_descriptions(),
            [("shape", "globe"), ("use", "toy")]
        );
    }

    #[test]
    fn the_index_keeps_the_order_of_creation() {
        let mut world = World::new();
        let [a, b, c] = std::array::from_fn(|_| world.spawn_empty().id());
        let mut index = ObjectIndex::default();
        index.insert("z", a);
        index.insert("a", b);
        index.insert("m", c);
        assert_eq!(index.remove("a"), Some(b));
        assert_eq!(index.iter().collect::<Vec<_>>(), [a, c]);
        assert_eq!(index.get("m"), Some(c));
        assert_eq!(index.get("a"), None);
    }
}
