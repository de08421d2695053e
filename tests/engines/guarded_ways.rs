//! Ways that are planned for a robot with a guard.

use bevy::prelude::*;
use tabletop::{
    controller::Sight,
    core::Table,
    planner::{GuardedGaps, RobotBody},
    prelude::*,
    program::TaskProgram,
    real::BodyGuard,
    robot::RobotPlugin,
    robot_body,
    scene::{IdAllocator, assemble},
    shipped::read_faultless_task,
    telling::{ProgramActor, carry_out},
};
use tabletop_harness::test_with;

use crate::support::shipped;

/// The sights of the ticks of an episode.
#[derive(Resource, Default)]
struct Sights(Vec<Sight>);

fn see(world: &mut World) {
    let sight = Sight::of(world);
    world.resource_mut::<Sights>().0.push(sight);
}

/// The robot does this with a guard that keeps these gaps. Returns its ticks.
fn ticks_of(body: &RobotBody, sentence: &str, setup: &str) -> Vec<Sight> {
    let program: TaskProgram = sentence.parse().unwrap();
    let scene = read_faultless_task(&shipped("tablesetup", setup), &[]).unwrap();
    let objects = assemble(&scene, &mut IdAllocator::default()).objects;
    let mut app = headless_app();
    app.init_resource::<Sights>().add_systems(FixedLast, see);
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app.world_mut().write_command(RobotCommand::Show(true));
    app.step(30);
    let actor = ProgramActor::Robot { body, seed: 0 };
    let told = carry_out(&mut app, &program, &objects, actor, |_, _| {});
    assert_eq!(told.failure, None, "{sentence}");
    app.world_mut().remove_resource::<Sights>().unwrap().0
}

/// The most by which a tick makes a gap narrower that the guard keeps, and is then narrower than that, in units.
fn worst(body: &RobotBody, ticks: &[Sight], least: GuardedGaps) -> f32 {
    let table = Table::default();
    let gaps = body.gaps();
    let mut last = vec![f32::INFINITY; gaps.len()];
    let mut worst = 0.0_f32;
    for tick in ticks {
        let angles: Vec<_> = tick.limbs.iter().map(|limb| limb.angles).collect();
        let openings: Vec<_> = tick.limbs.iter().map(|limb| limb.opening as f32).collect();
        let posed = body.posed(&angles, &openings);
        for (gap, last) in gaps.iter().zip(&mut last) {
            let kept = match gap.is_of_fingers {
                true => least.fingers_above_table,
                false => least.links,
            };
            let width = body.width(gap, &posed, &table, kept);
            if width < *last - 1e-4 {
                worst = worst.max(kept - width);
            }
            *last = width;
        }
    }
    worst
}

#[test_with()]
fn no_way_is_planned_that_the_guard_refuses() {
    const BESIDE: f32 = 0.02;
    let any = robot_body(&RobotPlugin::default(), &Table::default()).unwrap();
    let guarded = any.clone().guarded(BodyGuard::GAPS);
    let mut careless = 0.0_f32;
    for (sentence, setup) in [
        ("Put the red block on the blue block.", "seven-blocks.xml"),
        (
            "Put every block on the left of the table.",
            "seven-blocks.xml",
        ),
    ] {
        let ticks = ticks_of(&guarded, sentence, setup);
        let least = worst(&guarded, &ticks, BodyGuard::GAPS);
        assert!(least < BESIDE, "{sentence}: {least}");
        careless = careless.max(worst(
            &any,
            &ticks_of(&any, sentence, setup),
            BodyGuard::GAPS,
        ));
    }
    assert!(
        careless > BESIDE,
        "a robot without a guard keeps them, too: {careless}"
    );
}
