//! Benchmark of a headless tick beside one step of bare Rapier for the same scene, on one core.
//!
//! `cargo bench --bench headless_speed` prints, for unit blocks in towers of five that may not sleep, the median time of a
//! tick of the whole simulator, of a step of Rapier alone with the same bodies, settings and effort, and their ratio. Both run in
//! turns in one process, so that other loads on the machine affect both. Then it prints the cost of a tick when the blocks
//! sleep: run in full (another system is in the app), passed over by itself, and passed over with 59 others.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

#[path = "shared/towers.rs"]
mod towers;

use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy_rapier3d::rapier::prelude as rapier;
use tabletop::{
    core::TICK_SECONDS,
    physics::{Care, Engine, PhysicsSettings, integration_parameters},
    prelude::*,
};

use towers::{simulator, towers_of_five};

const TICKS_PER_TURN: u32 = 60;
const TURNS: usize = 40;

const SETTINGS: PhysicsSettings = PhysicsSettings {
    sleep: false,
    ..PhysicsSettings::DEFAULT
};

fn main() {
    awake();
    println!();
    at_rest();
}

fn awake() {
    println!("blocks  simulator  bare Rapier  ratio");
    for blocks in [10, 50, 200] {
        let mut simulator = simulator(SETTINGS, towers_of_five(blocks));
        let mut bare = BareRapier::new(blocks);
        simulator.step(60);
        (0..60).for_each(|_| bare.step());

        let (mut of_simulator, mut of_bare) = (Vec::new(), Vec::new());
        for _ in 0..TURNS {
            of_simulator.push(time(|| {
                simulator.step(u64::from(TICKS_PER_TURN));
            }));
            of_bare.push(time(|| (0..TICKS_PER_TURN).for_each(|_| bare.step())));
        }
        let (tick, step) = (median(of_simulator), median(of_bare));
        println!(
            "{blocks:6}  {:6.1} µs    {:6.1} µs   {:.2}",
            tick.as_secs_f64() * 1e6,
            step.as_secs_f64() * 1e6,
            tick.as_secs_f64() / step.as_secs_f64()
        );
    }
}

fn at_rest() {
    println!("blocks  at rest: made  passed over  60 passed over");
    for blocks in [10, 50, 200] {
        let resting = || simulator(PhysicsSettings::DEFAULT, towers_of_five(blocks));
        let (mut made, mut passed_over) = (resting(), resting());
        made.add_systems(FixedUpdate, || {});
        made.step(300);
        passed_over.step(300);

        let mut times = [const { Vec::new() }; 3];
        for _ in 0..TURNS {
            times[0].push(time(|| {
                made.step(u64::from(TICKS_PER_TURN));
            }));
            times[1].push(time(|| {
                for _ in 0..TICKS_PER_TURN {
                    passed_over.step(1);
                }
            }));
            times[2].push(time(|| {
                passed_over.step(u64::from(TICKS_PER_TURN));
            }));
        }
        let [made, alone, together] = times.map(|times| median(times).as_nanos() as f64 / 1e3);
        println!("{blocks:6}  {made:10.2} µs  {alone:8.2} µs  {together:11.3} µs");
    }
}

fn time(turn: impl FnOnce()) -> Duration {
    let start = Instant::now();
    turn();
    start.elapsed() / TICKS_PER_TURN
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}

#[derive(Default)]
struct BareRapier {
    pipeline: rapier::PhysicsPipeline,
    parameters: rapier::IntegrationParameters,
    islands: rapier::IslandManager,
    broad_phase: rapier::DefaultBroadPhase,
    narrow_phase: rapier::NarrowPhase,
    bodies: rapier::RigidBodySet,
    colliders: rapier::ColliderSet,
    impulse_joints: rapier::ImpulseJointSet,
    multibody_joints: rapier::MultibodyJointSet,
    ccd_solver: rapier::CCDSolver,
    care: Care,
}

impl BareRapier {
    fn new(blocks: usize) -> Self {
        let mut bare = Self {
            parameters: rapier::IntegrationParameters {
                dt: TICK_SECONDS,
                ..integration_parameters()
            },
            ..default()
        };
        let surface = |collider: rapier::ColliderBuilder| {
            collider
                .friction(SETTINGS.friction)
                .friction_combine_rule(rapier::CoefficientCombineRule::Multiply)
        };
        let table = Table::default();
        let half = Vec3::new(table.xspan, table.yspan, Table::THICKNESS) / 2.0;
        let slab = rapier::ColliderBuilder::cuboid(half.x, half.y, half.z)
            .translation(Vec3::NEG_Z * half.z);
        bare.colliders.insert(surface(slab));
        for location in towers_of_five(blocks) {
            let mut body = rapier::RigidBodyBuilder::dynamic()
                .translation(location)
                .ccd_enabled(true)
                .angular_damping(SETTINGS.angular_damping)
                .build();
            body.activation_mut().normalized_linear_threshold = -1.0;
            body.activation_mut().angular_threshold = -1.0;
            let body = bare.bodies.insert(body);
            let cube = rapier::ColliderBuilder::cuboid(0.5, 0.5, 0.5).mass(1.0);
            bare.colliders
                .insert_with_parent(surface(cube), body, &mut bare.bodies);
        }
        bare
    }

    fn step(&mut self) {
        self.care.spend(Engine {
            parameters: &mut self.parameters,
            islands: &mut self.islands,
            broad_phase: &self.broad_phase,
            narrow_phase: &self.narrow_phase,
            bodies: &mut self.bodies,
            colliders: &self.colliders,
            joints: &self.impulse_joints,
            gravity: SETTINGS.gravity,
        });
        self.pipeline.step(
            Vec3::NEG_Z * SETTINGS.gravity,
            &self.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut self.impulse_joints,
            &mut self.multibody_joints,
            &mut self.ccd_solver,
            &(),
            &(),
        );
    }
}
