//! Pressing of controls by touch: the robot's fingers and held objects press them.

use bevy::prelude::*;
use tabletop_core::{
    Bounds, Hand, Hands, ObjectIndex, ObjectSpec, Operator, Paused, Pose, Robot, RobotLayout, Solid,
};
use tabletop_physics::is_touching;

use crate::{network::Network, obey::trigger};

/// Largest distance, in units, of a touch: the robot's arms stop a millimetre before things that they cannot push away.
const TOUCH: f32 = 0.03;

/// The presses at present. A control is triggered when it is touched, and not again until it is let go of.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pressed(Vec<Press>);

/// A touch of a control's part that leads to another state.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Press {
    by: Operator,
    control: String,
    next: u32,
}

/// Run condition: something may touch a control.
pub(crate) fn is_possible(robot: Res<Robot>, hands: Res<Hands>, pressed: Res<Pressed>) -> bool {
    !robot.contacts.is_empty() || hands.hold_something() || !pressed.0.is_empty()
}

/// Triggers newly touched controls.
pub(crate) fn press(world: &mut World) {
    if world.resource::<Paused>().0 {
        return;
    }
    let mut presses = presses_of_robot(world);
    presses.extend(presses_of_hands(world));
    let before = world.resource::<Pressed>().0.clone();
    let is_new = |press: &&Press| {
        let is_same = |other: &Press| other.by == press.by && other.control == press.control;
        !before.iter().any(is_same)
    };
    let new: Vec<_> = presses.iter().filter(is_new).cloned().collect();
    for Press { by, control, next } in new {
        // Another press of this tick may have changed it.
        let network = Network::of(world);
        if network
            .control(&control)
            .is_ok_and(|control| control.state != next)
        {
            trigger(world, None, by, &control, next);
        }
    }
    if before != presses {
        world.insert_resource(Pressed(presses));
    }
}

fn presses_of_robot(world: &World) -> Vec<Press> {
    let layout = world.resource::<RobotLayout>();
    let limb = |body: &str| {
        let mut limbs = layout.limbs.iter();
        limbs.find(|limb| body.starts_with(limb.name.as_str()))
    };
    let mut presses = Vec::new();
    for contact in &world.resource::<Robot>().contacts {
        let (Some(limb), Some(spec), Some(place)) = (
            limb(&contact.body),
            world.get::<ObjectSpec>(contact.thing),
            world.get::<Transform>(contact.thing),
        ) else {
            continue;
        };
        let by = Operator::Limb(limb.name);
        let point = Pose::from(place).inverse() * contact.point;
        add(&mut presses, &by, spec, |shape, at| {
            let solids = shape.colliding();
            let distance = |solid: Solid, at: Pose| distance(solid, at.inverse() * point);
            solids
                .iter()
                .any(|solid| distance(solid.solid, at * solid.pose) < TOUCH)
        });
    }
    presses
}

fn presses_of_hands(world: &mut World) -> Vec<Press> {
    let hands = world.resource::<Hands>().clone();
    let objects: Vec<_> = world.resource::<ObjectIndex>().iter().collect();
    let mut presses = Vec::new();
    for hand in Hand::ALL {
        let Some(held) = hands.held_by(hand) else {
            continue;
        };
        let Some((spec, place)) = spec_and_pose(world, held) else {
            continue;
        };
        let bounds = Bounds::of_shape(&spec.shape, place);
        for &object in objects.iter().filter(|&&object| object != held) {
            let is_near = world.get::<ObjectSpec>(object).is_some_and(|other| {
                let pose = world.get::<Transform>(object).map(Pose::from);
                let room = Bounds::of_shape(&other.shape, pose.unwrap_or_default());
                !other.controls().is_empty() && room.overlaps(bounds, -TOUCH)
            });
            if !is_near {
                continue;
            }
            if let Some((other, pose)) = spec_and_pose(world, object) {
                let by = Operator::Object(spec.id.clone());
                add(&mut presses, &by, &other, |shape, at| {
                    is_touching(world, held, shape, pose * at, TOUCH)
                });
            }
        }
    }
    presses
}

fn spec_and_pose(world: &World, object: Entity) -> Option<(ObjectSpec, Pose)> {
    let spec = world.get::<ObjectSpec>(object)?.clone();
    let pose = world.get::<Transform>(object).map(Pose::from)?;
    Some((spec, pose))
}

/// Adds the controls of an object whose touched part leads to another state.
fn add(
    presses: &mut Vec<Press>,
    by: &Operator,
    spec: &ObjectSpec,
    mut is_touched: impl FnMut(&tabletop_core::Shape, Pose) -> bool,
) {
    for surface in spec.surfaces() {
        let Some((id, number)) = surface.control else {
            continue;
        };
        let next = spec
            .control(id)
            .and_then(|control| control.next_state(Some(number)));
        let Some(next) = next else {
            continue;
        };
        if is_touched(&surface.part.shape, surface.part.pose) {
            presses.push(Press {
                by: by.clone(),
                control: id.to_owned(),
                next,
            });
        }
    }
}

/// Distance of a point outside a solid, in the frame of the solid.
fn distance(solid: Solid, point: Vec3) -> f32 {
    match solid {
        Solid::Cuboid(span) => (point.abs() - span / 2.0).max(Vec3::ZERO).length(),
        Solid::Cylinder { radius, yspan } => {
            let aside = (point.with_y(0.0).length() - radius).max(0.0);
            let along = (point.y.abs() - yspan / 2.0).max(0.0);
            Vec2::new(aside, along).length()
        }
        Solid::Ball(radius) => (point.length() - radius).max(0.0),
        Solid::Polyhedron(polyhedron) => polyhedron.distance_to(point),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_to_the_surface() {
        let cuboid = Solid::Cuboid(Vec3::new(2.0, 4.0, 6.0));
        assert_eq!(distance(cuboid, Vec3::new(4.0, 0.0, 7.0)), 5.0);
        assert_eq!(distance(cuboid, Vec3::ONE), 0.0);
        let (radius, yspan) = (1.0, 2.0);
        let cylinder = Solid::Cylinder { radius, yspan };
        assert_eq!(distance(cylinder, Vec3::new(4.0, 5.0, 0.0)), 5.0);
        assert_eq!(distance(Solid::Ball(1.0), Vec3::X * 3.0), 2.0);
    }
}
