//! The parts of the simulation that a running script reads and writes.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Agent, CommandWriter, PictureDemand, SimBlocked, SimTick};
use tabletop_vision::PerceptionDemand;

use crate::{events::ScriptEvents, sense::Senses, settings::ScriptSettings};

/// The simulation as a running script reads and writes it.
#[derive(SystemParam)]
pub(crate) struct Simulation<'w, 's> {
    pub settings: Res<'w, ScriptSettings>,
    pub tick: Res<'w, SimTick>,
    pub senses: Senses<'w, 's>,
    pub demand: Res<'w, PictureDemand>,
    pub perception: Res<'w, PerceptionDemand>,
    pub agent: ResMut<'w, Agent>,
    pub blocked: ResMut<'w, SimBlocked>,
    pub commands: CommandWriter<'w>,
    pub events: ScriptEvents<'w>,
}
