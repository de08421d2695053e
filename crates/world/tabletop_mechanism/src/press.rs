//! Pressing of controls: by touch of the robot's fingers and held objects, and by the force of objects that fall or lean on them.

use bevy::prelude::*;
use tabletop_core::{
    Control, ControlKind, Held, ObjectIndex, ObjectSpec, Operator, Paused, Robot, RobotLayout,
    Shape, TICK_SECONDS,
};
use tabletop_geometry::{Pose, Solid, UNITS_PER_METER};
use tabletop_physics::{Pressure, is_touching, pressures_on};

use crate::{limb::limb_of, network::Network, obey::trigger};

/// Largest distance, in units, of a touch: the robot's arms stop a millimetre before things that they cannot push away.
const TOUCH: f32 = 0.03;

/// Distance, in units, beyond which an object has let go of the control it pressed: it may rock and bounce until it lies still.
const LET_GO: f32 = 0.2;

/// Least pressing force, in newtons: the weight of 50 g. Hands and arms are as strong as necessary, so their touch presses immovable
/// controls.
const LEAST_FORCE: f32 = 0.5;

/// Marks an object with switches, or shapes that lead to other states.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pressable;

/// The presses at present. A control is triggered when it is pressed, and not again until it is let go of.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pressed(Vec<Press>);

/// A press on a control's part that leads to another state.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Press {
    by: Operator,
    control: String,
    next: u32,
}

/// Run condition: something may press a control.
pub(crate) fn is_possible(pressables: Query<(), With<Pressable>>, pressed: Res<Pressed>) -> bool {
    !pressables.is_empty() || !pressed.0.is_empty()
}

/// True for objects with a part that can be pressed.
pub(crate) fn is_pressable(spec: &ObjectSpec) -> bool {
    let mut controls = spec.controls().into_iter();
    controls.any(|control| feels_touch(control.what))
}

/// True for controls that hands and arms operate by touch.
const fn feels_touch(control: &Control) -> bool {
    match control.kind {
        ControlKind::ToggleSwitch(_) | ControlKind::Custom(_) => true,
        ControlKind::PushButton(_) | ControlKind::IndicatorLights(_) => false,
    }
}

/// Triggers newly pressed controls.
pub(crate) fn press(world: &mut World) {
    if world.resource::<Paused>().0 {
        return;
    }
    let objects = world.resource::<ObjectIndex>().iter();
    let pressables: Vec<_> = objects
        .filter(|&object| world.get::<Pressable>(object).is_some())
        .collect();
    let mut presses = presses_of_robot(world);
    presses.extend(presses_of_held(world, &pressables));
    presses.extend(presses_of_free(world, &pressables));
    let before = world.resource::<Pressed>().0.clone();
    let is_new = |press: &&Press| !before.iter().any(|other| press.is_by_same(other));
    let new: Vec<_> = presses.iter().filter(is_new).cloned().collect();
    for press in &before {
        if !presses.iter().any(|other| press.is_by_same(other)) && lies_there(world, press) {
            presses.push(press.clone());
        }
    }
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

impl Press {
    fn is_by_same(&self, other: &Self) -> bool {
        self.by == other.by && self.control == other.control
    }
}

fn presses_of_robot(world: &World) -> Vec<Press> {
    let layout = world.resource::<RobotLayout>();
    let mut presses = Vec::new();
    for contact in &world.resource::<Robot>().contacts {
        let (Some(limb), Some(spec), Some(place)) = (
            limb_of(layout, &contact.body),
            world.get::<ObjectSpec>(contact.thing),
            world.get::<Transform>(contact.thing),
        ) else {
            continue;
        };
        let force = contact.impulse / (TICK_SECONDS * UNITS_PER_METER as f32);
        if !spec.is_fixed() && force < LEAST_FORCE {
            continue;
        }
        let by = Operator::Limb(limb);
        let point = Pose::from(place).inverse() * contact.point;
        add(&mut presses, &by, spec, feels_touch, |shape, at| {
            has_point(shape, at, point)
        });
    }
    presses
}

/// Held objects press immovable controls by touching them.
fn presses_of_held(world: &mut World, pressables: &[Entity]) -> Vec<Press> {
    let objects: Vec<_> = world.resource::<ObjectIndex>().iter().collect();
    let mut presses = Vec::new();
    for held in objects {
        if world.get::<Held>(held).is_none() {
            continue;
        }
        let Some((spec, place)) = spec_and_pose(world, held) else {
            continue;
        };
        let bounds = spec.shape.bounds(place);
        for &object in pressables.iter().filter(|&&object| object != held) {
            let is_near = world.get::<ObjectSpec>(object).is_some_and(|other| {
                let pose = world.get::<Transform>(object).map(Pose::from);
                let room = other.shape.bounds(pose.unwrap_or_default());
                other.is_fixed() && room.overlaps(bounds, -TOUCH)
            });
            if !is_near {
                continue;
            }
            if let Some((other, pose)) = spec_and_pose(world, object) {
                let by = Operator::Object(spec.id.clone());
                add(&mut presses, &by, &other, feels_touch, |shape, at| {
                    is_touching(world, held, shape, pose * at, TOUCH)
                });
            }
        }
    }
    presses
}

/// Presses by force: of free objects that fall or lean on a control, and of held ones that push a control that can move.
fn presses_of_free(world: &mut World, pressables: &[Entity]) -> Vec<Press> {
    let mut presses = Vec::new();
    for pressures in pressures_on(world, pressables).chunk_by(|a, b| (a.on, a.by) == (b.on, b.by)) {
        let Some(&Pressure { on, by, .. }) = pressures.first() else {
            continue;
        };
        let force: f32 = pressures.iter().map(|pressure| pressure.force).sum();
        let (true, Some(presser), Some((spec, pose))) = (
            force >= LEAST_FORCE,
            world.get::<ObjectSpec>(by),
            spec_and_pose(world, on),
        ) else {
            continue;
        };
        let is_held = world.get::<Held>(by).is_some();
        let feels = |control: &Control| match control.kind {
            ControlKind::ToggleSwitch(_) => true,
            // An object that only stands on its shapes does not press it.
            ControlKind::Custom(_) => is_held,
            ControlKind::PushButton(_) | ControlKind::IndicatorLights(_) => false,
        };
        let by = Operator::Object(presser.id.clone());
        add(&mut presses, &by, &spec, feels, |shape, at| {
            let own = pressures
                .iter()
                .filter(|pressure| has_point(shape, at, pose.inverse() * pressure.point));
            own.map(|pressure| pressure.force).sum::<f32>() >= LEAST_FORCE
        });
    }
    presses
}

/// True if a free object that has pressed a control is still there: it may lie on the side that is raised now.
fn lies_there(world: &mut World, press: &Press) -> bool {
    let Operator::Object(id) = &press.by else {
        return false;
    };
    let index = world.resource::<ObjectIndex>();
    let Some(presser) = index.get(id) else {
        return false;
    };
    if world.get::<Held>(presser).is_some() {
        return false;
    }
    let objects: Vec<_> = index.iter().collect();
    let control = objects.into_iter().find_map(|object| {
        let spec = world.get::<ObjectSpec>(object)?;
        let controls = spec.controls().into_iter();
        let control = controls.map(|control| (control.id == press.control).then_some(control));
        let control = control.flatten().next()?;
        let shape = Shape::Control(control.what.clone());
        let pose = world.get::<Transform>(object).map(Pose::from)?;
        Some((shape, pose * control.pose))
    });
    control.is_some_and(|(shape, at)| is_touching(world, presser, &shape, at, LET_GO))
}

/// True if a point, in the frame of an object, is on the surface of a part of it, given with its pose, or inside.
fn has_point(shape: &Shape, at: Pose, point: Vec3) -> bool {
    let solids = shape.colliding();
    let distance = |solid: &Solid, at: Pose| distance(solid, at.inverse() * point);
    solids
        .iter()
        .any(|solid| distance(&solid.solid, at * solid.pose) < TOUCH)
}

fn spec_and_pose(world: &World, object: Entity) -> Option<(ObjectSpec, Pose)> {
    let spec = world.get::<ObjectSpec>(object)?.clone();
    let pose = world.get::<Transform>(object).map(Pose::from)?;
    Some((spec, pose))
}

/// Adds the controls of an object whose pressed part leads to another state. Buttons follow their caps instead.
fn add(
    presses: &mut Vec<Press>,
    by: &Operator,
    spec: &ObjectSpec,
    feels: impl Fn(&Control) -> bool,
    mut is_pressed: impl FnMut(&Shape, Pose) -> bool,
) {
    for surface in spec.surfaces() {
        let Some((id, number)) = surface.control else {
            continue;
        };
        let next = spec
            .control(id)
            .filter(|&control| feels(control))
            .and_then(|control| control.next_state(Some(number)));
        let Some(next) = next else {
            continue;
        };
        if is_pressed(&surface.part.shape, surface.part.pose) {
            presses.push(Press {
                by: by.clone(),
                control: id.to_owned(),
                next,
            });
        }
    }
}

/// Distance of a point outside a solid, in the frame of the solid.
fn distance(solid: &Solid, point: Vec3) -> f32 {
    match *solid {
        Solid::Cuboid(span) => (point.abs() - span / 2.0).max(Vec3::ZERO).length(),
        Solid::Cylinder { radius, yspan } => {
            let aside = (point.with_y(0.0).length() - radius).max(0.0);
            let along = (point.y.abs() - yspan / 2.0).max(0.0);
            Vec2::new(aside, along).length()
        }
        Solid::Ball(radius) => (point.length() - radius).max(0.0),
        Solid::Polyhedron(ref polyhedron) => polyhedron.distance_to(point),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_to_the_surface() {
        let cuboid = Solid::Cuboid(Vec3::new(2.0, 4.0, 6.0));
        assert_eq!(distance(&cuboid, Vec3::new(4.0, 0.0, 7.0)), 5.0);
        assert_eq!(distance(&cuboid, Vec3::ONE), 0.0);
        let (radius, yspan) = (1.0, 2.0);
        let cylinder = Solid::Cylinder { radius, yspan };
        assert_eq!(distance(&cylinder, Vec3::new(4.0, 5.0, 0.0)), 5.0);
        assert_eq!(distance(&Solid::Ball(1.0), Vec3::X * 3.0), 2.0);
    }
}
