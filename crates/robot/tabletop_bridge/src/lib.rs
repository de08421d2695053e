//! The connection to real robots.
//!
//! A [`Shadow`] looks at one and can do nothing else. A [`Bridge`] drives one: the program sets a [`RobotTarget`] 60 times a second, and a thread of its own,
//! with a [`Watchdog`], passes on what is safe and brings the robot to rest when anything is not as it should be.
//!
//! A robot is reached by rosbridge ([`Rosbridge`]) or by its own ROS 1 ([`Ros1`]); its topics and limits are data, a [`BridgeProfile`]. This is the only crate
//! with a [`WallClock`]. There is no ECS. Angles are in rad and speeds in rad/s, of the robot's own joints.
//!
//! ```no_run
//! use tabletop_bridge::{Address, BridgeProfile, Shadow};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let address: Address = "baxter:ros://011305P0002.local:11311".parse()?;
//! let shadow = Shadow::connect(&address, &BridgeProfile::shipped(&address.robot)?)?;
//! println!("{:?}", shadow.state().joints["left_s0"].position);
//! # Ok(())
//! # }
//! ```

mod address;
mod bridge;
mod clock;
mod connection;
mod error;
mod follower;
mod guard;
mod interruption;
mod limits;
mod observation;
mod options;
mod orders;
mod pictures;
mod pilot;
mod profile;
mod ros1;
mod rosbridge;
mod sentinel;
mod shadow;
mod state;
mod target;
mod tolerances;
mod transport;
mod watchdog;

pub use address::{Address, AddressError, RobotWay};
pub use bridge::Bridge;
pub use clock::WallClock;
pub use error::{BridgeError, TopicFault};
pub use guard::Guard;
pub use interruption::{is_interrupted, stop_robots_at_the_end};
pub use limits::{ACCELERATION, LIMIT_MARGIN, LINEAR_ZONE, approach_speed};
pub use options::BridgeOptions;
pub use orders::{GripperMotion, RobotOrder};
pub use pictures::{PictureFeed, RobotPicture};
pub use pilot::Pilot;
pub use profile::{
    BridgeProfile, CameraOpening, CameraProfile, CommandTopic, GripperProfile, HeadProfile,
    HealthTopic, JointProfile, LimbProfile, ProfileError, RosVersion, SoftwareVersion, TimeLimit,
};
pub use ros1::Ros1;
pub use rosbridge::Rosbridge;
pub use sentinel::{Sentinel, keep_watch};
pub use shadow::Shadow;
pub use state::{GripperReading, JointJump, JointReading, RobotHealth, RobotState, StateReader};
pub use target::{FARTHEST_STEP, LimbTarget, RobotTarget, TargetError};
pub use tolerances::{HOLD, MOST_DEVIATION, OLDEST_REPORT, OLDEST_STATE, OLDEST_TARGET, RAMP};
pub use transport::{Listener, Received, ServiceCall, TopicType, Transport, TransportError};
pub use watchdog::{PERIOD, PredictedMotion, StopReason, Watchdog, WatchdogState};
