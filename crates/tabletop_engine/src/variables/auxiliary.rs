//! What scripts and the program tell each other about the robot: the script's `aux` variable (report section 5.2).

use crate::{
    protocol::{Array, Arrays},
    variables::invalid_field::InvalidField,
    variables::motor::{joints, no_struct, points},
};

/// What an init script gets to know. Rows are in the order left, right; joints in the order S0, S1, E0, E1, W0, W1, W2.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aux {
    /// The least angles of the arms' joints, in rad.
    pub min_joint_angles: [[f64; 7]; 2],
    /// The greatest angles of the arms' joints, in rad.
    pub max_joint_angles: [[f64; 7]; 2],
}

impl Aux {
    /// As named arrays. `path` is where scripts keep their files, with a slash at its end.
    pub(crate) fn arrays(&self, path: &str) -> Arrays {
        let mut arrays = Arrays::default();
        arrays.put("aux.path", Array::text(path));
        arrays.put("aux.numLimbs", Array::scalar(2.0));
        arrays.put("aux.numJoints", Array::scalar(7.0));
        arrays.put("aux.minJointAngles", Array::matrix(&self.min_joint_angles));
        arrays.put("aux.maxJointAngles", Array::matrix(&self.max_joint_angles));
        arrays
    }
}

/// What an init script wants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitReply {
    /// Where markers shall be, in units of 10 cm.
    pub draw_markers: Vec<[f64; 3]>,
    /// Angles that the arms' joints shall have at first, in rad; not yet clamped to the limits.
    pub init_joint_angles: Option<[[f64; 7]; 2]>,
    /// Whether the script is done already: it is not called back.
    pub exit: bool,
}

impl InitReply {
    /// Reads the fields "aux.…" of an engine's reply.
    pub(crate) fn read(arrays: &Arrays) -> Result<Self, InvalidField> {
        let mut reply = Self::default();
        for (name, array) in arrays.iter() {
            match name {
                "aux" => return Err(no_struct(name, array)),
                "aux.drawMarkers" => reply.draw_markers = points(name, array)?,
                "aux.initJointAngles" => reply.init_joint_angles = Some(joints(name, array)?),
                "aux.exit" => reply.exit = true,
                _ => {}
            }
        }
        Ok(reply)
    }
}
