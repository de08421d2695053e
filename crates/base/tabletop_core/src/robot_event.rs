//! Events of the robot, as sentences.

use crate::{MechanismFact, Obstacle, Operator, RobotFact, SimFact};

/// Limit on the angle of the report's figure 11, in degrees.
const LARGEST_GRIP_ANGLE: f32 = 180.0 / 16.0;

impl SimFact {
    /// The sentence for an event of the robot; `None` for other events.
    pub fn robot_event(&self) -> Option<String> {
        Some(match self {
            Self::Robot(RobotFact::GripMade { arm, id }) => format!("the {arm} gripper holds {id}"),
            Self::Robot(RobotFact::GripRefused { arm, id, angle }) => format!(
                "the {arm} gripper cannot hold {id}: its fingers touch it at θ = {:.1}°, which must be below \
             {LARGEST_GRIP_ANGLE}°",
                angle.to_degrees()
            ),
            Self::Robot(RobotFact::GripReleased { arm, id }) => {
                format!("the {arm} gripper holds {id} no longer")
            }
            Self::Robot(RobotFact::ArmBlocked { arm, by }) => match by {
                Obstacle::Table => format!("the {arm} arm is stopped by the table"),
                Obstacle::Object(name) | Obstacle::Link(name) => {
                    format!("the {arm} arm is stopped by {name}")
                }
            },
            Self::Mechanism(MechanismFact::Triggered {
                by: Operator::Limb(arm),
                control,
                ..
            }) => format!("the {arm} arm presses {control}"),
            Self::Mechanism(MechanismFact::Fastened {
                by: Operator::Limb(arm),
                bond,
                ..
            }) => format!(
                "the {arm} arm fastens {} to {}: step {}",
                bond.guest, bond.host, bond.tightness
            ),
            Self::Mechanism(MechanismFact::Loosened {
                by: Operator::Limb(arm),
                bond,
                ..
            }) => format!(
                "the {arm} arm loosens {} from {}: step {}",
                bond.guest, bond.host, bond.tightness
            ),
            Self::Mechanism(MechanismFact::Cut {
                by: Operator::Limb(arm),
                link,
                ..
            }) => format!("the {arm} arm cuts {link}"),
            Self::Scene(_)
            | Self::Mechanism(_)
            | Self::History(_)
            | Self::Hand(_)
            | Self::Recording(_)
            | Self::Robot(RobotFact::Shown { .. })
            | Self::Refused { .. } => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arm, CommandId, HistoryFact};

    #[test]
    fn facts_of_the_robot_have_words() {
        for (fact, expected) in [
            (
                SimFact::Robot(RobotFact::GripMade {
                    arm: Arm::Left.name(),
                    id: "red".into(),
                }),
                "the left gripper holds red",
            ),
            (
                SimFact::Robot(RobotFact::GripRefused {
                    arm: Arm::Right.name(),
                    id: "red".into(),
                    angle: 0.5,
                }),
                "the right gripper cannot hold red: its fingers touch it at θ = 28.6°, which must be below 11.25°",
            ),
            (
                SimFact::Robot(RobotFact::GripReleased {
                    arm: Arm::Right.name(),
                    id: "red".into(),
                }),
                "the right gripper holds red no longer",
            ),
            (
                SimFact::Robot(RobotFact::ArmBlocked {
                    arm: Arm::Left.name(),
                    by: Obstacle::Table,
                }),
                "the left arm is stopped by the table",
            ),
            (
                SimFact::Robot(RobotFact::ArmBlocked {
                    arm: Arm::Left.name(),
                    by: Obstacle::Object("table".into()),
                }),
                "the left arm is stopped by table",
            ),
        ] {
            assert_eq!(fact.robot_event().as_deref(), Some(expected));
        }
        let cause = CommandId(0);
        assert_eq!(
            SimFact::History(HistoryFact::Undone { cause }).robot_event(),
            None
        );
    }
}
