//! What a description lacks for dynamic mode, in which motors move masses.

use std::fmt;

use bevy::math::DMat3;
use tabletop_core::LimbId;
use tabletop_kinematics::{Link, ModelJoint};

use crate::articulation::tree::{Articulation, Carrier, TreePosition};

/// A number that dynamic mode needs and that neither the URDF nor the `robot.ron` gives. Its text says what to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MotorGap {
    /// The line of the URDF in which the joint or link starts, from 1.
    pub line: usize,
    /// The name of the joint or link.
    pub name: String,
    /// What is missing.
    pub kind: MotorGapKind,
}

/// A kind of number that dynamic mode needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotorGapKind {
    /// The largest torque of a joint's motor: without it, the joint stays where it is, or sinks.
    Effort,
    /// The largest speed of a joint's motor: without it, the joint stays where it is.
    Speed,
    /// The mass of a link that a limb moves: without it, what is beyond the joint may weigh nothing.
    Mass,
    /// The moments of inertia of such a link that has a mass.
    Inertia,
}

impl fmt::Display for MotorGap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {} of the URDF: {}", self.line, self.remedy())
    }
}

impl MotorGap {
    /// What is missing and what to write.
    pub(crate) fn remedy(&self) -> String {
        let name = &self.name;
        match self.kind {
            MotorGapKind::Effort => format!(
                "joint {name} has no motor: give its <limit> an effort (N m; N if it slides), or its entry in robot.ron one"
            ),
            MotorGapKind::Speed => format!(
                "joint {name} cannot move: give its <limit> a velocity (rad/s; m/s if it slides), or its entry in robot.ron a speed"
            ),
            MotorGapKind::Mass => format!(
                "link {name} weighs nothing: give it an <inertial> with mass (kg) and inertia (kg m²)"
            ),
            MotorGapKind::Inertia => format!(
                "link {name} has a mass and no moments of inertia: give its <inertial> an inertia (kg m²)"
            ),
        }
    }
}

impl Articulation {
    /// What the description lacks for dynamic mode, joints first.
    pub fn motor_gaps(&self) -> Vec<MotorGap> {
        let layout = &self.layout;
        let limbs = layout.limb_ids();
        let joints = limbs.flat_map(|limb| self.gaps_of_joints(limb));
        let links = self.bodies.iter().filter_map(|body| {
            let (Carrier::Link(link), TreePosition::Limb(..)) = (body.carrier, body.place) else {
                return None;
            };
            gap_of_link(self.model().link(link))
        });
        joints.chain(links).collect()
    }

    fn gaps_of_joints(&self, limb: LimbId) -> Vec<MotorGap> {
        let joints = self.layout.limb(limb).joints.iter();
        let gaps = joints.flat_map(|&joint| {
            let usual = self.layout.joint(joint);
            let described = self.joint(joint).map(|joint| self.model().joint(joint));
            let gap = |is_there: bool, kind| {
                let ModelJoint { line, name, .. } = described.filter(|_| !is_there)?;
                Some(MotorGap {
                    line: *line,
                    name: name.clone(),
                    kind,
                })
            };
            let of_urdf = |number: fn(&ModelJoint) -> f64| described.map_or(0.0, number);
            [
                gap(
                    of_urdf(|joint| joint.effort).max(usual.effort) > 0.0,
                    MotorGapKind::Effort,
                ),
                gap(
                    of_urdf(|joint| joint.velocity).max(usual.speed) > 0.0,
                    MotorGapKind::Speed,
                ),
            ]
        });
        gaps.flatten().collect()
    }
}

fn gap_of_link(link: &Link) -> Option<MotorGap> {
    let kind = match link.inertial.mass > 0.0 {
        false => MotorGapKind::Mass,
        true if link.inertial.inertia == DMat3::ZERO => MotorGapKind::Inertia,
        true => return None,
    };
    Some(MotorGap {
        line: link.line,
        name: link.name.clone(),
        kind,
    })
}

#[cfg(test)]
mod tests {
    use tabletop_core::RobotLayout;

    use super::*;

    const PANDA: &str = include_str!("../../../../assets/panda/panda.urdf");
    const LAYOUT: &str = include_str!("../../../../assets/panda/robot.ron");

    fn gaps(urdf: &str, layout: &str) -> Vec<String> {
        let source = crate::DescriptionSource {
            path: "panda.urdf".into(),
            urdf: urdf.to_owned(),
            layout: Some(layout.to_owned()),
            reach: None,
        };
        let robot = crate::Description::read(source).unwrap();
        let articulation = Articulation::new(robot.model, robot.layout).unwrap();
        let gaps = articulation.motor_gaps();
        gaps.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn the_robots_inside_the_program_lack_nothing() {
        assert_eq!(gaps(PANDA, LAYOUT), [""; 0]);
        let baxter = Articulation::new(
            tabletop_kinematics::baxter().unwrap(),
            RobotLayout::baxter().clone(),
        );
        assert_eq!(baxter.unwrap().motor_gaps(), []);
    }

    #[test]
    fn gaps_name_their_line_and_what_to_write() {
        let cut = |urdf: &str, from: &str, to: &str| {
            assert!(urdf.contains(from), "{from}");
            urdf.replacen(from, to, 1)
        };
        let urdf = cut(
            PANDA,
            "upper=\"1.7628\" effort=\"87\" velocity=\"2.175\"",
            "upper=\"1.7628\" velocity=\"0\"",
        );
        let third = urdf.find("<link name=\"panda_link3\">").unwrap();
        let (before, after) = urdf.split_at(third);
        let urdf = before.to_owned() + &cut(after, "<mass value=\"2.2\"/>", "<mass value=\"0\"/>");
        assert_eq!(
            gaps(&urdf, LAYOUT),
            [
                "line 66 of the URDF: joint panda_joint2 has no motor: give its <limit> an effort (N m; N if it slides), or its entry in robot.ron one",
                "line 66 of the URDF: joint panda_joint2 cannot move: give its <limit> a velocity (rad/s; m/s if it slides), or its entry in robot.ron a speed",
                "line 26 of the URDF: link panda_link3 weighs nothing: give it an <inertial> with mass (kg) and inertia (kg m²)",
            ]
        );
        let layout = cut(
            LAYOUT,
            "(name: \"panda_joint2\", ",
            "(name: \"panda_joint2\", effort: 80, speed: 2, ",
        );
        assert_eq!(gaps(&urdf, &layout).len(), 1);
    }
}
