//! The dock, whose power is switched off before its cartridges are changed: its recording, and the exact undo of each step.

use std::fs;

use bevy::prelude::*;
use tabletop::{core::Bonds, prelude::*};

use crate::demonstration::Demonstration;

const HAND: Hand = Hand::Right;

/// The commands in the dock, each with the ticks until the next.
fn acts() -> Vec<(SimCommand, u64)> {
    let trigger = || {
        let (hand, control, part) = (HAND, "power".to_owned(), None);
        SimCommand::Mechanism(MechanismCommand::Trigger {
            hand,
            control,
            part,
        })
    };
    let grasp = |object: &str| {
        let (hand, object) = (HAND, object.to_owned());
        SimCommand::Hand(HandCommand::Grasp { hand, object })
    };
    let go = |x: f32, y: f32, z: f32| {
        let (hand, location) = (HAND, Vec3::new(x, y, z));
        SimCommand::Hand(HandCommand::MoveTo { hand, location })
    };
    let release = || SimCommand::Hand(HandCommand::Release(HAND));
    let point = || {
        let (hand, target) = (HAND, "slot".to_owned());
        SimCommand::Mechanism(MechanismCommand::PointTo { hand, target })
    };
    vec![
        (trigger(), 20),
        (grasp("drawer"), 10),
        (go(1.0, 0.0, 1.15), 200),
        (release(), 60),
        (point(), 10),
        (grasp("bad"), 10),
        (go(0.0, 0.0, 4.0), 60),
        (go(-5.0, 2.0, 3.0), 80),
        (go(-5.0, 2.0, 0.42), 60),
        (release(), 30),
        (grasp("good"), 10),
        (go(-5.0, -2.0, 3.0), 60),
        (go(0.1, 0.0, 3.0), 80),
        (go(0.1, 0.0, 1.08), 60),
        (release(), 60),
        (grasp("drawer"), 10),
        (go(3.9, 0.0, 1.15), 200),
        (release(), 60),
        (trigger(), 20),
    ]
}

fn begins_a_segment(command: &SimCommand) -> bool {
    matches!(
        command,
        SimCommand::Mechanism(_)
            | SimCommand::Hand(HandCommand::Grasp { .. } | HandCommand::Release(_))
    )
}

fn begun(name: &str) -> Demonstration {
    let mut demonstration = Demonstration::new(name);
    let load = SimCommand::Scene(SceneCommand::Load("tablesetup/dock.xml".into()));
    let start = SimCommand::Recording(RecordingCommand::Start);
    demonstration.act(&[(vec![load], 120), (vec![start], 10)]);
    demonstration
}

/// The states of all controls, and the bonds.
fn mechanisms(demonstration: &Demonstration) -> (Vec<ObjectSpec>, Bonds) {
    let world = demonstration.app.world();
    let objects = world.resource::<ObjectIndex>().iter();
    let specs = objects.map(|object| world.get::<ObjectSpec>(object).unwrap().clone());
    (specs.collect(), world.resource::<Bonds>().clone())
}

#[test]
fn every_step_is_undone_exactly() {
    let (mut straight, mut with_detours) = (begun("dock"), begun("dock_with_detours"));
    for (command, ticks) in acts() {
        let mut last = vec![command.clone()];
        if begins_a_segment(&command) {
            with_detours.act(&[(vec![command.clone()], ticks)]);
            last.insert(0, SimCommand::History(HistoryCommand::Undo));
        }
        with_detours.act(&[(last, ticks)]);
        straight.act(&[(vec![command.clone()], ticks)]);
        assert_eq!(with_detours.bits(), straight.bits(), "{command:?}");
        assert_eq!(mechanisms(&with_detours), mechanisms(&straight));
    }
    let finish = SimCommand::Recording(RecordingCommand::Finish);
    straight.tick(std::slice::from_ref(&finish));
    with_detours.tick(&[finish]);
    let [expected, found] = [&straight, &with_detours].map(events);
    assert_eq!(found, expected);
    assert_eq!(
        expected[..6],
        [
            "create,dock,shape,composite,mass,0.0",
            "create,drawer,shape,composite,mass,1.0",
            "create,bad,shape,composite,use,broken drive,mass,0.3",
            "create,good,shape,composite,use,spare drive,mass,0.3",
            "initializeControl,power,toggleSwitch,dock,0",
            "initializeControl,lights,indicatorLights,dock,red",
        ]
    );
    assert_eq!(
        expected[6..],
        [
            "trigger,RightHand,power",
            "changeControlState,power,1",
            "changeControlState,lights,off",
            "grasp,RightHand,drawer",
            "release,RightHand",
            "pointTo,RightHand,slot,drawer",
            "grasp,RightHand,bad",
            "release,RightHand",
            "grasp,RightHand,good",
            "release,RightHand",
            "grasp,RightHand,drawer",
            "release,RightHand",
            "trigger,RightHand,power",
            "changeControlState,power,0",
            "changeControlState,lights,green",
        ]
    );
}

/// The events of a recording without moves and frame numbers.
fn events(demonstration: &Demonstration) -> Vec<String> {
    let mut events = Vec::new();
    for segment in 0.. {
        let path = demonstration.folder.join(format!("{segment}.txt"));
        let Ok(text) = fs::read_to_string(path) else {
            break;
        };
        let lines = text.lines().filter_map(|line| line.split_once(','));
        let lines = lines.map(|(_, event)| event.to_owned());
        events.extend(lines.filter(|event| !event.starts_with("move,")));
    }
    events
}
