//! Answers to Rapier's questions about contacts.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::prelude::{BevyPhysicsHooks, ContactModificationContextView};

use crate::{
    encounter::FreeFlights,
    workarounds::{seams::Seams, slip::oppose_slip},
};

/// What the answers depend on.
#[derive(SystemParam)]
pub(crate) struct ContactHooks<'w> {
    seams: Res<'w, Seams>,
    flights: Res<'w, FreeFlights>,
}

impl BevyPhysicsHooks for ContactHooks<'_> {
    fn modify_solver_contacts(&self, contacts: ContactModificationContextView) {
        let contacts = contacts.raw;
        if self.seams.cover(contacts) {
            contacts.solver_contacts.clear();
        } else {
            self.flights.put_where_bodies_touch(contacts);
            oppose_slip(contacts);
        }
    }
}
