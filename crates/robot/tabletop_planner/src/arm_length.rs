//! The length of an arm, by which poses are certainly out of reach.

use bevy::math::{DAffine3, DVec3};
use tabletop_kinematics::ArmChain;

/// How far the joints of an arm can be from each other, in m, in the frame of its base.
#[derive(Clone, Debug)]
pub(crate) struct ArmLength {
    /// The circle on which the second joint is turned by the first one.
    shoulder: ShoulderCircle,
    /// Points that are fixed in the tip's frame, and the greatest distance of each from that circle. None if a joint slides: then any pose may
    /// be reached.
    points: Vec<(DVec3, f64)>,
}

#[derive(Clone, Copy, Debug)]
struct ShoulderCircle {
    centre: DVec3,
    axis: DVec3,
    radius: f64,
}

impl ArmLength {
    /// The length of an arm, from any of its postures.
    pub fn of(chain: &ArmChain, angles: impl IntoIterator<Item = f64>) -> Self {
        let angles: Vec<_> = angles.into_iter().collect();
        let joints: Vec<_> = chain
            .frames(&angles)
            .map(|frame| frame.translation)
            .collect();
        let axes: Vec<_> = chain
            .jacobian(&angles)
            .iter()
            .map(|joint| joint.angular)
            .collect();
        let tip = chain.tip(&angles);
        let second = joints.get(1).copied().unwrap_or(tip.translation);
        let along = axes[0] * (second - joints[0]).dot(axes[0]);
        let centre = joints[0] + along;
        let shoulder = ShoulderCircle {
            centre,
            axis: axes[0],
            radius: second.distance(centre),
        };
        let lengths = joints.windows(2).map(|pair| pair[0].distance(pair[1]));
        let to_each: Vec<_> = lengths
            .skip(1)
            .scan(0.0, |sum, length| {
                *sum += length;
                Some(*sum)
            })
            .collect();
        let in_tip = |point: DVec3| tip.inverse().transform_point3(point);
        let mut points = Vec::new();
        // The last joint does not move itself, nor the foot on its axis of the joint before.
        if let ([.., before, last], [.., axis]) = (&joints[..], &axes[..])
            && let [.., to_before, to_last] = to_each[..]
        {
            let foot = last + axis * (before - last).dot(*axis);
            points.push((in_tip(*last), to_last));
            points.push((in_tip(foot), to_before + foot.distance(*before)));
        }
        if axes.contains(&DVec3::ZERO) {
            return Self {
                shoulder,
                points: Vec::new(),
            };
        }
        let last = joints.last().copied().unwrap_or_default();
        let to_tip = to_each.last().copied().unwrap_or(0.0) + last.distance(tip.translation);
        points.push((DVec3::ZERO, to_tip));
        Self { shoulder, points }
    }

    /// True if the tip is certainly not at this pose.
    pub fn excludes(&self, tip: &DAffine3) -> bool {
        /// For rounding, in m.
        const SLACK: f64 = 1e-6;
        self.points.iter().any(|(point, longest)| {
            self.shoulder.distance(tip.transform_point3(*point)) > longest + SLACK
        })
    }
}

impl ShoulderCircle {
    fn distance(&self, point: DVec3) -> f64 {
        let from_centre = point - self.centre;
        let height = from_centre.dot(self.axis);
        let across = (from_centre - self.axis * height).length();
        let out = across - self.radius;
        (out * out + height * height).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::Random;
    use tabletop_kinematics::{RobotModel, baxter};

    use super::*;

    #[test]
    fn an_arm_that_slides_excludes_nothing() {
        let text = "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>\
            <joint name='i' type='prismatic'><parent link='a'/><child link='b'/><limit upper='1' velocity='1'/></joint>\
            <joint name='j' type='revolute'><parent link='b'/><child link='c'/><limit upper='1' velocity='1'/></joint></robot>";
        let arm = ArmChain::between(&RobotModel::from_urdf(text).unwrap(), "a", "c").unwrap();
        let length = ArmLength::of(&arm, [0.0; 2]);
        assert!(!length.excludes(&arm.tip(&[1.0, 0.5])));
    }

    #[test]
    fn no_posture_is_excluded_and_far_poses_are() {
        let arm = ArmChain::between(&baxter().unwrap(), "torso", "right_end_effector").unwrap();
        let length = ArmLength::of(&arm, [0.1, -0.3, 0.2, 0.9, -0.4, 0.6, 0.3]);
        let mut random = Random::new(1);
        for _ in 0..2000 {
            let limits = arm.limits().iter();
            let angles: Vec<_> = limits
                .map(|[least, most]| least + (most - least) * f64::from(random.between((0.0, 1.0))))
                .collect();
            assert!(!length.excludes(&arm.tip(&angles)), "{angles:?}");
        }
        let stretched = arm.tip(&[0.0; 7]);
        let beyond = DAffine3::from_translation(stretched.translation * 0.03) * stretched;
        assert!(length.excludes(&beyond));
    }
}
