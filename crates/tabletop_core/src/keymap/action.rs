//! What keys do.

use std::fmt;

use bevy_input::keyboard::KeyCode::{self, *};

use super::{KeyBinding, Modifiers};
use crate::{Arm, JointLayout, JointRole, RobotJoint};

/// Something that a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Action {
    /// Pause, resume (report section 2.4).
    Pause,
    /// Quit (report section 2.4).
    Quit,
    /// Simulate one tick of a pause.
    Step,
    /// Simulate more slowly.
    Slower,
    /// Simulate faster.
    Faster,
    /// Move the camera along its direction of view (report section 3).
    CameraForward,
    /// The other way.
    CameraBack,
    /// Move the camera to its left.
    CameraLeft,
    /// Move the camera to its right.
    CameraRight,
    /// Raise the camera.
    CameraUp,
    /// Lower the camera.
    CameraDown,
    /// Turn the camera to its left.
    LookLeft,
    /// Turn the camera to its right.
    LookRight,
    /// Tilt the camera up.
    LookUp,
    /// Tilt the camera down.
    LookDown,
    /// Look at the table from where the camera starts.
    ViewStart,
    /// Look at the table from above.
    ViewTop,
    /// Look at the table from its front edge.
    ViewFront,
    /// Look at the table from where the robot's head is.
    ViewRobotEye,
    /// Turn the drag plane counter-clockwise (report section 4.3).
    PlaneCounterClockwise,
    /// Turn the drag plane clockwise.
    PlaneClockwise,
    /// Show the plane at right angles while held down.
    PlanePerpendicular,
    /// Discard the present segment of the recording (report section 4.1).
    Undo,
    /// Bring back the segment that was undone last.
    Redo,
    /// Make a big block (report section 6.1).
    MakeBlock,
    /// Make a stack of five blocks (report section 6.1).
    MakeStack,
    /// Remove every object that nobody holds (report section 6.1).
    ClearTable,
    /// Choose a task file or a recording and open it.
    OpenFile,
    /// Save what is on the table as a task file.
    SaveFile,
    /// Show, hide the robot (report section 5).
    ShowRobot,
    /// Show, hide what the robot sees (report section 5).
    ShowHeadView,
    /// Save what the robot sees as a picture (report section 5).
    SaveHeadView,
    /// Show the robot's next face.
    ShowNextFace,
    /// Start, stop the script that drives the robot (report section 5.2).
    RunScript,
    /// Move a joint of the robot while held down (report section 5.1).
    Move(RobotJoint, Way),
    /// Show, hide what the keys do.
    ShowHelp,
    /// Fill the screen with the window, or no longer.
    FillScreen,
    /// Draw panels and texts larger.
    DrawLarger,
    /// Draw panels and texts smaller.
    DrawSmaller,
    /// Draw panels and texts as large as fits the window.
    DrawToFit,
}

/// One of the two ways in which a joint moves, with the signs of manual control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Way {
    /// As the button + moves it: a gripper opens.
    Plus,
    /// As the button − moves it: a gripper closes.
    Minus,
}

/// What an action belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum ActionGroup {
    Simulation,
    Camera,
    Demonstration,
    Objects,
    Robot,
    RightArm,
    LeftArm,
    Window,
}

/// When an action can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Situation {
    /// Always.
    Any,
    /// While the selected hand holds something. Then its keys come before those of [`Any`](Self::Any).
    Holding,
}

/// A line of the table of actions.
struct ActionRow {
    group: ActionGroup,
    name: &'static str,
    label: &'static str,
    tooltip: &'static str,
    keys: Vec<KeyBinding>,
}

/// Actions without a joint.
const PLAIN: [Action; 39] = [
    Action::Pause,
    Action::Quit,
    Action::Step,
    Action::Slower,
    Action::Faster,
    Action::CameraForward,
    Action::CameraBack,
    Action::CameraLeft,
    Action::CameraRight,
    Action::CameraUp,
    Action::CameraDown,
    Action::LookLeft,
    Action::LookRight,
    Action::LookUp,
    Action::LookDown,
    Action::ViewStart,
    Action::ViewTop,
    Action::ViewFront,
    Action::ViewRobotEye,
    Action::PlaneCounterClockwise,
    Action::PlaneClockwise,
    Action::PlanePerpendicular,
    Action::Undo,
    Action::Redo,
    Action::MakeBlock,
    Action::MakeStack,
    Action::ClearTable,
    Action::OpenFile,
    Action::SaveFile,
    Action::ShowRobot,
    Action::ShowHeadView,
    Action::SaveHeadView,
    Action::ShowNextFace,
    Action::RunScript,
    Action::ShowHelp,
    Action::FillScreen,
    Action::DrawLarger,
    Action::DrawSmaller,
    Action::DrawToFit,
];

/// The joints in the order in which their keys lie on the keyboard.
const JOINTS: [RobotJoint; 17] = [
    RobotJoint::RightW2,
    RobotJoint::RightW1,
    RobotJoint::RightW0,
    RobotJoint::RightE1,
    RobotJoint::RightE0,
    RobotJoint::RightS1,
    RobotJoint::RightS0,
    RobotJoint::RightGripper,
    RobotJoint::LeftW2,
    RobotJoint::LeftW1,
    RobotJoint::LeftW0,
    RobotJoint::LeftE1,
    RobotJoint::LeftE0,
    RobotJoint::LeftS1,
    RobotJoint::LeftS0,
    RobotJoint::LeftGripper,
    RobotJoint::HeadPan,
];

const fn all() -> [Action; PLAIN.len() + 2 * JOINTS.len()] {
    let mut all = [Action::Pause; PLAIN.len() + 2 * JOINTS.len()];
    let mut i = 0;
    while i < PLAIN.len() {
        all[i] = PLAIN[i];
        i += 1;
    }
    let mut j = 0;
    while j < JOINTS.len() {
        all[i] = Action::Move(JOINTS[j], Way::Plus);
        all[i + 1] = Action::Move(JOINTS[j], Way::Minus);
        i += 2;
        j += 1;
    }
    all
}

impl ActionGroup {
    /// All groups, in the order in which they are listed.
    pub const ALL: [Self; 8] = [
        Self::Simulation,
        Self::Camera,
        Self::Demonstration,
        Self::Objects,
        Self::Robot,
        Self::RightArm,
        Self::LeftArm,
        Self::Window,
    ];

    /// Its name on the screen.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Simulation => "Simulation",
            Self::Camera => "Camera",
            Self::Demonstration => "Demonstration",
            Self::Objects => "Objects",
            Self::Robot => "Robot",
            Self::RightArm => "Right arm",
            Self::LeftArm => "Left arm",
            Self::Window => "Window",
        }
    }

    /// What belongs to it.
    pub fn actions(self) -> impl Iterator<Item = Action> {
        let all = Action::ALL.into_iter();
        all.filter(move |action| action.group() == self)
    }
}

impl Action {
    /// All actions.
    pub const ALL: [Self; PLAIN.len() + 2 * JOINTS.len()] = all();

    /// Its name in files: `pause`, `right_w2+`.
    pub fn name(self) -> String {
        if let Self::Move(joint, way) = self {
            format!("{joint}{}", way.sign())
        } else {
            self.row().name.to_owned()
        }
    }

    /// The action with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|action| action.name() == name)
    }

    /// The action whose keys move a joint of the robot: Baxter's joints have them, and joints of other robots that have the same keys.
    pub fn moving(joint: &JointLayout, way: Way) -> Option<Self> {
        let own = RobotJoint::ALL
            .into_iter()
            .find(|own| own.layout().keys == joint.keys)?;
        (!joint.keys[0].is_empty()).then_some(Self::Move(own, way))
    }

    /// What it does, in a few words.
    pub fn label(self) -> String {
        match (self, self.row().label) {
            (Self::Move(joint, way), label) if !joint.layout().is_gripper() => {
                format!("{label} {}", way.sign())
            }
            (_, label) => label.to_owned(),
        }
    }

    /// What it does, in a sentence.
    pub fn tooltip(self) -> &'static str {
        self.row().tooltip
    }

    /// What it belongs to.
    pub fn group(self) -> ActionGroup {
        self.row().group
    }

    /// The keys that do it unless the user binds others.
    pub fn default_bindings(self) -> Vec<KeyBinding> {
        self.row().keys
    }

    /// When it can be asked for.
    pub const fn situation(self) -> Situation {
        match self {
            Self::PlaneCounterClockwise | Self::PlaneClockwise | Self::PlanePerpendicular => {
                Situation::Holding
            }
            Self::CameraForward
            | Self::CameraBack
            | Self::CameraLeft
            | Self::CameraRight
            | Self::CameraUp
            | Self::CameraDown
            | Self::LookLeft
            | Self::LookRight
            | Self::LookUp
            | Self::LookDown
            | Self::Move(..)
            | Self::Pause
            | Self::Quit
            | Self::Step
            | Self::Slower
            | Self::Faster
            | Self::ViewStart
            | Self::ViewTop
            | Self::ViewFront
            | Self::ViewRobotEye
            | Self::Undo
            | Self::Redo
            | Self::MakeBlock
            | Self::MakeStack
            | Self::ClearTable
            | Self::OpenFile
            | Self::SaveFile
            | Self::ShowRobot
            | Self::ShowHeadView
            | Self::SaveHeadView
            | Self::ShowNextFace
            | Self::RunScript
            | Self::ShowHelp
            | Self::FillScreen
            | Self::DrawLarger
            | Self::DrawSmaller
            | Self::DrawToFit => Situation::Any,
        }
    }

    /// Whether it goes on while its key is held down; others are done once a press.
    pub const fn is_continuous(self) -> bool {
        match self {
            Self::CameraForward
            | Self::CameraBack
            | Self::CameraLeft
            | Self::CameraRight
            | Self::CameraUp
            | Self::CameraDown
            | Self::LookLeft
            | Self::LookRight
            | Self::LookUp
            | Self::LookDown
            | Self::PlaneCounterClockwise
            | Self::PlaneClockwise
            | Self::PlanePerpendicular
            | Self::Move(..) => true,
            Self::Pause
            | Self::Quit
            | Self::Step
            | Self::Slower
            | Self::Faster
            | Self::ViewStart
            | Self::ViewTop
            | Self::ViewFront
            | Self::ViewRobotEye
            | Self::Undo
            | Self::Redo
            | Self::MakeBlock
            | Self::MakeStack
            | Self::ClearTable
            | Self::OpenFile
            | Self::SaveFile
            | Self::ShowRobot
            | Self::ShowHeadView
            | Self::SaveHeadView
            | Self::ShowNextFace
            | Self::RunScript
            | Self::ShowHelp
            | Self::FillScreen
            | Self::DrawLarger
            | Self::DrawSmaller
            | Self::DrawToFit => false,
        }
    }

    /// The table from which input, help, tooltips and documentation are made.
    fn row(self) -> ActionRow {
        use ActionGroup::{Camera, Demonstration, Objects, Robot, Simulation, Window};
        let row = |group, name, label, tooltip, keys| ActionRow {
            group,
            name,
            label,
            tooltip,
            keys,
        };
        #[rustfmt::skip]
        let row = match self {
            Self::Pause => row(Simulation, "pause", "Pause, resume", "Stops the simulation, or lets it run on", vec![plain(Space)]),
            Self::Step => row(Simulation, "step", "One step", "Pauses, and simulates a sixtieth of a second", vec![plain(Period)]),
            Self::Slower => row(Simulation, "slower", "Slower", "Halves the pace of the simulation", vec![shift(Comma)]),
            Self::Faster => row(Simulation, "faster", "Faster", "Doubles the pace of the simulation", vec![shift(Period)]),
            Self::Quit => row(Simulation, "quit", "Quit", "Closes what is open over the window; else ends the program", vec![plain(Escape)]),

            Self::CameraForward => row(Camera, "camera_forward", "Forward", "Moves the camera along its direction of view", vec![plain(KeyW)]),
            Self::CameraBack => row(Camera, "camera_back", "Back", "Moves the camera against its direction of view", vec![plain(KeyS)]),
            Self::CameraLeft => row(Camera, "camera_left", "Left", "Moves the camera to its left", vec![plain(KeyA)]),
            Self::CameraRight => row(Camera, "camera_right", "Right", "Moves the camera to its right", vec![plain(KeyD)]),
            Self::CameraUp => row(Camera, "camera_up", "Up", "Raises the camera", vec![plain(KeyQ)]),
            Self::CameraDown => row(Camera, "camera_down", "Down", "Lowers the camera", vec![plain(KeyZ)]),
            Self::LookLeft => row(Camera, "look_left", "Look left", "Turns the camera to its left", vec![plain(ArrowLeft)]),
            Self::LookRight => row(Camera, "look_right", "Look right", "Turns the camera to its right", vec![plain(ArrowRight)]),
            Self::LookUp => row(Camera, "look_up", "Look up", "Tilts the camera up", vec![plain(ArrowUp)]),
            Self::LookDown => row(Camera, "look_down", "Look down", "Tilts the camera down", vec![plain(ArrowDown)]),
            Self::ViewStart => row(Camera, "view_start", "View: start", "Looks at the table from where the camera starts", vec![plain(Digit3), plain(Home)]),
            Self::ViewTop => row(Camera, "view_top", "View: top", "Looks at the table from above", vec![plain(Digit4)]),
            Self::ViewFront => row(Camera, "view_front", "View: front", "Looks at the table from its front edge", vec![plain(Digit5)]),
            Self::ViewRobotEye => row(Camera, "view_robot_eye", "View: robot's eye", "Looks at the table from where the robot's head is", vec![plain(Digit6)]),

            Self::PlaneCounterClockwise => row(Demonstration, "plane_counter_clockwise", "Plane CCW", "Turns the drag plane counter-clockwise", vec![plain(Slash)]),
            Self::PlaneClockwise => row(Demonstration, "plane_clockwise", "Plane CW", "Turns the drag plane clockwise", vec![shift(Slash)]),
            Self::PlanePerpendicular => row(Demonstration, "plane_perpendicular", "Plane at right angles", "Shows the drag plane at right angles", vec![plain(ControlLeft)]),
            Self::Undo => row(Demonstration, "undo", "Undo", "Discards the present segment of the recording", vec![ctrl(KeyZ)]),
            Self::Redo => row(Demonstration, "redo", "Redo", "Brings back the segment that was undone last", vec![ctrl_shift(KeyZ), ctrl(KeyY)]),

            Self::MakeBlock => row(Objects, "make_block", "Big block", "Makes a big block somewhere on the table", vec![plain(KeyB)]),
            Self::MakeStack => row(Objects, "make_stack", "Stack of five", "Makes a stack of five blocks somewhere on the table", vec![plain(KeyN)]),
            Self::ClearTable => row(Objects, "clear_table", "Clear the table", "Removes every object that nobody holds", vec![plain(KeyC)]),
            Self::OpenFile => row(Objects, "open_file", "Open a file", "Opens a task file or a recording", vec![ctrl(KeyO)]),
            Self::SaveFile => row(Objects, "save_file", "Save as a file", "Saves what is on the table as a task file", vec![ctrl(KeyS)]),

            Self::ShowRobot => row(Robot, "show_robot", "Show, hide", "Puts the robot to the table, or takes it away", vec![plain(KeyR)]),
            Self::ShowHeadView => row(Robot, "show_head_view", "Head view", "Shows or hides what the robot sees", vec![plain(Digit1)]),
            Self::SaveHeadView => row(Robot, "save_head_view", "Save the head view", "Saves what the robot sees as a picture", vec![plain(Digit2)]),
            Self::ShowNextFace => row(Robot, "show_next_face", "Next face", "Shows the robot's next face", vec![plain(Backslash)]),
            Self::RunScript => row(Robot, "run_script", "Script on, off", "Starts the script that drives the robot, or stops it", vec![plain(KeyM)]),

            Self::ShowHelp => row(Window, "show_help", "Help", "Shows or hides what the keys do", vec![plain(F1), shift(Slash)]),
            Self::FillScreen => row(Window, "fill_screen", "Full screen", "Fills the screen with the window, or no longer", vec![plain(F11)]),
            Self::DrawLarger => row(Window, "draw_larger", "Larger", "Draws everything larger", vec![ctrl(Equal), ctrl(NumpadAdd)]),
            Self::DrawSmaller => row(Window, "draw_smaller", "Smaller", "Draws everything smaller", vec![ctrl(KeyCode::Minus), ctrl(NumpadSubtract)]),
            Self::DrawToFit => row(Window, "draw_to_fit", "Fit the window", "Draws everything as large as fits the window", vec![ctrl(Digit0), ctrl(Numpad0)]),

            Self::Move(joint, way) => row_of_joint(joint, way),
        };
        row
    }
}

/// Joints have a key each, which with Shift moves them the other way; grippers have two (report section 5.1).
fn row_of_joint(joint: RobotJoint, way: Way) -> ActionRow {
    let JointLayout {
        role, label, keys, ..
    } = joint.layout();
    let [plus, minus] = keys;
    let (label, tooltip, keys) = match (role, way) {
        (JointRole::Gripper(_), Way::Plus) => ("Open gripper", "Opens the gripper", plus),
        (JointRole::Gripper(_), Way::Minus) => ("Close gripper", "Closes the gripper", minus),
        (_, Way::Plus) => (&**label, "Turns the joint", plus),
        (_, Way::Minus) => (&**label, "Turns the joint the other way", minus),
    };
    ActionRow {
        group: match joint.layout().limb() {
            Some(limb) if limb == Arm::Right.into() => ActionGroup::RightArm,
            Some(_) => ActionGroup::LeftArm,
            None => ActionGroup::Robot,
        },
        name: joint.name().as_str(),
        label,
        tooltip,
        keys: keys.clone(),
    }
}

const fn plain(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::NONE, key)
}

const fn shift(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::SHIFT, key)
}

const fn ctrl(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::CTRL, key)
}

const fn ctrl_shift(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::CTRL.with_shift(), key)
}

impl Way {
    /// The button that moves a joint this way: `+` or `-`.
    pub const fn sign(self) -> char {
        match self {
            Self::Plus => '+',
            Self::Minus => '-',
        }
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_action_is_listed_once_in_one_group() {
        let listed: BTreeSet<_> = Action::ALL.into_iter().collect();
        assert_eq!(listed.len(), Action::ALL.len());
        let grouped = ActionGroup::ALL.into_iter().flat_map(ActionGroup::actions);
        let mut grouped: Vec<_> = grouped.collect();
        grouped.sort();
        assert!(grouped.into_iter().eq(listed));
    }

    #[test]
    fn every_action_has_a_name_of_its_own() {
        for action in Action::ALL {
            assert_eq!(Action::from_name(&action.name()), Some(action));
        }
        assert_eq!(Action::from_name("right_w2"), None);
    }

    #[test]
    fn every_action_has_a_key_and_says_what_it_does() {
        for action in Action::ALL {
            assert!(!action.default_bindings().is_empty(), "{action}");
            assert!(!action.label().is_empty(), "{action}");
            assert!(!action.tooltip().is_empty(), "{action}");
        }
    }

    #[test]
    fn every_joint_has_keys_for_both_ways() {
        for joint in RobotJoint::ALL {
            for way in [Way::Plus, Way::Minus] {
                assert!(Action::ALL.contains(&Action::Move(joint, way)));
            }
        }
    }
}
