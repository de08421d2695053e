//! The script's `motor` variable (report section 5.2): commands to the robot, checked before anybody uses them.

use crate::{
    protocol::{Array, Arrays, Data},
    variables::{
        invalid_field::{FARTHEST, InvalidField, MatrixElement},
        matrix::JointMatrix,
    },
};

/// The script's commands for one tick. For Baxter, rows are in the order left, right; joints in the order S0, S1, E0, E1, W0, W1,
/// W2.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotorCommand {
    /// Velocities of the limbs' joints, in rad/s.
    pub joint_velocities: JointMatrix,
    /// The speed at which each limb's gripper opens (positive) or closes, in units/s.
    pub gripper_velocities: Vec<f64>,
    /// Angles that the joints take at once, in rad. The velocities then mean nothing.
    pub joint_angles: Option<JointMatrix>,
    /// Torques of the limbs' joints, in N m, for a robot that is moved by forces.
    pub joint_torques: Option<JointMatrix>,
    /// The speed of the head's turn, in rad/s, positive to the robot's left.
    pub head_velocity: Option<f64>,
}

const FIELDS: [&str; 5] = [
    "jointVelocities",
    "gripperVelocities",
    "jointAngles",
    "jointTorques",
    "headVelocity",
];

impl MotorCommand {
    /// No motion of so many limbs with so many joints each.
    pub fn at_rest(size: [usize; 2]) -> Self {
        Self {
            joint_velocities: JointMatrix::zeros(size),
            gripper_velocities: vec![0.0; size[0]],
            ..Self::default()
        }
    }

    /// Reads the fields "motor.…" of an engine's reply for this many limbs and joints of each. Missing joints are at rest.
    pub fn read(arrays: &Arrays, size: [usize; 2]) -> Result<Self, InvalidField> {
        let mut motor = Self::at_rest(size);
        for (name, array) in arrays.iter() {
            let Some(field) = name.strip_prefix("motor") else {
                continue;
            };
            match field.strip_prefix('.').unwrap_or_default() {
                "" => return Err(no_struct(name, array)),
                "jointVelocities" => motor.joint_velocities = joints(name, array, size)?,
                "gripperVelocities" => motor.gripper_velocities = column(name, array, size[0])?,
                "jointAngles" => motor.joint_angles = Some(joints(name, array, size)?),
                "jointTorques" => motor.joint_torques = Some(joints(name, array, size)?),
                "headVelocity" => motor.head_velocity = Some(number(name, array)?),
                other => return Err(unknown(name, other)),
            }
        }
        Ok(motor)
    }
}

pub(crate) fn no_struct(name: &str, array: &Array) -> InvalidField {
    InvalidField::NoStruct {
        name: name.to_owned(),
        found: array.describe(),
        expected: match array.data.class() {
            "struct" => "a struct of size 1x1",
            _ => "a struct",
        },
    }
}

fn unknown(field: &str, name: &str) -> InvalidField {
    let known = FIELDS
        .iter()
        .map(|known| (common_prefix(known, name), *known));
    let nearest = known.max_by_key(|(letters, _)| *letters);
    InvalidField::Unknown {
        field: field.to_owned(),
        known: FIELDS.join(", "),
        suggestion: nearest.and_then(|(letters, known)| (letters > "joint".len()).then_some(known)),
    }
}

fn common_prefix(known: &str, name: &str) -> usize {
    let pairs = known.bytes().zip(name.bytes());
    pairs.take_while(|(a, b)| a.eq_ignore_ascii_case(b)).count()
}

/// A row for each limb.
pub(crate) fn joints(
    field: &str,
    array: &Array,
    size: [usize; 2],
) -> Result<JointMatrix, InvalidField> {
    let numbers = matrix(field, array, size)?;
    Ok(JointMatrix::from_columns(size, numbers))
}

/// A number for each limb.
fn column(field: &str, array: &Array, limbs: usize) -> Result<Vec<f64>, InvalidField> {
    matrix(field, array, [limbs, 1]).map(<[f64]>::to_vec)
}

fn number(field: &str, array: &Array) -> Result<f64, InvalidField> {
    match matrix(field, array, [1, 1])? {
        [number] => Ok(*number),
        _ => Err(size(field, array, "1x1 double")),
    }
}

fn matrix<'a>(
    field: &str,
    array: &'a Array,
    [rows, columns]: [usize; 2],
) -> Result<&'a [f64], InvalidField> {
    let dims = [rows as u32, columns as u32];
    numbers(field, array, &dims, &format!("{rows}x{columns} double"))
}

/// Largest number of markers of a script.
const MOST_POINTS: u32 = 100_000;

/// Points in space, one in each row.
pub(crate) fn points(field: &str, array: &Array) -> Result<Vec<[f64; 3]>, InvalidField> {
    let expected = "Nx3 double, N at most 100000";
    let rows = match array.dims[..] {
        [_, 0] | [0, _] => 0,
        [rows @ ..=MOST_POINTS, 3] => rows,
        [_, 3] => return Err(size(field, array, expected)),
        _ => return Err(size(field, array, "Nx3")),
    };
    let dims = if rows == 0 {
        array.dims.clone()
    } else {
        vec![rows, 3]
    };
    let numbers = numbers(field, array, &dims, expected)?;
    if let Some(place) = numbers.iter().position(|number| number.abs() > FARTHEST) {
        return Err(InvalidField::TooFar {
            element: MatrixElement::new(field, &dims, place),
            found: numbers.get(place).copied().unwrap_or_default(),
        });
    }
    let rows = rows as usize;
    Ok((0..rows)
        .map(|row| {
            [0, 1, 2].map(|column| {
                numbers
                    .get(column * rows + row)
                    .copied()
                    .unwrap_or_default()
            })
        })
        .collect())
}

fn numbers<'a>(
    field: &str,
    array: &'a Array,
    dims: &[u32],
    expected: &str,
) -> Result<&'a [f64], InvalidField> {
    let Data::Double(numbers) = &array.data else {
        return Err(size(field, array, expected));
    };
    if array.dims != dims {
        return Err(size(field, array, expected.trim_end_matches(" double")));
    }
    let Some(place) = numbers.iter().position(|number| !number.is_finite()) else {
        return Ok(numbers);
    };
    let number = numbers.get(place).copied().unwrap_or(f64::NAN);
    Err(InvalidField::NotFinite {
        element: MatrixElement::new(field, dims, place),
        found: match number {
            _ if number.is_nan() => "NaN",
            _ if number > 0.0 => "Inf",
            _ => "-Inf",
        },
    })
}

fn size(field: &str, array: &Array, expected: &str) -> InvalidField {
    InvalidField::Size {
        field: field.to_owned(),
        found: array.describe(),
        expected: expected.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(field: &str, array: Array) -> String {
        let mut arrays = Arrays::default();
        arrays.put(field, array);
        MotorCommand::read(&arrays, [2, 7]).unwrap_err().to_string()
    }

    #[test]
    fn a_motor_is_read() {
        let mut arrays = Arrays::default();
        let mut rows = [[0.0; 7]; 2];
        rows[1][2] = 0.5;
        arrays.put("motor.jointVelocities", Array::matrix(&rows));
        arrays.put("motor.gripperVelocities", Array::column(vec![1.0, -1.0]));
        arrays.put("motor.headVelocity", Array::scalar(0.25));
        arrays.put("aux.exit", Array::scalar(1.0));
        let motor = MotorCommand::read(&arrays, [2, 7]).unwrap();
        assert_eq!(motor.joint_velocities, rows);
        assert_eq!(motor.gripper_velocities, [1.0, -1.0]);
        assert_eq!(
            (motor.joint_angles, motor.head_velocity),
            (None, Some(0.25))
        );
    }

    #[test]
    fn a_robot_with_one_arm_has_one_row() {
        let mut arrays = Arrays::default();
        arrays.put("motor.jointAngles", Array::matrix(&[[0.5; 7]]));
        arrays.put("motor.gripperVelocities", Array::scalar(-1.0));
        let motor = MotorCommand::read(&arrays, [1, 7]).unwrap();
        assert_eq!(motor.joint_angles, Some([[0.5; 7]].into()));
        assert_eq!(motor.joint_velocities, [[0.0; 7]]);
        assert_eq!(motor.gripper_velocities, [-1.0]);
        let fault = MotorCommand::read(&arrays, [2, 7]).unwrap_err().to_string();
        assert_eq!(fault, "motor.jointAngles is 1x7 double; it must be 2x7");
    }

    #[test]
    fn faults_state_the_found_and_the_expected_value() {
        let three = Array::matrix(&[[0.0; 7]; 3]);
        assert_eq!(
            fault("motor.jointVelocities", three),
            "motor.jointVelocities is 3x7 double; it must be 2x7"
        );
        let row = Array::matrix(&[[0.0; 2]]);
        assert_eq!(
            fault("motor.gripperVelocities", row),
            "motor.gripperVelocities is 1x2 double; it must be 2x1"
        );
        let mut rows = [[0.0; 7]; 2];
        rows[1][2] = f64::NAN;
        let nan = "motor.jointAngles(2,3) is NaN; it must be a finite number";
        assert_eq!(fault("motor.jointAngles", Array::matrix(&rows)), nan);
        let text = "motor.headVelocity is 1x4 char; it must be 1x1 double";
        assert_eq!(fault("motor.headVelocity", Array::text("fast")), text);
        assert_eq!(
            fault("motor", Array::scalar(1.0)),
            "motor is 1x1 double; it must be a struct"
        );
        let typo = fault("motor.velocity", Array::scalar(1.0));
        assert!(
            typo.starts_with("motor.velocity is not a field that the robot knows"),
            "{typo}"
        );
        let typo = fault("motor.JointVelocity", Array::scalar(1.0));
        assert!(typo.ends_with("(did you mean jointVelocities?)"), "{typo}");
    }

    #[test]
    fn markers_are_rows_of_three() {
        let rows = points(
            "aux.drawMarkers",
            &Array::matrix(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]),
        );
        assert_eq!(rows.unwrap(), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        let empty = Array {
            dims: vec![0, 0],
            data: Data::Double(Vec::new()),
        };
        assert_eq!(
            points("aux.drawMarkers", &empty).unwrap(),
            Vec::<[f64; 3]>::new()
        );
        let fault = points("aux.drawMarkers", &Array::matrix(&[[1.0, 2.0]])).unwrap_err();
        assert_eq!(
            fault.to_string(),
            "aux.drawMarkers is 1x2 double; it must be Nx3"
        );
        let far = [[0.0; 3], [0.0, -1e39, 0.0]];
        let fault = points("aux.drawMarkers", &Array::matrix(&far)).unwrap_err();
        assert_eq!(
            fault.to_string(),
            "aux.drawMarkers(2,2) is -1e39; it must be between -1e6 and 1e6"
        );
    }
}
