//! Physics of the tabletop simulator: the one place that adds and configures Rapier.
//!
//! Every entity with an [`ObjectSpec`] or a [`Table`](tabletop_core::Table) gets a rigid body,
//! every [`Joint`](tabletop_core::Joint) a constraint, in the tick in which it appears. One step is made a tick, in
//! [`SimSystems::Physics`]; the poses are in the entities' `Transform` afterwards, the velocities in
//! their [`Twist`].
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_physics::PhysicsPlugin;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), PhysicsPlugin::default()))
//!     .start();
//! let ball = app
//!     .world_mut()
//!     .spawn(ObjectSpec {
//!         id: "ball".into(),
//!         pose: Pose::IDENTITY,
//!         mass: 1.0,
//!         shape: Shape::Sphere { radius: 1.0, color: Rgb::GRAY },
//!         dynamics: Default::default(),
//!         descriptions: vec![],
//!     })
//!     .id();
//! app.step(60);
//! let height = app.world().get::<Transform>(ball).unwrap().translation.z;
//! assert!((height + 98.1 / 2.0).abs() < 1.0, "it fell to {height}");
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod bodies;
mod effort;
mod encounter;
mod geometry;
mod holding;
mod hooks;
mod impact;
mod linkage;
mod mover;
mod rest;
mod settings;
mod snapshot;
mod twist;
mod unequal;
mod workarounds;

pub use bodies::{BodySystems, collider, mass_properties, reshape, take_in};
pub use effort::{Care, Engine};
pub use geometry::{
    Convex, Nearby, Nearest, Pressure, convex_parts, depth, is_touching, nearby, nearest,
    pressures_on, pushed_out, to_rapier,
};
pub use holding::{Carry, MET_WHEN_THERE, hold, let_go, pull_velocity, push, put};
pub use mover::{
    Approach, Environment, FreeObject, MovedBody, MovedBodyItem, Pushed, SweptSolid, are_near,
    limits,
};
pub use settings::PhysicsSettings;
pub use snapshot::{PhysicsSnapshot, remove_joint, remove_object, renew_if_empty};
pub use workarounds::{
    contact::contact,
    enabling::set_enabled,
    impulses::{impulse_share, solved_points},
    release::JustReleased,
};

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Care, Carry, PhysicsPlugin, PhysicsSettings, hold, let_go, remove_object};
}

use bevy::{ecs::schedule::ScheduleConfigs, ecs::system::ScheduleSystem, prelude::*};
use bevy_rapier3d::{
    plugin::systems,
    prelude::*,
    rapier::dynamics::{IntegrationParameters, SpringCoefficients},
};
use tabletop_core::{
    CommandSystems, ObjectSpec, Paused, RestingSystems, SimSystems, TICK_SECONDS, TickSystems,
};
use tabletop_geometry::Twist;
use tabletop_history::RollbackApp;

use crate::{
    hooks::ContactHooks,
    workarounds::{
        burden, order, outside,
        quarantine::{self, Quarantine},
        release, relief, rolling,
        seams::{self, Seams},
        short_turn, transforms,
    },
};

/// Length to which Rapier scales its tolerances. The parameters are in units; a greater number would only fatten the boxes
/// in which it looks for contacts.
const LENGTH_UNIT: f32 = 1.0;

/// Adds Rapier and gives objects, table and joints their bodies. Needs [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct PhysicsPlugin {
    /// The constants to start with; they stay as a resource.
    pub settings: PhysicsSettings,
}

impl Plugin for PhysicsPlugin {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<TransformPlugin>() {
            app.add_plugins(TransformPlugin);
        }
        // Before Rapier, which would insert these without making Bevy clear them.
        app.register_type::<Care>()
            .register_type::<Carry>()
            .register_type::<JustReleased>()
            .register_type::<PhysicsSettings>()
            .add_message::<CollisionEvent>()
            .add_message::<ContactForceEvent>()
            .add_message::<MassModifiedEvent>();
        app.init_resource::<Care>()
            .init_resource::<outside::WrittenBack>()
            .init_resource::<Quarantine>()
            .init_resource::<impact::Onset>()
            .init_resource::<impact::SubstepsBefore>()
            .init_resource::<encounter::FreeFlights>()
            .init_resource::<linkage::FreeLinkages>()
            .init_resource::<burden::Burdened>()
            .init_resource::<burden::NewBodies>()
            .init_resource::<Seams>()
            .insert_resource(self.settings)
            .insert_resource(TimestepMode::Fixed {
                dt: TICK_SECONDS,
                substeps: 1,
            })
            .add_plugins(
                RapierPhysicsPlugin::<ContactHooks>::default()
                    .with_custom_initialization(
                        RapierContextInitialization::InitializeDefaultRapierContext {
                            integration_parameters: integration_parameters(),
                            rapier_configuration: RapierConfiguration {
                                gravity: Vec3::NEG_Z * self.settings.gravity,
                                ..RapierConfiguration::new(LENGTH_UNIT)
                            },
                        },
                    )
                    .in_fixed_schedule()
                    .with_default_system_setup(false),
            )
            .configure_sets(
                FixedUpdate,
                (
                    PhysicsSet::SyncBackend,
                    PhysicsSet::StepSimulation,
                    PhysicsSet::Writeback,
                )
                    .chain()
                    .in_set(SimSystems::Physics),
            )
            .add_systems(
                FixedUpdate,
                (
                    sync_backend().in_set(PhysicsSet::SyncBackend),
                    effort::configure_solver
                        .after(PhysicsSet::SyncBackend)
                        .before(PhysicsSet::StepSimulation)
                        .in_set(SimSystems::Physics),
                    impact::note_substeps
                        .run_if(impact::is_any_elastic)
                        .after(PhysicsSet::SyncBackend)
                        .before(effort::configure_solver)
                        .in_set(SimSystems::Physics),
                    impact::keep_speed
                        .run_if(impact::is_any_elastic)
                        .after(effort::configure_solver)
                        .before(encounter::look_ahead)
                        .before(impact::note_onset)
                        .in_set(SimSystems::Physics),
                    encounter::look_ahead
                        .after(effort::configure_solver)
                        .before(burden::take_up)
                        .before(PhysicsSet::StepSimulation)
                        .in_set(SimSystems::Physics),
                    impact::note_onset
                        .run_if(impact::may_strike)
                        .after(encounter::look_ahead)
                        .before(PhysicsSet::StepSimulation)
                        .in_set(SimSystems::Physics),
                    burden::take_up
                        .after(effort::configure_solver)
                        .after(impact::note_onset)
                        .before(PhysicsSet::StepSimulation)
                        .in_set(SimSystems::Physics),
                    linkage::note_energies
                        .run_if(linkage::is_any_jointed)
                        .after(burden::take_up)
                        .before(PhysicsSet::StepSimulation)
                        .in_set(SimSystems::Physics),
                    RapierPhysicsPlugin::<ContactHooks>::get_systems(PhysicsSet::StepSimulation),
                    linkage::give_back
                        .run_if(linkage::is_any_jointed)
                        .after(PhysicsSet::StepSimulation)
                        .before(burden::put_down)
                        .in_set(SimSystems::Physics),
                    burden::put_down
                        .after(PhysicsSet::StepSimulation)
                        .before(impact::rebound)
                        .before(relief::relieve)
                        .in_set(SimSystems::Physics),
                    impact::rebound
                        .run_if(impact::has_impacts)
                        .after(PhysicsSet::StepSimulation)
                        .before(relief::relieve)
                        .in_set(SimSystems::Physics),
                    relief::relieve
                        .after(PhysicsSet::StepSimulation)
                        .before(PhysicsSet::Writeback)
                        .in_set(SimSystems::Physics),
                    RapierPhysicsPlugin::<ContactHooks>::get_systems(PhysicsSet::Writeback),
                    quarantine::let_out
                        .after(systems::writeback_rigid_bodies)
                        .after(systems::writeback_mass_properties)
                        .in_set(PhysicsSet::Writeback),
                    unequal::warn_of_unequal_masses
                        .after(relief::relieve)
                        .before(PhysicsSet::Writeback)
                        .in_set(SimSystems::Physics),
                    outside::note_written_back
                        .after(PhysicsSet::Writeback)
                        .in_set(SimSystems::Physics),
                    (transforms::propagate(), twist::note_twists).in_set(SimSystems::Propagate),
                )
                    .in_set(RestingSystems),
            )
            .add_observer(rolling::let_cylinders_roll)
            .add_plugins((bodies::plugin, rest::plugin))
            .add_systems(
                FixedUpdate,
                release::let_fall
                    .run_if(Paused::is_running)
                    .after(BodySystems)
                    .before(CommandSystems::Hands)
                    .in_set(TickSystems)
                    .in_set(RestingSystems),
            )
            .rollback_component::<ObjectSpec>()
            .rollback_component::<Velocity>()
            .rollback_component::<Sleeping>()
            .rollback_component::<RigidBody>()
            .rollback_component::<GravityScale>()
            .rollback_component::<SoftCcd>()
            .rollback_component::<RigidBodyDisabled>()
            .rollback_component::<JustReleased>()
            .rollback_component::<Carry>()
            .rollback_resource::<Care>()
            .rollback_resource::<Quarantine>()
            .rollback_resource::<Seams>()
            .rollback_resource::<burden::NewBodies>()
            .rollback_state::<PhysicsSnapshot>()
            .derived_component::<Twist>();
    }
}

/// Rapier's systems before a step, with our propagation of transforms in place of its own. Between them they ask for the changes of thirty
/// components of every body, so they run only when there are any.
fn sync_backend() -> ScheduleConfigs<ScheduleSystem> {
    let carry_changes = (
        (
            systems::on_add_entity_with_parent,
            systems::on_change_context,
            systems::sync_removals,
            systems::init_rigid_bodies,
            systems::init_colliders,
            systems::init_joints,
        )
            .chain(),
        (
            systems::apply_scale,
            order::note_changes,
            systems::apply_collider_user_changes,
            systems::apply_joint_user_changes,
            systems::apply_initial_rigid_body_impulses,
            systems::apply_rigid_body_user_changes,
            short_turn::turn_the_short_way,
            seams::find_seams,
        )
            .chain(),
    )
        .chain()
        .run_if(outside::has_changed);
    (transforms::propagate(), carry_changes).chain()
}

/// The parameters of Rapier's solver, tuned until towers of ten unit blocks stand still. At this scale, gravity is ten times the one that
/// Rapier's defaults are made for, and its soft contacts let tall stacks sway and buckle (`tests/quality` of tabletop_scene sets the
/// bar). [`Care`] changes them before every step.
pub fn integration_parameters() -> IntegrationParameters {
    let stiff_contacts = SpringCoefficients {
        natural_frequency: 540.0,
        damping_ratio: 10.0,
    };
    IntegrationParameters {
        dt: TICK_SECONDS,
        length_unit: LENGTH_UNIT,
        num_solver_iterations: effort::BASE_SUBSTEPS,
        contact_softness: stiff_contacts,
        static_contact_softness: stiff_contacts,
        warmstart_joints: true,
        normalized_allowed_linear_error: 0.05,
        // Squeezed bodies come apart gently.
        normalized_max_corrective_velocity: 3.0,
        normalized_prediction_distance: effort::PREDICTION,
        normalized_max_linear_velocity: 4000.0,
        // Kept contacts lag behind what rocks, and feed it: with 0.001, a ring on a peg never comes to rest. Without any, towers creep.
        normalized_contact_recycle_distance: 0.0008,
        ..default()
    }
}
