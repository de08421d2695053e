//! What the worst moments cost, and how quick it is in the best ones: `cargo bench -p tabletop_bridge --bench stops [-- COUNT]`. A program that drives a
//! mock Baxter on the genuine rospy, one behind rosbridge and a mock Panda is ended by signals and panics, and an emergency stop is pressed, at COUNT
//! moments each; then it drives for a minute beside a busy core.
#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "it is a benchmark"
)]

#[path = "../tests/ros1/mock.rs"]
#[expect(dead_code, reason = "tests use more of it")]
mod mock;
#[path = "../tests/rosbridge/mock.rs"]
#[expect(dead_code, reason = "tests use more of it")]
mod rosbridge;

use std::{
    env,
    io::Write as _,
    process::{Child, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

use mock::MockBaxter;
use rosbridge::MockServer;
use tabletop_bridge::{
    Address, Bridge, BridgeOptions, BridgeProfile, LimbTarget, RobotTarget, Sentinel,
    WatchdogState, is_interrupted, keep_watch, stop_robots_at_the_end,
};

/// The variable with the address of the robot that this program drives until it is killed, and that with its speed.
const ADDRESS: &str = "TABLETOP_BENCH_DRIVES";
const SPEED: &str = "TABLETOP_BENCH_SPEED";
/// The variable with the limb, and the one that makes this program the sentinel of one that drives.
const LIMB: &str = "TABLETOP_BENCH_LIMB";
const SENTINEL: &str = "TABLETOP_BENCH_SENTINEL";
/// In rad/s.
const FAST: f64 = 0.5;
/// From one target to the next.
const PERIOD: Duration = Duration::from_micros(16_667);
/// Length of the drive beside a busy core.
const MINUTE: Duration = Duration::from_secs(60);

fn main() {
    if let (Ok(address), Ok(speed), Ok(limb)) = (env::var(ADDRESS), env::var(SPEED), env::var(LIMB))
    {
        let address = address.parse().unwrap();
        match env::var(SENTINEL) {
            Ok(_) => return watch_over(&address),
            Err(_) => return drive(&address, &limb, speed.parse().unwrap()),
        }
    }
    let mut words = env::args().skip(1).filter(|word| !word.starts_with("--"));
    let count = words.next().map_or(100, |count| count.parse().unwrap());
    end(count);
    press(count);
    hurry();
}

fn begin(address: &Address, limb: &str) -> Bridge {
    let options = BridgeOptions {
        limbs: vec![limb.to_owned()],
        speed: 0.5,
        enable: true,
        ..BridgeOptions::default()
    };
    let profile = BridgeProfile::shipped(&address.robot).unwrap();
    let mut bridge = Bridge::connect(address, &profile, &options).unwrap();
    if profile.needs_sentinel() {
        let mut command = Command::new(env::current_exe().unwrap());
        command.env(SENTINEL, "");
        bridge.set_sentinel(Sentinel::start(command).unwrap());
    }
    while bridge.arm().is_err() {
        thread::sleep(PERIOD);
    }
    bridge
}

fn watch_over(address: &Address) {
    let profile = BridgeProfile::shipped(&address.robot).unwrap();
    let ready = || {
        println!("ready");
        Ok(())
    };
    keep_watch(address, &profile, &[], std::io::stdin().lock(), ready).unwrap();
}

fn first_joint(limb: &str, speed: f64) -> RobotTarget {
    let mut speeds = vec![0.0; 7];
    speeds[0] = speed;
    RobotTarget {
        limbs: [(limb.to_owned(), LimbTarget::Velocities(speeds))].into(),
        ..RobotTarget::default()
    }
}

/// Drives until a signal ends it, or it is asked to panic.
fn drive(address: &Address, limb: &str, speed: f64) {
    stop_robots_at_the_end();
    let is_to_panic = Arc::new(AtomicBool::new(false));
    let asked = is_to_panic.clone();
    thread::spawn(move || {
        let line = std::io::stdin().lines().next();
        asked.store(line.is_some(), Ordering::Relaxed);
    });
    let mut bridge = begin(address, limb);
    while !is_interrupted() {
        drop(bridge.aim(first_joint(limb, speed)));
        thread::sleep(PERIOD);
        assert!(!is_to_panic.load(Ordering::Relaxed), "it was asked to");
    }
}

/// Moments, in s, that look random and are the same in every run.
fn moment(number: usize) -> f64 {
    (number as f64 * 0.618_034).fract()
}

/// What ends a program.
#[derive(Clone, Copy)]
enum Cause {
    Signal(&'static str),
    /// In its next tick.
    Panic,
}

const CAUSES: [Cause; 5] = [
    Cause::Signal("KILL"),
    Cause::Signal("INT"),
    Cause::Signal("TERM"),
    Cause::Signal("HUP"),
    Cause::Panic,
];

impl Cause {
    fn name(self) -> String {
        match self {
            Self::Signal(signal) => format!("SIG{signal}"),
            Self::Panic => "a panic".into(),
        }
    }

    fn strike(self, program: &mut Child) {
        match self {
            Self::Signal(signal) => {
                let mut kill = Command::new("kill");
                kill.args([format!("-{signal}"), program.id().to_string()]);
                assert!(kill.status().unwrap().success());
            }
            Self::Panic => writeln!(program.stdin.as_mut().unwrap(), "panic").unwrap(),
        }
    }
}

/// Programs that drive at 0.5 rad/s are ended by each cause at many moments: how far the joint goes on, in the mock's truth.
fn end(count: usize) {
    thread::scope(|scope| {
        scope.spawn(|| {
            let mut baxter = MockBaxter::start();
            let address = baxter.address();
            let angle = move || baxter.report().angles["right_s0"];
            end_each(count, "baxter, ROS 1", &address, "right", angle);
        });
        for (name, limb, joint) in [
            ("baxter", "right", "right_s0"),
            ("panda", "panda", "panda_joint1"),
        ] {
            scope.spawn(move || {
                let server = MockServer::start(name);
                let address = server.address();
                let angle = move || server.robot().angles[joint];
                end_each(count, &format!("{name}, rosbridge"), &address, limb, angle);
            });
        }
    });
}

fn end_each(
    count: usize,
    robot: &str,
    address: &Address,
    limb: &str,
    mut angle: impl FnMut() -> f64,
) {
    for cause in CAUSES {
        let mut ways = Vec::new();
        for number in 0..count {
            let speed = if number % 2 == 0 { FAST } else { -FAST };
            let mut command = Command::new(env::current_exe().unwrap());
            command.env(ADDRESS, address.to_string()).env(LIMB, limb);
            command.env(SPEED, speed.to_string()).stdin(Stdio::piped());
            command.stdout(Stdio::null()).stderr(Stdio::null());
            let begun = angle();
            let mut program = command.spawn().unwrap();
            while (angle() - begun).abs() < 0.1 {
                // A busy machine may have stopped it.
                if program.try_wait().unwrap().is_some() {
                    program = command.spawn().unwrap();
                }
                thread::sleep(Duration::from_millis(1));
            }
            thread::sleep(Duration::from_secs_f64(0.3 * moment(number)));
            let at_its_end = angle();
            cause.strike(&mut program);
            while program.try_wait().unwrap().is_none() {
                thread::sleep(Duration::from_millis(1));
            }
            thread::sleep(Duration::from_millis(500));
            ways.push((angle() - at_its_end).abs());
        }
        let what = format!(
            "{robot}: after {} at 0.5 rad/s it goes on for",
            cause.name()
        );
        print(&what, "rad", &mut ways);
    }
}

fn press(count: usize) {
    let mut baxter = MockBaxter::start();
    let mut late = Vec::new();
    for number in 0..count {
        let speed = if number % 2 == 0 { FAST } else { -FAST };
        let mut bridge = begin(&baxter.address(), "right");
        let begin = Instant::now();
        let end = Duration::from_secs_f64(0.4 + 0.5 * moment(number));
        while begin.elapsed() < end {
            bridge.aim(first_joint("right", speed)).unwrap();
            thread::sleep(PERIOD);
        }
        let stopped_at = baxter.order("estop").stopped_at;
        while bridge.aim(first_joint("right", speed)).is_ok() {
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
    let mut bridge = begin(&baxter.address(), "right");
    let begin = Instant::now();
    let mut asked = Vec::new();
    let mut due = begin;
    while begin.elapsed() < MINUTE {
        // Each speed is another one, so each command is known.
        let speed = 1e-3 + 1e-6 * asked.len() as f64;
        let age = bridge.age();
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
        bridge.aim(first_joint("right", speed)).unwrap();
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
