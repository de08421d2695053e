//! The phases of a tick: which systems run in which order.

use bevy::prelude::*;

/// Everything of a tick: whatever is in [`FixedUpdate`] and in none of the [`OrderSystems`]. Does not run while
/// [`SimBlocked`](crate::SimBlocked) is set.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TickSystems;

/// The phases of a tick, in their order, all in the [`FixedUpdate`] schedule.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SimSystems {
    /// Commands that name files become commands that hold their content.
    Load,
    /// Commands, scenarios and scripts are carried out: things appear, disappear and get targets. Runs while paused, too.
    Ingest,
    /// Hands, joints and grippers turn targets into kinematic poses and motor commands.
    Actuate,
    /// The physics engine makes one step.
    Physics,
    /// Global transforms are brought up to this tick. Runs while paused, too.
    Propagate,
    /// Contacts, grips and forward kinematics are read from the new state; then [the picture is taken](crate::PictureSystems).
    Sense,
    /// Recorders and scripts get what this tick brought.
    Record,
    /// [`SimTick`](crate::SimTick) moves on.
    Advance,
}

/// Who gives commands for the tick that begins, in this order, before [`TickSystems`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OrderSystems {
    /// Scenarios.
    Scenario,
    /// What a user holds down: keys and buttons.
    User,
    /// Scripts.
    Script,
}

/// The phases in which commands are carried out, in this order, after [`SimSystems::Load`] and before [`SimSystems::Actuate`].
/// [`SimCommand::phase`](crate::SimCommand::phase) says which command has which. They run while paused, too.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CommandSystems {
    /// Recordings begin.
    Recording,
    /// The clock is stopped, or runs on.
    Clock,
    /// Objects appear and go. It is part of [`SimSystems::Ingest`].
    Scene,
    /// Undo and redo.
    History,
    /// The demonstrator's hands.
    Hands,
    /// Controls and bonds.
    Mechanisms,
    /// The robot.
    Robot,
}

/// Who moves things in [`SimSystems::Actuate`], in this order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ActuateSystems {
    /// The demonstrator's hands.
    Hands,
    /// The robot.
    Robot,
}
