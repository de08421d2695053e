//! Slips: friction acts against them.
//!
//! Rapier looks for the impulse that would stop a patch of contacts, and takes as much of it as Coulomb's law allows. A brick is stopped by less
//! impulse along than across, so this one points aside, and a brick that slides aslant drifts. A velocity of the surface makes the impulse that would stop
//! the patch point against its slip.

use bevy::prelude::*;
use bevy_rapier3d::rapier::prelude::{ContactModificationContext, RigidBody};

/// Lets friction act against the slip of two bodies.
pub(crate) fn oppose_slip(contacts: &mut ContactModificationContext) {
    let count = contacts.solver_contacts.len();
    if count == 0 || *contacts.friction == 0.0 {
        return;
    }
    let bodies = [contacts.rigid_body1, contacts.rigid_body2];
    let bodies = bodies.map(|body| contacts.bodies.get(body?));
    if bodies.iter().flatten().any(|body| body.is_kinematic()) {
        return;
    }
    let points = contacts.solver_contacts.iter();
    let points = points.map(|contact| contact.anchor1.midpoint(contact.anchor2));
    let centre = points.sum::<Vec3>() / count as f32;
    let normal = *contacts.normal;
    let [first, second] = bodies.map(|body| {
        let body = body.filter(|body| body.is_dynamic());
        body.map_or(Vec3::ZERO, |body| body.velocity_at_point(centre))
    });
    let slip = (first - second).reject_from_normalized(normal);
    let yielding = bodies.map(|body| body.map_or(Vec3::ZERO, |body| yielding(body, centre, slip)));
    let yielding = (yielding[0] + yielding[1]).reject_from_normalized(normal);
    let along = yielding.dot(slip);
    if along <= 0.0 {
        return;
    }
    let velocity = yielding * (slip.length_squared() / along) - slip;
    for contact in &mut *contacts.solver_contacts {
        contact.tangent_velocity = velocity;
    }
}

/// The change of a body's velocity at a point by an impulse there.
fn yielding(body: &RigidBody, point: Vec3, impulse: Vec3) -> Vec3 {
    if !body.is_dynamic() {
        return Vec3::ZERO;
    }
    let mass = body.mass_properties();
    let arm = point - body.center_of_mass();
    let turn = mass.effective_world_inv_inertia * arm.cross(impulse);
    mass.effective_inv_mass * impulse + turn.cross(arm)
}
