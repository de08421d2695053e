//! Many worlds in one process, one after the other.

use std::fs;

use bevy::math::Vec3;
use tabletop_core::{
    ObjectSpec, SceneCommand, SceneItem, SceneSpec, Shape, StepApp as _, WriteCommand as _,
};
use tabletop_geometry::{Pose, Rgb};
use tabletop_sim::headless_app;

/// Number of worlds of a round, and of the prisms in each.
const WORLDS: u16 = 50;
const PRISMS: u16 = 40;

/// Largest growth of memory, in kB, from the first round to the third. The prisms of a round alone have 9,000 kB.
const MOST_GROWTH: u64 = 6_000;

/// A world with prisms that no other one has, for a few ticks.
fn live(number: u16) {
    let prism = |i: u16| {
        let shape = Shape::Prism {
            radius: 0.4 + f32::from(number * PRISMS + i) / 65536.0,
            yspan: 1.0,
            sides: 64,
            color: Rgb::GRAY,
        };
        let place = [f32::from(i % 8) * 2.0 - 7.0, f32::from(i / 8) * 2.0 - 4.0];
        let pose = Pose::at(Vec3::new(place[0], place[1], 1.0));
        SceneItem::Object(ObjectSpec::new(format!("prism{i}"), pose, 1.0, shape))
    };
    let scene = SceneSpec {
        items: (0..PRISMS).map(prism).collect(),
        ..SceneSpec::default()
    };
    let mut app = headless_app();
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app.step(2);
}

/// A number of this process, such as its threads or its memory in kB; 0 where the system does not tell it.
fn of_process(name: &str) -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with(name));
    let number = line.and_then(|line| line.split_whitespace().nth(1)?.parse().ok());
    number.unwrap_or(0)
}

#[test]
fn worlds_share_their_threads_and_leave_no_memory_behind() {
    let after = [0, 1, 2].map(|round| {
        (0..WORLDS).for_each(|world| live(round * WORLDS + world));
        (of_process("Threads"), of_process("RssAnon"))
    });
    let [(threads, memory), _, (threads_at_end, memory_at_end)] = after;
    assert_eq!(threads, threads_at_end);
    assert!(
        memory_at_end.saturating_sub(memory) < MOST_GROWTH,
        "{after:?}"
    );
}
