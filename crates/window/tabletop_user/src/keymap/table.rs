//! The table of actions: the source of input, help, tooltips and documentation.

use bevy_input::keyboard::KeyCode::{self, *};

use super::{
    BindingError, KeyBinding, Modifiers,
    action::{Action, Way},
};
use tabletop_core::{JointId, JointLayout, JointName, JointRole, LimbId, LimbLayout, RobotLayout};
use thiserror::Error;

/// A group of actions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum ActionGroup {
    Simulation,
    Camera,
    Demonstration,
    Chosen,
    Objects,
    Robot,
    Limb(LimbId),
    Window,
}

/// A situation in which actions are available.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Situation {
    /// Always.
    Any,
    /// While the selected hand holds something. Its keys then come before those of [`Any`](Self::Any).
    Holding,
    /// While an object is [chosen](crate::Chosen). Its keys then come before all others.
    Choosing,
}

/// A row of the table of actions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ActionRow {
    pub action: Action,
    pub group: ActionGroup,
    pub label: String,
    pub tooltip: &'static str,
    pub situation: Situation,
    pub is_continuous: bool,
    /// Its keys unless the user binds others.
    pub default_keys: Vec<KeyBinding>,
}

impl ActionRow {
    /// Makes the action continue while its key is held down; others are done once a press.
    fn continuous(self) -> Self {
        Self {
            is_continuous: true,
            ..self
        }
    }

    /// Makes it an action on the chosen object.
    fn while_choosing(self) -> Self {
        Self {
            situation: Situation::Choosing,
            ..self
        }
    }

    /// Makes it an action on the held object.
    fn while_holding(self) -> Self {
        Self {
            situation: Situation::Holding,
            ..self
        }
    }
}

/// A key in a robot's layout that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("joint {joint}: {source}")]
pub struct JointKeyError {
    /// The joint that it is to move.
    pub joint: JointName,
    /// The fault of the key.
    pub source: BindingError,
}

/// The table for a robot, and the keys of its joints that do not exist.
pub(super) fn rows(layout: &RobotLayout) -> (Vec<ActionRow>, Vec<JointKeyError>) {
    let mut rows = plain_rows();
    let mut faults = Vec::new();
    for joint in joints_by_place(layout) {
        rows.extend(rows_of_joint(layout.joint(joint), &mut faults));
    }
    (rows, faults)
}

/// The groups of a robot's actions with their names, in the order in which they are listed.
pub(super) fn groups(layout: &RobotLayout) -> Vec<(ActionGroup, String)> {
    use ActionGroup::{Camera, Chosen, Demonstration, Objects, Robot, Simulation, Window};
    let named = |group, name: &str| (group, name.to_owned());
    let mut groups = vec![
        named(Simulation, "Simulation"),
        named(Camera, "Camera"),
        named(Demonstration, "Demonstration"),
        named(Chosen, "Chosen object"),
        named(Objects, "Objects"),
        named(Robot, "Robot"),
    ];
    let limbs = layout.limbs.iter().enumerate();
    groups.extend(limbs.rev().map(|(i, LimbLayout { label: name, .. })| {
        let is_arm = name.to_lowercase().contains("arm");
        let name = if is_arm {
            name.clone()
        } else {
            format!("{name} arm")
        };
        (ActionGroup::Limb(LimbId(i as u8)), name)
    }));
    groups.push(named(Window, "Window"));
    groups
}

fn row(
    action: Action,
    group: ActionGroup,
    label: &str,
    tooltip: &'static str,
    default_keys: Vec<KeyBinding>,
) -> ActionRow {
    ActionRow {
        action,
        group,
        label: label.to_owned(),
        tooltip,
        situation: Situation::Any,
        is_continuous: false,
        default_keys,
    }
}

/// The actions that move no joint.
#[rustfmt::skip]
fn plain_rows() -> Vec<ActionRow> {
    use ActionGroup::{Camera, Chosen, Demonstration, Objects, Robot, Simulation, Window};
    vec![
        row(Action::Pause, Simulation, "Pause, resume", "Stops the simulation, or lets it run on", vec![plain(Space)]),
        row(Action::Step, Simulation, "One step", "Pauses, and simulates a sixtieth of a second", vec![plain(Period)]),
        row(Action::Slower, Simulation, "Slower", "Halves the pace of the simulation", vec![shift(Comma)]),
        row(Action::Faster, Simulation, "Faster", "Doubles the pace of the simulation", vec![shift(Period)]),
        row(Action::Quit, Simulation, "Quit", "Closes the open overlay, otherwise ends the program", vec![plain(Escape)]),

        row(Action::CameraForward, Camera, "Forward", "Moves the camera along its direction of view", vec![plain(KeyW)]).continuous(),
        row(Action::CameraBack, Camera, "Back", "Moves the camera against its direction of view", vec![plain(KeyS)]).continuous(),
        row(Action::CameraLeft, Camera, "Left", "Moves the camera to its left", vec![plain(KeyA)]).continuous(),
        row(Action::CameraRight, Camera, "Right", "Moves the camera to its right", vec![plain(KeyD)]).continuous(),
        row(Action::CameraUp, Camera, "Up", "Raises the camera", vec![plain(KeyQ)]).continuous(),
        row(Action::CameraDown, Camera, "Down", "Lowers the camera", vec![plain(KeyZ)]).continuous(),
        row(Action::LookLeft, Camera, "Look left", "Turns the camera to its left", vec![plain(ArrowLeft)]).continuous(),
        row(Action::LookRight, Camera, "Look right", "Turns the camera to its right", vec![plain(ArrowRight)]).continuous(),
        row(Action::LookUp, Camera, "Look up", "Tilts the camera up", vec![plain(ArrowUp)]).continuous(),
        row(Action::LookDown, Camera, "Look down", "Tilts the camera down", vec![plain(ArrowDown)]).continuous(),
        row(Action::ViewStart, Camera, "View: start", "Looks at the table from the camera's first place", vec![plain(Digit3), plain(Home)]),
        row(Action::ViewTop, Camera, "View: top", "Looks at the table from above", vec![plain(Digit4)]),
        row(Action::ViewFront, Camera, "View: front", "Looks at the table from its front edge", vec![plain(Digit5)]),
        row(Action::ViewRobotEye, Camera, "View: robot's eye", "Looks at the table from the robot's head", vec![plain(Digit6)]),

        row(Action::PlaneCounterClockwise, Demonstration, "Plane CCW", "Turns the drag plane counterclockwise", vec![plain(Slash)]).continuous().while_holding(),
        row(Action::PlaneClockwise, Demonstration, "Plane CW", "Turns the drag plane clockwise", vec![shift(Slash)]).continuous().while_holding(),
        row(Action::PlanePerpendicular, Demonstration, "Plane at right angles", "Shows the perpendicular drag plane", vec![plain(ControlLeft)]).continuous().while_holding(),
        row(Action::PlaneUpright, Demonstration, "Plane upright", "Shows the upright plane in place of the level one", vec![plain(ShiftLeft)]).continuous().while_holding(),
        row(Action::HandLeft, Demonstration, "Left hand", "Acts with the left hand from now on", vec![plain(Digit7)]),
        row(Action::HandRight, Demonstration, "Right hand", "Acts with the right hand from now on", vec![plain(Digit8)]),
        row(Action::HandBoth, Demonstration, "Both hands", "Acts with both hands from now on", vec![shift(Digit7)]),
        row(Action::HandAny, Demonstration, "Any hand", "Acts with whichever hand is free from now on", vec![shift(Digit8)]),
        row(Action::Record, Demonstration, "Record", "Begins a recording, or ends it", vec![ctrl(KeyR)]),
        row(Action::NameTake, Demonstration, "Name the takes", "Goes to the name of the next recordings", vec![ctrl(KeyN)]),
        row(Action::Undo, Demonstration, "Undo", "Takes back the present segment of the recording, the last change outside of one, or the last edit of an open one", vec![ctrl(KeyZ)]),
        row(Action::Redo, Demonstration, "Redo", "Brings back the segment, change or edit that was undone last", vec![ctrl_shift(KeyZ), ctrl(KeyY)]),
        row(Action::DeleteSegments, Demonstration, "Delete segments", "Deletes the selected segments of the open recording", vec![plain(Delete)]),
        row(Action::Trigger, Demonstration, "Trigger", "Presses the switch or other control under the cursor", vec![plain(KeyE)]),
        row(Action::PointTo, Demonstration, "Point to", "Points to the object under the cursor", vec![plain(KeyX)]),
        row(Action::Fasten, Demonstration, "Fasten", "Fastens the held object, or the one under the cursor, by a step", vec![plain(KeyF)]),
        row(Action::Loosen, Demonstration, "Loosen", "Loosens the held object, or the one under the cursor, by a step", vec![shift(KeyF)]),
        row(Action::Cut, Demonstration, "Cut", "Closes the held scissors, or those under the cursor", vec![shift(KeyE)]),

        row(Action::NextObject, Chosen, "Next object", "Chooses the next object for the keyboard", vec![plain(Tab)]),
        row(Action::PreviousObject, Chosen, "Previous object", "Chooses the object before it", vec![shift(Tab)]),
        row(Action::TakeOrRelease, Chosen, "Take, let go", "Takes the chosen object, or lets it go", vec![plain(Enter)]).while_choosing(),
        row(Action::ObjectLeft, Chosen, "Object left", "Moves the chosen object to the left", vec![plain(ArrowLeft)]).continuous().while_choosing(),
        row(Action::ObjectRight, Chosen, "Object right", "Moves the chosen object to the right", vec![plain(ArrowRight)]).continuous().while_choosing(),
        row(Action::ObjectAway, Chosen, "Object away", "Moves the chosen object away from you", vec![plain(ArrowUp)]).continuous().while_choosing(),
        row(Action::ObjectNearer, Chosen, "Object nearer", "Moves the chosen object towards you", vec![plain(ArrowDown)]).continuous().while_choosing(),
        row(Action::ObjectUp, Chosen, "Object up", "Raises the chosen object", vec![plain(PageUp)]).continuous().while_choosing(),
        row(Action::ObjectDown, Chosen, "Object down", "Lowers the chosen object", vec![plain(PageDown)]).continuous().while_choosing(),
        row(Action::TurnLeft, Chosen, "Turn left", "Turns the chosen object to the left, about Z", vec![shift(ArrowLeft)]).continuous().while_choosing(),
        row(Action::TurnRight, Chosen, "Turn right", "Turns the chosen object to the right, about Z", vec![shift(ArrowRight)]).continuous().while_choosing(),
        row(Action::TipAway, Chosen, "Tip away", "Tips the chosen object away from you", vec![shift(ArrowUp)]).continuous().while_choosing(),
        row(Action::TipNearer, Chosen, "Tip nearer", "Tips the chosen object towards you", vec![shift(ArrowDown)]).continuous().while_choosing(),
        row(Action::RollLeft, Chosen, "Roll left", "Rolls the chosen object to the left", vec![shift(PageUp)]).continuous().while_choosing(),
        row(Action::RollRight, Chosen, "Roll right", "Rolls the chosen object to the right", vec![shift(PageDown)]).continuous().while_choosing(),
        row(Action::DeleteObject, Chosen, "Delete", "Takes the chosen object from the table", vec![plain(Delete)]).while_choosing(),

        row(Action::MakeBlock, Objects, "Big block", "Makes a big block somewhere on the table", vec![plain(KeyB)]),
        row(Action::MakeStack, Objects, "Stack of five", "Makes a stack of five blocks somewhere on the table", vec![plain(KeyN)]),
        row(Action::ClearTable, Objects, "Clear the table", "Removes every object that nobody holds", vec![plain(KeyC)]),
        row(Action::CopyObjects, Objects, "Copy", "Keeps the chosen object, or those selected in Objects, for pasting", vec![ctrl(KeyC)]),
        row(Action::PasteObjects, Objects, "Paste", "Puts the copied objects on the table", vec![ctrl(KeyV)]),
        row(Action::OpenFile, Objects, "Open a file", "Opens a task file or a recording", vec![ctrl(KeyO)]),
        row(Action::SaveFile, Objects, "Save as a file", "Saves the table as a task file", vec![ctrl(KeyS)]),

        row(Action::ShowRobot, Robot, "Show, hide", "Puts the robot at the table, or takes it away", vec![plain(KeyR)]),
        row(Action::ShowHeadView, Robot, "Head view", "Shows or hides the robot's view", vec![plain(Digit1)]),
        row(Action::SaveHeadView, Robot, "Save the head view", "Saves the robot's view as a picture", vec![plain(Digit2)]),
        row(Action::ShowNextFace, Robot, "Next face", "Shows the robot's next face", vec![plain(Backslash)]),
        row(Action::RunScript, Robot, "Script on, off", "Starts the script that drives the robot, or stops it", vec![plain(KeyM)]),
        row(Action::Imitate, Robot, "Do what was shown", "Lets the robot imitate the recording, or stops it", vec![ctrl(Enter)]),

        row(Action::StatusWindow, Window, "Status", "Goes to the window Status", vec![alt(Digit1)]),
        row(Action::CameraWindow, Window, "Camera", "Goes to the window Camera Navigation", vec![alt(Digit2)]),
        row(Action::RobotWindow, Window, "Robot", "Goes to the window Robot", vec![alt(Digit3)]),
        row(Action::DemoToolsWindow, Window, "Demo Tools", "Goes to the window Demonstration Tools", vec![alt(Digit4)]),
        row(Action::PoseWindow, Window, "Pose", "Goes to the window Pose and Dragging", vec![alt(Digit5)]),
        row(Action::ObjectsWindow, Window, "Objects", "Goes to the window Objects", vec![alt(Digit6)]),
        row(Action::TimelineWindow, Window, "Timeline", "Goes to the window Timeline", vec![alt(Digit7)]),
        row(Action::RecordingsWindow, Window, "Recordings", "Goes to the window Recordings", vec![alt(Digit8)]),
        row(Action::PlotsWindow, Window, "Plots", "Goes to the window Plots", vec![alt(Digit9)]),
        row(Action::MessagesWindow, Window, "Messages", "Goes to the window Messages", vec![alt(Digit0)]),
        row(Action::ShowHelp, Window, "Help", "Shows or hides the list of keys", vec![plain(F1), shift(Slash)]),
        row(Action::FillScreen, Window, "Full screen", "Fills the screen with the window, or no longer", vec![plain(F11)]),
        row(Action::DrawLarger, Window, "Larger", "Draws everything larger", vec![ctrl(Equal), ctrl(NumpadAdd)]),
        row(Action::DrawSmaller, Window, "Smaller", "Draws everything smaller", vec![ctrl(KeyCode::Minus), ctrl(NumpadSubtract)]),
        row(Action::DrawToFit, Window, "Fit the window", "Draws everything as large as fits the window", vec![ctrl(Digit0), ctrl(Numpad0)]),
    ]
}

/// All joints in the order of their keys on the keyboard: the last limb before the first, each from its tip to its base.
fn joints_by_place(layout: &RobotLayout) -> impl Iterator<Item = JointId> {
    let limbs = layout.limbs.iter().rev();
    let joints = limbs.flat_map(|limb| {
        let joints = limb.joints.iter().rev();
        joints.chain([&limb.gripper.joint]).copied()
    });
    joints.chain(layout.neck)
}

/// The two rows of a joint. A joint has one key, which Shift reverses; a gripper has two (report section 5.1).
fn rows_of_joint(joint: &JointLayout, faults: &mut Vec<JointKeyError>) -> [ActionRow; 2] {
    [Way::Plus, Way::Minus].map(|way| {
        let JointLayout {
            name,
            role,
            label,
            keys: [plus, minus],
            ..
        } = joint;
        let (key, sign) = match way {
            Way::Plus => (plus, '+'),
            Way::Minus => (minus, '-'),
        };
        let (group, label, tooltip) = match (role, way) {
            (JointRole::Gripper(limb), Way::Plus) => (
                ActionGroup::Limb(*limb),
                "Open gripper".to_owned(),
                "Opens the gripper",
            ),
            (JointRole::Gripper(limb), Way::Minus) => (
                ActionGroup::Limb(*limb),
                "Close gripper".to_owned(),
                "Closes the gripper",
            ),
            (JointRole::Limb { limb, .. }, way) => (
                ActionGroup::Limb(*limb),
                format!("{label} {sign}"),
                turns(way),
            ),
            (JointRole::Neck, way) => (ActionGroup::Robot, format!("{label} {sign}"), turns(way)),
        };
        let action = Action::Move(*name, way);
        let key = key.as_deref().and_then(|key| {
            let fault = |source| JointKeyError {
                joint: *name,
                source,
            };
            key.parse()
                .map_err(|source| faults.push(fault(source)))
                .ok()
        });
        row(action, group, &label, tooltip, key.into_iter().collect()).continuous()
    })
}

const fn turns(way: Way) -> &'static str {
    match way {
        Way::Plus => "Turns the joint",
        Way::Minus => "Turns the joint the other way",
    }
}

const fn plain(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::NONE, key)
}

const fn shift(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::SHIFT, key)
}

const fn alt(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::ALT, key)
}

const fn ctrl(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::CTRL, key)
}

const fn ctrl_shift(key: KeyCode) -> KeyBinding {
    KeyBinding::new(Modifiers::CTRL.with_shift(), key)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use bevy::reflect::{Typed as _, enums::Enum as _};

    use super::*;

    fn all() -> Vec<ActionRow> {
        rows(RobotLayout::baxter()).0
    }

    #[test]
    fn a_key_that_does_not_exist_is_reported_with_its_joint() {
        let mut layout = RobotLayout::baxter().clone();
        layout.joints[0].keys[0] = Some("Quot".to_owned());
        let (_, faults) = rows(&layout);
        let faults: Vec<_> = faults.iter().map(ToString::to_string).collect();
        assert_eq!(
            faults,
            [
                "joint left_s0: there is no key `Quot`; keys are named as on a US keyboard: KeyA, Digit1, Space, F1"
            ]
        );
    }

    #[test]
    fn every_action_has_a_row() {
        let rows = all();
        let listed: BTreeSet<_> = rows.iter().map(|row| row.action.variant_name()).collect();
        let variants = Action::type_info().as_enum().unwrap().variant_names();
        let missing: Vec<_> = variants
            .iter()
            .filter(|name| !listed.contains(**name))
            .collect();
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn no_two_rows_have_one_action_or_name() {
        let rows = all();
        let actions: BTreeSet<_> = rows.iter().map(|row| row.action).collect();
        let names: BTreeSet<_> = rows.iter().map(|row| &row.action).collect();
        assert_eq!((actions.len(), names.len()), (rows.len(), rows.len()));
    }

    #[test]
    fn every_group_is_listed() {
        let groups = groups(RobotLayout::baxter());
        for row in all() {
            let of_row = groups.iter().filter(|(group, _)| *group == row.group);
            assert_eq!(of_row.count(), 1, "{}", row.action);
        }
    }

    #[test]
    fn every_action_has_a_key_a_label_and_a_tooltip() {
        for row in all() {
            assert!(!row.default_keys.is_empty(), "{}", row.action);
            assert!(!row.label.is_empty(), "{}", row.action);
            assert!(!row.tooltip.is_empty(), "{}", row.action);
        }
    }

    #[test]
    fn every_joint_can_be_moved_both_ways() {
        let layout = RobotLayout::baxter();
        let actions: BTreeSet<_> = all().into_iter().map(|row| row.action).collect();
        for joint in &layout.joints {
            for way in [Way::Plus, Way::Minus] {
                assert!(actions.contains(&Action::Move(joint.name, way)));
            }
        }
    }
}
