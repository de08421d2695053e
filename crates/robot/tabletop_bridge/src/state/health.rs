//! Whether a robot is on.

use serde_json::Value as Json;

use crate::profile::HealthTopic;

/// Whether a robot can move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotHealth {
    /// Its motors are on.
    Enabled,
    /// Its motors are off.
    Disabled,
    /// A person has stopped it, or it has stopped itself, until a person resets it.
    EmergencyStop,
    /// A part of it is faulty.
    Error,
}

/// The health in a message of a topic; none if the message makes no sense.
pub(super) fn health(topic: &HealthTopic, message: &Json) -> Option<RobotHealth> {
    match topic {
        HealthTopic::AssemblyState(_) => {
            let is = |field: &str| message.get(field)?.as_bool();
            let (enabled, stopped, error) = (is("enabled")?, is("stopped")?, is("error")?);
            let button = message.get("estop_button")?.as_u64()?;
            Some(if stopped || button != 0 {
                RobotHealth::EmergencyStop
            } else if error {
                RobotHealth::Error
            } else if enabled {
                RobotHealth::Enabled
            } else {
                RobotHealth::Disabled
            })
        }
        HealthTopic::FrankaRobotState(_) => Some(match message.get("robot_mode")?.as_u64()? {
            1 | 2 => RobotHealth::Enabled,
            4 | 6 => RobotHealth::Error,
            5 => RobotHealth::EmergencyStop,
            _ => RobotHealth::Disabled,
        }),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_pressed_button_is_an_emergency_stop_whatever_else_is_said() {
        let topic = HealthTopic::AssemblyState("/robot/state".into());
        let of = |enabled: bool, stopped: bool, error: bool, button: u8| {
            let message = json!({"ready": true, "enabled": enabled, "stopped": stopped, "error": error, "estop_button": button, "estop_source": 0});
            health(&topic, &message)
        };
        assert_eq!(of(true, false, false, 0), Some(RobotHealth::Enabled));
        assert_eq!(of(false, false, false, 0), Some(RobotHealth::Disabled));
        assert_eq!(of(true, false, true, 0), Some(RobotHealth::Error));
        assert_eq!(of(true, false, false, 1), Some(RobotHealth::EmergencyStop));
        assert_eq!(of(false, true, true, 3), Some(RobotHealth::EmergencyStop));
        assert_eq!(health(&topic, &json!({"enabled": true})), None);
    }
}
