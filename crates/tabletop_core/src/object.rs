//! What an object is: its shape, and the shapes with states that are objects or parts themselves.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{BondPoint, IndicatorLights, MeshSpec, Pose, Rgb, Rollback, ToggleSwitch};

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

/// The shape of an object or of a part of one (report section 6.2). Sizes are full extents in units of 10 cm;
/// the shape's origin is its centre, for a composite its reference point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(opaque)]
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
        /// How many flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// A prism, or a part of a pyramid, along Z; its first corner is towards X.
    Frustum {
        /// Radius of the corners of its end towards +Z.
        radius_top: f32,
        /// Radius of the corners of its end towards -Z.
        radius_bottom: f32,
        /// Length.
        zspan: f32,
        /// How many flat sides, 3 or more.
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
        /// How many flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// What a file describes by triangles.
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
    Control(Box<Control>),
    /// A point at which a composite is fastened to another one. It has no extents.
    BondPoint(Box<BondPoint>),
}

/// A shape as a part of a composite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// The part's id as the task file has it; empty if it has none. Need not be unique.
    pub id: String,
    /// Its pose in the frame of the composite that it is a direct part of.
    pub pose: Pose,
    /// Its shape.
    pub shape: Shape,
    /// Whether the demonstrator can point to it. Its id is then unique on the table.
    #[serde(default)]
    pub pointable: bool,
}

/// A shape with states, numbered from 0: an object of its own or a part of a composite. Its id is that of the object or part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// What it is.
    pub kind: ControlKind,
    /// Its state.
    pub state: u32,
    /// The state that is shown and reported instead, if there is one.
    pub override_state: Option<u32>,
    /// Ids of the controls that take over its state whenever it changes.
    pub downstream: Vec<String>,
}

/// The kinds of controls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ControlKind {
    /// Two blocks that meet at an angle: pressing the raised one presses the other one up and changes the state.
    ToggleSwitch(ToggleSwitch),
    /// A row of lights, of which a state shows some.
    IndicatorLights(IndicatorLights),
    /// Shapes of its own for every state.
    Custom(CustomControl),
}

/// A control of its own shapes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CustomControl {
    /// What kind of control it is, for recordings.
    pub name: String,
    /// Its states.
    pub states: Vec<CustomState>,
}

/// A state of a custom control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CustomState {
    /// Its name in recordings; empty for its number.
    pub name: String,
    /// The shapes that there are in this state.
    pub parts: Vec<Part>,
    /// The state to which triggering leads, for each of the [simple parts](Shape::simple_parts) of these shapes.
    pub next: Vec<Option<u32>>,
    /// What coming into this state does to other objects, in this order.
    #[serde(default)]
    pub changes: Vec<Change>,
}

/// Something that a control does to other objects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Change {
    /// It removes an object.
    Remove {
        /// Its id.
        object: String,
    },
    /// It gives an object another colour.
    Recolor {
        /// Its id.
        object: String,
        /// The colour.
        color: Rgb,
    },
    /// It makes an object, at a pose on the table.
    Spawn(Box<ObjectSpec>),
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
