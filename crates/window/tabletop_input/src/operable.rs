//! Choices for the thing under the cursor, besides taking it: trigger, point to, fasten, loosen, cut.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    Bonds, Hand, Hands, Joint, JointKind, MechanismCommand, ObjectIndex, ObjectSpec,
    TouchedSurface, Turn,
};
use tabletop_geometry::Pose;
use tabletop_user::Action;

use crate::pick::Pickable;

/// Something that can be done to an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed {
    /// Operate its control.
    Trigger,
    /// Point to it.
    PointTo,
    /// Fasten it to what it touches.
    Fasten,
    /// Loosen its bond.
    Loosen,
    /// Close the scissors that it is a blade of.
    Cut,
}

impl Deed {
    /// In the order of the context menu.
    pub const ALL: [Self; 5] = [
        Self::Trigger,
        Self::PointTo,
        Self::Fasten,
        Self::Loosen,
        Self::Cut,
    ];

    /// The action of its key.
    pub const fn action(self) -> Action {
        match self {
            Self::Trigger => Action::Trigger,
            Self::PointTo => Action::PointTo,
            Self::Fasten => Action::Fasten,
            Self::Loosen => Action::Loosen,
            Self::Cut => Action::Cut,
        }
    }
}

/// A deed with the command for it, or why it cannot be done.
pub type Choice = (Deed, Result<MechanismCommand, String>);

/// The abilities of the selected hand.
#[derive(SystemParam)]
pub(crate) struct Operable<'w, 's> {
    pickable: Pickable<'w, 's>,
    hands: Res<'w, Hands>,
    bonds: Res<'w, Bonds>,
    index: Res<'w, ObjectIndex>,
    joints: Query<'w, 's, &'static Joint>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
}

impl Operable<'_, '_> {
    /// The choices for the object along a line of sight, with its id; `None` if it is not an object, or another one than the selected
    /// hand holds.
    pub fn choices_along(&self, ray: Ray3d) -> Option<(&str, [Choice; 5])> {
        let object = self.pickable.object_along(ray)?;
        let (spec, place) = self.objects.get(object).ok()?;
        let pose = Pose::from(place);
        let (surface, distance) = spec.touched_along(ray, pose)?;
        let hand = self.hands.selected;
        let is_idle = match self.hands.held_by(hand) {
            None => true,
            Some(held) if held == object => false,
            Some(_) => return None,
        };
        let guest = nearest_guest(spec, pose, ray.get_point(distance));
        let choice = |deed| {
            let command = match deed {
                Deed::Trigger | Deed::PointTo if !is_idle => Err(format!("{hand} holds something")),
                Deed::Trigger => trigger(hand, spec, &surface),
                Deed::PointTo => Ok(MechanismCommand::PointTo {
                    hand,
                    target: surface.pointable.to_owned(),
                }),
                Deed::Fasten => self.turned(hand, &guest, Turn::Tighter),
                Deed::Loosen => self.turned(hand, &guest, Turn::Looser),
                Deed::Cut => self.cut(hand, object),
            };
            (deed, command)
        };
        Some((&spec.id, Deed::ALL.map(choice)))
    }

    /// The command for a deed to the held object or, if nothing is held, to the one along a line of sight.
    pub fn command(&self, deed: Deed, ray: Option<Ray3d>) -> Result<MechanismCommand, String> {
        let hand = self.hands.selected;
        let held = self.hands.held_by(hand);
        match (deed, held.and_then(|held| self.objects.get(held).ok())) {
            (Deed::Fasten, Some((spec, _))) => self.turned(hand, &spec.id, Turn::Tighter),
            (Deed::Loosen, Some((spec, _))) => self.turned(hand, &spec.id, Turn::Looser),
            (Deed::Cut, Some(_)) => self.cut(hand, held.unwrap_or(Entity::PLACEHOLDER)),
            (Deed::Trigger | Deed::PointTo, Some(_)) => Err(format!("{hand} holds something")),
            (deed, None) => {
                let choices = ray.and_then(|ray| self.choices_along(ray));
                let choices = choices.map(|(_, choices)| choices.into_iter());
                choices
                    .into_iter()
                    .flatten()
                    .find(|(other, _)| *other == deed)
                    .map_or_else(
                        || Err("there is no object under the cursor".into()),
                        |(_, command)| command,
                    )
            }
        }
    }

    fn cut(&self, hand: Hand, blade: Entity) -> Result<MechanismCommand, String> {
        let (spec, _) = self
            .objects
            .get(blade)
            .map_err(|_| "there is no such object".to_owned())?;
        let is_blade = |joint: &Joint| {
            matches!(joint.kind, JointKind::Shears { .. }) && joint.objects.contains(&blade)
        };
        match self.joints.iter().any(is_blade) {
            true => Ok(MechanismCommand::Cut {
                hand,
                blade: spec.id.clone(),
            }),
            false => Err(format!("`{}` is no scissors", spec.id)),
        }
    }

    fn turned(&self, hand: Hand, guest: &str, turn: Turn) -> Result<MechanismCommand, String> {
        let objects = self.objects.iter_many(self.index.iter());
        let objects: Vec<_> = objects.map(|(spec, place)| (spec, place.into())).collect();
        self.bonds.turned(&objects, guest, turn)?;
        let guest = guest.to_owned();
        Ok(match turn {
            Turn::Tighter => MechanismCommand::Fasten { hand, guest },
            Turn::Looser => MechanismCommand::Loosen { hand, guest },
        })
    }
}

fn trigger(
    hand: Hand,
    spec: &ObjectSpec,
    surface: &TouchedSurface,
) -> Result<MechanismCommand, String> {
    let (id, part) = surface
        .control
        .ok_or_else(|| format!("`{}` is not a control there", spec.id))?;
    let next = spec
        .control(id)
        .and_then(|control| control.next_state(Some(part)));
    match next {
        Some(_) => Ok(MechanismCommand::Trigger {
            hand,
            control: id.to_owned(),
            part: Some(part),
        }),
        None => Err(format!("`{id}` has no other state from there")),
    }
}

/// The guest point of an object that is nearest to a point; the object itself if it has none.
fn nearest_guest(spec: &ObjectSpec, pose: Pose, point: Vec3) -> String {
    let distance = |place: Pose| (pose * place.location).distance(point);
    let guests = spec.guest_points().into_iter();
    guests
        .map(|(guest, _)| (distance(guest.pose), guest.id))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or_else(|| spec.id.clone(), |(_, id)| id.to_owned())
}
