//! What the worst moments cost, and how quick it is in the best ones: `cargo bench -p tabletop_bridge --bench stops [-- COUNT]`. A program that drives a
//! mock Baxter on the genuine rospy is killed, and an emergency stop is pressed, at COUNT moments each; then it drives for a minute beside a busy core.
#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "it is a benchmark"
)]

#[path = "../tests/ros1/mock.rs"]
#[expect(dead_code, reason = "tests use more of it")]
mod mock;

use std::{
    env,
    process::{Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

use mock::MockBaxter;
use tabletop_bridge::{
    Address, Bridge, BridgeOptions, BridgeProfile, LimbTarget, RobotTarget, WatchdogState,
};

/// The variable with the address of the robot that this program drives until it is killed, and that with its speed.
const ADDRESS: &str = "TABLETOP_BENCH_DRIVES";
const SPEED: &str = "TABLETOP_BENCH_SPEED";
/// In rad/s.
const FAST: f64 = 0.5;
/// From one target to the next.
const PERIOD: Duration = Duration::from_micros(16_667);
/// Length of the drive beside a busy core.
const MINUTE: Duration = Duration::from_secs(60);

fn main() {
    if let (Ok(address), Ok(speed)) = (env::var(ADDRESS), env::var(SPEED)) {
        drive_for_ever(&address.parse().unwrap(), speed.parse().unwrap());
    }
    let mut words = env::args().skip(1).filter(|word| !word.starts_with("--"));
    let count = words.next().map_or(100, |count| count.parse().unwrap());
    hurry();
    kill(count);
    press(count);
}

fn begin(address: &Address) -> Bridge {
    let options = BridgeOptions {
        limbs: vec!["right".into()],
        speed: 0.5,
        enable: true,
        ..BridgeOptions::default()
    };
    let profile = BridgeProfile::shipped("baxter").unwrap();
    let mut bridge = Bridge::connect(address, &profile, &options).unwrap();
    while bridge.arm().is_err() {
        thread::sleep(PERIOD);
    }
    bridge
}

fn first_joint(speed: f64) -> RobotTarget {
    let mut speeds = vec![0.0; 7];
    speeds[0] = speed;
    RobotTarget {
        limbs: [("right".to_owned(), LimbTarget::Velocities(speeds))].into(),
        ..RobotTarget::default()
    }
}

fn drive_for_ever(address: &Address, speed: f64) -> ! {
    let mut bridge = begin(address);
    loop {
        bridge.aim(first_joint(speed)).unwrap();
        thread::sleep(PERIOD);
    }
}

/// Moments, in s, that look random and are the same in every run.
fn moment(number: usize) -> f64 {
    (number as f64 * 0.618_034).fract()
}

fn kill(count: usize) {
    let mut baxter = MockBaxter::start();
    let mut ways = Vec::new();
    for number in 0..count {
        let speed = if number % 2 == 0 { FAST } else { -FAST };
        let mut command = Command::new(env::current_exe().unwrap());
        command.env(ADDRESS, baxter.address().to_string());
        command.env(SPEED, speed.to_string()).stdout(Stdio::null());
        let begun = baxter.report().angles["right_s0"];
        let mut program = command.spawn().unwrap();
        while (baxter.report().angles["right_s0"] - begun).abs() < 0.1 {
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(Duration::from_secs_f64(0.3 * moment(number)));
        program.kill().unwrap();
        program.wait().unwrap();
        let at_death = baxter.report().angles["right_s0"];
        thread::sleep(Duration::from_millis(500));
        ways.push((baxter.report().angles["right_s0"] - at_death).abs());
    }
    print("killed at 0.5 rad/s, it goes on for", "rad", &mut ways);
}

fn press(count: usize) {
    let mut baxter = MockBaxter::start();
    let mut late = Vec::new();
    for number in 0..count {
        let speed = if number % 2 == 0 { FAST } else { -FAST };
        let mut bridge = begin(&baxter.address());
        let begin = Instant::now();
        let end = Duration::from_secs_f64(0.4 + 0.5 * moment(number));
        while begin.elapsed() < end {
            bridge.aim(first_joint(speed)).unwrap();
            thread::sleep(PERIOD);
        }
        let stopped_at = baxter.order("estop").stopped_at;
        while bridge.aim(first_joint(speed)).is_ok() {
            thread::sleep(PERIOD);
        }
        while matches!(bridge.watchdog(), WatchdogState::Ramping(_)) {
            thread::sleep(PERIOD);
        }
        thread::sleep(Duration::from_millis(200));
        let log = &baxter.report().log["right"];
        let last = log.last().map_or(0.0, |(time, _)| *time);
        late.push((last - stopped_at).max(0.0) * 1e3);
        drop(bridge);
        baxter.order("reset");
        baxter.order("forget");
    }
    print(
        "an emergency stop is followed by commands for",
        "ms",
        &mut late,
    );
}

fn hurry() {
    let mut baxter = MockBaxter::start();
    let is_over = Arc::new(AtomicBool::new(false));
    let over = is_over.clone();
    let busy = thread::spawn(move || {
        while !over.load(Ordering::Relaxed) {
            std::hint::spin_loop();
        }
    });
    let mut bridge = begin(&baxter.address());
    let begin = Instant::now();
    let mut asked = Vec::new();
    let mut due = begin;
    while begin.elapsed() < MINUTE {
        // Each speed is another one, so each command is known.
        let speed = 1e-3 + 1e-6 * asked.len() as f64;
        let age = bridge.age();
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
        bridge.aim(first_joint(speed)).unwrap();
        asked.push((speed, now.as_secs_f64(), age.as_secs_f64()));
        due += PERIOD;
        thread::sleep(due.saturating_duration_since(Instant::now()));
    }
    let log = baxter.report().log["right"].clone();
    is_over.store(true, Ordering::Relaxed);
    busy.join().unwrap();
    let known = asked.iter().filter_map(|(speed, at, age)| {
        let (time, _) = log.iter().find(|(_, sent)| (sent - speed).abs() < 1e-9)?;
        Some(((time - at) * 1e3, (time - at + age) * 1e3))
    });
    let (mut from_target, mut from_state): (Vec<_>, Vec<_>) = known.unzip();
    println!(
        "{} of {} targets became commands",
        from_target.len(),
        asked.len()
    );
    print("from a target to its command", "ms", &mut from_target);
    print(
        "from the state that the target answers, up to 10 ms old, to the command",
        "ms",
        &mut from_state,
    );
}

fn print(what: &str, unit: &str, numbers: &mut [f64]) {
    numbers.sort_by(f64::total_cmp);
    let at = |share: f64| numbers[((numbers.len() - 1) as f64 * share) as usize];
    println!(
        "{what}: median {:.3} {unit}, 99 % {:.3} {unit}, most {:.3} {unit} ({} times)",
        at(0.5),
        at(0.99),
        at(1.0),
        numbers.len()
    );
}
