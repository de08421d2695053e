//! The choice of what an episode holds.

/// The choice of what an episode holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EpisodeSelection {
    /// The state; `None` for that of what acts.
    pub state: Option<StateKind>,
    /// The action; `None` for that of what acts: the robot if one of its joints moves, otherwise the hands.
    pub action: Option<ActionKind>,
}

/// The kind of state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateKind {
    /// Positions of the robot's joints, in rad; of grippers, their opening in units.
    Robot,
    /// Poses of the objects, and places and grips of the hands.
    Objects,
    /// Those of the robot, then those of the objects.
    Both,
}

/// The kind of action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionKind {
    /// The motion of each hand until the next frame: along X, Y and Z in units, about them in rad, and 1 while it holds something.
    Hands,
    /// The positions of the robot's joints in the next frame.
    Joints,
}
