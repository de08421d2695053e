//! No two systems of a tick may run in either order.

use bevy::{
    ecs::schedule::{LogLevel, ScheduleBuildSettings},
    prelude::*,
};
use tabletop::prelude::*;

fn with_ambiguities_as_errors(app: &mut App) {
    app.edit_schedule(FixedUpdate, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Error,
            ..default()
        });
    });
}

#[test]
fn the_order_of_a_tick_is_unambiguous() {
    let mut app = headless_app();
    with_ambiguities_as_errors(&mut app);
    app.step(1);
    assert_eq!(app.world().resource::<SimTick>().0, 1);
}

#[test]
#[should_panic(expected = "FixedUpdate")]
fn an_unordered_system_is_found() {
    let mut app = headless_app();
    with_ambiguities_as_errors(&mut app);
    app.add_systems(FixedUpdate, |_: Query<&mut Transform>| {});
    app.step(1);
}
