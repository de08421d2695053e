//! The robot at the table, as planning needs it.

use tabletop_core::{RobotLayout, Table};
use tabletop_kinematics::{ModelError, baxter};
use tabletop_planner::RobotBody;
use tabletop_robot::RobotPlugin;

/// The robot of a plugin in front of a table, as planning needs it.
///
/// # Errors
/// Its description lacks something that planning needs.
pub fn robot_body(robot: &RobotPlugin, table: &Table) -> Result<RobotBody, ModelError> {
    match &robot.description {
        Some(description) => RobotBody::new(&description.layout, description.model.clone(), table),
        None => RobotBody::new(RobotLayout::baxter(), baxter()?, table),
    }
}
