//! Grips: the objects in the grippers.

use std::collections::BTreeSet;

use bevy::prelude::*;
use bevy_rapier3d::prelude::Velocity;
use tabletop_core::{
    Bonds, Held, LimbId, LimbName, Manipulator, MechanismFact, ObjectSpec, Robot, RobotFact,
    RobotLayout, SimFact,
};
use tabletop_geometry::Pose;
use tabletop_physics::{Carry, hold, let_go, pull_velocity};

use crate::gripper::{alignment::Alignment, closing::Touched};

/// The grips of all grippers.
#[derive(Resource, Clone, Debug)]
pub(crate) struct Grips {
    /// The limbs, by [`LimbId`].
    names: Vec<LimbName>,
    held: Vec<Vec<Grip>>,
    /// Objects that a closing gripper could not hold; forgotten when it opens.
    pub refused: Vec<Vec<Entity>>,
    /// The object that each closing gripper turns between its fingers, until it opens.
    pub alignments: Vec<Option<Alignment>>,
}

/// An object in a gripper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grip {
    /// The object.
    pub object: Entity,
    /// Its pose in the end effector's frame.
    pub pose: Pose,
    /// Contact points of the left and the right finger, in the end effector's frame.
    pub points: [Vec3; 2],
    /// True if joints hold it, too. It is then pulled along as far as they allow.
    pub is_jointed: bool,
}

impl Grips {
    /// Empty grippers.
    pub fn none(layout: &RobotLayout) -> Self {
        Self {
            names: layout.limbs.iter().map(|limb| limb.name).collect(),
            held: vec![Vec::new(); layout.limbs.len()],
            refused: vec![Vec::new(); layout.limbs.len()],
            alignments: vec![None; layout.limbs.len()],
        }
    }

    /// The limbs.
    fn limbs(&self) -> impl Iterator<Item = LimbId> + use<> {
        (0..self.held.len() as u8).map(LimbId)
    }

    /// The grips of a gripper, in the order in which they were made.
    pub fn of(&self, limb: LimbId) -> &[Grip] {
        &self.held[limb.index()]
    }

    /// True while a gripper presses on objects that its fingers touch.
    pub fn is_pressing(&self, limb: LimbId) -> bool {
        let refused = &self.refused[limb.index()];
        self.alignments[limb.index()].is_some_and(|turned| !refused.contains(&turned.object))
    }

    /// Name of a limb.
    pub fn name_of(&self, limb: LimbId) -> LimbName {
        self.names[limb.index()]
    }

    /// True if joints hold any of the held objects, too.
    pub fn hold_jointed(&self) -> bool {
        self.held.iter().flatten().any(|grip| grip.is_jointed)
    }

    /// All held objects.
    pub fn all(&self) -> impl Iterator<Item = Entity> {
        self.held.iter().flatten().map(|grip| grip.object)
    }
}

/// Grips an object that the fingers touch.
pub(crate) fn take(world: &mut World, limb: LimbId, touched: Touched) {
    let object = touched.object;
    let end_effector = world.resource::<Robot>().limb(limb).end_effector;
    let Some(here) = world.get::<Transform>(object).map(Pose::from) else {
        return;
    };
    let Some(id) = id(world, object) else {
        return;
    };
    let arm = world.resource::<Grips>().name_of(limb);
    let carry = hold(world, object, Manipulator::Gripper(arm));
    world.resource_mut::<Grips>().held[limb.index()].push(Grip {
        object,
        pose: end_effector.inverse() * here,
        points: touched.points.map(|point| end_effector.inverse() * point),
        is_jointed: carry == Carry::AgainstJoints,
    });
    world.write_message(SimFact::Robot(RobotFact::GripMade { arm, id }));
}

/// Releases every object that a gripper holds.
pub(crate) fn release(world: &mut World, limb: LimbId) {
    let mut grips = world.resource_mut::<Grips>();
    let arm = grips.name_of(limb);
    let held = std::mem::take(&mut grips.held[limb.index()]);
    for Grip { object, .. } in held {
        let Some(id) = id(world, object) else {
            continue;
        };
        let_go(world, object);
        world.write_message(SimFact::Robot(RobotFact::GripReleased { arm, id }));
    }
}

/// Pulls along held objects that joints hold as well.
pub(crate) fn pull_jointed(
    grips: Res<Grips>,
    robot: Res<Robot>,
    mut objects: Query<(&Transform, &mut Velocity)>,
) {
    for limb in grips.limbs() {
        for grip in grips.of(limb).iter().filter(|grip| grip.is_jointed) {
            if let Ok((transform, mut velocity)) = objects.get_mut(grip.object) {
                let target = robot.limb(limb).end_effector * grip.pose;
                *velocity = pull_velocity(Pose::from(transform), target);
            }
        }
    }
}

/// Takes over the new places of objects that a bond has moved, or holds from now on.
pub(crate) fn follow_bonds(
    mut facts: MessageReader<SimFact>,
    robot: Res<Robot>,
    bonds: Res<Bonds>,
    objects: Query<(&ObjectSpec, &Transform, &Carry)>,
    mut grips: ResMut<Grips>,
) {
    let mut moved = BTreeSet::new();
    for fact in facts.read() {
        if let SimFact::Mechanism(
            MechanismFact::Fastened { bond, .. } | MechanismFact::Loosened { bond, .. },
        ) = fact
        {
            moved.extend(bonds.connected(&bond.guest));
        }
    }
    for limb in grips.limbs() {
        for place in 0..grips.of(limb).len() {
            let grip = grips.of(limb)[place];
            let Ok((spec, here, carry)) = objects.get(grip.object) else {
                continue;
            };
            let is_jointed = *carry == Carry::AgainstJoints;
            if is_jointed != grip.is_jointed || moved.contains(&*spec.id) {
                grips.held[limb.index()][place] = Grip {
                    pose: robot.limb(limb).end_effector.inverse() * Pose::from(here),
                    is_jointed,
                    ..grip
                };
            }
        }
    }
}

/// Ends the grip on an object that a hand has taken.
pub(crate) fn give_to_hands(
    taken: Query<(&ObjectSpec, &Held), Changed<Held>>,
    mut grips: ResMut<Grips>,
    mut facts: MessageWriter<SimFact>,
) {
    if taken.is_empty() {
        return;
    }
    for limb in grips.limbs() {
        let arm = grips.name_of(limb);
        grips.held[limb.index()].retain(|grip| match taken.get(grip.object) {
            Ok((spec, held)) if held.by != Manipulator::Gripper(arm) => {
                let id = spec.id.clone();
                facts.write(SimFact::Robot(RobotFact::GripReleased { arm, id }));
                false
            }
            _ => true,
        });
    }
}

/// Ends the grip on an object that is gone.
pub(crate) fn note_lost(
    remove: On<Remove, Held>,
    objects: Query<&ObjectSpec>,
    mut grips: ResMut<Grips>,
    mut facts: MessageWriter<SimFact>,
) {
    for limb in grips.limbs() {
        let arm = grips.name_of(limb);
        let held = &mut grips.held[limb.index()];
        let Some(place) = held.iter().position(|grip| grip.object == remove.entity) else {
            continue;
        };
        held.remove(place);
        if let Ok(spec) = objects.get(remove.entity) {
            facts.write(SimFact::Robot(RobotFact::GripReleased {
                arm,
                id: spec.id.clone(),
            }));
        }
    }
}

/// True if a gripper can take an object: it has mass, and nothing holds it.
pub(crate) fn can_take(object: Entity, objects: &Query<(&ObjectSpec, Has<Held>)>) -> bool {
    objects
        .get(object)
        .is_ok_and(|(spec, is_held)| !spec.is_fixed() && !is_held)
}

fn id(world: &World, object: Entity) -> Option<String> {
    Some(world.get::<ObjectSpec>(object)?.id.clone())
}
