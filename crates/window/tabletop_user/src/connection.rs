//! The connection to a real robot, as the user controls and watches it.

use bevy::prelude::*;

/// A request of the user about the real robot. The crate that has the connection reads it.
#[derive(Message, Clone, Debug, PartialEq)]
pub enum ConnectionOrder {
    /// Connect to a robot, which is only looked at.
    Follow {
        /// Its address, such as `baxter:ros://HOST:11311`.
        address: String,
    },
    /// Connect to a robot, which is driven in the place of the simulated one.
    Drive {
        /// Its address.
        address: String,
        /// How it may be driven.
        leave: DrivingLeave,
    },
    /// End the connection. A robot that is driven is brought to rest first, and holds its position.
    Stop,
}

/// How a real robot may be driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivingLeave {
    /// The share of the joints' greatest speeds that they may have, above 0 and at most 1.
    pub speed: f64,
    /// Whether its motors may be switched on at the start.
    pub enable: bool,
    /// Whether grippers that do not know their range may find it out at the start.
    pub calibrate: bool,
    /// Whether it may move to angles that are far away.
    pub moves: bool,
}

impl Default for DrivingLeave {
    /// A tenth of the speed, and nothing else.
    fn default() -> Self {
        Self {
            speed: 0.1,
            enable: false,
            calibrate: false,
            moves: false,
        }
    }
}

/// The connection to a real robot. The crate that has it sets it.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub enum Connection {
    /// There is none, and none was asked for.
    #[default]
    None,
    /// The robot of an address is being looked for.
    Connecting(String),
    /// The robot of an address is looked at.
    Following(String),
    /// The robot of an address is driven.
    Driving(String),
    /// The robot was not found, or is followed or driven no longer, for a reason.
    Ended(String),
}

impl Connection {
    /// True while a robot is driven.
    pub const fn drives(&self) -> bool {
        matches!(self, Self::Driving(_))
    }
}
