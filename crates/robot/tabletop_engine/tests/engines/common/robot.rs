//! A robot that turns its joints as commanded and knows the places of its hands.

use tabletop_engine::{Aux, InitReply, MotorCommand, Sensor};
use tabletop_kinematics::{ArmChain, baxter};

use super::limits;

/// A tick, in s.
pub const TICK: f64 = 1.0 / 60.0;

pub struct Robot {
    arms: [ArmChain; 2],
    limits: Aux,
    pub angles: [[f64; 7]; 2],
    pub grippers: [f64; 2],
    pub head: f64,
}

impl Robot {
    pub fn new(init: &InitReply) -> Self {
        let model = baxter().unwrap();
        let mut start = [[0.0; 7]; 2];
        if let Some(angles) = &init.init_joint_angles {
            for (start, angles) in start.iter_mut().zip(angles.rows()) {
                start.copy_from_slice(angles);
            }
        }
        let arm =
            |side| ArmChain::between(&model, "torso", &format!("{side}_end_effector")).unwrap();
        Self {
            arms: [arm("left"), arm("right")],
            limits: limits(),
            angles: start,
            grippers: [2.0; 2],
            head: 0.0,
        }
    }

    pub fn hands(&self) -> [[f64; 3]; 2] {
        [0, 1].map(|side: usize| {
            let tip = self.arms[side].tip(&self.angles[side]).translation;
            [-10.0 * tip.y, 10.0 * tip.x - 9.0, 10.0 * tip.z + 2.0]
        })
    }

    pub fn sensor(&self) -> Sensor {
        Sensor {
            time_elapsed: TICK,
            joint_angles: self.angles.into(),
            end_eff_pos: self.hands().into(),
            gripper_opening: self.grippers.into(),
            head_angle: Some(self.head),
            ..super::at_rest()
        }
    }

    pub fn obey(&mut self, motor: &MotorCommand) {
        for side in 0..2 {
            for joint in 0..7 {
                let angle = match &motor.joint_angles {
                    Some(angles) => angles[side][joint],
                    None => self.angles[side][joint] + motor.joint_velocities[side][joint] * TICK,
                };
                let least = self.limits.min_joint_angles[side][joint];
                self.angles[side][joint] =
                    angle.clamp(least, self.limits.max_joint_angles[side][joint]);
            }
            let opening = self.grippers[side] + motor.gripper_velocities[side] * TICK;
            self.grippers[side] = opening.clamp(0.0, 2.0);
        }
        self.head =
            (self.head + motor.head_velocity.unwrap_or_default() * TICK).clamp(-1.571, 1.571);
    }
}
