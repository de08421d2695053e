//! The robot's plugin.

use bevy::prelude::*;
use tabletop_core::{
    ActuateSystems, CameraCarrier, CommandSystems, Figure, HandCameras, HandImages, HeadCamera,
    PictureSystems, RestingSystems, Robot, RobotLayout, RobotMode, SimSystems, TickSystems,
    require,
};
use tabletop_history::RollbackApp;
use tabletop_physics::PhysicsPlugin;

use crate::{
    articulation::{
        link_entities::{LinkEntities, RobotLink},
        passive_links::PassiveLinks,
        tree::Articulation,
    },
    description::Description,
    hand_cameras::place_hand_cameras,
    look::link_figures::{LinkFigures, show_figures},
};

/// Adds the robot: its description, bodies, looks and cameras. A drive moves it. Needs [`CorePlugin`](tabletop_core::CorePlugin) and [`PhysicsPlugin`].
#[derive(Clone, Debug, Default)]
pub struct RobotPlugin {
    /// A robot other than the one that ships with the program.
    pub description: Option<Description>,
    /// The mode in which its joints move.
    pub mode: RobotMode,
}

impl RobotPlugin {
    /// What is known of its joints, limbs and cameras.
    pub fn layout(&self) -> &RobotLayout {
        match &self.description {
            Some(description) => &description.layout,
            None => RobotLayout::baxter(),
        }
    }
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
        if self.mode == RobotMode::Dynamic {
            for gap in articulation.motor_gaps() {
                warn!("the robot cannot move by its motors as it should: {gap}");
            }
        }
        let layout = description.layout.clone();
        app.register_type::<RobotLink>()
            .insert_resource(HandCameras(articulation.hand_cameras.clone().into()))
            .insert_resource(articulation)
            .insert_resource(description)
            .init_resource::<LinkFigures>()
            .init_resource::<LinkEntities>()
            .init_resource::<PassiveLinks>()
            .init_resource::<HeadCamera>()
            .derived_component::<Figure>()
            .rollback_resource::<Robot>()
            .rollback_resource::<LinkEntities>()
            .rollback_resource::<PassiveLinks>();
        let world = app.world_mut();
        world.insert_resource(Robot {
            mode: self.mode,
            ..Robot::at_home(&layout)
        });
        if let Some(mut camera) = world.get_resource_mut::<HeadCamera>() {
            camera.carrier = CameraCarrier::from(&layout);
        }
        world.insert_resource(layout);
        app.add_systems(
            FixedUpdate,
            (
                turn_camera
                    .after(ActuateSystems::Robot)
                    .in_set(SimSystems::Actuate),
                // Undo has turned the neck, and a recording that begins notes where the camera looks.
                turn_camera
                    .after(CommandSystems::History)
                    .before(CommandSystems::Recording)
                    .in_set(TickSystems),
                place_hand_cameras
                    .run_if(HandImages::is_asked)
                    .after(SimSystems::Sense)
                    .before(PictureSystems::Receive)
                    .in_set(TickSystems),
                show_figures
                    .run_if(resource_changed::<Robot>)
                    .in_set(SimSystems::Propagate),
            )
                .in_set(RestingSystems),
        );
    }

    fn finish(&self, app: &mut App) {
        require::<PhysicsPlugin>(app, self);
    }
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
