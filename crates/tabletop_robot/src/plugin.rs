//! What the plugin adds to an app.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_core::{
    ActuateSystems, CommandSystems, HeadCamera, Robot, RobotJoint, RobotMode, RollbackRegistry,
    SimSystems, Table,
};
use tabletop_kinematics::{Model, ModelError};
use tabletop_physics::BodySystems;

use crate::{
    advance,
    driven::Motors,
    feel,
    figures::{Figures, show_figures},
    grips::{self, Grips},
    meeting::Meetings,
    orders::{self, Orders},
    parts::{self, Parts},
    skeleton::Skeleton,
};

/// Which robot stands at the table.
#[derive(Resource, Clone, Debug)]
pub struct Description {
    /// Its model.
    pub model: Model,
    /// Where it was read from; `None` for the robot that comes with the program.
    pub source: Option<Source>,
}

/// Where a robot's description was read from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// The file, beside which its meshes are.
    pub path: PathBuf,
    /// What it says.
    pub urdf: String,
}

impl Description {
    /// The robot that a file describes.
    ///
    /// # Errors
    ///
    /// The text is no URDF that can be used, or lacks joints or links that the robot's arms need; the error names them.
    pub fn read(source: Source) -> Result<Self, ModelError> {
        let model = Model::from_urdf(&source.urdf)?;
        Skeleton::new(model.clone())?;
        Ok(Self {
            model,
            source: Some(source),
        })
    }

    /// The file beside which its meshes are.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.source.as_ref().map(|source| source.path.as_path())
    }

    /// The Baxter that comes with the program.
    ///
    /// # Errors
    ///
    /// None that a test of the program would not find.
    pub fn baxter() -> Result<Self, ModelError> {
        Ok(Self {
            model: tabletop_kinematics::baxter()?,
            source: None,
        })
    }
}

/// Adds the robot. Needs [`CorePlugin`](tabletop_core::CorePlugin) and [`PhysicsPlugin`](tabletop_physics::PhysicsPlugin).
#[derive(Clone, Debug, Default)]
pub struct BaxterPlugin {
    /// Another robot than the one that comes with the program.
    pub description: Option<Description>,
    /// How its joints move.
    pub mode: RobotMode,
}

impl Plugin for BaxterPlugin {
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
        let mut skeleton = match Skeleton::new(description.model.clone()) {
            Ok(skeleton) => skeleton,
            Err(error) => {
                error!("there is no robot: {error}");
                return;
            }
        };
        for (link, error) in skeleton.add_meshes(description.path()) {
            warn!("link {link} is not touched where this mesh would be: {error}");
        }
        app.insert_resource(Meetings::new(&skeleton))
            .insert_resource(skeleton)
            .insert_resource(description)
            .init_resource::<Figures>()
            .init_resource::<Orders>()
            .init_resource::<Parts>()
            .init_resource::<Grips>()
            .init_resource::<Motors>()
            .init_resource::<HeadCamera>();
        let world = app.world_mut();
        world.resource_mut::<Robot>().mode = self.mode;
        let mut registry = world.resource_mut::<RollbackRegistry>();
        registry.add::<Robot>();
        registry.add::<Orders>();
        registry.add::<Parts>();
        registry.add::<Grips>();
        registry.add::<Motors>();
        app.add_systems(Startup, publish)
            .add_systems(
                FixedUpdate,
                (
                    (
                        stand_at_table.run_if(table_has_come),
                        orders::obey,
                        grips::give_to_hands,
                    )
                        .chain()
                        .after(BodySystems)
                        .in_set(CommandSystems::Robot),
                    (advance::advance, grips::draw_jointed, turn_camera)
                        .chain()
                        .in_set(ActuateSystems::Robot),
                    feel::feel.in_set(SimSystems::Sense),
                    show_figures
                        .run_if(resource_changed::<Robot>)
                        .in_set(SimSystems::Propagate),
                ),
            )
            .add_observer(grips::note_lost);
    }
}

fn table_has_come(tables: Query<(), Added<Table>>) -> bool {
    !tables.is_empty()
}

/// Puts the robot in front of the table, as its joints have it.
pub(crate) fn stand_at_table(world: &mut World) -> Result {
    parts::teleport(world)?;
    world.run_system_cached(publish)?;
    Ok(())
}

/// Writes where the arms are.
fn publish(known: advance::Known, orders: Res<Orders>, mut robot: ResMut<Robot>) {
    let base = known.base();
    known.publish(&mut robot, &orders, base);
}

/// Lets the head camera turn with the neck.
fn turn_camera(robot: Res<Robot>, mut camera: ResMut<HeadCamera>) {
    let pan = robot.joint(RobotJoint::HeadPan).position as f32;
    if camera.pan != pan {
        camera.pan = pan;
    }
}
