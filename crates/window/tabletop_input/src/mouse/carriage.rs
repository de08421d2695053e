//! The way on which the mouse carries an object.

use bevy::prelude::*;
use tabletop_core::{HandCommand, Hands};
use tabletop_user::{DragPlane, Dragging, Neighborhood};

use crate::{around::Around, drag::Drag};

/// Change of a place, in units, from which on it is another.
const SAME: f32 = 1e-3;

/// A drag, and where it sends the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Carriage {
    pub drag: Drag,
    /// The location that the object was last sent to.
    pub sent: Vec3,
    /// The height, in units, of an object over the highest thing below it in the level plane.
    pub clearance: f32,
    /// True if the object is let go of in the end.
    pub lets_go: bool,
}

impl Carriage {
    /// Begins to carry an object that is held.
    pub fn start(
        object: Entity,
        around: &Around,
        plane: DragPlane,
        ray: Ray3d,
        lets_go: bool,
    ) -> Option<Self> {
        let there = around.of(object)?;
        Some(Self {
            drag: Drag::start(object, there.here, plane.normal(), ray)?,
            sent: there.here,
            clearance: there.clearance(),
            lets_go,
        })
    }

    /// The drag after the object has been sent on towards its goal.
    pub fn sent_on(self, there: &Neighborhood, dragging: &Dragging) -> Self {
        let goal = self.drag.goal;
        let next = match self.drag.is_level() && dragging.goes_on_top {
            true => there.way_to(there.on_top(dragging, goal, self.clearance)),
            false => there.snapped(dragging, goal),
        };
        match next.distance(self.sent) < SAME {
            true => self,
            false => Self { sent: next, ..self },
        }
    }

    /// The command that sends the object where it is to go.
    pub fn command(&self, hands: &Hands) -> HandCommand {
        HandCommand::MoveTo {
            hand: hands.selected,
            location: self.sent,
        }
    }
}
