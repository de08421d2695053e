//! Pictures of a robot's cameras, on a connection of their own: on that of commands they would make them late.

use std::{sync::Arc, thread::sleep, time::Duration};

use base64::{Engine as _, engine::general_purpose::STANDARD as BASE64};
use serde_json::{Value as Json, json};

use crate::{
    address::{Address, RobotWay},
    clock::WallClock,
    error::BridgeError,
    follower::Follower,
    profile::{BridgeProfile, CameraOpening},
    ros1::Ros1,
    rosbridge::Rosbridge,
    transport::{Listener, ServiceCall, TopicType, Transport},
};

/// The shortest time from picture to picture by rosbridge, which is slow with them: scripts get four a second.
const PERIOD: Duration = Duration::from_millis(200);

/// How long the opening of a camera may take.
const PATIENCE: Duration = Duration::from_secs(5);

/// How often a thread looks that waits for the first picture.
const LOOK: Duration = Duration::from_millis(5);

/// The most columns and rows of a picture.
const MOST_SIDE: u64 = 4096;

/// Controls of a `baxter_core_msgs/CameraSettings` that turn the picture of a camera that hangs upside down.
const FLIP: i32 = 107;
const MIRROR: i32 = 108;

/// A picture of a robot's camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotPicture {
    /// When it arrived, on the clock of the feed.
    pub at: Duration,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
}

/// A robot's camera.
#[derive(Debug)]
pub struct PictureFeed {
    clock: WallClock,
    follower: Follower<Latest>,
}

#[derive(Debug, Default)]
struct Latest {
    picture: Option<Arc<RobotPicture>>,
    nonsense: u64,
}

impl PictureFeed {
    /// Connects to a robot, and opens one of its cameras if it needs to be. A Baxter shows two of its three cameras at a time.
    ///
    /// # Errors
    /// It cannot be reached, or has no such camera, or does not open it.
    pub fn connect(
        address: &Address,
        profile: &BridgeProfile,
        camera: &str,
    ) -> Result<Self, BridgeError> {
        let found = profile.cameras.iter().find(|it| it.name == camera);
        let camera = found.ok_or_else(|| BridgeError::NoCamera {
            robot: profile.robot.clone(),
            camera: camera.to_owned(),
        })?;
        let clock = WallClock::start();
        let topic = TopicType {
            topic: camera.topic.clone(),
            message: profile.ros.type_name("sensor_msgs/Image"),
        };
        let (host, port) = (&address.host, address.port);
        let open = |transport: &mut dyn Transport| match &camera.opening {
            Some(opening) => open(transport, opening),
            None => Ok(()),
        };
        let listener: Box<dyn Listener> = match address.way {
            RobotWay::Ros => {
                let mut ros = Ros1::connect(host, port, clock)?;
                open(&mut ros)?;
                ros.subscribe(&topic)?;
                Box::new(ros)
            }
            RobotWay::Rosbridge => {
                let mut rosbridge = Rosbridge::connect(host, port, clock)?;
                open(&mut rosbridge)?;
                rosbridge.subscribe_at_most_every(&topic, PERIOD)?;
                Box::new(rosbridge)
            }
        };
        let follower =
            Follower::start(
                listener,
                clock,
                Latest::default(),
                |latest, received| match picture(&received.message, received.at) {
                    Some(picture) => latest.picture = Some(Arc::new(picture)),
                    None => latest.nonsense += 1,
                },
            )?;
        Ok(Self { clock, follower })
    }

    /// The newest picture, if there was one.
    pub fn latest(&self) -> Option<Arc<RobotPicture>> {
        self.follower.heard().latest.picture.clone()
    }

    /// Waits for the first picture, but no longer than this. False if none has come.
    pub fn wait(&self, most: Duration) -> bool {
        let end = self.clock.now() + most;
        while self.latest().is_none() {
            if self.clock.now() >= end || self.fault().is_some() {
                return false;
            }
            sleep(LOOK);
        }
        true
    }

    /// How old the newest picture is.
    pub fn age(&self) -> Option<Duration> {
        let picture = self.latest()?;
        Some(self.clock.now().saturating_sub(picture.at))
    }

    /// How many messages were no pictures that are known. They are passed over.
    pub fn nonsense(&self) -> u64 {
        let heard = self.follower.heard();
        heard.nonsense + heard.latest.nonsense
    }

    /// Why there will be no newer picture; none as long as the connection holds.
    pub fn fault(&self) -> Option<String> {
        self.follower.heard().fault.clone()
    }
}

fn open(transport: &mut dyn Transport, opening: &CameraOpening) -> Result<(), BridgeError> {
    let control = |id: i32| json!({"id": id, "value": 1});
    let controls = match opening.is_upside_down {
        true => vec![control(FLIP), control(MIRROR)],
        false => Vec::new(),
    };
    let (width, height) = opening.size;
    let settings =
        json!({"width": width, "height": height, "fps": opening.rate, "controls": controls});
    let call = ServiceCall {
        service: opening.service.clone(),
        service_type: "baxter_core_msgs/OpenCamera".into(),
        request: json!({"name": opening.name, "settings": settings}),
    };
    let answer = transport.call(&call, PATIENCE)?;
    match answer.get("err").and_then(Json::as_i64) {
        Some(0) => Ok(()),
        Some(_) | None => Err(BridgeError::CameraClosed {
            camera: opening.name.clone(),
            answer: answer.to_string(),
        }),
    }
}

/// The picture of a `sensor_msgs/Image`; none if its numbers do not fit together, or its encoding is not known.
fn picture(message: &Json, at: Duration) -> Option<RobotPicture> {
    let number = |field: &str| message.get(field)?.as_u64();
    let side = |field: &str| number(field).filter(|side| (1..=MOST_SIDE).contains(side));
    let (width, height) = (side("width")? as usize, side("height")? as usize);
    // Bytes of a pixel, and where red, green and blue are in it.
    let (bytes, [red, green, blue]) = match message.get("encoding")?.as_str()? {
        "rgb8" => (3, [0, 1, 2]),
        "rgba8" => (4, [0, 1, 2]),
        "bgr8" => (3, [2, 1, 0]),
        "bgra8" => (4, [2, 1, 0]),
        "mono8" => (1, [0, 0, 0]),
        _ => return None,
    };
    let step = usize::try_from(number("step")?).ok()?;
    let data = BASE64.decode(message.get("data")?.as_str()?).ok()?;
    if step < bytes * width || data.len() < step.checked_mul(height)? {
        return None;
    }
    let rows = data.chunks_exact(step).take(height);
    let pixels = rows.flat_map(|row| row[..bytes * width].chunks_exact(bytes));
    let rgb = pixels.flat_map(|pixel| [pixel[red], pixel[green], pixel[blue]]);
    Some(RobotPicture {
        at,
        width,
        height,
        rgb: rgb.collect(),
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn image(encoding: &str, size: [u64; 2], step: u64, data: &[u8]) -> Json {
        json!({"width": size[0], "height": size[1], "encoding": encoding, "step": step, "data": BASE64.encode(data)})
    }

    fn rgb(image: &Json) -> Option<Vec<u8>> {
        picture(image, Duration::ZERO).map(|picture| picture.rgb)
    }

    #[test]
    fn pictures_of_every_encoding_become_red_green_and_blue() {
        assert_eq!(
            rgb(&image("rgb8", [1, 2], 3, &[1, 2, 3, 4, 5, 6])).unwrap(),
            [1, 2, 3, 4, 5, 6]
        );
        assert_eq!(
            rgb(&image("bgra8", [1, 1], 4, &[1, 2, 3, 4])).unwrap(),
            [3, 2, 1]
        );
        assert_eq!(
            rgb(&image("mono8", [2, 1], 2, &[7, 8])).unwrap(),
            [7, 7, 7, 8, 8, 8]
        );
        // Rows may be longer than they need.
        assert_eq!(
            rgb(&image("mono8", [1, 2], 2, &[7, 0, 8, 0])).unwrap(),
            [7, 7, 7, 8, 8, 8]
        );
    }

    #[test]
    fn what_is_no_picture_is_none() {
        for wrong in [
            image("rgb8", [1, 2], 3, &[0; 5]),
            image("rgb8", [2, 1], 3, &[0; 6]),
            image("rgb8", [0, 1], 3, &[0; 6]),
            image("rgb8", [4097, 1], 20_000, &[0; 20_000]),
            image("bayer", [1, 1], 1, &[0]),
            image("rgb8", [1, 1], u64::MAX, &[0; 3]),
            json!({}),
        ] {
            assert_eq!(rgb(&wrong), None);
        }
    }

    proptest! {
        #[test]
        fn any_numbers_are_a_picture_or_none(width in 0..10u64, height in 0..10u64, step in 0..50u64, data in prop::collection::vec(any::<u8>(), 0..500)) {
            if let Some(rgb) = rgb(&image("bgr8", [width, height], step, &data)) {
                prop_assert_eq!(rgb.len() as u64, 3 * width * height);
            }
        }
    }
}
