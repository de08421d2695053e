//! A demonstration without a window, checked as a test would check it: `cargo run --release --example headless_ci`.
//!
//! The simulator runs on Bevy's `MinimalPlugins`. The demonstrator's acts are written as commands, and the results are
//! read from facts.
#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use bevy::prelude::*;
use tabletop::prelude::*;

/// All facts so far.
#[derive(Resource, Default)]
struct Facts(Vec<SimFact>);

fn listen(mut all: ResMut<Facts>, mut facts: MessageReader<SimFact>) {
    all.0.extend(facts.read().cloned());
}

fn main() -> Result {
    let mut app = headless_app();
    app.init_resource::<Facts>()
        .add_systems(FixedUpdate, listen.in_set(SimSystems::Record));

    let hand = Hand::Right;
    let object = "RedBlock".to_owned();
    let on_top = Vec3::new(-2.0, 0.0, 3.0);
    for (command, ticks) in [
        (
            SimCommand::Scene(SceneCommand::Load("tablesetup/default.xml".into())),
            60,
        ),
        (SimCommand::Hand(HandCommand::Grasp { hand, object }), 1),
        (
            SimCommand::Hand(HandCommand::MoveBy {
                hand,
                offset: Vec3::Z * 4.0,
            }),
            30,
        ),
        (
            SimCommand::Hand(HandCommand::MoveTo {
                hand,
                location: on_top + Vec3::Z * 2.0,
            }),
            30,
        ),
        (
            SimCommand::Hand(HandCommand::MoveTo {
                hand,
                location: on_top,
            }),
            30,
        ),
        (SimCommand::Hand(HandCommand::Release(hand)), 120),
    ] {
        app.world_mut().write_command(command);
        app.step(ticks);
    }

    let world = app.world();
    for fact in &world.resource::<Facts>().0 {
        println!("{fact:?}");
    }
    let red_block = world
        .resource::<ObjectIndex>()
        .get("RedBlock")
        .ok_or("there is no RedBlock")?;
    let location = world
        .get::<Transform>(red_block)
        .ok_or("RedBlock is nowhere")?
        .translation;
    println!("RedBlock is at {location}");
    if location.distance(on_top) > 0.01 {
        return Err(format!("RedBlock should be on GreenBlock, at {on_top}").into());
    }
    Ok(())
}
