//! The systems of a tick: no two may run in either order, and none while the simulation is blocked.

use std::collections::HashSet;

use bevy::{
    ecs::schedule::{LogLevel, ScheduleBuildSettings},
    prelude::*,
};
use tabletop::{
    TabletopSimPlugins,
    core::{OrderSystems, TickSystems},
    headless_app_with,
    prelude::*,
    real::RealRobotPlugin,
    recorder::{RecorderPlugin, UnrecordedPlugin},
};

fn with_ambiguities_as_errors(app: &mut App) {
    app.edit_schedule(FixedUpdate, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Error,
            hierarchy_detection: LogLevel::Error,
            ..default()
        });
    });
}

#[test]
fn the_order_of_a_tick_is_unambiguous() {
    let without_recorder = TabletopSimPlugins
        .build()
        .disable::<RecorderPlugin>()
        .add(UnrecordedPlugin);
    let beside_a_real_robot = TabletopSimPlugins.build().add(RealRobotPlugin::default());
    for mut app in [
        headless_app(),
        headless_app_with(without_recorder),
        headless_app_with(beside_a_real_robot),
    ] {
        with_ambiguities_as_errors(&mut app);
        app.step(1);
        assert_eq!(app.world().resource::<SimTick>().0, 1);
    }
}

#[test]
#[should_panic(expected = "FixedUpdate")]
fn an_unordered_system_is_found() {
    let mut app = headless_app();
    with_ambiguities_as_errors(&mut app);
    app.add_systems(FixedUpdate, |_: Query<&mut Transform>| {});
    app.step(1);
}

/// The systems that neither belong to a tick nor give orders for it.
fn stray_systems(app: &mut App) -> Vec<String> {
    app.step(1);
    let mut stray = Vec::new();
    app.edit_schedule(FixedUpdate, |schedule| {
        let sets = [
            TickSystems.intern(),
            OrderSystems::Scenario.intern(),
            OrderSystems::User.intern(),
            OrderSystems::Controller.intern(),
            OrderSystems::Script.intern(),
        ];
        // A set without systems is unknown.
        let in_set = |set| schedule.graph().systems_in_set(set).ok();
        let placed: HashSet<_> = sets.into_iter().filter_map(in_set).flatten().collect();
        let systems = schedule.systems().into_iter().flatten();
        stray = systems
            .filter(|(key, _)| !placed.contains(key))
            .map(|(_, system)| system.name().to_string())
            .filter(|name| !name.ends_with("apply_deferred"))
            .collect();
    });
    stray
}

#[test]
fn nothing_of_a_tick_runs_at_a_standstill() {
    let mut app = headless_app();
    assert_eq!(stray_systems(&mut app), Vec::<String>::new());
}

#[test]
fn a_stray_system_is_found() {
    let mut app = headless_app();
    app.add_systems(FixedUpdate, (|| {}).before(TickSystems));
    assert_eq!(stray_systems(&mut app).len(), 1);
}
