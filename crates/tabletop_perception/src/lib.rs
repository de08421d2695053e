//! The robot's eyes in the simulation: where it believes that the objects are, by the pictures of its head camera alone.
//!
//! [`PerceptionPlugin`] looks at each picture that the head camera takes, as long as somebody [demands](PerceptionDemand) it. The robot knows the shapes and colours of
//! the objects, the joints between them, and its own posture; poses it sees ([`tabletop_vision`]).

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod eyesight;

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::prelude::*;
use tabletop_core::{PictureSystems, SensorImage, SimSystems, SimTick};
use tabletop_vision::ObjectPercept;

use eyesight::Eyesight;

/// The robot's eyes. Needs the head camera's pictures: `tabletop_camera::CameraPlugin`.
#[derive(Clone, Copy, Debug, Default)]
pub struct PerceptionPlugin;

/// The objects as the robot believes them to be.
#[derive(Resource, Clone, Debug, Default)]
pub struct Perception {
    /// The tick of the picture in which they were seen.
    pub tick: SimTick,
    /// The objects, in the order of their creation.
    pub objects: Vec<PerceivedObject>,
}

/// An object as the robot believes it to be.
#[derive(Clone, Debug, PartialEq)]
pub struct PerceivedObject {
    /// Its id.
    pub id: String,
    /// The object.
    pub object: Entity,
    /// What was seen of it.
    pub seen: ObjectPercept,
}

/// The demand for perception of the next picture. Asking twice is the same as asking once; without a demand the eyes are closed.
#[derive(Resource, Debug, Default)]
pub struct PerceptionDemand(AtomicBool);

impl PerceptionDemand {
    /// Asks for perception of the next picture.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn is_asked(demand: Res<Self>) -> bool {
        demand.0.load(Ordering::Relaxed)
    }
}

impl Plugin for PerceptionPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Perception>()
            .init_resource::<PerceptionDemand>()
            .init_resource::<SensorImage>()
            .init_resource::<Eyesight>()
            .add_systems(
                FixedUpdate,
                eyesight::perceive
                    .after(PictureSystems)
                    .before(SimSystems::Record)
                    .run_if(PerceptionDemand::is_asked.and_then(resource_changed::<SensorImage>)),
            );
    }
}
