//! Objects: their descriptions and shapes, and the controls among these.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::{Pose, Rgb};

use crate::{BondPoint, IndicatorLights, MeshSpec, PushButton, Rollback, ToggleSwitch};

/// The description of an object: everything that physics, pictures and recordings need to know of it.
///
/// As a component it marks the entity of an object on the table; the entity's `Transform` is the object's present pose;
/// [`pose`](Self::pose) remains the one that it was given at first.
#[derive(Component, Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[component(immutable)]
#[require(Transform, Rollback)]
#[reflect(Component, no_field_bounds)]
pub struct ObjectSpec {
    /// Its id. In a [`SceneSpec`](crate::SceneSpec) it is the id that the file asks for (empty: any); on the table it is unique.
    pub id: String,
    /// Its first pose: that of its centre (for a composite: of its reference point), which is also its centre of mass.
    pub pose: Pose,
    /// Mass in kg; 0 makes it immovable.
    pub mass: f32,
    /// Its geometry and colours.
    pub shape: Shape,
    /// Its friction, restitution and initial velocity.
    #[serde(default, skip_serializing_if = "Dynamics::is_default")]
    pub dynamics: Dynamics,
    /// Symbolic properties for recordings, as names and values in the order of the file.
    pub descriptions: Vec<(String, String)>,
}

/// An object's friction, restitution and initial velocity, where they differ from the defaults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, Reflect)]
#[serde(default)]
pub struct Dynamics {
    /// Coulomb friction of its surface. The friction of a contact is the product of both surfaces'.
    pub friction: Option<f32>,
    /// Restitution of its surface, 0 to 1: the share of an impact's speed with which it bounces back. That of a contact is the mean of
    /// both surfaces'.
    pub restitution: Option<f32>,
    /// Its initial velocity, in units/s.
    pub velocity: Vec3,
}

/// The shape of an object or a part (report section 6.2). Sizes are full extents in units of 10 cm. The shape's origin is its
/// centre, or the reference point of a composite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(no_field_bounds)]
pub enum Shape {
    /// A solid cuboid.
    Block {
        /// Extents along X, Y, Z.
        span: Vec3,
        /// Its colour.
        color: Rgb,
    },
    /// A solid circular cylinder along Y.
    Cylinder {
        /// Radius.
        radius: f32,
        /// Length.
        yspan: f32,
        /// Its colour.
        color: Rgb,
    },
    /// A solid ball.
    Sphere {
        /// Radius.
        radius: f32,
        /// Its colour.
        color: Rgb,
    },
    /// A cuboid container, open towards +Z.
    Box {
        /// Outer extents along X, Y, Z.
        span: Vec3,
        /// Thickness of floor and walls.
        thickness: f32,
        /// Its colour.
        color: Rgb,
    },
    /// A cylinder along Y with flat sides; its first corner is towards X.
    Prism {
        /// Radius of the corners.
        radius: f32,
        /// Length.
        yspan: f32,
        /// Number of flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// A prism, or a part of a pyramid, along Z; its first corner is towards X.
    Frustum {
        /// Radius of the corners at its +Z end.
        radius_top: f32,
        /// Radius of the corners at its -Z end.
        radius_bottom: f32,
        /// Length.
        zspan: f32,
        /// Number of flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// A ring about Z.
    Ring {
        /// Radius of its outer corners; the first one is towards X.
        radius_outer: f32,
        /// Radius of its hole.
        radius_inner: f32,
        /// Height.
        zspan: f32,
        /// Number of flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// A mesh of the triangles in a file.
    Mesh {
        /// Its surface, and the solids that fill it.
        mesh: MeshSpec,
        /// Its colour.
        color: Rgb,
    },
    /// Several shapes as one rigid body.
    Composite {
        /// The shapes, which may overlap.
        parts: Vec<Part>,
    },
    /// A link of a chain: a block that is drawn longer than it collides, to cover the gaps at its joints.
    Link {
        /// Extents of the colliding block; Y is along the chain.
        span: Vec3,
        /// Length added to the drawn block at both ends along Y.
        padding: f32,
        /// Its colour.
        color: Rgb,
    },
    /// The lid of a lid box: a plate with a box as its handle on top.
    Lid {
        /// Extents of the plate, whose centre is the lid's origin.
        span: Vec3,
        /// Colour of the plate.
        color: Rgb,
        /// Outer extents of the handle.
        handle_span: Vec3,
        /// Thickness of the handle's walls.
        handle_thickness: f32,
        /// Colour of the handle.
        handle_color: Rgb,
    },
    /// A switch, lights, or shapes with states.
    Control(Control),
    /// A point at which a composite is fastened to another one. It has no extents.
    BondPoint(BondPoint),
}

/// A shape as a part of a composite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(no_field_bounds)]
pub struct Part {
    /// The part's id as in the task file; empty if it has none. It need not be unique.
    pub id: String,
    /// Its pose in the frame of the composite that directly contains it.
    pub pose: Pose,
    /// Its shape.
    pub shape: Shape,
    /// True if the demonstrator can point to it. Its id is then unique on the table.
    #[serde(default)]
    pub pointable: bool,
}

/// A shape with states, numbered from 0. It is an object or a part of a composite, whose id is the control's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(no_field_bounds)]
pub struct Control {
    /// Its kind.
    pub kind: ControlKind,
    /// Its state.
    pub state: u32,
    /// The state that is shown and reported instead, if any.
    pub override_state: Option<u32>,
    /// Ids of the controls that copy its state whenever it changes.
    pub downstream: Vec<String>,
}

/// The kinds of controls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(no_field_bounds)]
pub enum ControlKind {
    /// Two blocks that meet at an angle: pressing the raised one lifts the other and changes the state.
    ToggleSwitch(ToggleSwitch),
    /// The cap of a button, which springs back: its state is where it is.
    PushButton(PushButton),
    /// A row of lights. Each state turns some of them on.
    IndicatorLights(IndicatorLights),
    /// A control whose task file gives the shapes of every state.
    Custom(CustomControl),
}

/// A control with shapes of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(no_field_bounds)]
pub struct CustomControl {
    /// The kind of control, as recordings name it.
    pub name: String,
    /// Its states.
    pub states: Vec<CustomState>,
}

/// A state of a custom control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(no_field_bounds)]
pub struct CustomState {
    /// Its name in recordings; empty for its number.
    pub name: String,
    /// The shapes of this state.
    pub parts: Vec<Part>,
    /// For each [simple part](Shape::simple_parts) of these shapes, the state to which triggering it leads.
    pub next: Vec<Option<u32>>,
    /// Changes to other objects when the control enters this state, in order.
    #[serde(default)]
    pub changes: Vec<Change>,
}

/// A change that a control makes to another object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(no_field_bounds)]
#[expect(
    clippy::large_enum_variant,
    reason = "a file is read once and has few changes; a box would only hide the object from reflection"
)]
pub enum Change {
    /// Remove an object.
    Remove {
        /// Its id.
        object: String,
    },
    /// Give an object another colour.
    Recolor {
        /// Its id.
        object: String,
        /// The colour.
        color: Rgb,
    },
    /// Make an object at a pose on the table.
    Spawn(ObjectSpec),
}

impl Dynamics {
    /// True if all of it is as by default: an ordinary object that starts at rest.
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

    /// True if nothing can move it.
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

impl Part {
    /// A part that cannot be pointed to.
    pub fn new(id: impl Into<String>, pose: Pose, shape: Shape) -> Self {
        Self {
            id: id.into(),
            pose,
            shape,
            pointable: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
