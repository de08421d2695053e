//! The rows of states and joints, read.

use std::path::Path;

use bevy::math::{Quat, Vec3};
use tabletop_core::{JointName, JointState, SimTick};
use tabletop_geometry::{Pose, Twist};

use crate::{
    error::RecorderError,
    files::{limits::MOST_ROW_BYTES, log_file::read_whole_lines},
    reading::{event::number, fault::damaged},
};

/// The pose and the speed of an object at the end of a tick.
#[derive(Clone, Debug, PartialEq)]
pub struct StateRow {
    /// The tick.
    pub tick: SimTick,
    /// Id of the object.
    pub id: String,
    /// Its location, in units, and rotation.
    pub pose: Pose,
    /// Its speed, in units/s and rad/s.
    pub twist: Twist,
}

/// The state of a joint of the robot at the end of a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointRow {
    /// The tick.
    pub tick: SimTick,
    /// The joint.
    pub joint: JointName,
    /// Its position, velocity and torque.
    pub state: JointState,
}

pub(super) fn states(path: &Path) -> Result<Vec<StateRow>, RecorderError> {
    rows(path, |fields| {
        let [tick, id, numbers @ ..] = fields else {
            return Err(String::new());
        };
        let numbers = numbers_of::<f32, 13>(numbers)?;
        let [x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz] = numbers;
        Ok(StateRow {
            tick: SimTick(number("a tick", tick)?),
            id: (*id).to_owned(),
            pose: Pose::new(Vec3::new(x, y, z), Quat::from_xyzw(qx, qy, qz, qw)),
            twist: Twist {
                linear: Vec3::new(vx, vy, vz),
                angular: Vec3::new(wx, wy, wz),
            },
        })
    })
}

/// The rows of the first tick name all joints of the robot.
pub(super) fn joints(path: &Path) -> Result<Vec<JointRow>, RecorderError> {
    let mut first_tick = None;
    let mut known = Vec::new();
    rows(path, |fields| {
        let [tick, name, numbers @ ..] = fields else {
            return Err(String::new());
        };
        let tick = SimTick(number("a tick", tick)?);
        let joint = JointName::new(name).map_err(|error| error.to_string())?;
        if *first_tick.get_or_insert(tick) == tick {
            known.push(joint);
        } else if !known.contains(&joint) {
            return Err(format!("expected a joint, found `{name}`"));
        }
        let [position, velocity, torque] = numbers_of::<f64, 3>(numbers)?;
        Ok(JointRow {
            tick,
            joint,
            state: JointState {
                position,
                velocity,
                torque,
            },
        })
    })
}

/// The rows of a file below its header.
fn rows<T>(
    path: &Path,
    mut parse: impl FnMut(&[&str]) -> Result<T, String>,
) -> Result<Vec<T>, RecorderError> {
    let text = read_whole_lines(path, MOST_ROW_BYTES)?;
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            damaged(path, line, error)
        })?;
        let fields: Vec<_> = record.iter().collect();
        let row = parse(&fields).map_err(|problem| {
            let line = record.position().map_or(0, csv::Position::line);
            damaged(path, line, problem)
        })?;
        rows.push(row);
    }
    Ok(rows)
}

fn numbers_of<T: std::str::FromStr + Copy, const N: usize>(
    texts: &[&str],
) -> Result<[T; N], String> {
    let numbers: Result<Vec<T>, _> = texts.iter().map(|text| number("a number", text)).collect();
    let found = texts.len();
    <[T; N]>::try_from(numbers?).map_err(|_| format!("expected {N} numbers, found {found}"))
}

#[cfg(test)]
mod tests {
    use tabletop_core::RobotLayout;

    use super::*;
    use crate::files::{joints, states};

    fn file(name: &str, lines: &[Vec<String>]) -> std::path::PathBuf {
        let name = format!("tabletop_rows_{name}_{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let lines: Vec<_> = lines.iter().map(|fields| fields.join(",") + "\n").collect();
        std::fs::write(&path, lines.concat()).unwrap();
        path
    }

    #[test]
    fn states_read_back_to_the_bit() {
        let state = states::ObjectState {
            pose: Pose::new(
                Vec3::new(0.1, -1e-30, 3e7),
                Quat::from_rotation_x(1.0 / 3.0),
            ),
            twist: Twist {
                linear: Vec3::splat(1.0 / 3.0),
                angular: Vec3::NEG_Y,
            },
        };
        let path = file(
            "states",
            &[states::header(), states::row(SimTick(9), "a", state)],
        );
        let row = StateRow {
            tick: SimTick(9),
            id: "a".into(),
            pose: state.pose,
            twist: state.twist,
        };
        assert_eq!(states(&path).unwrap(), [row]);
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn joints_read_back_to_the_bit_and_wrong_rows_are_named() {
        let mut all = [JointState::default(); 17];
        let before = all;
        all[3].position = 1.0 / 3.0;
        let baxter = RobotLayout::baxter();
        let mut lines = vec![joints::header()];
        lines.extend(joints::rows(SimTick(4), baxter, None, &before));
        lines.extend(joints::rows(SimTick(5), baxter, Some(&before), &all));
        let path = file("joints", &lines);
        let rows = joints(&path).unwrap();
        assert_eq!(rows.len(), 18);
        let row = JointRow {
            tick: SimTick(5),
            joint: JointName::from_static("left_e1"),
            state: all[3],
        };
        assert!(rows.contains(&row));
        for (field, problem) in [
            (1, "expected a joint, found `x`"),
            (4, "expected a number, found `x`"),
        ] {
            let mut lines = lines.clone();
            lines[18][field] = "x".into();
            let path = file("joints", &lines);
            let error = joints(&path).unwrap_err().to_string();
            assert!(
                error.starts_with(&format!("{}:19: ", path.display())),
                "{error}"
            );
            assert!(error.contains(problem), "{error}");
        }
        lines[18].pop();
        let error = joints(&file("joints", &lines)).unwrap_err().to_string();
        assert!(error.contains("expected 3 numbers, found 2"), "{error}");
        std::fs::remove_file(path).unwrap();
    }
}
