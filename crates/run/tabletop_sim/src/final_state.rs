//! Final states that the command line writes.

use std::io::Write;

use bevy::prelude::*;
use serde_json::json;
use tabletop_core::{Decimal, ObjectIndex, ObjectSpec, Robot, RobotLayout};
use tabletop_geometry::Pose;

/// Writes the poses of all objects as CSV, in the order of creation: `id,x,y,z,rx,ry,rz` in units and degrees, the numbers as
/// recordings write them.
///
/// # Errors
///
/// An error of the writer.
pub fn write_state(world: &World, out: impl Write) -> csv::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    for object in world.resource::<ObjectIndex>().iter() {
        let (Some(spec), Some(transform)) = (
            world.get::<ObjectSpec>(object),
            world.get::<Transform>(object),
        ) else {
            continue;
        };
        let pose = Pose::from(transform);
        let numbers = [pose.location, pose.degrees()]
            .into_iter()
            .flat_map(|vector| vector.to_array())
            .map(|number| Decimal(number).to_string());
        csv.write_record(std::iter::once(spec.id.clone()).chain(numbers))?;
    }
    csv.flush()?;
    Ok(())
}

/// Writes the robot as JSON: positions of its joints in rad, end effectors and openings of the grippers in units, ids of the objects
/// in them.
///
/// # Errors
///
/// An error of the writer.
pub fn write_robot(world: &World, mut out: impl Write) -> std::io::Result<()> {
    let robot = world.resource::<Robot>();
    let id = |&object: &Entity| Some(&*world.get::<ObjectSpec>(object)?.id);
    let layout = world.resource::<RobotLayout>();
    let limbs = layout.limbs.iter().zip(&robot.limbs);
    let arms = limbs.map(|(limb, state)| {
        let Pose { location, rotation } = state.end_effector;
        let value = json!({
            "angles": robot.positions_of(&limb.joints),
            "end_effector": {
                "position": location.to_array(),
                "quaternion_xyzw": rotation.to_array(),
            },
            "gripper_opening": robot.joint(limb.gripper.joint).position,
            "holds": state.holds.iter().filter_map(id).collect::<Vec<_>>(),
            "blocked_by": state.blocked_by.as_ref().map(ToString::to_string),
        });
        (limb.name.to_string(), value)
    });
    let mut json = serde_json::Map::from_iter(arms);
    json.insert("shown".into(), json!(robot.is_shown));
    if let Some(neck) = layout.neck {
        let name = layout.joint(neck).name.to_string();
        json.insert(name, json!(robot.joint(neck).position));
    }
    serde_json::to_writer_pretty(&mut out, &json)?;
    writeln!(out)
}
