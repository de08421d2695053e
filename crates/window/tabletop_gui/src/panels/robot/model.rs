//! The content of the Robot window, and the user's input.

use tabletop_core::{Face, JointId, Robot, RobotLayout};
use tabletop_input::Directions;
use tabletop_user::{Connection, ConnectionOrder, Keymap};

/// The content of the window.
#[derive(Clone, Copy)]
pub(super) struct Model<'a> {
    pub robot: &'a Robot,
    pub layout: &'a RobotLayout,
    /// Ids of the objects in the grippers, by limb.
    pub held: &'a [Vec<&'a str>],
    pub shows_head_view: bool,
    /// True if a script moves the arms.
    pub is_scripted: bool,
    pub keymap: &'a Keymap,
    /// The real robot.
    pub connection: &'a Connection,
}

impl Model<'_> {
    /// True if the user can move a joint.
    pub fn is_free(&self, joint: JointId) -> bool {
        !self.is_scripted || self.layout.neck == Some(joint)
    }
}

/// The user's input to the window.
#[derive(Default)]
pub(super) struct RobotInput {
    pub pressed: PressedButtons,
    pub requests: Vec<Request>,
}

/// The directions in which the buttons move the joints.
#[derive(Default)]
pub(super) struct PressedButtons {
    /// Those that are held down.
    pub held: Directions,
    /// Those that have gone down in this frame.
    pub struck: Directions,
}

/// A wish of the user to the window.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Request {
    ShowRobot(bool),
    ToggleHeadView,
    ToggleScript,
    /// Bring all joints back to where they stood at the start.
    GoHome,
    /// Bring a joint to an angle in rad, or an opening in units.
    Go(JointId, f64),
    ShowFace(Face),
    Connection(ConnectionOrder),
}
