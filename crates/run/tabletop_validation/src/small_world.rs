//! Small worlds, in which experiments take place.

use bevy::{
    math::{DQuat, DVec3},
    prelude::*,
};
use tabletop_core::{
    ClockCommand, ObjectIndex, SceneCommand, SceneItem, SceneSpec, SimCommand, TICK_SECONDS,
    TICKS_PER_SECOND, Table, WriteCommand as _, step_world,
};
use tabletop_geometry::{Pose, Twist};
use tabletop_physics::{PhysicsPlugin, PhysicsSettings, push};
use tabletop_sim::{TabletopSimPlugins, headless_world};

use crate::specimen::Specimen;

/// Gravity by default, in units/s².
pub(crate) const G: f64 = PhysicsSettings::DEFAULT.gravity as f64;

/// The settings of every shipped world.
pub(crate) const SHIPPED: PhysicsSettings = PhysicsSettings::DEFAULT;

/// The shipped settings without the rates at which rotations die away.
pub(crate) const UNDAMPED: PhysicsSettings = PhysicsSettings {
    angular_damping: 0.0,
    rolling_damping: 0.0,
    link_damping: 0.0,
    ..SHIPPED
};

/// Length of a tick in s.
pub(crate) const TICK: f64 = TICK_SECONDS as f64;

/// A table, large enough for every way, where time has not begun.
const TABLE: Table = Table {
    xspan: 100.0,
    yspan: 100.0,
};

/// The whole simulator without a window, with a few objects.
pub(crate) struct SmallWorld {
    world: World,
    gravity: f64,
}

impl SmallWorld {
    pub fn new(settings: PhysicsSettings, specimens: &[Specimen]) -> Self {
        let items = specimens
            .iter()
            .map(|specimen| SceneItem::Object(specimen.spec.clone()));
        let mut world = Self::with_items(settings, items.collect());
        for Specimen { spec, spin } in specimens {
            if *spin != Vec3::ZERO {
                let object = world.entity(&spec.id);
                push(&mut world.world, object, Vec3::ZERO, *spin);
            }
        }
        world
    }

    pub fn with_items(settings: PhysicsSettings, items: Vec<SceneItem>) -> Self {
        let physics = PhysicsPlugin { settings };
        let mut world = headless_world(TabletopSimPlugins.build().set(physics));
        let scene = SceneSpec {
            table: TABLE,
            items,
        };
        world.write_command(ClockCommand::SetPaused(true));
        world.write_command(SceneCommand::Set(Box::new(scene)));
        step_world(&mut world, 1);
        world.write_command(ClockCommand::SetPaused(false));
        Self {
            world,
            gravity: f64::from(settings.gravity),
        }
    }

    /// Gives a command for the next tick.
    pub fn command(&mut self, command: impl Into<SimCommand>) {
        self.world.write_command(command);
    }

    pub fn step(&mut self, ticks: u64) {
        step_world(&mut self.world, ticks);
    }

    pub fn seconds(&mut self, seconds: f64) {
        self.step(ticks(seconds));
    }

    /// Simulates tick by tick and sees the world after each.
    pub fn watch(&mut self, seconds: f64, mut see: impl FnMut(&Self)) {
        for _ in 0..ticks(seconds) {
            self.step(1);
            see(self);
        }
    }

    fn entity(&self, id: &str) -> Entity {
        let object = self.world.resource::<ObjectIndex>().get(id);
        object.unwrap_or(Entity::PLACEHOLDER)
    }

    /// The pose of an object; far away if there is none.
    pub fn pose(&self, id: &str) -> Pose {
        let place = self.world.get::<Transform>(self.entity(id));
        place.map_or(Pose::at(Vec3::NAN), Pose::from)
    }

    pub fn location(&self, id: &str) -> DVec3 {
        self.pose(id).location.as_dvec3()
    }

    pub fn rotation(&self, id: &str) -> DQuat {
        self.pose(id).rotation.as_dquat()
    }

    pub fn twist(&self, id: &str) -> Twist {
        let twist = self.world.get::<Twist>(self.entity(id));
        twist.copied().unwrap_or_default()
    }

    pub fn velocity(&self, id: &str) -> DVec3 {
        self.twist(id).linear.as_dvec3()
    }

    pub fn spin(&self, id: &str) -> DVec3 {
        self.twist(id).angular.as_dvec3()
    }

    /// The energy of an object above its place at a height of 0, in kg units²/s².
    pub fn energy(&self, specimen: &Specimen) -> f64 {
        let id = &specimen.spec.id;
        let spin = self.spin(id);
        let turning = specimen.angular_momentum(self.rotation(id), spin).dot(spin);
        let moving = specimen.mass() * self.velocity(id).length_squared();
        specimen.mass() * self.gravity * self.location(id).z + (moving + turning) / 2.0
    }
}

/// The number of ticks in a time.
fn ticks(seconds: f64) -> u64 {
    (seconds * f64::from(TICKS_PER_SECOND)).round() as u64
}
