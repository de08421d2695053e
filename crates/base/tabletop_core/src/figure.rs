//! Figures: visible things that are no objects, such as the robot's links.

use std::sync::Arc;

use bevy::prelude::*;

use tabletop_geometry::Triangles;

/// The look of an entity that is no object. The user and the head camera see it at the entity's
/// [`GlobalTransform`] as long as the entity has this component.
#[derive(Component, Clone, Debug)]
#[component(immutable)]
#[require(Transform)]
pub struct Figure {
    /// The surface for the window.
    pub fine: Arc<Triangles>,
    /// The surface for the head camera and for picking with the mouse.
    pub coarse: Arc<Triangles>,
}

/// Marks a figure that carries the head camera: the camera's pictures leave it out.
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[reflect(Component)]
pub struct CarriesHeadCamera;
