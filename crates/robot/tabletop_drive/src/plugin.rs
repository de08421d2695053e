//! The plugin of the simulated drive.

use bevy::prelude::*;
use tabletop_core::{
    ActuateSystems, CommandSystems, RestApp as _, RestingSystems, Robot, RobotLayout, RobotMode,
    SimSystems, require,
};
use tabletop_history::{RollbackApp, is_rolling_back};
use tabletop_robot::{Articulation, RobotPlugin};

use crate::{
    command::{joint_targets::JointTargets, obey::obey},
    contacts::sense,
    dynamics::motors::Motors,
    gripper::grips::{self, Grips},
    motion::{
        advance::advance,
        placement::{
            NewTable, meets_objects, note_table, pass_through_objects, publish, stand_at_table,
            table_has_come,
        },
    },
    self_collision::SelfCollisionMatrix,
};

/// Lets the robot move in the simulation. Needs [`RobotPlugin`], added before.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrivePlugin;

impl Plugin for DrivePlugin {
    fn build(&self, app: &mut App) {
        let world = app.world();
        let Some(articulation) = world.get_resource::<Articulation>() else {
            error!("there is no robot to move: add RobotPlugin before DrivePlugin");
            return;
        };
        let self_collisions = SelfCollisionMatrix::new(articulation);
        let layout = world.resource::<RobotLayout>();
        let (targets, grips) = (JointTargets::none(layout), Grips::none(layout));
        app.insert_resource(self_collisions)
            .insert_resource(targets)
            .insert_resource(grips)
            .init_resource::<NewTable>()
            .init_resource::<Motors>()
            .rollback_resource::<JointTargets>()
            .rollback_resource::<NewTable>()
            .rollback_resource::<Grips>()
            .rollback_resource::<Motors>()
            .add_systems(Startup, publish)
            .add_systems(
                FixedUpdate,
                (
                    (
                        stand_at_table.run_if(table_has_come),
                        obey,
                        grips::give_to_hands,
                        grips::follow_bonds,
                    )
                        .chain()
                        .in_set(CommandSystems::Robot),
                    (
                        pass_through_objects.run_if(meets_objects),
                        advance,
                        grips::pull_jointed,
                    )
                        .chain()
                        .in_set(ActuateSystems::Robot),
                    sense::sense_contacts.in_set(SimSystems::Sense),
                )
                    .in_set(RestingSystems),
            )
            .wake_while(can_move)
            .add_observer(note_table.run_if(not(is_rolling_back)))
            .add_observer(grips::note_lost.run_if(not(is_rolling_back)));
    }

    fn finish(&self, app: &mut App) {
        require::<RobotPlugin>(app, self);
    }
}

/// True if the robot moves or pulls at anything.
fn can_move(robot: Res<Robot>, targets: Res<JointTargets>, grips: Res<Grips>) -> bool {
    let is_dynamic = robot.mode == RobotMode::Dynamic;
    is_dynamic || robot.is_changed() || targets.are_given() || grips.all().next().is_some()
}
