//! Free objects that an arm touches, as the arm's own dynamics needs them.
//!
//! For physics, the robot's bodies go where they are sent through any obstacle, and pushed objects get their speed at once. So the
//! effort of a push must be known before the arm moves, not after.

use bevy::{math::DAffine3, prelude::*};
use bevy_rapier3d::{
    parry::bounding_volume::BoundingVolume, plugin::RapierContextMut, rapier::prelude as rapier,
};
use tabletop_core::{LimbId, TICK_SECONDS};
use tabletop_geometry::UNITS_PER_METER;
use tabletop_physics::{FreeObject, impulse_share, limits::TOUCHING};

use tabletop_robot::{FRICTION, JointAxis, TreePosition, in_meters};

use crate::{
    dynamics::impulse::ContactLoad, dynamics::impulse::FrictionAxis, dynamics::matrix::Joints,
    dynamics::matrix::each, motion::tick_motion::TickMotion,
};

/// Cosine of the largest angle to a direction at which something fixed is straight ahead.
const AHEAD: f32 = 0.7;

/// The things that an arm touches or is about to be touched by, each once, where it is nearest. `gravity` in units/s²; `is_mine` is true for
/// the robot's bodies and held objects.
pub(crate) fn contact_loads(
    motion: &mut TickMotion,
    limb: LimbId,
    rapier: &RapierContextMut,
    gravity: f32,
    is_mine: impl Fn(Entity) -> bool,
) -> Vec<(Entity, ContactLoad)> {
    if motion.environment.free.is_empty() || !motion.is_shown {
        return Vec::new();
    }
    let solids = motion.solids(limb);
    motion
        .articulation
        .update(&mut motion.scratch, &motion.positions);
    let axes = motion.articulation.axes(limb, &motion.scratch);
    let to_robot = in_meters(motion.base).inverse();
    let mut touches = Vec::new();
    for thing in &motion.environment.free {
        let Some(body) = body(rapier, thing.object) else {
            continue;
        };
        // An approaching thing is touched on its way.
        let reach = TOUCHING + body.linvel().length() * TICK_SECONDS;
        let bounds = thing.bounds.loosened(reach);
        let near = solids
            .iter()
            .filter(|(_, solid)| solid.bounds().intersects(&bounds));
        let contacts = near.flat_map(|(number, solid)| {
            let solids = thing.solids.iter();
            let contacts = solids.filter_map(|thing| solid.contact(thing, reach));
            contacts.map(move |contact| (*number, contact))
        });
        let Some((number, contact)) = contacts.min_by(|(_, a), (_, b)| a.dist.total_cmp(&b.dist))
        else {
            continue;
        };
        let normal = contact.normal1;
        let speed = body.velocity_at_point(contact.point2).dot(normal);
        if contact.dist > TOUCHING - speed.min(0.0) * TICK_SECONDS {
            continue;
        }
        // A thing that rests on the arm falls towards it; a thing elsewhere stays in place.
        let falls = (Vec3::NEG_Z.dot(normal) * gravity * TICK_SECONDS).min(0.0);
        let carriers = match motion.articulation.bodies[number].place {
            TreePosition::Limb(_, joints) => joints.min(axes.len()),
            TreePosition::Trunk | TreePosition::Head => 0,
        };
        let lever = |direction| lever(&axes, carriers, to_robot, contact.point1, direction);
        let ahead = resistance(rapier, thing, normal, &is_mine);
        let (along, across) = normal.any_orthonormal_pair();
        let slides = [along, across].map(|direction| {
            let speed = body.velocity_at_point(contact.point2).dot(direction);
            let resistance = resistance(rapier, thing, direction, &is_mine);
            FrictionAxis {
                lever: lever(direction),
                speed: f64::from(speed) / UNITS_PER_METER,
                resistance: f64::from(resistance) / UNITS_PER_METER,
            }
        });
        let touch = ContactLoad {
            lever: lever(normal),
            mass: f64::from(body.mass()),
            speed: f64::from(speed + falls) / UNITS_PER_METER,
            resistance: f64::from(ahead) / UNITS_PER_METER,
            friction: friction(rapier, thing),
            slides: slides.into(),
        };
        touches.push((thing.object, touch));
    }
    touches
}

/// Speed of a point along a direction per rad/s (m/s) of each joint, in m. `joints` carry the point.
fn lever(
    axes: &[JointAxis],
    carriers: usize,
    to_robot: DAffine3,
    point: Vec3,
    direction: Vec3,
) -> Joints {
    let point = to_robot.transform_point3(point.as_dvec3() / UNITS_PER_METER);
    let direction = to_robot.transform_vector3(direction.as_dvec3());
    each(axes.len(), |i| match i < carriers {
        true => axes[i].motion_of(point).dot(direction),
        false => 0.0,
    })
}

/// The momentum, in kg units/s, that the thing's other contacts can take from it in a tick if it goes that way: by pushing,
/// and by friction, according to the impulses of the last tick.
fn resistance(
    rapier: &RapierContextMut,
    thing: &FreeObject,
    direction: Vec3,
    is_mine: impl Fn(Entity) -> bool,
) -> f32 {
    let Some(&handle) = rapier.colliders.entity2collider().get(&thing.object) else {
        return 0.0;
    };
    let mut total = 0.0;
    for pair in rapier.simulation.narrow_phase.contact_pairs_with(handle) {
        let (other, sign) = match pair.collider1 == handle {
            true => (pair.collider2, 1.0),
            false => (pair.collider1, -1.0),
        };
        let [Some(own), Some(other)] =
            [handle, other].map(|handle| rapier.colliders.colliders.get(handle))
        else {
            continue;
        };
        let other_body = other.parent().and_then(|body| {
            let entity = rapier.rigidbody_set.rigid_body_entity(body)?;
            Some((entity, rapier.rigidbody_set.bodies.get(body)?))
        });
        let Some((_, other_body)) = other_body.filter(|(entity, _)| !is_mine(*entity)) else {
            continue;
        };
        let friction = own.friction() * other.friction();
        let share = impulse_share(
            pair,
            &rapier.rigidbody_set.bodies,
            &rapier.colliders.colliders,
        );
        for manifold in pair.solver_manifolds() {
            let reported: f32 = manifold.points.iter().map(|point| point.data.impulse).sum();
            let impulse = reported * share;
            let ahead = manifold.data.normal.dot(direction) * sign;
            let touches = manifold.points.iter().any(|point| point.dist < TOUCHING);
            if ahead > AHEAD && touches && other_body.is_fixed() {
                return f32::INFINITY;
            }
            total += impulse * (ahead.max(0.0) + friction * (1.0 - ahead * ahead).max(0.0).sqrt());
        }
    }
    total
}

/// Friction between a thing and the robot.
fn friction(rapier: &RapierContextMut, thing: &FreeObject) -> f64 {
    let collider = rapier.colliders.entity2collider().get(&thing.object);
    let collider = collider.and_then(|handle| rapier.colliders.colliders.get(*handle));
    collider.map_or(0.0, |collider| f64::from(collider.friction() * FRICTION))
}

fn body<'a>(rapier: &'a RapierContextMut, object: Entity) -> Option<&'a rapier::RigidBody> {
    let handle = *rapier.rigidbody_set.entity2body().get(&object)?;
    rapier.rigidbody_set.bodies.get(handle)
}
