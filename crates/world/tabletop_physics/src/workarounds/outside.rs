//! Changes from outside: changes of bodies, colliders and joints other than by Rapier's own steps.

use bevy::{
    ecs::{
        change_detection::Tick,
        query::QueryFilter,
        system::{SystemChangeTick, SystemParam},
    },
    prelude::*,
};
use bevy_rapier3d::prelude::*;

/// Bodies whose changes the plugin is about to carry to Rapier.
pub(crate) type ChangedBody = Or<(
    Changed<RigidBody>,
    Changed<RigidBodyDisabled>,
    Changed<GlobalTransform>,
    Changed<Velocity>,
    Changed<Sleeping>,
    Changed<GravityScale>,
    Changed<Damping>,
    Changed<LockedAxes>,
    Changed<Dominance>,
    Changed<ExternalForce>,
    Changed<ExternalImpulse>,
    Changed<AdditionalMassProperties>,
    Changed<AdditionalSolverIterations>,
    Changed<Ccd>,
    Changed<SoftCcd>,
)>;

/// Colliders whose changes the plugin is about to carry to Rapier.
pub(crate) type ChangedCollider = Or<(
    Changed<Collider>,
    Changed<ColliderDisabled>,
    Changed<ColliderMassProperties>,
    Changed<CollisionGroups>,
    Changed<SolverGroups>,
    Changed<Friction>,
    Changed<Restitution>,
    Changed<Sensor>,
    Changed<ActiveEvents>,
    Changed<ActiveHooks>,
    Changed<ActiveCollisionTypes>,
    Changed<ContactForceEventThreshold>,
    Changed<ContactSkin>,
)>;

/// Components that only bodies of other apps have, in one query: where there are none, it is answered at once.
type ChangedExtra = Or<(
    Changed<LockedAxes>,
    Changed<Dominance>,
    Changed<ExternalForce>,
    Changed<ExternalImpulse>,
    Changed<AdditionalMassProperties>,
    Changed<AdditionalSolverIterations>,
    Changed<ColliderDisabled>,
    Changed<CollisionGroups>,
    Changed<SolverGroups>,
    Changed<Sensor>,
    Changed<ActiveEvents>,
    Changed<ActiveHooks>,
    Changed<ActiveCollisionTypes>,
    Changed<ContactForceEventThreshold>,
    Changed<ContactSkin>,
)>;

/// The moment after the last step, when Rapier's changes had been written to components.
#[derive(Resource, Default)]
pub(crate) struct WrittenBack(Option<Tick>);

/// Notes the moment at which the results of a step have been written to components.
pub(crate) fn note_written_back(mut written: ResMut<WrittenBack>, now: SystemChangeTick) {
    written.0 = Some(now.this_run());
}

/// True if a change, an addition or a removal since the last step has to be carried to Rapier.
pub(crate) fn has_changed(
    world: &World,
    written: Res<WrittenBack>,
    now: SystemChangeTick,
    mut watches: Local<Watches>,
    mut removed: Removals,
    mut removed_since: Local<Option<Tick>>,
) -> bool {
    if removed.any() {
        *removed_since = written.0; // It is asked while paused, too, and must remember.
    }
    let Some(since) = written.0 else {
        return true;
    };
    *removed_since == Some(since) || watches.see_a_change(world, since, now.this_run())
}

/// Changes of the components that the plugin carries to Rapier.
pub(crate) struct Watches(Vec<Watch>);

/// True if one of its components has changed after the first of these moments.
type Watch = Box<dyn FnMut(&World, Tick, Tick) -> bool + Send + Sync>;

impl FromWorld for Watches {
    fn from_world(world: &mut World) -> Self {
        let mut watches = Self(Vec::new());
        watches
            .watch::<Changed<Transform>>(world)
            .watch::<(Changed<GlobalTransform>, With<ChildOf>)>(world)
            .watch::<Changed<Velocity>>(world)
            .watch::<Changed<Sleeping>>(world)
            .watch::<Changed<RigidBody>>(world)
            .watch::<Changed<RigidBodyDisabled>>(world)
            .watch::<Changed<GravityScale>>(world)
            .watch::<Changed<Damping>>(world)
            .watch::<Changed<Ccd>>(world)
            .watch::<Changed<SoftCcd>>(world)
            .watch::<ChangedExtra>(world)
            .watch::<Changed<Collider>>(world)
            .watch::<Changed<ColliderMassProperties>>(world)
            .watch::<Changed<ColliderScale>>(world)
            .watch::<Changed<Friction>>(world)
            .watch::<Changed<Restitution>>(world)
            .watch::<Changed<ImpulseJoint>>(world)
            .watch::<Changed<MultibodyJoint>>(world);
        watches
    }
}

impl Watches {
    fn watch<F: QueryFilter + 'static>(&mut self, world: &mut World) -> &mut Self {
        let mut changed = world.query_filtered::<(), F>();
        self.0.push(Box::new(move |world: &World, since, now| {
            changed.update_archetypes(world);
            !changed.is_empty(world, since, now)
        }));
        self
    }

    fn see_a_change(&mut self, world: &World, since: Tick, now: Tick) -> bool {
        self.0.iter_mut().any(|watch| watch(world, since, now))
    }
}

/// Removed components, which Rapier has to forget.
#[derive(SystemParam)]
pub(crate) struct Removals<'w, 's> {
    body_handles: RemovedComponents<'w, 's, RapierRigidBodyHandle>,
    collider_handles: RemovedComponents<'w, 's, RapierColliderHandle>,
    impulse_joint_handles: RemovedComponents<'w, 's, RapierImpulseJointHandle>,
    multibody_joint_handles: RemovedComponents<'w, 's, RapierMultibodyJointHandle>,
    bodies: RemovedComponents<'w, 's, RigidBody>,
    colliders: RemovedComponents<'w, 's, Collider>,
    impulse_joints: RemovedComponents<'w, 's, ImpulseJoint>,
    multibody_joints: RemovedComponents<'w, 's, MultibodyJoint>,
    disabled_bodies: RemovedComponents<'w, 's, RigidBodyDisabled>,
    disabled_colliders: RemovedComponents<'w, 's, ColliderDisabled>,
    sensors: RemovedComponents<'w, 's, Sensor>,
}

impl Removals<'_, '_> {
    /// True if any was removed since the last call.
    pub fn any(&mut self) -> bool {
        let removed = [
            self.body_handles.read().count(),
            self.collider_handles.read().count(),
            self.impulse_joint_handles.read().count(),
            self.multibody_joint_handles.read().count(),
            self.bodies.read().count(),
            self.colliders.read().count(),
            self.impulse_joints.read().count(),
            self.multibody_joints.read().count(),
            self.disabled_bodies.read().count(),
            self.disabled_colliders.read().count(),
            self.sensors.read().count(),
        ];
        removed.iter().any(|&removed| removed > 0)
    }
}
