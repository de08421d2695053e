//! Ticks at rest that are passed over leave the world as if they had been made.

use bevy::prelude::*;
use bevy_rapier3d::prelude::ExternalImpulse;
use tabletop::{
    core::{PictureDemand, RestingSystems, SensorImage},
    prelude::*,
    replay::first_difference,
};

use crate::{
    demonstration::{Demonstration, assert_replays},
    random::{Random, hand_command, robot_command, scene, scene_command},
};

const FILES: [&str; 4] = ["default", "lidbox-and-block", "cylinders", "hammer"];

/// What happens between two ticks.
#[derive(Debug)]
enum Event {
    Command(SimCommand),
    /// An object is struck, without a command.
    Strike(usize),
    /// An object is put elsewhere, without a command.
    Displace(usize),
    /// An object is taken away, without a command.
    Remove(usize),
    /// The head camera is asked for a picture.
    Picture,
}

fn event(random: &mut Random) -> Event {
    let object = random.below(64);
    match random.below(24) {
        0..=5 => Event::Command(hand_command(random)),
        6 => Event::Command(robot_command(random)),
        7 | 8 => Event::Command(RobotCommand::Show(false).into()),
        9 | 10 => Event::Command(scene_command(random)),
        11 => Event::Command(RecordingCommand::Start.into()),
        12..=14 => Event::Command(RecordingCommand::Finish.into()),
        15 => Event::Command(HistoryCommand::Undo.into()),
        16 => Event::Command(ClockCommand::SetPaused(true).into()),
        17..=19 => Event::Command(ClockCommand::SetPaused(false).into()),
        20 => Event::Strike(object),
        21 => Event::Displace(object),
        22 => Event::Remove(object),
        _ => Event::Picture,
    }
}

#[derive(Resource, Default)]
struct Seen {
    ticks: u64,
    facts: Vec<SimFact>,
}

fn see(mut seen: ResMut<Seen>, mut facts: MessageReader<SimFact>) {
    seen.ticks += 1;
    seen.facts.extend(facts.read().cloned());
}

fn demonstration(name: &str, every_tick: bool) -> Demonstration {
    let mut demonstration = Demonstration::new(name);
    let app = &mut demonstration.app;
    app.init_resource::<Seen>()
        .add_systems(FixedLast, see.in_set(RestingSystems));
    if every_tick {
        app.add_systems(FixedUpdate, || {});
    }
    demonstration
}

fn undergo(app: &mut App, event: &Event) {
    let world = app.world_mut();
    let object = |world: &World, number: usize| {
        let objects: Vec<_> = world.resource::<ObjectIndex>().iter().collect();
        Some(*objects.get(number % objects.len().max(1))?)
    };
    match event {
        Event::Command(command) => {
            world.write_command(command.clone());
        }
        &Event::Strike(number) => {
            if let Some(object) = object(world, number) {
                world.entity_mut(object).insert(ExternalImpulse {
                    impulse: Vec3::new(3.0, 1.0, 8.0),
                    ..default()
                });
            }
        }
        &Event::Displace(number) => {
            if let Some(object) = object(world, number)
                && let Some(mut place) = world.get_mut::<Transform>(object)
            {
                place.translation.z += 0.5;
            }
        }
        &Event::Remove(number) => {
            if let Some(object) = object(world, number) {
                world.despawn(object);
            }
        }
        Event::Picture => world.resource::<PictureDemand>().ask(),
    }
}

#[test]
fn what_is_passed_over_leaves_no_trace() {
    let (mut made, mut passed_over) = (0, 0);
    for seed in 0..40 {
        let mut random = Random(seed);
        let mut worlds = [false, true]
            .map(|every_tick| demonstration(&format!("every_tick_{every_tick}"), every_tick));
        let begin = match seed % 5 {
            4 => scene(),
            file => {
                let path = format!("tablesetup/{}.xml", FILES[file as usize]);
                SceneCommand::Load(path.into()).into()
            }
        };
        let mut recordings = 0;
        for number in 0..16 {
            let event = match number {
                0 => Event::Command(begin.clone()),
                _ => event(&mut random),
            };
            if matches!(event, Event::Command(SimCommand::Recording(_))) {
                recordings += 1;
            }
            let ticks = 1 + random.below(500) as u64;
            let is_one_by_one = random.below(4) == 0;
            for world in &mut worlds {
                undergo(&mut world.app, &event);
                match is_one_by_one {
                    true => (0..ticks).for_each(|_| {
                        world.app.step(1);
                    }),
                    false => {
                        world.app.step(ticks);
                    }
                }
            }
            let [found, expected] = &worlds;
            let place = format!("seed {seed}, event {number}: {event:?}, {ticks} ticks");
            assert_eq!(found.bits(), expected.bits(), "{place}");
            let [found, expected] = [found, expected].map(|world| world.app.world());
            let [facts, expected_facts] =
                [found, expected].map(|world| &world.resource::<Seen>().facts);
            assert_eq!(
                without_folders(facts),
                without_folders(expected_facts),
                "{place}"
            );
            let [image, expected_image] =
                [found, expected].map(|world| world.resource::<SensorImage>());
            assert!(image == expected_image, "{place}");
        }
        for world in &mut worlds {
            world.tick(&[RecordingCommand::Finish.into()]);
        }
        let [found, expected] = &worlds;
        if recordings > 0 && found.folder.exists() {
            let difference = first_difference(&expected.folder, &found.folder).unwrap();
            assert_eq!(difference, None, "seed {seed}");
        }
        let [some, all] = [found, expected].map(|world| world.app.world().resource::<Seen>().ticks);
        made += some;
        passed_over += all - some;
    }
    assert!(
        passed_over > made / 4,
        "{passed_over} ticks were passed over, {made} were made"
    );
}

/// The facts, without where recordings are.
fn without_folders(facts: &[SimFact]) -> Vec<String> {
    let facts = facts.iter().map(|fact| {
        if let SimFact::RecordingStarted { cause, .. } = fact {
            format!("started {cause:?}")
        } else if let SimFact::RecordingFinished { cause, .. } = fact {
            format!("finished {cause:?}")
        } else {
            format!("{fact:?}")
        }
    });
    facts.collect()
}

#[test]
fn a_demonstration_after_ticks_that_were_passed_over_replays() {
    let mut demonstration = demonstration("after_rest", false);
    let hand = Hand::Left;
    let object = "RedBlock".into();
    let location = Vec3::new(2.0, 0.0, 5.0);
    demonstration.act(&[
        (
            vec![SceneCommand::Load("tablesetup/default.xml".into()).into()],
            1234,
        ),
        (vec![RecordingCommand::Start.into()], 100),
        (vec![HandCommand::Grasp { hand, object }.into()], 1),
        (vec![HandCommand::MoveTo { hand, location }.into()], 60),
        (vec![HandCommand::Release(hand).into()], 300),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    assert!(demonstration.app.world().resource::<Seen>().ticks < 1000);
    assert_replays(&demonstration.folder);
}
