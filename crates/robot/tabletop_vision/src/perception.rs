//! The robot's eyes in the simulation: where it believes that the objects are, by the pictures of its head camera alone.
//!
//! [`PerceptionPlugin`] looks at each picture that the head camera takes, as long as somebody [demands](PerceptionDemand) it. The robot knows the shapes and colours of
//! the objects, the joints between them, and its own posture; poses it sees.

mod belief;
mod eyesight;

use bevy::prelude::*;
use tabletop_core::{PictureSystems, RestingSystems, SensorImage, SimSystems, TickSystems};

pub use belief::{PerceivedObject, Perception, PerceptionDemand};
use eyesight::Eyesight;

/// The robot's eyes. Needs the head camera's pictures: `tabletop_camera::CameraPlugin`.
#[derive(Clone, Copy, Debug, Default)]
pub struct PerceptionPlugin;

impl Plugin for PerceptionPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Perception>()
            .init_resource::<PerceptionDemand>()
            .init_resource::<SensorImage>()
            .init_resource::<Eyesight>()
            .add_systems(
                FixedUpdate,
                eyesight::perceive
                    .after(PictureSystems::Draw)
                    .before(SimSystems::Record)
                    .in_set(TickSystems)
                    .in_set(RestingSystems)
                    .run_if(PerceptionDemand::is_asked.and_then(resource_changed::<SensorImage>)),
            );
    }
}
