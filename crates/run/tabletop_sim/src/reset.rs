//! The world, put back to before its first tick: an episode begins in it as in a new one.

use bevy::prelude::*;
use tabletop_core::{HeadCamera, IssuedCommand, Markers, Paused, SimTick};
use tabletop_history::{WorldSnapshot, drop_removed};
use tabletop_recorder::set_earlier_commands;

/// Lets a world be [`reset`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ResetPlugin;

impl Plugin for ResetPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(PostStartup, remember_beginning);
    }
}

/// The world before its first tick.
#[derive(Resource)]
struct InitialWorld {
    world: WorldSnapshot,
    camera: Option<HeadCamera>,
}

/// Makes the present moment the one to which [`reset`] leads. Nothing may be on the table, so that an episode begins in an empty world.
pub fn remember_beginning(world: &mut World) {
    let beginning = InitialWorld {
        world: WorldSnapshot::take(world),
        camera: world.get_resource().copied(),
    };
    world.insert_resource(beginning);
}

/// Puts the world back to before its first tick, at a fraction of the cost of a new one. The same commands then lead through the same states
/// as in a new world, to the bit. Does nothing in a world without [`ResetPlugin`], or one that has not started.
///
/// ```
/// use tabletop_core::prelude::*;
/// use tabletop_sim::{headless_app, reset};
///
/// let mut app = headless_app();
/// for _episode in 0..2 {
///     app.world_mut()
///         .write_command(SceneCommand::Load("tablesetup/default.xml".into()));
///     app.step(10);
///     assert_eq!(app.world().resource::<SimTick>().0, 10);
///     reset(app.world_mut());
///     assert_eq!(app.world().resource::<ObjectIndex>().iter().count(), 0);
/// }
/// ```
pub fn reset(world: &mut World) {
    if !world.contains_resource::<InitialWorld>() {
        return;
    }
    world.resource_mut::<Messages<IssuedCommand>>().clear();
    world.resource_scope(|world, beginning: Mut<InitialWorld>| {
        beginning.world.restore(world);
        if let Some(camera) = beginning.camera {
            world.insert_resource(camera);
        }
    });
    world.insert_resource(Paused(false));
    world.insert_resource(Markers::default());
    let tick = *world.resource::<SimTick>();
    set_earlier_commands(world, tick, &[]);
    drop_removed(world);
}

#[cfg(test)]
mod tests {
    use tabletop_core::prelude::*;

    use super::*;
    use crate::{final_state::write_state, headless::headless_app};

    /// Loads a task file, moves something, and returns the final state.
    fn episode(app: &mut App, setup: &str) -> Vec<u8> {
        let commands: [SimCommand; 2] = [
            SceneCommand::Load(setup.into()).into(),
            RobotCommand::Show(true).into(),
        ];
        for command in commands {
            app.world_mut().write_command(command);
        }
        app.step(5);
        let world = app.world();
        let first = world.resource::<ObjectIndex>().iter().next().unwrap();
        let object = world.get::<ObjectSpec>(first).unwrap().id.clone();
        let hand = Hand::Left;
        app.world_mut()
            .write_command(HandCommand::Grasp { hand, object });
        app.step(5);
        let location = Vec3::new(1.0, -2.0, 4.0);
        app.world_mut()
            .write_command(HandCommand::MoveTo { hand, location });
        app.step(10);
        app.world_mut().write_command(HandCommand::Release(hand));
        app.world_mut().write_command(RobotCommand::drive([(
            RobotJoint::LeftS1,
            Drive::Velocity(0.5),
        )]));
        app.step(100);
        let mut state = Vec::new();
        write_state(app.world(), &mut state).unwrap();
        state
    }

    #[test]
    fn an_episode_in_a_world_that_was_reset_is_that_in_a_new_one() {
        let mut app = headless_app();
        for setup in [
            "tablesetup/default.xml",
            "tablesetup/chains.xml",
            "tablesetup/default.xml",
        ] {
            let again = episode(&mut app, setup);
            assert_eq!(again, episode(&mut headless_app(), setup), "{setup}");
            reset(app.world_mut());
        }
    }
}
