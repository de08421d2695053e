//! The order in which panels stand, and the time after it changes in which they find their sizes.

use bevy_egui::egui::{Context, Id};

use super::{arrangement::Panels, panel::Panel};

/// The time in which the panels find their sizes, in seconds, and the passes that they need for it, however slow these are.
const SETTLING_SECONDS: f64 = 0.5;
const SETTLING_PASSES: u64 = 8;

/// The order of the panels, and the time and the pass since which it is so.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PanelOrder {
    order: Vec<Panel>,
    since: f64,
    pass: u64,
}

impl PanelOrder {
    /// Notes when panels are opened, closed or aligned.
    pub fn note(context: &Context, panels: &Panels) {
        let order = panels.open_in_order();
        let now = context.input(|input| input.time);
        let pass = context.cumulative_pass_nr();
        context.data_mut(|data| {
            let noted: Option<Self> = data.get_temp(place());
            if noted.is_none_or(|noted| noted.order != order) {
                let since = now;
                data.insert_temp(place(), Self { order, since, pass });
            }
        });
    }

    /// True if the panels have had the time to find their sizes.
    pub fn has_settled(context: &Context) -> bool {
        let noted: Option<Self> = context.data(|data| data.get_temp(place()));
        let now = context.input(|input| input.time);
        let pass = context.cumulative_pass_nr();
        noted.is_some_and(|noted| {
            now > noted.since + SETTLING_SECONDS && pass > noted.pass + SETTLING_PASSES
        })
    }
}

fn place() -> Id {
    Id::new("order of panels")
}
