//! The panels of the window.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// A panel: a window inside the window, which the user opens, moves and closes.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect, Serialize, Deserialize,
)]
pub enum Panel {
    /// Speeds, the script and the recording.
    Status,
    /// Moves the user's camera.
    Camera,
    /// The robot's joints and state.
    Robot,
    /// Hands, rotations and recording.
    DemonstrationTools,
    /// The pose of what is held, and how the mouse drags.
    Pose,
    /// Task files and presets.
    Objects,
    /// The recording that is made or open, along its time.
    Timeline,
    /// The recordings that there are.
    Recordings,
    /// Quantities over time.
    Plots,
    /// Notices to the user.
    Messages,
}

/// The edge of the desk at which a panel stands, unless the user has moved it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PanelEdge {
    Left,
    Right,
    /// Along all of the lower edge.
    Bottom,
}

impl Panel {
    /// The panels in the order of their buttons, and from the top downwards when they are aligned.
    pub const ALL: [Self; 10] = [
        Self::Status,
        Self::Camera,
        Self::Robot,
        Self::DemonstrationTools,
        Self::Pose,
        Self::Objects,
        Self::Timeline,
        Self::Recordings,
        Self::Plots,
        Self::Messages,
    ];

    /// The text of its button.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Status => "Status",
            Self::Camera => "Camera",
            Self::Robot => "Robot",
            Self::DemonstrationTools => "Demo Tools",
            Self::Pose => "Pose",
            Self::Objects => "Objects",
            Self::Messages => "Messages",
            Self::Timeline => "Timeline",
            Self::Recordings => "Recordings",
            Self::Plots => "Plots",
        }
    }

    /// The text of its title bar.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Status => "Status",
            Self::Camera => "Camera Navigation",
            Self::Robot => "Robot",
            Self::DemonstrationTools => "Demonstration Tools",
            Self::Pose => "Pose and Dragging",
            Self::Objects => "Objects",
            Self::Messages => "Messages",
            Self::Timeline => "Timeline",
            Self::Recordings => "Recordings",
            Self::Plots => "Plots",
        }
    }

    /// The tooltip of its button.
    pub const fn tooltip(self) -> &'static str {
        match self {
            Self::Status => "Speeds, the script's state and the recording",
            Self::Camera => "Move and turn your view, or go to one of the views",
            Self::Robot => "See the robot and its view; move its joints",
            Self::DemonstrationTools => {
                "Hands, held objects and their turns; record, undo and redo"
            }
            Self::Pose => "Read and type where the held object is; choose how the mouse drags",
            Self::Objects => "Load and save task files; make objects, and clear the table",
            Self::Messages => "All messages so far, each with its place",
            Self::Plots => "Poses, speeds, joints, grippers and contacts over time",
            Self::Recordings => {
                "The recordings of a folder; open, compare, name, export or multiply them"
            }
            Self::Timeline => "The recording along its time; step, play slowly or fast",
        }
    }

    /// Where it stands.
    pub(crate) const fn edge(self) -> PanelEdge {
        match self {
            Self::Status | Self::Camera | Self::Robot | Self::DemonstrationTools => PanelEdge::Left,
            Self::Pose | Self::Objects | Self::Recordings | Self::Plots | Self::Messages => {
                PanelEdge::Right
            }
            Self::Timeline => PanelEdge::Bottom,
        }
    }

    /// Width of its contents in points, unless it is docked.
    pub const fn width(self) -> f32 {
        match self {
            Self::Status
            | Self::Camera
            | Self::Robot
            | Self::DemonstrationTools
            | Self::Pose
            | Self::Objects => 304.0,
            Self::Messages => 340.0,
            Self::Recordings => 460.0,
            Self::Plots => 520.0,
            Self::Timeline => 640.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use bevy::reflect::{TypeInfo, Typed};

    use super::*;

    #[test]
    fn every_panel_has_its_turn_once() {
        let TypeInfo::Enum(variants) = Panel::type_info() else {
            panic!("a panel is a variant");
        };
        let names: BTreeSet<_> = Panel::ALL.map(|panel| format!("{panel:?}")).into();
        let expected = variants.variant_names().iter().map(ToString::to_string);
        assert_eq!(names, expected.collect());
        assert!(Panel::ALL.is_sorted(), "declared in the order of the bar");
    }

    #[test]
    fn every_panel_has_texts_of_its_own() {
        for text in [Panel::label, Panel::title, Panel::tooltip] {
            let texts: BTreeSet<_> = Panel::ALL.map(text).into();
            assert_eq!(texts.len(), Panel::ALL.len());
            assert!(texts.iter().all(|text| !text.is_empty()));
        }
    }
}
