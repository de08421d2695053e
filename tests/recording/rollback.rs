//! Undo restores all state that a tick changes on an entity that rolls back or in a resource, or derives it from restored state.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use bevy::{
    ecs::{change_detection::Tick, component::ComponentId, world::EntityRef},
    prelude::*,
};
use tabletop::{
    core::{RobotMode, Rollback},
    headless_app_with,
    history::RollbackRegistry,
    prelude::*,
    recorder::RecorderPlugin,
    robot::{Description, DescriptionSource, RobotPlugin},
    scenario::{Outcome, Program, Scenario, ScenarioRun},
    xml::read_task,
};

use crate::{
    demonstration::{Demonstration, fresh_folder},
    random::{Random, scene, script},
};

/// The components of the entities that roll back, after a tick.
struct Composition {
    entities: BTreeMap<Entity, BTreeSet<ComponentId>>,
    at: Tick,
}

impl Composition {
    fn of(world: &mut World) -> Self {
        let mut entities = world.query_filtered::<EntityRef, With<Rollback>>();
        let components =
            |entity: EntityRef| entity.archetype().components().iter().copied().collect();
        Self {
            entities: entities
                .iter(world)
                .map(|entity| (entity.id(), components(entity)))
                .collect(),
            at: world.increment_change_tick(),
        }
    }

    /// The names of the components that have changed, come or gone since, and of which undo knows nothing.
    fn forgotten(&self, world: &mut World) -> BTreeSet<String> {
        let now = Self::of(world);
        let registry = world.resource::<RollbackRegistry>();
        let mut forgotten = BTreeSet::new();
        for (&entity, components) in &now.entities {
            let Some(before) = self.entities.get(&entity) else {
                continue;
            };
            let entity = world.entity(entity);
            let has_changed = |&&component: &&ComponentId| {
                entity
                    .get_change_ticks_by_id(component)
                    .is_some_and(|ticks| ticks.is_changed(self.at, now.at))
            };
            let changed = components.iter().filter(has_changed);
            for component in changed.chain(components.symmetric_difference(before)) {
                let info = world.components().get_info(*component).unwrap();
                if !info.type_id().is_some_and(|id| registry.covers(id)) {
                    forgotten.insert(info.name().to_string());
                }
            }
        }
        forgotten
    }
}

/// Simulates a tick, and adds the names of the components and resources that undo forgets.
fn watch(app: &mut App, forgotten: &mut BTreeSet<String>) {
    let before = Composition::of(app.world_mut());
    app.step(1);
    forgotten.extend(forgotten_resources(app.world_mut(), before.at));
    forgotten.extend(before.forgotten(app.world_mut()));
}

/// Resources that undo leaves as they are.
const NOT_ROLLED_BACK: [&str; 27] = [
    // Undo itself, and the recording that it is a part of.
    "tabletop_core::recording::History",
    "tabletop_core::recording::Recording",
    "tabletop_core::timeline::Timeline",
    "tabletop_history::removal::KeepRemoved",
    "tabletop_history::rollback::RollingBack",
    "tabletop_history::segments::Segments",
    "tabletop_recorder::files::session::SessionSettings",
    "tabletop_recorder::recording::recorder::Recorder",
    // Numbers of commands go on after undo.
    "tabletop_core::command::carry_out::Cause",
    "tabletop_core::command::issued::NextCommandId",
    "tabletop_scenario::run::ScenarioRun",
    "tabletop_script::runner::ScriptRunner",
    // Pictures are made of the present state.
    "tabletop_camera::head_camera::HeadCameraRenderer",
    "tabletop_camera::visible_world::FigureCount",
    "tabletop_core::hand_camera::HandImages",
    "tabletop_core::sensor::HeadCamera",
    "tabletop_core::sensor::PictureDemand",
    "tabletop_core::sensor::SensorImage",
    "tabletop_robot::look::link_figures::LinkFigures",
    // Empty when undo comes.
    "tabletop_physics::bodies::PendingBodies",
    // Found out anew in every tick.
    "tabletop_physics::encounter::free_flights::FreeFlights",
    "tabletop_physics::impact::onset::Onset",
    "tabletop_physics::linkage::FreeLinkages",
    "tabletop_core::clock::Forgotten",
    "tabletop_core::rest::Rest",
    "tabletop_physics::workarounds::outside::WrittenBack",
    "tabletop_physics::rest::LastStep",
];

/// The names of the program's resources that have changed since, and of which undo knows nothing.
fn forgotten_resources(world: &mut World, since: Tick) -> BTreeSet<String> {
    let now = world.increment_change_tick();
    let registry = world.resource::<RollbackRegistry>();
    let changed = world.iter_resources().filter_map(|(info, _)| {
        let ticks = world.get_resource_change_ticks_by_id(info.id())?;
        let is_covered = info.type_id().is_some_and(|id| registry.covers(id));
        let name = info.name().to_string();
        let is_ours = name.starts_with("tabletop_") && !NOT_ROLLED_BACK.contains(&name.as_str());
        (ticks.is_changed(since, now) && is_ours && !is_covered).then_some(name)
    });
    changed.collect()
}

#[test]
fn nothing_that_a_random_demonstration_changes_is_forgotten() {
    let mut forgotten = BTreeSet::new();
    for seed in 0..4 {
        let mut demonstration = Demonstration::new("watched");
        demonstration.tick(&[
            scene(),
            SimCommand::Robot(RobotCommand::Show(true)),
            SimCommand::Recording(RecordingCommand::Start),
        ]);
        for commands in script(&mut Random(seed), 300) {
            for command in commands {
                demonstration.app.world_mut().write_command(command);
            }
            watch(&mut demonstration.app, &mut forgotten);
        }
    }
    assert!(
        forgotten.is_empty(),
        "register these with rollback_component, rollback_resource or derived_component: {forgotten:#?}"
    );
}

#[test]
fn nothing_that_a_shipped_scenario_changes_is_forgotten() {
    watch_scenarios("kinematic", RobotMode::Kinematic, |_| true);
}

#[test]
fn nothing_that_motors_change_is_forgotten() {
    watch_scenarios("motors", RobotMode::Dynamic, |scenario| {
        scenario.contains("Robot(")
    });
}

#[test]
#[ignore = "takes a minute"]
fn nothing_that_motors_change_in_any_scenario_is_forgotten() {
    watch_scenarios("all_motors", RobotMode::Dynamic, |scenario| {
        !scenario.contains("Robot(")
    });
}

/// Performs the shipped scenarios whose text is chosen.
fn watch_scenarios(name: &str, mode: RobotMode, is_chosen: impl Fn(&str) -> bool) {
    let mut forgotten = BTreeSet::new();
    for entry in fs::read_dir("scenarios").unwrap() {
        let path = entry.unwrap().path();
        let is_scenario = path.extension().is_some_and(|ending| ending == "ron");
        if is_scenario && is_chosen(&fs::read_to_string(&path).unwrap()) {
            perform(name, &path, mode, &mut forgotten);
        }
    }
    assert!(
        forgotten.is_empty(),
        "register these with rollback_component, rollback_resource or derived_component: {forgotten:#?}"
    );
}

/// The shipped robot of one arm.
fn panda() -> Description {
    let read = |name: &str| fs::read_to_string(Path::new("assets/panda").join(name)).unwrap();
    let source = DescriptionSource {
        path: "assets/panda/panda.urdf".into(),
        urdf: read("panda.urdf"),
        layout: Some(read("robot.ron")),
        reach: None,
    };
    Description::read(source).unwrap()
}

/// Performs a scenario.
fn perform(name: &str, path: &Path, mode: RobotMode, forgotten: &mut BTreeSet<String>) {
    let text = fs::read_to_string(path).unwrap();
    let scenario = Scenario::parse(path, &text).unwrap();
    let read = |path: &Path| Ok(read_task(path).unwrap().scene);
    let program = Program::new(&scenario, read, 0).unwrap();
    let recorder = RecorderPlugin {
        folder: fresh_folder(&format!("watched_{name}")),
        ..default()
    };
    let is_of_panda = path.ends_with("panda_stack.ron");
    let robot = RobotPlugin {
        mode,
        description: is_of_panda.then(panda),
    };
    let plugins = TabletopSimPlugins.build().set(recorder).set(robot);
    let mut app = headless_app_with(plugins);
    app.insert_resource(ScenarioRun::new(program));
    while *app.world().resource::<ScenarioRun>().outcome() == Outcome::Running {
        watch(&mut app, forgotten);
    }
}
