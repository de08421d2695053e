//! The head camera and its pictures.

use std::{
    f32::consts::FRAC_PI_3,
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::Pose;

use crate::{CameraCarrier, Light, Paused, Picture, SimTick, picture::fault_of_view};

/// The settings of the robot's head camera (report section 4, "head camera").
///
/// Its pose follows from the table, in front of which the robot stands, unless [`mount`](Self::mount) gives one.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(Resource)]
pub struct HeadCamera {
    /// Angle of the neck joint H0 in radians; positive turns the view to the robot's left.
    pub pan: f32,
    /// Angle between the lower and upper edges of the picture in radians, above 0 and below π.
    pub vertical_fov: f32,
    /// Makes the angle between the left and right edges equal to [`vertical_fov`](Self::vertical_fov), at any size
    /// of the picture. Its pixels are then not square, as in the pictures of the original program.
    pub square_fov: bool,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Smooths edges by four samples a pixel.
    pub antialiasing: bool,
    /// The robot that carries it.
    #[serde(default, skip_serializing_if = "is_baxter")]
    pub carrier: CameraCarrier,
    /// Pose of a camera that is not on the robot's head: it looks along its own -Z, with its Y up. Lengths in units.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mount: Option<Pose>,
    /// The light in its pictures. The window shows everything in the [usual one](crate::LIGHT).
    #[serde(default, skip_serializing_if = "is_usual")]
    pub light: Light,
}

impl HeadCamera {
    /// The fault of settings that make no sense.
    pub fn fault(&self) -> Option<String> {
        let fault = fault_of_view(self.width, self.height, self.vertical_fov);
        if fault.is_some() {
            return fault;
        }
        let is_finite = self.pan.is_finite()
            && self.carrier.is_within(CameraCarrier::FARTHEST)
            && self.mount.is_none_or(|mount| {
                mount.location.is_finite() && (mount.rotation.length_squared() - 1.0).abs() < 0.01
            });
        if !is_finite {
            return Some("it is nowhere: a number is not finite, or its rotation is none".into());
        }
        self.light.fault()
    }
}

fn is_usual(light: &Light) -> bool {
    *light == Light::default()
}

fn is_baxter(carrier: &CameraCarrier) -> bool {
    *carrier == CameraCarrier::default()
}

impl Default for HeadCamera {
    fn default() -> Self {
        Self {
            pan: 0.0,
            vertical_fov: FRAC_PI_3,
            square_fov: false,
            width: 200,
            height: 150,
            antialiasing: true,
            carrier: CameraCarrier::default(),
            mount: None,
            light: Light::default(),
        }
    }
}

/// The last picture of the head camera. Before the first one it has no pixels.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct SensorImage {
    /// The tick at whose end it was taken.
    pub tick: SimTick,
    /// The picture. That of a real camera has neither depth nor objects.
    pub picture: Picture,
    /// When a real camera's picture arrived, on the clock of its connection; `None` for one that was drawn.
    pub received: Option<Duration>,
    /// The entities behind the numbers in [`Picture::objects`]: number 1 is the first entity, and so on. The table comes first,
    /// if there is one, then the objects in the order of their creation, then the figures likewise.
    pub shown: Vec<Entity>,
}

impl SensorImage {
    /// The table or object at the centre of a pixel.
    pub fn shown_at(&self, column: u32, row: u32) -> Option<Entity> {
        let number = *self.picture.objects.get(self.picture.index(column, row)?)?;
        self.shown.get((number as usize).checked_sub(1)?).copied()
    }
}

/// A request to the head camera for a picture at the end of a tick. Without a request it takes none.
///
/// Ask before [`SimSystems::Sense`](crate::SimSystems::Sense); the [`SensorImage`] is ready in
/// [`SimSystems::Record`](crate::SimSystems::Record) of the same tick. Asking needs only shared access, and asking
/// twice is the same as asking once, so the order of the systems that ask does not matter. While the simulation stands still, a
/// request waits, unless it is [insisted](Self::insist) on.
#[derive(Resource, Debug, Default)]
pub struct PictureDemand {
    is_asked: AtomicBool,
    is_insisted: AtomicBool,
}

impl PictureDemand {
    /// Asks for a picture of this tick.
    pub fn ask(&self) {
        self.is_asked.store(true, Ordering::Relaxed);
    }

    /// Asks for a picture of this tick, even if the simulation is paused.
    pub fn insist(&self) {
        self.ask();
        self.is_insisted.store(true, Ordering::Relaxed);
    }

    /// True if a picture was asked for.
    pub(crate) fn is_asked(&self) -> bool {
        self.is_asked.load(Ordering::Relaxed)
    }

    /// Takes the request back; true if there was one.
    pub fn take(&mut self) -> bool {
        *self.is_insisted.get_mut() = false;
        std::mem::take(self.is_asked.get_mut())
    }

    /// Run condition: the simulation is running, or a system insists.
    pub(crate) fn is_due(demand: Option<Res<Self>>, paused: Res<Paused>) -> bool {
        !paused.0 || demand.is_some_and(|demand| demand.is_insisted.load(Ordering::Relaxed))
    }
}

/// The systems that take the picture, in order, after [`SimSystems::Sense`](crate::SimSystems::Sense) and before
/// [`SimSystems::Record`](crate::SimSystems::Record).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PictureSystems {
    /// A real camera gives its newest picture, and takes the demand for it.
    Receive,
    /// Cameras of the simulation draw what is still asked for.
    Draw,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn asking_twice_is_asking_once() {
        let mut demand = PictureDemand::default();
        assert!(!demand.take());
        demand.ask();
        demand.ask();
        assert!(demand.take());
        assert!(!demand.take());
    }

    #[test]
    fn a_number_stands_for_an_entity() {
        let mut world = World::new();
        let [table, block] = std::array::from_fn(|_| world.spawn_empty().id());
        let mut image = SensorImage {
            shown: vec![table, block],
            ..default()
        };
        image.picture.resize(4, 1);
        image.picture.objects.copy_from_slice(&[0, 1, 2, 3]);
        let shown = [0, 1, 2, 3, 4].map(|column| image.shown_at(column, 0));
        assert_eq!(shown, [None, Some(table), Some(block), None, None]);
    }
}
