//! Ticks at rest that are passed over leave the world as if they had been made.

use std::{ops::Range, time::Duration};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_rapier3d::prelude::ExternalImpulse;
use tabletop::{
    core::{PictureDemand, RestingSystems, SensorImage, Timeline},
    prelude::*,
    replay::first_difference,
    scenario::{Outcome, Program, Scenario, ScenarioRun},
    user::PacePlugin,
};

use crate::{
    demonstration::{Demonstration, assert_replays},
    random::{Random, hand_command, robot_command, scene, scene_command},
    window::Window,
};

const FILES: [&str; 4] = ["default", "lidbox-and-block", "cylinders", "hammer"];

/// An event between two ticks.
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
    Nothing,
}

fn event(random: &mut Random) -> Event {
    let object = random.below(64);
    match random.below(24) {
        0..=5 => Event::Command(hand_command(random)),
        6 => Event::Command(robot_command(random)),
        7 => Event::Command(RobotCommand::Show(false).into()),
        8 => Event::Command(RobotCommand::Show(true).into()),
        9 | 10 => Event::Command(scene_command(random)),
        11 => Event::Command(RecordingCommand::Start.into()),
        12 | 13 => Event::Command(RecordingCommand::Finish.into()),
        14 => Event::Nothing,
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
        Event::Nothing => {}
    }
}

#[test]
fn passed_over_ticks_leave_no_trace() {
    compare_with_every_tick("few", 0..15);
}

#[test]
#[ignore = "takes a minute"]
fn many_passed_over_ticks_leave_no_trace() {
    compare_with_every_tick("many", 15..40);
}

/// Compares worlds that pass over ticks with worlds that run them all.
fn compare_with_every_tick(name: &str, seeds: Range<u64>) {
    let (mut made, mut passed_over) = (0, 0);
    for seed in seeds {
        let mut random = Random(seed);
        let mut worlds = pair(&format!("every_tick_{name}"));
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
        passed_over > made,
        "{passed_over} ticks were passed over, {made} were made"
    );
}

/// The facts without the folders of recordings.
fn without_folders(facts: &[SimFact]) -> Vec<String> {
    let facts = facts.iter().map(|fact| {
        if let SimFact::Recording(RecordingFact::Started { cause, .. }) = fact {
            format!("started {cause:?}")
        } else if let SimFact::Recording(RecordingFact::Finished { cause, .. }) = fact {
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

/// A world that passes over ticks and one that runs them all.
fn pair(name: &str) -> [Demonstration; 2] {
    [false, true].map(|every_tick| demonstration(&format!("{name}_{every_tick}"), every_tick))
}

fn ticks_made(world: &Demonstration) -> u64 {
    world.app.world().resource::<Seen>().ticks
}

#[test]
fn a_recording_of_a_scene_at_rest_makes_its_frames_alone() {
    let mut worlds = pair("frames_alone");
    let mut made = 0;
    for world in &mut worlds {
        let load = SceneCommand::Load("tablesetup/default.xml".into()).into();
        let begin = vec![load, RobotCommand::Show(true).into()];
        world.act(&[(begin, 400), (vec![RecordingCommand::Start.into()], 100)]);
        let before = ticks_made(world);
        world.act(&[(Vec::new(), 700), (Vec::new(), 500)]);
        if made == 0 {
            made = ticks_made(world) - before;
        }
    }
    assert_eq!(made, 1200 / 15, "four ticks a second");
    let [end, expected] = [0, 1].map(|i| worlds[i].app.world().resource::<Timeline>().end);
    assert_eq!(end, expected);
    for world in &mut worlds {
        world.tick(&[RecordingCommand::Finish.into()]);
    }
    let [found, expected] = worlds;
    assert_eq!(found.bits(), expected.bits());
    let difference = first_difference(&expected.folder, &found.folder).unwrap();
    assert_eq!(difference, None);
    assert_replays(&found.folder);
}

#[test]
fn a_scenario_passes_over_its_waits() {
    let steps = r#"(setup: "tablesetup/default.xml", steps: [
        Start, Robot(Show), Wait(20), Robot(Move([(LeftE1, 1.0)])), Wait(20),
        Select(Right), Grasp("RedBlock"), MoveBy((0, 0, 3)), Wait(5), Release, WaitUntilRest(10),
        Expect(AtRest("RedBlock")), Wait(10), Finish,
    ])"#;
    let mut worlds = pair("waits");
    for world in &mut worlds {
        let app = &mut world.app;
        let scenario = Scenario::parse("waits.ron", steps).unwrap();
        let read = |path: &std::path::Path| {
            tabletop::xml::read_task(path)
                .map(|task| task.scene)
                .map_err(|error| error.to_string())
        };
        let program = Program::new(&scenario, read, 0).unwrap();
        app.insert_resource(ScenarioRun::new(program));
        while *app.world().resource::<ScenarioRun>().outcome() == Outcome::Running {
            app.step(7);
        }
        assert_eq!(
            *app.world().resource::<ScenarioRun>().outcome(),
            Outcome::Done
        );
    }
    let [found, expected] = worlds;
    assert_eq!(found.bits(), expected.bits());
    let difference = first_difference(&expected.folder, &found.folder).unwrap();
    assert_eq!(difference, None);
    let [some, all] = [&found, &expected].map(ticks_made);
    assert!(some < all / 2, "{some} of {all} ticks were made");
}

#[test]
fn a_window_at_rest_records_a_replayable_demonstration() {
    let mut window = Window::open("window_at_rest", |plugins| plugins.add(PacePlugin));
    window
        .app
        .init_resource::<Seen>()
        .add_systems(FixedLast, see.in_set(RestingSystems))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(
            200,
        )));
    let hand = Hand::Right;
    let object = "GreenBlock".into();
    let location = Vec3::new(-3.0, 1.0, 4.0);
    let acts: [(SimCommand, usize); 8] = [
        (
            SceneCommand::Load("tablesetup/default.xml".into()).into(),
            50,
        ),
        (RobotCommand::Show(true).into(), 20),
        (RecordingCommand::Start.into(), 50),
        (HandCommand::Grasp { hand, object }.into(), 1),
        (HandCommand::MoveTo { hand, location }.into(), 5),
        (HandCommand::Release(hand).into(), 50),
        (HandCommand::Select(Hand::Left).into(), 20),
        (RecordingCommand::Finish.into(), 2),
    ];
    for (command, frames) in acts {
        window.give(command);
        window.frames(frames);
    }
    let made = window.app.world().resource::<Seen>().ticks;
    let all = window.next_tick();
    assert!(made < all / 2, "{made} of {all} ticks were made");
    assert_replays(&window.folder);
}
