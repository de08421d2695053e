//! The phases of a tick: the order in which its systems run.

use bevy::prelude::*;

/// All systems of a tick: everything in [`FixedUpdate`] outside the [`OrderSystems`]. They do not run while
/// [`SimBlocked`](crate::SimBlocked) is set.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TickSystems;

/// The phases of a tick, in their order, all in the [`FixedUpdate`] schedule.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SimSystems {
    /// Commands that name files become commands that hold the files' contents.
    Load,
    /// Commands are carried out: objects appear and disappear, joints get targets. Runs while paused, too.
    Ingest,
    /// Hands, joints and grippers turn targets into kinematic poses and motor commands.
    Actuate,
    /// Rapier makes one step.
    Physics,
    /// Global transforms are brought up to this tick. Runs while paused, too.
    Propagate,
    /// Contacts, grips and forward kinematics are read from the new state. Then [the picture is taken](crate::PictureSystems).
    Sense,
    /// Recorders and scripts receive the results of this tick.
    Record,
    /// [`SimTick`](crate::SimTick) advances.
    Advance,
}

/// The givers of commands for the tick that is beginning, in order, before [`TickSystems`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OrderSystems {
    /// Scenarios.
    Scenario,
    /// Keys and buttons that the user holds down.
    User,
    /// The controller that acts for the robot.
    Controller,
    /// Scripts.
    Script,
}

/// The phases in which commands are carried out, in order. The first comes before [`SimSystems::Load`], the others between it and
/// [`SimSystems::Actuate`]. [`SimCommand::phase`](crate::SimCommand::phase) assigns them. They run while paused, too.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CommandSystems {
    /// Undo and redo, between two ticks: [`SimTick`](crate::SimTick) is turned before anything else is done in a tick.
    History,
    /// Recordings begin.
    Recording,
    /// The clock is paused or resumed.
    Clock,
    /// Objects appear and disappear. Part of [`SimSystems::Ingest`].
    Scene,
    /// The demonstrator's hands.
    Hands,
    /// Controls and bonds.
    Mechanisms,
    /// The robot.
    Robot,
}

/// The parts of [`CommandSystems::Mechanisms`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MechanismSystems {
    /// Commands are carried out.
    Obey,
    /// Controls react to contacts, and bonds to turns; not while paused.
    React,
}

/// The parts of [`SimSystems::Actuate`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ActuateSystems {
    /// The demonstrator's hands.
    Hands,
    /// The robot.
    Robot,
}
