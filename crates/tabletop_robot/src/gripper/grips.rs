//! What the grippers hold.

use bevy::prelude::*;
use bevy_rapier3d::prelude::{GravityScale, Velocity};
use tabletop_core::{
    Gripped, Held, Joint, LimbId, LimbName, ObjectSpec, Pose, Robot, RobotLayout, SimFact,
};
use tabletop_physics::{JustReleased, hold, let_go, pull_velocity};

use crate::gripper::closing::Touched;

/// What the grippers hold, and how.
#[derive(Resource, Clone, Debug)]
pub(crate) struct Grips {
    /// The limbs, by [`LimbId`].
    names: Vec<LimbName>,
    held: Vec<Vec<Grip>>,
    /// Objects that a closing gripper could not hold, until it opens.
    pub refused: Vec<Vec<Entity>>,
}

/// An object in a gripper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grip {
    /// The object.
    pub object: Entity,
    /// Its pose in the end effector's frame.
    pub pose: Pose,
    /// Where the left and the right finger touch it, in the end effector's frame.
    pub points: [Vec3; 2],
    /// Whether joints hold it, too: then it is pull_velocity along as far as they let it.
    pub is_jointed: bool,
}

impl Grips {
    /// Empty grippers.
    pub fn none(layout: &RobotLayout) -> Self {
        Self {
            names: layout.limbs.iter().map(|limb| limb.name).collect(),
            held: vec![Vec::new(); layout.limbs.len()],
            refused: vec![Vec::new(); layout.limbs.len()],
        }
    }

    /// The limbs.
    fn limbs(&self) -> impl Iterator<Item = LimbId> + use<> {
        (0..self.held.len() as u8).map(LimbId)
    }

    /// What a gripper holds, in the order in which it took it.
    pub fn of(&self, limb: LimbId) -> &[Grip] {
        &self.held[limb.index()]
    }

    /// What a limb is called.
    pub fn name_of(&self, limb: LimbId) -> LimbName {
        self.names[limb.index()]
    }

    /// Everything that is held.
    pub fn all(&self) -> impl Iterator<Item = Entity> {
        self.held.iter().flatten().map(|grip| grip.object)
    }
}

/// Takes an object into a gripper whose fingers touch it.
pub(crate) fn take(world: &mut World, limb: LimbId, touched: Touched) {
    let object = touched.object;
    let end_effector = world.resource::<Robot>().limb(limb).end_effector;
    let Some(here) = world.get::<Transform>(object).map(Pose::from) else {
        return;
    };
    let Some(id) = id(world, object) else {
        return;
    };
    let is_jointed = world
        .query::<&Joint>()
        .iter(world)
        .any(|joint| joint.objects.contains(&object));
    let mut grips = world.resource_mut::<Grips>();
    let arm = grips.name_of(limb);
    grips.held[limb.index()].push(Grip {
        object,
        pose: end_effector.inverse() * here,
        points: touched.points.map(|point| end_effector.inverse() * point),
        is_jointed,
    });
    let mut body = world.entity_mut(object);
    body.insert(Gripped { by: arm });
    if is_jointed {
        body.insert(GravityScale(0.0));
        body.remove::<JustReleased>();
    } else {
        hold(body);
    }
    world.write_message(SimFact::GripMade { arm, id });
}

/// Lets go of everything that a gripper holds.
pub(crate) fn release(world: &mut World, limb: LimbId) {
    let mut grips = world.resource_mut::<Grips>();
    let arm = grips.name_of(limb);
    let held = std::mem::take(&mut grips.held[limb.index()]);
    for Grip { object, .. } in held {
        let Some(id) = id(world, object) else {
            continue;
        };
        let mut body = world.entity_mut(object);
        body.remove::<Gripped>();
        let_go(body);
        world.write_message(SimFact::GripReleased { arm, id });
    }
}

/// Draws along what joints hold as well.
pub(crate) fn draw_jointed(
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

/// Gives up what a hand has taken out of a gripper.
pub(crate) fn give_to_hands(
    held: Query<&ObjectSpec, (With<Held>, With<Gripped>)>,
    mut grips: ResMut<Grips>,
    mut commands: Commands,
    mut facts: MessageWriter<SimFact>,
) {
    if held.is_empty() {
        return;
    }
    for limb in grips.limbs() {
        let arm = grips.name_of(limb);
        grips.held[limb.index()].retain(|grip| {
            let Ok(spec) = held.get(grip.object) else {
                return true;
            };
            commands.entity(grip.object).remove::<Gripped>();
            facts.write(SimFact::GripReleased {
                arm,
                id: spec.id.clone(),
            });
            false
        });
    }
}

/// A gripper whose object goes without it is empty.
pub(crate) fn note_lost(
    remove: On<Remove, Gripped>,
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
            facts.write(SimFact::GripReleased {
                arm,
                id: spec.id.clone(),
            });
        }
    }
}

/// Whether a gripper can take an object: it has mass, and nothing holds it.
pub(crate) fn can_take(
    object: Entity,
    objects: &Query<(&ObjectSpec, Has<Held>, Has<Gripped>)>,
) -> bool {
    objects
        .get(object)
        .is_ok_and(|(spec, is_held, is_gripped)| !spec.is_fixed() && !is_held && !is_gripped)
}

fn id(world: &World, object: Entity) -> Option<String> {
    Some(world.get::<ObjectSpec>(object)?.id.clone())
}
