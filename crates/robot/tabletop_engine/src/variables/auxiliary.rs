//! The script's `aux` variable (report section 5.2): facts about the robot, and wishes of the script.

use crate::{
    protocol::{Array, Arrays},
    variables::{
        invalid_field::InvalidField,
        matrix::JointMatrix,
        motor::{joints, no_struct, points},
    },
};

/// The knowledge of an init script. For Baxter, rows are in the order left, right; joints in the order S0, S1, E0, E1, W0, W1,
/// W2.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aux {
    /// The least angles of the limbs' joints, in rad.
    pub min_joint_angles: JointMatrix,
    /// The greatest angles of the limbs' joints, in rad.
    pub max_joint_angles: JointMatrix,
}

impl Aux {
    /// The number of limbs, and of joints in the limb that has most.
    pub fn size(&self) -> [usize; 2] {
        self.min_joint_angles.size()
    }

    /// As named arrays. `path` is where scripts keep their files, with a slash at its end.
    pub(crate) fn arrays(&self, path: &str) -> Arrays {
        let mut arrays = Arrays::default();
        arrays.put("aux.path", Array::text(path));
        let [limbs, joints] = self.size();
        arrays.put("aux.numLimbs", Array::scalar(limbs as f64));
        arrays.put("aux.numJoints", Array::scalar(joints as f64));
        arrays.put("aux.minJointAngles", self.min_joint_angles.array());
        arrays.put("aux.maxJointAngles", self.max_joint_angles.array());
        arrays
    }
}

/// The wishes of an init script.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitReply {
    /// The places of markers, in units of 10 cm.
    pub draw_markers: Vec<[f64; 3]>,
    /// Angles that the limbs' joints shall have at first, in rad; not yet clamped to the limits.
    pub init_joint_angles: Option<JointMatrix>,
    /// True if the script is done already: it is not called back.
    pub exit: bool,
}

impl InitReply {
    /// Reads the fields "aux.…" of an engine's reply.
    pub(crate) fn read(arrays: &Arrays, size: [usize; 2]) -> Result<Self, InvalidField> {
        let mut reply = Self::default();
        for (name, array) in arrays.iter() {
            match name {
                "aux" => return Err(no_struct(name, array)),
                "aux.drawMarkers" => reply.draw_markers = points(name, array)?,
                "aux.initJointAngles" => reply.init_joint_angles = Some(joints(name, array, size)?),
                "aux.exit" => reply.exit = true,
                _ => {}
            }
        }
        Ok(reply)
    }
}
