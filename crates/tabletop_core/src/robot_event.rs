//! Events of the robot, as sentences.

use crate::{Obstacle, Operator, SimFact};

/// Limit on the angle of the report's figure 11, in degrees.
const LARGEST_GRIP_ANGLE: f32 = 180.0 / 16.0;

impl SimFact {
    /// The sentence for an event of the robot; `None` for other events.
    pub fn robot_event(&self) -> Option<String> {
        Some(match self {
            Self::GripMade { arm, id } => format!("the {arm} gripper holds {id}"),
            Self::GripRefused { arm, id, angle } => format!(
                "the {arm} gripper cannot hold {id}: its fingers touch it at θ = {:.1}°, which must be below \
             {LARGEST_GRIP_ANGLE}°",
                angle.to_degrees()
            ),
            Self::GripReleased { arm, id } => format!("the {arm} gripper holds {id} no longer"),
            Self::ArmBlocked { arm, by } => match by {
                Obstacle::Table => format!("the {arm} arm is stopped by the table"),
                Obstacle::Object(name) | Obstacle::Link(name) => {
                    format!("the {arm} arm is stopped by {name}")
                }
            },
            Self::Triggered {
                by: Operator::Limb(arm),
                control,
                ..
            } => format!("the {arm} arm presses {control}"),
            Self::Fastened {
                by: Operator::Limb(arm),
                bond,
                ..
            } => format!(
                "the {arm} arm fastens {} to {}: step {}",
                bond.guest, bond.host, bond.tightness
            ),
            Self::Loosened {
                by: Operator::Limb(arm),
                bond,
                ..
            } => format!(
                "the {arm} arm loosens {} from {}: step {}",
                bond.guest, bond.host, bond.tightness
            ),
            Self::Cut {
                by: Operator::Limb(arm),
                link,
                ..
            } => format!("the {arm} arm cuts {link}"),
            Self::TaskLoaded { .. }
            | Self::Triggered { .. }
            | Self::ControlChanged { .. }
            | Self::PointedTo { .. }
            | Self::Fastened { .. }
            | Self::Loosened { .. }
            | Self::Cut { .. }
            | Self::ObjectCreated { .. }
            | Self::ObjectDeleted { .. }
            | Self::SegmentBegun { .. }
            | Self::Grasped { .. }
            | Self::Released { .. }
            | Self::Destroyed { .. }
            | Self::RecordingStarted { .. }
            | Self::RecordingFinished { .. }
            | Self::RecordingFailed { .. }
            | Self::Undone { .. }
            | Self::Redone { .. }
            | Self::RobotShown { .. }
            | Self::Refused { .. } => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arm, CommandId};

    #[test]
    fn facts_of_the_robot_have_words() {
        for (fact, expected) in [
            (
                SimFact::GripMade {
                    arm: Arm::Left.name(),
                    id: "red".into(),
                },
                "the left gripper holds red",
            ),
            (
                SimFact::GripRefused {
                    arm: Arm::Right.name(),
                    id: "red".into(),
                    angle: 0.5,
                },
                "the right gripper cannot hold red: its fingers touch it at θ = 28.6°, which must be below 11.25°",
            ),
            (
                SimFact::GripReleased {
                    arm: Arm::Right.name(),
                    id: "red".into(),
                },
                "the right gripper holds red no longer",
            ),
            (
                SimFact::ArmBlocked {
                    arm: Arm::Left.name(),
                    by: Obstacle::Table,
                },
                "the left arm is stopped by the table",
            ),
            (
                SimFact::ArmBlocked {
                    arm: Arm::Left.name(),
                    by: Obstacle::Object("table".into()),
                },
                "the left arm is stopped by table",
            ),
        ] {
            assert_eq!(fact.robot_event().as_deref(), Some(expected));
        }
        let cause = CommandId(0);
        assert_eq!(SimFact::Undone { cause }.robot_event(), None);
    }
}
