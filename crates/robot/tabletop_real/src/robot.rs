//! The real robot.

use std::{sync::Arc, time::Duration};

use bevy::prelude::*;
use tabletop_bridge::{
    Address, Bridge, BridgeError, BridgeProfile, PictureFeed, RobotPicture, RobotState, Shadow,
    StopReason, WatchdogState,
};
use tabletop_core::Table;
use tabletop_planner::RobotBody;

use crate::body_guard::BodyGuard;

/// How long the first picture is waited for.
const FIRST_PICTURE: Duration = Duration::from_secs(1);

/// A real robot.
#[derive(Resource)]
pub struct RealRobot {
    link: RealLink,
    /// The pictures of its head camera.
    feed: Option<PictureFeed>,
    /// Why it is followed or driven no longer.
    end: Option<String>,
}

/// The connection to a real robot.
pub enum RealLink {
    /// It is only looked at.
    Shadow(Shadow),
    /// It is driven.
    Driven(Box<Bridge>),
}

impl RealLink {
    /// A robot that is driven, and guarded by a model of its body at a table.
    pub fn guarded(mut bridge: Bridge, body: RobotBody, table: Table) -> Self {
        bridge.set_guard(BodyGuard::new(body, table));
        Self::Driven(Box::new(bridge))
    }
}

/// The pictures of the camera in a robot's head; `None` if it has none there. The first one is waited for, so that a recording begins with a picture; a camera
/// that sends none for a second may send some later.
///
/// # Errors
/// The camera cannot be opened.
pub fn head_pictures(
    address: &Address,
    profile: &BridgeProfile,
) -> Option<Result<PictureFeed, BridgeError>> {
    const HEAD: &str = "head";
    let mut cameras = profile.cameras.iter();
    cameras.find(|camera| camera.name == HEAD)?;
    let connected = PictureFeed::connect(address, profile, HEAD);
    Some(connected.inspect(|feed| {
        feed.wait(FIRST_PICTURE);
    }))
}

impl RealRobot {
    /// A robot, with its head camera if it has one.
    pub const fn new(link: RealLink, feed: Option<PictureFeed>) -> Self {
        Self {
            link,
            feed,
            end: None,
        }
    }

    /// The newest picture of its head camera.
    pub fn picture(&self) -> Option<Arc<RobotPicture>> {
        self.feed.as_ref()?.latest()
    }

    /// Its head camera, if it has one.
    pub(crate) const fn feed(&self) -> Option<&PictureFeed> {
        self.feed.as_ref()
    }

    /// Its state as of its last messages.
    pub fn state(&self) -> RobotState {
        match &self.link {
            RealLink::Shadow(shadow) => shadow.state(),
            RealLink::Driven(bridge) => bridge.state(),
        }
    }

    /// True if it is driven, and not only looked at.
    pub const fn is_driven(&self) -> bool {
        matches!(self.link, RealLink::Driven(_))
    }

    /// Why it is followed or driven no longer; none as long as it is.
    pub fn end(&self) -> Option<&str> {
        self.end.as_deref()
    }

    /// Brings a driven robot to rest, lets it hold its position, and ends the connection.
    pub fn stop(self) -> Option<StopReason> {
        match self.link {
            RealLink::Shadow(_) => None,
            RealLink::Driven(bridge) => Some(bridge.stop()),
        }
    }

    pub(crate) fn bridge(&mut self) -> Option<&mut Bridge> {
        match &mut self.link {
            RealLink::Shadow(_) => None,
            RealLink::Driven(bridge) => Some(bridge),
        }
    }

    /// Ends for a reason; the first one counts.
    pub(crate) fn give_up(&mut self, reason: String) {
        self.end.get_or_insert(reason);
    }

    /// Notes if the connection or the robot has ended it.
    pub(crate) fn look_after(&mut self) {
        let fault = match &self.link {
            RealLink::Shadow(shadow) => shadow.fault(),
            RealLink::Driven(bridge) => match bridge.watchdog() {
                WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => {
                    Some(reason.to_string())
                }
                WatchdogState::Watching | WatchdogState::Armed => None,
            },
        };
        if let Some(fault) = fault {
            self.give_up(fault);
        }
    }
}
