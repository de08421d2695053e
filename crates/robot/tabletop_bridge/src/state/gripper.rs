//! Grippers as they report themselves.

use std::time::Duration;

use serde_json::Value as Json;

use crate::orders::SENDER;

/// A gripper as it reports itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GripperReading {
    /// The id that commands must name.
    pub id: u32,
    /// Whether it knows its range.
    pub is_calibrated: bool,
    /// Whether it holds something.
    pub is_gripping: bool,
    /// Whether it is faulty.
    pub has_error: bool,
    /// Its opening, from 0 (closed) to 1 (open).
    pub opening: f64,
    /// The number of this program's last command that it has got.
    pub sequence: Option<u32>,
    /// When it reported this.
    pub at: Duration,
}

impl GripperReading {
    /// The reading in a `baxter_core_msgs/EndEffectorState`; none if the message makes no sense.
    pub(super) fn of(message: &Json, at: Duration) -> Option<Self> {
        let number = |field: &str| message.get(field)?.as_u64();
        Some(Self {
            id: u32::try_from(number("id")?).ok()?,
            is_calibrated: number("calibrated")? == 1,
            is_gripping: number("gripping")? == 1,
            has_error: number("error").unwrap_or(0) == 1,
            opening: message.get("position")?.as_f64()? / 100.0,
            sequence: match message.get("command_sender")?.as_str()? == SENDER {
                true => u32::try_from(number("command_sequence")?).ok(),
                false => None,
            },
            at,
        })
    }

    /// How old it is.
    pub fn age(&self, now: Duration) -> Duration {
        now.saturating_sub(self.at)
    }
}
