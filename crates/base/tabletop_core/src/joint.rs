//! Joints between objects.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::Pose;

use crate::Rollback;

/// The kind of a joint between two objects.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub enum JointKind {
    /// The origins of both joint frames coincide; all rotations are free.
    Ball,
    /// The second frame slides along -X of the first; nothing turns.
    Slider {
        /// Least distance along -X of the first frame, in units.
        #[serde(default)]
        min: f32,
        /// Greatest distance along -X of the first frame, in units.
        #[serde(alias = "travel")]
        max: f32,
        /// Coefficient of the dry friction, as a fraction of the second object's weight.
        friction: f32,
        /// Share of the speed that the joint takes away in a tick, 0 to 1.
        #[serde(default)]
        damping: f32,
    },
    /// The second frame turns about X of the first, and nothing slides.
    Hinge {
        /// Least angle, in radians.
        min: f32,
        /// Greatest angle, in radians.
        max: f32,
        /// Share of the speed that the joint takes away in a tick, 0 to 1.
        damping: f32,
    },
    /// The frames coincide, and nothing moves.
    Fixed,
    /// The second frame slides along -X of the first, and springs back to where both coincide.
    PushButton {
        /// Greatest distance along -X of the first frame, in units.
        travel: f32,
        /// Force of the spring for a unit of way, in kg/s²; at rest it is that of the travel.
        stiffness: f32,
    },
    /// The second frame turns about X of the first and springs back to the greatest angle. Closing it cuts a chain link that
    /// touches both objects.
    Shears {
        /// Angle when they are shut, in radians.
        min: f32,
        /// Angle when they are open, in radians.
        max: f32,
    },
}

/// A joint between two objects, by their ids.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointSpec {
    /// Ids of the two objects.
    pub objects: [String; 2],
    /// The joint's frame in the frame of each object.
    pub frames: [Pose; 2],
    /// The motion that the joint leaves free.
    pub kind: JointKind,
    /// True if the objects collide with each other.
    #[serde(default)]
    pub collides: bool,
}

/// A joint on the table. Its entity is a child of the second object's and disappears with either of the two.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[component(immutable)]
#[require(Transform, Rollback)]
#[reflect(Component)]
pub struct Joint {
    /// The two objects.
    pub objects: [Entity; 2],
    /// The joint's frame in the frame of each object.
    pub frames: [Pose; 2],
    /// The motion that the joint leaves free.
    pub kind: JointKind,
    /// True if the objects collide with each other.
    pub collides: bool,
}

impl Joint {
    /// The joint by the ids of its objects; `None` if one of them has none.
    pub fn spec(&self, id: impl FnMut(Entity) -> Option<String>) -> Option<JointSpec> {
        let [first, second] = self.objects.map(id);
        Some(JointSpec {
            objects: [first?, second?],
            frames: self.frames,
            kind: self.kind,
            collides: self.collides,
        })
    }
}
