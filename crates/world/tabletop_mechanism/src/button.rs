//! Push buttons: their states are where their caps are.

use bevy::prelude::*;
use tabletop_core::{
    Joint, JointKind, MechanismFact, ObjectIndex, ObjectSpec, Operator, Paused, PushButton, Robot,
    RobotLayout, Shape, SimFact,
};
use tabletop_geometry::Pose;
use tabletop_physics::{pressures_on, push};

use crate::{limb::limb_of, network::Network};

/// How fast a hand pushes a cap, in units/s: twice as fast as it needs to reach the bottom.
const PUSH: f32 = 75.0;

/// A cap that has come down, or up again.
pub(crate) struct MovedCap {
    cap: Entity,
    control: String,
    is_pressed: bool,
}

/// The caps that have come down or up, in the order of their creation.
pub(crate) fn moved_caps(
    joints: Query<&Joint>,
    objects: Query<(&ObjectSpec, &Transform)>,
    index: Res<ObjectIndex>,
    paused: Res<Paused>,
) -> Vec<MovedCap> {
    if paused.0 {
        return Vec::new();
    }
    let moved = |joint: &Joint| {
        let JointKind::PushButton { .. } = joint.kind else {
            return None;
        };
        let [(_, housing), (spec, cap)] = objects.get_many(joint.objects).ok()?;
        let (state, button) = push_button(spec)?;
        let [first, second] = joint.frames;
        let moved = (Pose::from(housing) * first).inverse() * (Pose::from(cap) * second);
        let was_pressed = state != 0;
        let is_pressed = button.is_pressed_at(-moved.location.x, was_pressed);
        (is_pressed != was_pressed).then(|| MovedCap {
            cap: joint.objects[1],
            control: spec.id.clone(),
            is_pressed,
        })
    };
    let mut moved: Vec<_> = joints.iter().filter_map(moved).collect();
    if moved.len() > 1 {
        moved.sort_by_key(|moved| index.iter().position(|object| object == moved.cap));
    }
    moved
}

fn push_button(spec: &ObjectSpec) -> Option<(u32, &PushButton)> {
    if let Shape::Control(control) = &spec.shape {
        return control.push_button().map(|button| (control.state, button));
    }
    None
}

/// Gives buttons the states in which their caps are.
pub(crate) fn follow_caps(In(moved): In<Vec<MovedCap>>, world: &mut World) {
    for MovedCap {
        cap,
        control,
        is_pressed,
    } in moved
    {
        if is_pressed && let Some(by) = presser(world, cap) {
            let control = control.clone();
            let cause = None;
            world.write_message(SimFact::Mechanism(MechanismFact::Triggered {
                cause,
                by,
                control,
            }));
        }
        let mut network = Network::of(world);
        network.press(&control, is_pressed);
        network.take_effect(world, true);
    }
}

/// Who presses a cap, if it is not a hand that has pushed it: a limb of the robot, or the object that presses hardest.
fn presser(world: &mut World, cap: Entity) -> Option<Operator> {
    let layout = world.resource::<RobotLayout>();
    let contacts = world.resource::<Robot>().contacts.iter();
    let mut limbs = contacts
        .filter(|contact| contact.thing == cap)
        .filter_map(|contact| limb_of(layout, &contact.body));
    if let Some(limb) = limbs.next() {
        return Some(Operator::Limb(limb));
    }
    let pressures = pressures_on(world, &[cap]);
    let hardest = pressures
        .iter()
        .filter(|pressure| pressure.force > 0.0)
        .max_by(|a, b| a.force.total_cmp(&b.force))?;
    let object = world.get::<ObjectSpec>(hardest.by)?;
    Some(Operator::Object(object.id.clone()))
}

/// Pushes the cap of a button down.
pub(crate) fn push_cap(world: &mut World, control: &str) {
    let Some(cap) = world.resource::<ObjectIndex>().get(control) else {
        return;
    };
    let mut joints = world.query::<&Joint>();
    let slides = |joint: &&Joint| {
        matches!(joint.kind, JointKind::PushButton { .. }) && joint.objects[1] == cap
    };
    let Some(joint) = joints.iter(world).find(slides).copied() else {
        return;
    };
    let Some(place) = world.get::<Transform>(cap).map(Pose::from) else {
        return;
    };
    let downwards = (place * joint.frames[1]).rotation * Vec3::NEG_X;
    push(world, cap, downwards * PUSH, Vec3::ZERO);
}
