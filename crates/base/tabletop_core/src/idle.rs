//! Rest of a window in which only the user acts.

use bevy::prelude::*;

use crate::{RestingSystems, rest};

/// Number of ticks in which nothing can happen unless the user acts, as it was at the end of the last frame; 0 while something moves.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Idle(pub u64);

/// The ticks that the next tick may pass over.
#[derive(Resource, Default)]
struct PassedOver(u64);

/// Publishes [`Idle`], and passes over such ticks when frames are far apart.
#[derive(Clone, Copy, Debug, Default)]
pub struct IdlePlugin;

impl Plugin for IdlePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Idle>()
            .init_resource::<PassedOver>()
            .add_systems(FixedFirst, catch_up.in_set(RestingSystems))
            .add_systems(Last, look_for_rest);
    }
}

fn look_for_rest(world: &mut World) {
    let may_pass_over = rest::holds_for_all_systems(world);
    let ticks = rest::ticks_of_rest(world);
    let idle = Idle(if may_pass_over { ticks } else { 0 });
    world.resource_mut::<Idle>().set_if_neq(idle);
    world.resource_mut::<PassedOver>().0 = idle.0;
}

/// Passes over the ticks of a frame in which nothing could happen, except the last one. Frames may then be far apart, and the
/// user's next command is still carried out in one tick, as in any other frame.
fn catch_up(world: &mut World) {
    let PassedOver(most) = std::mem::take(&mut *world.resource_mut::<PassedOver>());
    let time = world.resource::<Time<Fixed>>();
    let waiting = time.overstep().as_nanos() / time.timestep().as_nanos();
    let ticks = most.min(u64::try_from(waiting).unwrap_or(u64::MAX));
    if ticks == 0 {
        return;
    }
    rest::pass_over(world, ticks);
    let mut time = world.resource_mut::<Time<Fixed>>();
    let passed = time.timestep() * u32::try_from(ticks).unwrap_or(u32::MAX);
    time.discard_overstep(passed);
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use bevy::time::TimeUpdateStrategy;

    use super::*;
    use crate::{CorePlugin, SceneCommand, SimTick, WriteCommand as _};

    #[derive(Resource, Default)]
    struct Made(Vec<u64>);

    /// An app whose frames are a tenth of a second apart.
    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), IdlePlugin))
            .init_resource::<Made>()
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(
                100,
            )))
            .add_systems(
                FixedUpdate,
                (|mut made: ResMut<Made>, tick: Res<SimTick>| made.0.push(tick.0))
                    .in_set(RestingSystems),
            );
        app
    }

    fn made(app: &mut App, frames: usize) -> Vec<u64> {
        (0..frames).for_each(|_| app.update());
        std::mem::take(&mut app.world_mut().resource_mut::<Made>().0)
    }

    #[test]
    fn whoever_asks_during_a_frame_learns_that_the_world_rests() {
        #[derive(Resource, Default)]
        struct Learned(Vec<bool>);
        let mut app = app();
        app.init_resource::<Learned>()
            .add_systems(Update, |idle: Res<Idle>, mut learned: ResMut<Learned>| {
                learned.0.push(*idle != Idle(0))
            });
        app.finish();
        app.cleanup();
        made(&mut app, 20);
        assert_eq!(app.world().resource::<Learned>().0[10..], [true; 10]);
    }

    #[test]
    fn a_frame_of_an_idle_world_makes_its_last_tick() {
        let mut app = app();
        app.finish();
        app.cleanup();
        let settling = made(&mut app, 11);
        assert_eq!(settling[..12], (0..12).collect::<Vec<_>>());
        let last = made(&mut app, 10);
        assert_eq!(last.len(), 10);
        assert_eq!(last[9] - last[0], 54, "of six ticks a frame");
        app.world_mut().write_command(SceneCommand::Clear);
        made(&mut app, 1);
        assert_eq!(*app.world().resource::<Idle>(), Idle(0));
        assert_eq!(made(&mut app, 1).len(), 6);
    }
}
