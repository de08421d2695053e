//! The examples of scripts serve their purpose in a real Octave.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bevy::{ecs::message::MessageCursor, prelude::*};
use tabletop::{
    camera::Camera,
    core::{Agent, HeadCamera, Markers, ScriptCommand, ScriptEvent},
    prelude::*,
    recorder::RecorderPlugin,
    scenario::{Outcome, Program, Scenario, ScenarioRun},
    script::{EngineChoice, ScriptPlugin, ScriptSettings},
    shipped::read_task,
};
use tabletop_harness::test_with;

use crate::{
    scripts::copy_of_matlab,
    support::{place, shipped},
};

/// A simulator whose robot is driven by an example.
struct Stage {
    app: App,
    events: MessageCursor<ScriptEvent>,
    printed: String,
    is_over: bool,
}

impl Stage {
    fn new(pair: &str, scenario: Option<&str>) -> Self {
        let Ok(engine) = "octave".parse::<EngineChoice>();
        let settings = ScriptSettings {
            engine,
            agent: Some(copy_of_matlab(pair)),
            ..default()
        };
        let recorder = RecorderPlugin {
            folder: place(&format!("examples_{pair}")),
            ..default()
        };
        let plugins = TabletopSimPlugins.build().set(ScriptPlugin { settings });
        let mut app = headless_app_with(plugins.set(recorder));
        if let Some(name) = scenario {
            let scenario = Scenario::read(shipped("tests/scripts", name)).unwrap();
            let read = |file: &Path| Ok(read_task(file).map_err(|error| error.to_string())?.scene);
            app.insert_resource(ScenarioRun::new(Program::new(&scenario, read, 0).unwrap()));
        } else {
            app.world_mut()
                .write_command(SceneCommand::Set(Box::default()));
        }
        app.world_mut().write_message(ScriptCommand::Start);
        let mut stage = Self {
            app,
            events: MessageCursor::default(),
            printed: String::new(),
            is_over: false,
        };
        stage.tick();
        let agent = stage.app.world().resource::<Agent>();
        assert!(
            matches!(agent, Agent::Online { .. }),
            "these tests need GNU Octave (octave-cli): {agent:?}"
        );
        stage
    }

    /// The folder of its scripts.
    fn scripts(&self) -> PathBuf {
        let settings = self.app.world().resource::<ScriptSettings>();
        settings.agent.clone().unwrap()
    }

    fn tick(&mut self) {
        self.app.step(1);
        let messages = self.app.world().resource::<Messages<ScriptEvent>>();
        for event in self.events.read(messages) {
            match event {
                ScriptEvent::Printed { line, .. } => self.printed += &format!("{line}\n"),
                ScriptEvent::Failed { reason } => panic!("{reason}"),
                ScriptEvent::Stopped => self.is_over = true,
                ScriptEvent::Started { .. } | ScriptEvent::Noted { .. } => {}
            }
        }
    }

    fn hand(&self) -> Vec3 {
        self.app
            .world()
            .resource::<Robot>()
            .limb(Arm::Right)
            .end_effector
            .location
    }

    /// Least distance of the right hand to each marker until the script has exited.
    fn nearest(&mut self, mut begin: impl FnMut(&Self) -> bool) -> Vec<f32> {
        let markers = self.app.world().resource::<Markers>().0.clone();
        assert!(!markers.is_empty());
        let mut nearest = vec![f32::MAX; markers.len()];
        let mut begun = false;
        for _ in 0..60 * 120 {
            self.tick();
            begun = begun || begin(self);
            if begun {
                for (nearest, marker) in nearest.iter_mut().zip(&markers) {
                    *nearest = nearest.min(marker.distance(self.hand()));
                }
            }
            if self.is_over {
                return nearest;
            }
        }
        panic!("it does not end: {nearest:?} {}", self.printed);
    }
}

#[test_with(Octave)]
fn the_reaching_hand_gets_to_every_marker() {
    let nearest = Stage::new("reach", None).nearest(|_| true);
    assert_eq!(nearest.len(), 4);
    assert!(
        nearest.iter().all(|distance| *distance < 0.11),
        "{nearest:?}"
    );
}

#[test_with(Octave)]
fn the_babbling_arm_learns_to_reach_and_remembers() {
    let mut stage = Stage::new("babble", None);
    let nearest = stage.nearest(|stage| stage.printed.contains("units; error"));
    assert_eq!(nearest.len(), 4);
    assert!(
        nearest.iter().all(|distance| *distance < 0.4),
        "{nearest:?}"
    );
    let line = stage
        .printed
        .lines()
        .find(|line| line.contains("units; error"))
        .unwrap();
    let words = line
        .split_whitespace()
        .filter_map(|word| word.parse::<f64>().ok());
    let errors: Vec<_> = words.filter(|number| *number < 1.0).collect();
    assert!(errors[1] < 0.7 * errors[0], "the error falls: {line}");
    let folder = stage.scripts();
    assert!(folder.join("babble.mat").exists());
}

#[test_with(Octave)]
fn the_head_keeps_the_red_block_near_the_middle_of_its_picture() {
    let mut stage = Stage::new("follow", Some("follow.ron"));
    let (mut ticks, mut widest, mut turned) = (0, 0.0_f32, (0.0_f32, 0.0_f32));
    while *stage.app.world().resource::<ScenarioRun>().outcome() == Outcome::Running {
        stage.tick();
        ticks += 1;
        let world = stage.app.world();
        let Some(block) = world.resource::<ObjectIndex>().get("RedBlock") else {
            continue;
        };
        let head = world.resource::<HeadCamera>();
        let camera = Camera::of_head(head, &Table::default());
        let pixel = camera.pixel_of(world.get::<Transform>(block).unwrap().translation);
        turned = (turned.0.min(head.pan), turned.1.max(head.pan));
        // For two seconds it may look for the block.
        if ticks > 120 {
            widest = widest.max((pixel.unwrap().x - 99.5).abs());
        }
    }
    let outcome = stage.app.world().resource::<ScenarioRun>().outcome();
    assert_eq!(*outcome, Outcome::Done);
    assert!(widest < 35.0, "{widest} columns from the middle");
    assert!(turned.0 < -0.5 && turned.1 > 0.4, "{turned:?}");
}

#[test_with(Octave)]
fn demonstrations_become_pictures() {
    let mut stage = Stage::new("record", Some("demonstrate.ron"));
    while *stage.app.world().resource::<ScenarioRun>().outcome() == Outcome::Running {
        stage.tick();
    }
    let folder = stage.scripts();
    let mut pictures: Vec<_> = fs::read_dir(folder.join("pictures"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    pictures.sort();
    // Two seconds, four pictures a second.
    assert_eq!(pictures.len(), 8, "{pictures:?}");
    let decoder = png::Decoder::new(std::io::BufReader::new(
        fs::File::open(&pictures[0]).unwrap(),
    ));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (200, 150));
    let is_red = |pixel: &[u8]| pixel[0] > 120 && pixel[1] < 80 && pixel[2] < 80;
    assert!(pixels.chunks_exact(3).filter(|pixel| is_red(pixel)).count() > 100);
}
