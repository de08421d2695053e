//! How fast a joint may turn where it is.

use crate::profile::JointProfile;

/// The greatest change of a joint's speed in ordinary motion, in rad/s². A Baxter's joints are springs: they swing after harder ones.
pub const ACCELERATION: f64 = 5.0;

/// The last way before a goal or a limit, in rad, on which the speed is proportional to what is left of it. Before that it is what
/// [`ACCELERATION`] can brake in time.
pub const LINEAR_ZONE: f64 = 0.05;

/// What a joint keeps away from its limits, in rad: a robot drops the whole command if any joint of it would pass its limit.
pub const LIMIT_MARGIN: f64 = 0.005;

/// The greatest speed, in rad/s, at which something that is this far away, in rad, can be approached and not passed.
///
/// It is continuous, and so is its slope: proportional in the linear zone, the parabola of even braking before it.
pub fn approach_speed(distance: f64) -> f64 {
    let distance = distance.max(0.0);
    match distance < LINEAR_ZONE {
        true => distance * (ACCELERATION / LINEAR_ZONE).sqrt(),
        false => (2.0 * ACCELERATION * (distance - LINEAR_ZONE / 2.0)).sqrt(),
    }
}

/// A joint's speed, in rad/s, on the way to a goal that is this far away, in rad.
pub(crate) fn speed_towards(way: f64) -> f64 {
    approach_speed(way.abs()).copysign(way)
}

/// A speed, in rad/s, that a joint can have at a position: no faster than the share of its greatest speed, and so slow before a limit that it never
/// passes it. What is already beyond a limit can only come back.
pub(crate) fn limited_speed(joint: &JointProfile, share: f64, position: f64, wanted: f64) -> f64 {
    let (least, largest) = joint.limits;
    let fastest = joint.speed * share;
    let up = approach_speed(largest - LIMIT_MARGIN - position).min(fastest);
    let down = approach_speed(position - least - LIMIT_MARGIN).min(fastest);
    wanted.clamp(-down, up)
}

/// A speed on the way from the last one to a wanted one, in rad/s, `seconds` later.
pub(crate) fn ramped_speed(last: f64, wanted: f64, seconds: f64) -> f64 {
    let most = ACCELERATION * seconds;
    last + (wanted - last).clamp(-most, most)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn joint() -> JointProfile {
        JointProfile {
            name: "left_s0".into(),
            limits: (-1.7, 1.7),
            speed: 1.5,
        }
    }

    #[test]
    fn the_speed_before_a_limit_is_smooth() {
        let slope = |distance: f64| {
            (approach_speed(distance + 1e-6) - approach_speed(distance - 1e-6)) / 2e-6
        };
        assert_eq!(approach_speed(-1.0), 0.0);
        assert!((approach_speed(LINEAR_ZONE) - 0.5).abs() < 1e-12);
        assert!((slope(LINEAR_ZONE - 1e-5) - slope(LINEAR_ZONE + 1e-5)).abs() < 0.01);
    }

    proptest! {
        #[test]
        fn no_joint_passes_its_limit_whatever_is_wanted(
            start in -1.69..1.69f64,
            wanted in prop::collection::vec(-100.0..100.0f64, 1..40),
        ) {
            let (joint, dt) = (joint(), 0.01);
            let (mut position, mut speed) = (start, 0.0);
            for wanted in wanted {
                for _ in 0..10 {
                    let limited = limited_speed(&joint, 1.0, position, wanted);
                    let next = limited_speed(&joint, 1.0, position, ramped_speed(speed, limited, dt));
                    // What limits ask for brakes no harder than the acceleration, but for the steps of time.
                    prop_assert!((next - speed).abs() <= ACCELERATION * dt * 1.15 + 1e-9, "{speed} {next} at {position}");
                    speed = next;
                    position += speed * dt;
                    prop_assert!((-1.7..=1.7).contains(&position));
                }
            }
        }

        #[test]
        fn what_is_beyond_a_limit_only_comes_back(beyond in 0.0..1.0f64, wanted in -100.0..100.0f64) {
            let speed = limited_speed(&joint(), 1.0, 1.7 + beyond, wanted);
            prop_assert!((-1.5..=0.0).contains(&speed));
        }
    }
}
