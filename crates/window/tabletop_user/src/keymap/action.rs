//! Actions that keys do.

use std::fmt;

use bevy::{prelude::*, reflect::enums::Enum as _};

use tabletop_core::{JointName, snake_case};

/// An action that a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect)]
pub enum Action {
    /// Pause or resume (report section 2.4).
    Pause,
    /// Quit (report section 2.4).
    Quit,
    /// While paused, simulate one tick.
    Step,
    /// Simulate more slowly.
    Slower,
    /// Simulate faster.
    Faster,
    /// Move the camera along its direction of view (report section 3).
    CameraForward,
    /// Move the camera against its direction of view.
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
    /// Turn the drag plane counterclockwise (report section 4.3).
    PlaneCounterClockwise,
    /// Turn the drag plane clockwise.
    PlaneClockwise,
    /// Show the perpendicular plane while held down.
    PlanePerpendicular,
    /// Show the upright plane in place of the level one while held down.
    PlaneUpright,
    /// Choose the next object for the keyboard.
    NextObject,
    /// Choose the object before the chosen one.
    PreviousObject,
    /// Take the chosen object, or let it go.
    TakeOrRelease,
    /// Move the chosen object to the viewer's left.
    ObjectLeft,
    /// Move the chosen object to the viewer's right.
    ObjectRight,
    /// Move the chosen object away from the viewer.
    ObjectAway,
    /// Move the chosen object towards the viewer.
    ObjectNearer,
    /// Raise the chosen object.
    ObjectUp,
    /// Lower the chosen object.
    ObjectDown,
    /// Turn the chosen object counterclockwise as seen from above.
    TurnLeft,
    /// Turn the chosen object clockwise as seen from above.
    TurnRight,
    /// Tip the chosen object away from the viewer.
    TipAway,
    /// Tip the chosen object towards the viewer.
    TipNearer,
    /// Roll the chosen object to the viewer's left.
    RollLeft,
    /// Roll the chosen object to the viewer's right.
    RollRight,
    /// Remove the chosen object.
    DeleteObject,
    /// Act with the left hand.
    HandLeft,
    /// Act with the right hand.
    HandRight,
    /// Act with both hands.
    HandBoth,
    /// Act with whichever hand is free.
    HandAny,
    /// Begin a recording, or end it.
    Record,
    /// Write the name of the next takes.
    NameTake,
    /// Discard the present segment of the recording (report section 4.1), or take back the last edit of the open one.
    Undo,
    /// Bring back the segment or edit that was undone last.
    Redo,
    /// Delete the selected segments of the open recording.
    DeleteSegments,
    /// Trigger the control under the cursor.
    Trigger,
    /// Point to the part under the cursor.
    PointTo,
    /// Fasten the held object, or the one under the cursor, by a step.
    Fasten,
    /// Loosen the held object, or the one under the cursor, by a step.
    Loosen,
    /// Close the scissors that are held, or that the cursor is on.
    Cut,
    /// Make a big block (report section 6.1).
    MakeBlock,
    /// Make a stack of five blocks (report section 6.1).
    MakeStack,
    /// Remove every object that nobody holds (report section 6.1).
    ClearTable,
    /// Keep the chosen object, or the selected ones, for pasting.
    CopyObjects,
    /// Put the copied objects on the table.
    PasteObjects,
    /// Choose and open a task file or a recording.
    OpenFile,
    /// Save the scene on the table as a task file.
    SaveFile,
    /// Show or hide the robot (report section 5).
    ShowRobot,
    /// Show or hide the head camera's view (report section 5).
    ShowHeadView,
    /// Save the head camera's view as a picture (report section 5).
    SaveHeadView,
    /// Show the robot's next face.
    ShowNextFace,
    /// Start or stop the script that drives the robot (report section 5.2).
    RunScript,
    /// Let the robot imitate the demonstrated task, or stop it.
    Imitate,
    /// Move a joint of the robot while held down (report section 5.1).
    Move(JointName, Way),
    /// Go to the window Status.
    StatusWindow,
    /// Go to the window Camera Navigation.
    CameraWindow,
    /// Go to the window Robot.
    RobotWindow,
    /// Go to the window Demonstration Tools.
    DemoToolsWindow,
    /// Go to the window Pose and Dragging.
    PoseWindow,
    /// Go to the window Objects.
    ObjectsWindow,
    /// Go to the window Timeline.
    TimelineWindow,
    /// Go to the window Recordings.
    RecordingsWindow,
    /// Go to the window Plots.
    PlotsWindow,
    /// Go to the window Messages.
    MessagesWindow,
    /// Show or hide the list of keys.
    ShowHelp,
    /// Enter or leave full screen.
    FillScreen,
    /// Draw panels and text larger.
    DrawLarger,
    /// Draw panels and text smaller.
    DrawSmaller,
    /// Draw panels and text as large as the window allows.
    DrawToFit,
}

/// One of the two ways in which a joint moves, with the signs of manual control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect)]
pub enum Way {
    /// As button + moves it: a gripper opens.
    Plus,
    /// As button − moves it: a gripper closes.
    Minus,
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
    /// Writes its name in files: `camera_up`, `right_w2+`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Move(joint, way) = self {
            write!(f, "{joint}{}", way.sign())
        } else {
            f.write_str(&snake_case(self.variant_name()))
        }
    }
}
