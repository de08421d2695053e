//! How long joint states are on their way from a mock Baxter on the genuine rospy, and how long commands take to move it: `cargo bench -p
//! tabletop_bridge --bench latency`. Both ends are on this machine.
#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "it is a benchmark"
)]

#[path = "../tests/ros1/mock.rs"]
#[expect(dead_code, reason = "tests use more of it")]
mod mock;

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use mock::MockBaxter;
use serde_json::json;
use tabletop_bridge::{Listener as _, Ros1, TopicType, Transport as _, WallClock};

/// How many messages are measured.
const COUNT: usize = 1000;

fn main() {
    let baxter = MockBaxter::start();
    let clock = WallClock::start();
    let address = baxter.address();
    let mut ros = Ros1::connect(&address.host, address.port, clock).unwrap();
    let topic = |topic: &str, message: &str| TopicType {
        topic: topic.into(),
        message: message.into(),
    };
    let states = topic("/robot/joint_states", "sensor_msgs/JointState");
    ros.subscribe(&states).unwrap();
    let commands = topic(
        "/robot/limb/left/joint_command",
        "baxter_core_msgs/JointCommand",
    );
    ros.advertise(&commands, false).unwrap();

    let mut ways = Vec::new();
    while ways.len() < COUNT {
        let Some(received) = ros.poll(clock.now() + Duration::from_secs(1)).unwrap() else {
            continue;
        };
        let stamp = &received.message["header"]["stamp"];
        let secs = stamp["secs"].as_u64().unwrap();
        if secs > 0 {
            let nsecs = u32::try_from(stamp["nsecs"].as_u64().unwrap()).unwrap();
            let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
            ways.push(now.saturating_sub(Duration::new(secs, nsecs)));
        }
    }
    print("a state's way", &mut ways);

    let mut reactions = Vec::new();
    for turn in 0..COUNT / 10 {
        let speed = if turn % 2 == 0 { 0.5 } else { -0.5 };
        let command = json!({"mode": 2, "command": [speed], "names": ["left_s0"]});
        let sent = clock.now();
        ros.publish(&commands.topic, &command).unwrap();
        loop {
            let Some(received) = ros.poll(clock.now() + Duration::from_secs(1)).unwrap() else {
                continue;
            };
            let message = &received.message;
            let names = message["name"].as_array().unwrap();
            let place = names.iter().position(|name| name == "left_s0");
            if place.is_some_and(|place| message["velocity"][place] == speed) {
                reactions.push(received.at - sent);
                break;
            }
        }
    }
    print("from a command to the state that shows it", &mut reactions);
}

fn print(what: &str, times: &mut [Duration]) {
    times.sort_unstable();
    let ms = |share: f64| times[((times.len() - 1) as f64 * share) as usize].as_secs_f64() * 1e3;
    println!(
        "{what}: median {:.2} ms, 99 % {:.2} ms, longest {:.2} ms",
        ms(0.5),
        ms(0.99),
        ms(1.0)
    );
}
