//! Programs that are shown, asked about, and done by the robot.

use std::path::Path;

use tabletop_core::{ObjectSpec, StepApp as _, WriteCommand as _};
use tabletop_episodes::telling::table_of;
use tabletop_program::{Example, TableScene, TaskProgram};
use tabletop_recorder::{RecorderPlugin, UnrecordedPlugin};
use tabletop_sim::{TabletopSimPlugins, headless_app_with};
use tabletop_user::{Imitating, TaughtProgram, UserPlugin};

use super::*;

const EACH: &str = "Put every red block into the box.";

/// Two red blocks and a green one beside a box.
fn table() -> SceneSpec {
    let text = r#"<tabletop xspan="20" yspan="12">
  <box id="Box" location="(4,-1,0.4)" xspan="3.6" yspan="3.6" zspan="0.8" thickness="0.1" color="gray" mass="2"/>
  <block id="RedA" location="(-2,-3,0.4)" xspan="0.8" yspan="0.8" zspan="0.8" color="red"/>
  <block id="RedB" location="(0,-3,0.4)" xspan="0.8" yspan="0.8" zspan="0.8" color="red"/>
  <block id="Green" location="(-1,-1,0.4)" xspan="0.8" yspan="0.8" zspan="0.8" color="green"/>
</tabletop>"#;
    tabletop_xml::parse(Path::new("table.xml"), text.as_bytes()).scene
}

fn app() -> App {
    let plugins = TabletopSimPlugins.build();
    let plugins = plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin);
    let mut app = headless_app_with((plugins, UserPlugin, plugin));
    let world = app.world_mut();
    world.write_command(SceneCommand::Set(Box::new(table())));
    frame(&mut app);
    frame(&mut app);
    app
}

/// A picture and a tick.
fn frame(app: &mut App) {
    app.world_mut().run_schedule(Update);
    app.step(1);
}

fn scene(app: &mut App) -> TableScene {
    let world = app.world_mut();
    let objects: Vec<_> = world.query::<&ObjectSpec>().iter(world).cloned().collect();
    table_of(world, &objects)
}

/// Shows a program on the table as it is, and waits for what was found.
fn show(app: &mut App, program: &str) {
    let program: TaskProgram = program.parse().unwrap();
    let example = Example::of_program(&program, &scene(app)).unwrap();
    app.world_mut()
        .resource_mut::<Teaching>()
        .show(Some(example));
    frame(app);
    while *taught(app) == TaughtProgram::default() {
        frame(app);
    }
}

fn taught(app: &App) -> &TaughtProgram {
    app.world().resource()
}

fn order(app: &mut App, order: TaskOrder) {
    app.world_mut().write_message(order);
    frame(app);
}

/// The number of the other program with these sentences.
fn other(app: &App, sentences: &str) -> Option<usize> {
    let others = &taught(app).others;
    let place = others.iter().position(|other| other.sentences == sentences);
    place.map(|place| place + 1)
}

#[test]
fn what_is_open_is_asked_and_decided_by_one_more_demonstration() {
    let mut app = app();
    show(&mut app, EACH);
    assert_eq!(taught(&app).demonstrations, 1);
    let asked = taught(&app).others[0].sentences.clone();
    let before = scene(&mut app).objects;
    order(&mut app, TaskOrder::Ask(1));
    assert!(taught(&app).is_awaiting);
    frame(&mut app);
    frame(&mut app);
    assert_ne!(scene(&mut app).objects, before, "another table decides");
    show(&mut app, EACH);
    assert_eq!(other(&app, &asked), None, "it was not shown");
    let taught = taught(&app);
    assert_eq!((taught.demonstrations, &*taught.sentences), (2, EACH));
    assert!(!taught.is_awaiting);
}

#[test]
fn an_answer_leaves_nothing_open_and_a_new_recording_begins_anew() {
    let mut app = app();
    show(&mut app, EACH);
    let first = taught(&app).others[0].sentences.clone();
    let number = other(&app, &first).unwrap();
    order(&mut app, TaskOrder::Answer(number));
    assert_eq!(taught(&app).sentences, first);
    assert!(taught(&app).others.is_empty());
    show(&mut app, "Put the green block on the table.");
    assert_eq!(taught(&app).demonstrations, 1);
}

#[test]
fn demonstrations_of_different_programs_are_told_so() {
    let mut app = app();
    show(&mut app, EACH);
    order(&mut app, TaskOrder::ShowAgain);
    show(&mut app, "Put the green block on the box.");
    let fault = taught(&app).fault.as_deref();
    assert_eq!(fault, Some("no program explains all 2 demonstrations"));
    order(&mut app, TaskOrder::Perform);
    assert_eq!(*app.world().resource::<Imitating>(), Imitating::Idle);
}

#[test]
fn the_robot_does_the_program_step_by_step() {
    let mut app = app();
    show(&mut app, EACH);
    order(&mut app, TaskOrder::Perform);
    let mut captions = Vec::new();
    for _ in 0..60 * 120 {
        frame(&mut app);
        match app.world().resource::<Imitating>() {
            Imitating::Idle => break,
            Imitating::Preparing => {}
            Imitating::Step(step) => {
                let caption = (step.number, step.sentence.clone());
                if captions.last() != Some(&caption) {
                    captions.push(caption);
                }
            }
        }
    }
    let notices = app.world().resource::<Notices>();
    let last = notices.iter().last();
    assert_eq!(last, Some("the robot has done the program"));
    assert_eq!(captions.len(), 2, "{captions:?}");
    let program: TaskProgram = EACH.parse().unwrap();
    let rest = Example::of_program(&program, &scene(&mut app)).unwrap();
    assert_eq!(rest.steps(), 0, "something is left to do");
}
