//! The robot's plugin.

use bevy::prelude::*;
use tabletop_core::{
    ActuateSystems, CameraCarrier, CommandSystems, Figure, HandCameras, HandImages, HeadCamera,
    PictureSystems, RestApp as _, RestingSystems, Robot, RobotLayout, RobotMode, SimSystems,
    TickSystems, require,
};
use tabletop_history::{RollbackApp, is_rolling_back};
use tabletop_physics::PhysicsPlugin;

use crate::{
    articulation::{
        link_entities::{LinkEntities, RobotLink},
        passive_links::PassiveLinks,
        self_collision::SelfCollisionMatrix,
        tree::Articulation,
    },
    command::{joint_targets::JointTargets, obey::obey},
    contacts::sense,
    description::Description,
    dynamics::motors::Motors,
    gripper::grips::{self, Grips},
    hand_cameras::place_hand_cameras,
    look::link_figures::{LinkFigures, show_figures},
    motion::{
        advance::advance,
        placement::{
            NewTable, meets_objects, note_table, pass_through_objects, publish, stand_at_table,
            table_has_come,
        },
    },
};

/// Adds the robot. Needs [`CorePlugin`](tabletop_core::CorePlugin) and [`PhysicsPlugin`].
#[derive(Clone, Debug, Default)]
pub struct RobotPlugin {
    /// A robot other than the one that ships with the program.
    pub description: Option<Description>,
    /// The mode in which its joints move.
    pub mode: RobotMode,
}

impl Plugin for RobotPlugin {
    fn build(&self, app: &mut App) {
        let description = match self
            .description
            .clone()
            .map_or_else(Description::baxter, Ok)
        {
            Ok(description) => description,
            Err(error) => {
                error!("there is no robot: {error}");
                return;
            }
        };
        let mut articulation =
            match Articulation::new(description.model.clone(), description.layout.clone()) {
                Ok(articulation) => articulation,
                Err(error) => {
                    error!("there is no robot: {error}");
                    return;
                }
            };
        for (link, error) in articulation.add_meshes(description.source.as_ref()) {
            warn!("link {link} has no collision shape where this mesh would be: {error}");
        }
        let layout = description.layout.clone();
        app.register_type::<RobotLink>()
            .insert_resource(SelfCollisionMatrix::new(&articulation))
            .insert_resource(HandCameras(articulation.hand_cameras.clone().into()))
            .insert_resource(articulation)
            .insert_resource(description)
            .init_resource::<LinkFigures>()
            .insert_resource(JointTargets::none(&layout))
            .init_resource::<LinkEntities>()
            .init_resource::<PassiveLinks>()
            .init_resource::<NewTable>()
            .insert_resource(Grips::none(&layout))
            .init_resource::<Motors>()
            .init_resource::<HeadCamera>()
            .derived_component::<Figure>()
            .rollback_resource::<Robot>()
            .rollback_resource::<JointTargets>()
            .rollback_resource::<LinkEntities>()
            .rollback_resource::<PassiveLinks>()
            .rollback_resource::<NewTable>()
            .rollback_resource::<Grips>()
            .rollback_resource::<Motors>();
        let world = app.world_mut();
        world.insert_resource(Robot {
            mode: self.mode,
            ..Robot::at_home(&layout)
        });
        if let Some(mut camera) = world.get_resource_mut::<HeadCamera>() {
            camera.carrier = CameraCarrier::from(&layout);
        }
        world.insert_resource(layout);
        app.add_systems(Startup, publish)
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
                        turn_camera,
                    )
                        .chain()
                        .in_set(ActuateSystems::Robot),
                    sense::sense_contacts.in_set(SimSystems::Sense),
                    place_hand_cameras
                        .run_if(HandImages::is_asked)
                        .after(SimSystems::Sense)
                        .before(PictureSystems)
                        .in_set(TickSystems),
                    show_figures
                        .run_if(resource_changed::<Robot>)
                        .in_set(SimSystems::Propagate),
                )
                    .in_set(RestingSystems),
            )
            .wake_while(can_move)
            .add_observer(note_table.run_if(not(is_rolling_back)))
            .add_observer(grips::note_lost.run_if(not(is_rolling_back)));
    }

    fn finish(&self, app: &mut App) {
        require::<PhysicsPlugin>(app, self);
    }
}

/// True if the robot moves or pulls at anything.
fn can_move(robot: Res<Robot>, targets: Res<JointTargets>, grips: Res<Grips>) -> bool {
    let is_dynamic = robot.mode == RobotMode::Dynamic;
    is_dynamic || robot.is_changed() || targets.are_given() || grips.all().next().is_some()
}

/// Lets the head camera turn with the neck.
fn turn_camera(layout: Res<RobotLayout>, robot: Res<Robot>, mut camera: ResMut<HeadCamera>) {
    let Some(neck) = layout.neck else {
        return;
    };
    let pan = robot.joints[neck.index()].position as f32;
    if camera.pan != pan {
        camera.pan = pan;
    }
}
