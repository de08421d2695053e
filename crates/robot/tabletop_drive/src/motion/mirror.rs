//! The robot as a mirror of a real one.

use tabletop_core::LimbId;

use crate::{
    command::joint_targets::MirroredJoints,
    gripper::closing::{Touched, close},
    motion::tick_motion::TickMotion,
};

/// How much thicker or thinner than its opening a thing between the fingers of a real gripper may be in the simulation, in units.
const UNCERTAIN: f32 = 0.2;

impl TickMotion<'_> {
    /// Puts the joints where they were measured, whatever is in the way.
    pub fn mirror(&mut self, measured: &MirroredJoints) {
        for (position, measured) in self.positions.iter_mut().zip(measured) {
            if let Some(measured) = measured {
                *position = measured.position;
            }
        }
    }

    /// The objects that a gripper can mean which says that it holds something: those between its fingers that are as thick as it is open.
    pub fn gripped(&mut self, limb: LimbId) -> Vec<Touched> {
        let gripper = &self.articulation.layout.limb(limb).gripper;
        let finger = gripper.finger;
        let opening = self.positions[gripper.joint.index()] as f32 + UNCERTAIN;
        let end_effector = self.end_effector(limb);
        let between = self.between(end_effector, opening, finger);
        let room = close(end_effector, opening, finger, &between).room;
        let is_as_thick = room > 0.0 && room < 2.0 * UNCERTAIN;
        if !is_as_thick {
            return Vec::new();
        }
        close(end_effector, opening - room, finger, &between).touched
    }
}
