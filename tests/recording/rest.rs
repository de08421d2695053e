//! Objects that nobody touches come to rest, to the bit, and stay there.

use std::{collections::BTreeSet, fs, path::PathBuf};

use bevy::prelude::*;
use bevy_rapier3d::prelude::Velocity;
use tabletop::{prelude::*, xml};

use crate::demonstration::Demonstration;

/// The examples of the report's section 6.2, each on a table of its own.
const EXAMPLES: [(&str, &str); 9] = [
    (
        "figure 4",
        r#"<block location="(2,0,1)" rotation="(0,0,-15)" xspan="2" yspan="2" zspan="2"/>
           <block location="(-2,0,1)" rotation="(0,0,45)" xspan="2" yspan="2" zspan="2"/>"#,
    ),
    (
        "block",
        r#"<block location="(0,0,1.5)" mass="0.5" xspan="5" yspan="4" zspan="3"/>"#,
    ),
    (
        "cylinder",
        r#"<cylinder location="(0,0,2)" mass="0.5" yspan="7" radius="2"/>"#,
    ),
    (
        "sphere",
        r#"<sphere location="(0,0,2)" mass="0.5" radius="2"/>"#,
    ),
    (
        "box",
        r#"<box location="(0,0,1.5)" mass="1" xspan="5" yspan="4" zspan="3" thickness="0.2"/>"#,
    ),
    (
        "composite",
        r#"<composite location="(0,0,1)" rotation="(0,0,-30)" mass="10">
             <composite location="(-0.2,0,0)">
               <block location="(0,0,0)"/>
               <cylinder location="(0,0.9,0)" radius="0.75" yspan="0.8"/>
               <cylinder location="(0,-0.9,0)" radius="0.75" yspan="0.8"/>
             </composite>
             <cylinder location="(2.8,0,0)" rotation="(0,0,90)" radius="0.35" yspan="5"/>
           </composite>"#,
    ),
    (
        "chain",
        r#"<chain start="(6,-2,4)" end="(-6,-2,4)" linkCount="12"/>"#,
    ),
    (
        "lid box",
        r#"<lidbox location="(0,0,2.5)" mass="10" xspan="6" yspan="5" zspan="5" thickness="0.6"
             handleXspan="1" handleYspan="2" handleZspan="0.6"/>"#,
    ),
    (
        "trapdoor",
        r#"<lidbox location="(0,0,3)" rotation="(0,90,-90)" mass="10" xspan="6" yspan="5" zspan="5"
             thickness="0.6" handleXspan="1" handleYspan="2" handleZspan="0.6"/>"#,
    ),
];

/// Every bit of every object's pose and velocity.
fn bits(app: &App) -> Vec<(String, Vec<u32>)> {
    let world = app.world();
    let objects = world.resource::<ObjectIndex>().iter().map(|object| {
        let place = world.get::<Transform>(object).unwrap();
        let velocity = world.get::<Velocity>(object).copied().unwrap_or_default();
        let vectors = [place.translation, velocity.linear, velocity.angular];
        let numbers = vectors.into_iter().flat_map(|vector| vector.to_array());
        let numbers = numbers.chain(place.rotation.to_array());
        let id = world.get::<ObjectSpec>(object).unwrap().id.clone();
        (id, numbers.map(f32::to_bits).collect())
    });
    objects.collect()
}

/// Objects that tremble for longer, by some 0.0003 units a second: scissors, whose spring holds them open, and what lies against them.
const TREMBLING: [(&str, &[&str]); 2] = [
    (
        "tablesetup/elements.xml",
        &["bondPoint_screw0", "scissors_lower", "scissors_upper"],
    ),
    ("tablesetup/wire.xml", &["Scissors_lower", "Scissors_upper"]),
];

fn trembles(name: &str, id: &str) -> bool {
    let mut known = TREMBLING.iter();
    known.any(|(file, ids)| *file == name && ids.contains(&id))
}

/// The objects of a scene that are not at rest from 15 to 60 s.
fn restless(name: &str, app: &mut App) -> BTreeSet<String> {
    app.step(15 * 60);
    let rest = bits(app);
    let mut restless = BTreeSet::new();
    for _ in 16..=60 {
        app.step(60);
        let now = bits(app);
        assert_eq!(rest.len(), now.len(), "{name}");
        let moved = rest.iter().zip(&now).filter(|(before, now)| before != now);
        restless.extend(moved.map(|((id, _), _)| id.clone()));
    }
    restless.retain(|id| !trembles(name, id));
    restless
}

fn task_files() -> Vec<PathBuf> {
    let files = fs::read_dir("tablesetup").unwrap();
    let files = files.map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|it| it == "xml"))
        .collect();
    files.sort();
    files
}

#[test]
fn every_shipped_scene_is_at_rest_after_a_quarter_of_a_minute() {
    let restless = task_files().into_iter().filter_map(|file| {
        let name = file.display().to_string();
        let mut app = headless_app();
        app.world_mut().write_command(SceneCommand::Load(file));
        let restless = restless(&name, &mut app);
        (!restless.is_empty()).then_some((name, restless))
    });
    assert_eq!(restless.collect::<Vec<_>>(), []);
}

#[test]
fn every_example_of_the_report_is_at_rest_after_a_quarter_of_a_minute() {
    for (name, elements) in EXAMPLES {
        let text = format!(
            r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml" xspan="20" yspan="12">{elements}</tabletop>"#
        );
        let scene = xml::parse(name.as_ref(), text.as_bytes()).scene;
        assert!(!scene.items.is_empty());
        let mut app = headless_app();
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        assert_eq!(restless(name, &mut app), BTreeSet::new(), "{name}");
    }
}

#[test]
fn a_recording_of_a_scene_at_rest_has_no_line_after_its_first_frame() {
    for file in task_files() {
        let mut untouched = Demonstration::new("untouched");
        untouched.act(&[
            (
                vec![SimCommand::Scene(SceneCommand::Load(file.clone()))],
                15 * 60,
            ),
            (
                vec![SimCommand::Recording(RecordingCommand::Start)],
                45 * 60,
            ),
            (vec![SimCommand::Recording(RecordingCommand::Finish)], 1),
        ]);
        let events = fs::read_to_string(untouched.folder.join("0.txt")).unwrap();
        let name = file.display().to_string();
        let mut late = events.lines().filter(|line| !line.starts_with("0,"));
        let moved = late.find(|line| line.split(',').nth(2).is_none_or(|id| !trembles(&name, id)));
        assert_eq!(moved, None, "{name}");
    }
}

#[test]
fn a_scene_settles_while_something_is_moved_far_away() {
    let scene = |with_mover: bool| {
        let mut scene = xml::read_task("tablesetup/hammer.xml".as_ref())
            .unwrap()
            .scene;
        if with_mover {
            let shape = Shape::Block {
                span: Vec3::ONE,
                color: Rgb::GRAY,
            };
            let pose = Pose::at(Vec3::new(-8.0, 4.0, 0.5));
            let mover = ObjectSpec::new("mover", pose, 1.0, shape);
            scene.items.push(SceneItem::Object(mover));
        }
        SimCommand::Scene(SceneCommand::Set(Box::new(scene)))
    };
    let hammer = |app: &App| {
        bits(app)
            .into_iter()
            .find(|(id, _)| id == "hammer")
            .unwrap()
    };

    let mut app = headless_app();
    let hand = Hand::Any;
    app.world_mut().write_command(scene(true));
    app.step(1);
    let object = "mover".to_owned();
    app.world_mut()
        .write_command(HandCommand::Grasp { hand, object });
    let mut resting = None;
    for tick in 0..30 * 60 {
        let angle = tick as f32 / 20.0;
        let location = Vec3::new(-8.0 + angle.cos(), 4.0 + angle.sin(), 2.0);
        app.world_mut()
            .write_command(HandCommand::MoveTo { hand, location });
        app.step(1);
        if tick == 5 * 60 {
            resting = Some(hammer(&app));
        }
    }
    assert_eq!(Some(hammer(&app)), resting);
}

#[test]
fn a_fixed_object_carries_a_falling_load_after_it_was_held() {
    let text = r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml" xspan="20" yspan="12">
        <block id="shelf" location="(0,0,3)" xspan="4" yspan="4" zspan="0.5" mass="0"/>
        <block id="load" location="(0,0,8)" xspan="1" yspan="1" zspan="1" mass="1"/>
      </tabletop>"#;
    let scene = xml::parse("shelf".as_ref(), text.as_bytes()).scene;
    let mut app = headless_app();
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app.step(2);
    let (hand, object) = (Hand::Any, "shelf".to_owned());
    app.world_mut()
        .write_command(HandCommand::Grasp { hand, object });
    app.step(3);
    app.world_mut().write_command(HandCommand::Release(hand));
    let load = app.world().resource::<ObjectIndex>().get("load").unwrap();
    let place = |app: &App| app.world().get::<Transform>(load).unwrap().translation;
    for _ in 0..120 {
        app.step(1);
        assert!(place(&app).z > 3.75 - 0.05, "{}", place(&app));
    }
    let aside = place(&app).truncate().length();
    assert!(aside < 0.002, "it landed {aside} aside");
}

#[test]
fn a_fixed_object_stops_a_fast_load_after_it_was_held_still() {
    let text = r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml" xspan="20" yspan="12">
        <block id="shelf" location="(0,0,3)" xspan="4" yspan="4" zspan="0.5" mass="0"/>
        <box id="load" location="(6,0,0.5)" xspan="1" yspan="1" zspan="1" thickness="0.1" mass="1"/>
      </tabletop>"#;
    let scene = xml::parse("shelf".as_ref(), text.as_bytes()).scene;
    let mut app = headless_app();
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    let (hand, height) = (Hand::Any, 12.0);
    let lifted = Vec3::new(6.0, 0.0, height);
    let above = Vec3::Z * height;
    for (object, ways) in [("shelf", vec![]), ("load", vec![lifted, above])] {
        app.step(120);
        let object = object.to_owned();
        app.world_mut()
            .write_command(HandCommand::Grasp { hand, object });
        app.step(120);
        for location in ways {
            app.world_mut()
                .write_command(HandCommand::MoveTo { hand, location });
            app.step(120);
        }
        app.world_mut().write_command(HandCommand::Release(hand));
    }
    let load = app.world().resource::<ObjectIndex>().get("load").unwrap();
    let place = |app: &App| app.world().get::<Transform>(load).unwrap().translation;
    assert!((place(&app) - above).length() < 0.1, "{}", place(&app));
    for _ in 0..120 {
        app.step(1);
        assert!(place(&app).z > 3.75 - 0.05, "{}", place(&app));
    }
    assert!(place(&app).z < 4.0, "{}", place(&app));
}
