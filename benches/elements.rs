//! Costs of elements of task files: how long 10,000 instances take until they are in the world, what 200 controls add to a tick, and what
//! a tick of rings costs beside one of cylinders. `cargo bench --bench elements` prints medians.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

use std::{
    fmt::Write as _,
    path::Path,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop::{
    physics::{PhysicsPlugin, PhysicsSettings},
    prelude::*,
    xml::{NAMESPACE, parse},
};

const INSTANCES: usize = 10_000;
const CONTROLS: i32 = 200;
const TICKS_PER_TURN: u32 = 60;
const TURNS: usize = 40;

fn main() {
    instances();
    println!();
    controls();
    println!();
    rings();
}

/// The time from the text of a task file to the end of the tick in which its objects are in the world.
fn instances() {
    let mut content = String::from(
        "<def name='cube'><var name='side' value='1'/><var name='half' value='$side/2$'/>\
         <block id='cube$n$' location='($x$,$y$,$half$)' xspan='$side$' yspan='$side$' zspan='$side$'/></def>",
    );
    for n in 0..INSTANCES {
        let (x, y) = (n % 100 * 2, n / 100 * 2);
        let _written = write!(
            content,
            "<instance def='cube'><var name='n' value='{n}'/><var name='x' value='{x}'/><var name='y' value='{y}'/></instance>"
        );
    }
    let (mut reading, mut setting) = (Vec::new(), Vec::new());
    for _ in 0..5 {
        let mut app = headless_app_with(TabletopSimPlugins);
        app.step(1);
        let mut scene = SceneSpec::default();
        reading.push(time(|| scene = read(&content)));
        assert_eq!(scene.items.len(), INSTANCES);
        setting.push(time(|| {
            app.world_mut()
                .write_command(SceneCommand::Set(Box::new(scene)));
            app.step(1);
        }));
        assert_eq!(app.world().resource::<ObjectIndex>().len(), INSTANCES);
    }
    let [reading, setting] = [reading, setting].map(|times| median(times).as_secs_f64() * 1e3);
    println!(
        "{INSTANCES} instances: read in {reading:.0} ms, in the world after {setting:.0} ms more"
    );
}

/// A tick of 50 blocks in towers that may not sleep: alone, with 200 composites, and with the same composites as controls.
fn controls() {
    let place = |n: i32| format!("({},{},0)", n % 20 * 2 - 20, n / 20 * 2 + 10);
    let (mut plain, mut operated) = (String::new(), String::new());
    for n in 0..CONTROLS {
        let (at, next) = (place(n), (n + 1) % CONTROLS);
        let _written = write!(
            plain,
            "<composite location='{at}' mass='0'><block location='(-0.15,0,0.05)' xspan='0.3' yspan='0.3' zspan='0.1'/>\
             <block location='(0.15,0,0.05)' xspan='0.3' yspan='0.3' zspan='0.1'/></composite>"
        );
        let _written = write!(
            operated,
            "<toggleSwitch id='c{n}' location='{at}' mass='0'><downstream id='c{next}'/></toggleSwitch>"
        );
    }
    let towers = towers();
    let mut apps = ["", &plain, &operated].map(|others| awake(&format!("{towers}{others}")));
    let [alone, plain, operated] = ticks(&mut apps);
    println!(
        "a tick of 50 blocks: {alone:.1} µs, with {CONTROLS} fixed composites {plain:.1} µs, with {CONTROLS} switches {operated:.1} µs"
    );
}

fn towers() -> String {
    let block = |n: i32| {
        let (x, y, z) = (n / 5 % 5 * 2 - 4, n / 25 * 2, n % 5);
        format!("<block location='({x},{y},{z}.5)'/>")
    };
    (0..50).map(block).collect()
}

/// A tick of ten rings, and of ten cylinders, that may not sleep: lying, and standing on their rims.
fn rings() {
    for (how, rotation, z) in [
        ("lying", "(0,0,0)", 0.25),
        ("on their rims", "(90,0,0)", 1.0),
    ] {
        let (mut rings, mut cylinders) = (String::new(), String::new());
        for n in 0..10 {
            let x = n * 3 - 15;
            let _written = write!(
                rings,
                "<ring location='({x},0,{z})' rotation='{rotation}' radiusOuter='1' radiusInner='0.5' zspan='0.5'/>"
            );
            let turned = match z < 0.5 {
                true => "(90,0,0)",
                false => "(0,0,0)",
            };
            let _written = write!(
                cylinders,
                "<cylinder location='({x},0,{z})' rotation='{turned}' radius='1' yspan='0.5'/>"
            );
        }
        let mut apps = [cylinders, rings].map(|content| awake(&content));
        let [cylinders, rings] = ticks(&mut apps);
        println!("a tick of ten, {how}: cylinders {cylinders:.1} µs, rings {rings:.1} µs");
    }
}

fn read(content: &str) -> SceneSpec {
    let text = format!("<tabletop xmlns='{NAMESPACE}' xspan='60' yspan='60'>{content}</tabletop>");
    let task = parse(Path::new("bench.xml"), text.as_bytes());
    assert_eq!(task.faults, []);
    task.scene
}

/// A scene that may not sleep, a second after it was set.
fn awake(content: &str) -> App {
    let settings = PhysicsSettings {
        sleep: false,
        ..PhysicsSettings::DEFAULT
    };
    let mut app = headless_app_with(TabletopSimPlugins.build().set(PhysicsPlugin { settings }));
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(read(content))));
    app.step(60);
    app
}

/// Cost of a tick of each app, in µs. The apps take turns, so that other load of the machine affects all alike.
fn ticks<const N: usize>(apps: &mut [App; N]) -> [f64; N] {
    let mut times = [const { Vec::new() }; N];
    for _ in 0..TURNS {
        for (app, times) in apps.iter_mut().zip(&mut times) {
            times.push(
                time(|| {
                    app.step(u64::from(TICKS_PER_TURN));
                }) / TICKS_PER_TURN,
            );
        }
    }
    times.map(|times| median(times).as_secs_f64() * 1e6)
}

fn time(act: impl FnOnce()) -> Duration {
    let start = Instant::now();
    act();
    start.elapsed()
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}
