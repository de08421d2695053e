//! Comparison with MuJoCo: the speed of the simulator, and how still its towers stand.
//!
//! `cargo bench --bench peers` makes a Python environment of its own in the target folder, installs `mujoco==3.9.0` there with
//! pip, and prints ratios of times: medians over turns in which both simulate the same towers one after the other, each
//! on one core, so that other loads on the machine affect both.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]
#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

#[path = "../shared/towers.rs"]
mod towers;

use std::{
    io::{BufRead, BufReader, Lines, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
    time::Instant,
};

use bevy::prelude::*;
use tabletop::{physics::PhysicsSettings, prelude::*};

use towers::{simulator, towers_of_five};

const PACKAGE: &str = "mujoco==3.9.0";
const TURNS: usize = 15;

const AWAKE: PhysicsSettings = PhysicsSettings {
    sleep: false,
    ..PhysicsSettings::DEFAULT
};

fn main() {
    let mut mujoco = MuJoCo::start();

    println!("How far the top of a tower of ten has moved after a minute, in units of 10 cm:");
    let (ours, coarse, fine) = (
        drift(),
        mujoco.ask("coarse-drift", 10, 60.0),
        mujoco.ask("fine-drift", 10, 60.0),
    );
    println!("tabletop {ours:.4}, MuJoCo at 1/60 s {coarse:.4}, at 0.002 s elliptic {fine:.4}");

    println!();
    println!("How many times as fast as MuJoCo (towers of five, median of {TURNS} turns):");
    println!(
        "blocks  tick      awake, at 1/60 s  awake, at 0.002 s elliptic  at rest, at 1/60 s, one a call, 60 a call"
    );
    for blocks in [10, 50, 200] {
        let mut awake = simulator(AWAKE, towers_of_five(blocks));
        let mut resting = simulator(PhysicsSettings::DEFAULT, towers_of_five(blocks));
        awake.step(60);
        resting.step(300);
        let turn = || {
            let ours = time(&mut awake);
            let coarse = mujoco.ask("coarse", blocks, 1.0) / 1e9;
            let fine = mujoco.ask("fine", blocks, 1.0) / 1e9;
            let one_by_one = time_one_by_one(&mut resting);
            let together = time(&mut resting);
            [
                ours,
                coarse / ours,
                fine / ours,
                coarse / one_by_one,
                coarse / together,
            ]
        };
        let turns: Vec<_> = std::iter::repeat_with(turn).take(TURNS).collect();
        let [ours, coarse, fine, one_by_one, together] =
            [0, 1, 2, 3, 4].map(|column| median(turns.iter().map(|turn| turn[column]).collect()));
        let tick = ours / 60.0 * 1e6;
        println!(
            "{blocks:6}  {tick:6.1} µs {coarse:16.2}  {fine:26.1}  {one_by_one:30.0}  {together:9.0}"
        );
    }
}

/// Time that the simulator takes for a second, in seconds.
fn time(simulator: &mut App) -> f64 {
    let start = Instant::now();
    simulator.step(60);
    start.elapsed().as_secs_f64()
}

/// Time that it takes when each tick is asked for alone.
fn time_one_by_one(simulator: &mut App) -> f64 {
    let start = Instant::now();
    for _ in 0..60 {
        simulator.step(1);
    }
    start.elapsed().as_secs_f64()
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn drift() -> f32 {
    let storeys = || (0..10).map(|storey| Vec3::Z * (storey as f32 + 0.5));
    let mut tower = simulator(AWAKE, storeys());
    tower.step(60 * 60);
    let top = tower.world().resource::<ObjectIndex>().get("block9");
    let top = tower.world().get::<Transform>(top.unwrap()).unwrap();
    top.translation.distance(Vec3::Z * 9.5)
}

/// The other side, which answers questions about its towers.
struct MuJoCo {
    process: Child,
    questions: ChildStdin,
    answers: Lines<BufReader<ChildStdout>>,
}

impl MuJoCo {
    fn start() -> Self {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/mujoco_towers.py");
        let mut process = Command::new(python())
            .arg(script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let questions = process.stdin.take().unwrap();
        let answers = BufReader::new(process.stdout.take().unwrap()).lines();
        Self {
            process,
            questions,
            answers,
        }
    }

    fn ask(&mut self, scene: &str, blocks: usize, seconds: f64) -> f64 {
        writeln!(self.questions, "{scene} {blocks} {seconds}").unwrap();
        self.answers.next().unwrap().unwrap().parse().unwrap()
    }
}

impl Drop for MuJoCo {
    fn drop(&mut self) {
        let _gone = self.process.kill();
        let _gone = self.process.wait();
    }
}

/// The interpreter of an environment that has MuJoCo.
fn python() -> PathBuf {
    let environment = Path::new(env!("CARGO_TARGET_TMPDIR")).join("peers");
    let python = environment.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });
    if !python.exists() {
        let system = if cfg!(windows) { "python" } else { "python3" };
        run(Command::new(system).args(["-m", "venv"]).arg(&environment));
    }
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", PACKAGE]));
    python
}

fn run(command: &mut Command) {
    let status = command.status().unwrap();
    assert!(status.success(), "{command:?}: {status}");
}
