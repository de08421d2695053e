//! Many worlds in one process, one after the other.

use std::fs;

use bevy::math::Vec3;
use tabletop_core::{
    ObjectSpec, SceneCommand, SceneItem, SceneSpec, Shape, StepApp as _, WriteCommand as _,
};
use tabletop_geometry::{Pose, Rgb};
use tabletop_sim::headless_app;

/// A world with shapes that no other one has, for a few ticks.
fn live(number: u16) {
    let size = 0.5 + f32::from(number) / 4096.0;
    let color = Rgb::GRAY;
    let ring = Shape::Ring {
        radius_outer: size,
        radius_inner: size / 2.0,
        zspan: 0.5,
        sides: 64,
        color,
    };
    let prism = Shape::Prism {
        radius: size,
        yspan: 1.0,
        sides: 64,
        color,
    };
    let object = |id: &str, x, shape| {
        let pose = Pose::at(Vec3::new(x, 0.0, 2.0));
        SceneItem::Object(ObjectSpec::new(id, pose, 1.0, shape))
    };
    let scene = SceneSpec {
        items: vec![object("ring", -3.0, ring), object("prism", 3.0, prism)],
        ..SceneSpec::default()
    };
    let mut app = headless_app();
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app.step(5);
}

/// Number of worlds of a round.
const WORLDS: u16 = 100;

/// A number of the process, such as its threads or its memory in kB, where the system tells it.
fn of_process(name: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
fn worlds_share_their_threads_and_leave_no_memory_behind() {
    let mut after = [0, 0, 0];
    for (round, memory) in after.iter_mut().enumerate() {
        for number in 0..WORLDS {
            live(WORLDS * round as u16 + number);
        }
        *memory = of_process("VmRSS").unwrap_or(0);
        println!("{:?} {memory}", of_process("Threads"));
    }
}
