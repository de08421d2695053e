//! Changes of measured angles that no joint can make: a second publisher, an encoder that was restarted, another robot.

use std::{fmt, time::Duration};

use crate::{
    profile::JointProfile,
    tolerances::{JUMP_FACTOR, JUMP_SLACK, JUMP_SPAN},
};

/// A change of a joint's angle that the joint cannot have made.
#[derive(Clone, Debug, PartialEq)]
pub struct JointJump {
    /// The joint.
    pub joint: String,
    /// The change, in rad.
    pub by: f64,
    /// The time between the two states.
    pub within: Duration,
}

impl fmt::Display for JointJump {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { joint, by, within } = self;
        write!(
            f,
            "{joint} jumped by {by:.2} rad in {} ms, which no joint can: its states are of two publishers, or its encoder was restarted",
            within.as_millis()
        )
    }
}

/// The jump from one angle to another, in rad, if it is one.
pub(super) fn jump(
    joint: &JointProfile,
    before: (f64, Duration),
    now: (f64, Duration),
) -> Option<JointJump> {
    let by = (now.0 - before.0).abs();
    let within = now.1.saturating_sub(before.1);
    let seconds = within.max(JUMP_SPAN).as_secs_f64();
    let most = JUMP_FACTOR * joint.speed * seconds + JUMP_SLACK;
    (by > most).then(|| JointJump {
        joint: joint.name.clone(),
        by,
        within,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fast_joint_does_not_jump_and_a_second_publisher_does() {
        let joint = JointProfile {
            name: "left_w2".into(),
            limits: (-3.0, 3.0),
            speed: 4.0,
        };
        let ms = Duration::from_millis;
        // A period, a burst after a pause, and a pause.
        assert_eq!(jump(&joint, (0.0, ms(100)), (0.04, ms(110))), None);
        assert_eq!(jump(&joint, (0.0, ms(100)), (0.2, ms(101))), None);
        assert_eq!(jump(&joint, (0.0, ms(100)), (2.0, ms(600))), None);
        let found = jump(&joint, (0.0, ms(100)), (-1.0, ms(110))).unwrap();
        assert!(
            found
                .to_string()
                .starts_with("left_w2 jumped by 1.00 rad in 10 ms"),
            "{found}"
        );
    }
}
