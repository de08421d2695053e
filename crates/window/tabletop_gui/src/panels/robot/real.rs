//! The real robot: connected to, stopped, let go.

use bevy_egui::egui::{
    Button, CollapsingHeader, Color32, Id, Modal, RichText, Slider, TextEdit, Ui, WidgetType,
};
use tabletop_user::{Connection, ConnectionOrder, DrivingLeave};

use crate::widgets::{button::button, name::name, typed_number::TypedRange};

/// The colour of the button that stops the robot.
const STOP: Color32 = Color32::from_rgb(190, 30, 30);

/// What the user has typed and chosen, and whether he is asked before the robot is driven.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ConnectionDraft {
    address: String,
    leave: DrivingLeave,
    is_asked: bool,
}

/// The connection, and the fields and buttons that change it.
pub(super) fn real_robot(
    ui: &mut Ui,
    connection: &Connection,
    draft: &mut ConnectionDraft,
) -> Option<ConnectionOrder> {
    let is_open = !matches!(connection, Connection::None);
    let section = CollapsingHeader::new("Real robot")
        .open(is_open.then_some(true))
        .show(ui, |ui| match connection {
            Connection::None => choice(ui, draft),
            Connection::Ended(reason) => {
                ui.label(RichText::new(reason).color(ui.visuals().error_fg_color));
                choice(ui, draft)
            }
            Connection::Connecting(address) => {
                ui.horizontal(|ui| {
                    ui.spinner();
                    ui.label(format!("Connecting to {address}"));
                });
                None
            }
            Connection::Following(address) => {
                ui.label(format!("The simulated robot follows {address}."));
                let disconnect = button(ui, true, "Disconnect", "Lets go of it");
                disconnect.clicked().then_some(ConnectionOrder::Stop)
            }
            Connection::Driving(address) => {
                ui.label(format!("Whatever moves the robot moves {address}."));
                let stop = Button::new(RichText::new("Stop").color(Color32::WHITE).strong());
                let stop = stop
                    .fill(STOP)
                    .min_size([ui.available_width(), 32.0].into());
                let stop = ui.add(stop);
                let tooltip =
                    "Brings it to rest, lets it hold its position, and lets go of it (Esc)";
                let stop = stop.on_hover_text(tooltip);
                stop.clicked().then_some(ConnectionOrder::Stop)
            }
        });
    let asked = ask(ui, draft);
    section.body_returned.flatten().or(asked)
}

fn choice(ui: &mut Ui, draft: &mut ConnectionDraft) -> Option<ConnectionOrder> {
    let field = TextEdit::singleline(&mut draft.address).hint_text("baxter:ros://HOST:11311");
    let field = ui.add(field.desired_width(f32::INFINITY));
    name(&field, WidgetType::TextEdit, "Address of the robot");
    let address = draft.address.trim();
    let is_typed = !address.is_empty();
    let (follows, drives) = ui
        .horizontal(|ui| {
            let tooltip = "Looks at it, and sends it nothing: the simulated robot is where it is";
            let follow = button(ui, is_typed, "Follow", tooltip);
            let tooltip =
                "Asks how, and then lets whatever moves the simulated robot move this one";
            let drive = button(ui, is_typed, "Drive…", tooltip);
            (follow.clicked(), drive.clicked())
        })
        .inner;
    draft.is_asked |= drives;
    follows.then(|| ConnectionOrder::Follow {
        address: draft.address.trim().to_owned(),
    })
}

/// Asks before the robot is driven.
fn ask(ui: &Ui, draft: &mut ConnectionDraft) -> Option<ConnectionOrder> {
    if !draft.is_asked {
        return None;
    }
    let address = draft.address.trim().to_owned();
    let leave = &mut draft.leave;
    let modal = Modal::new(Id::new("drive")).show(ui.ctx(), |ui| {
        ui.set_width(380.0);
        ui.heading("Drive a real robot?");
        ui.label(format!(
            "{address} will move. Is somebody at the emergency stop, and nobody within reach? Esc stops it at any time."
        ));
        let title = "Share of the greatest speeds";
        let speeds = 0.05..=1.0;
        let typed = TypedRange(speeds.clone());
        let context = ui.ctx().clone();
        let slider = Slider::new(&mut leave.speed, speeds)
            .text("of the greatest speeds")
            .custom_parser(move |text| typed.take(&context, title, text))
            .update_while_editing(false);
        let slider = ui.add(slider);
        name(&slider, WidgetType::Slider, title);
        ui.checkbox(&mut leave.enable, "Switch its motors on");
        ui.checkbox(&mut leave.calibrate, "Let its grippers find out their range");
        ui.checkbox(&mut leave.moves, "Let it move to angles that are far away");
        ui.horizontal(|ui| {
            let drive = button(ui, true, "Drive", "Connects, and drives it from the first order on");
            let stay = button(ui, true, "Cancel", "Moves nothing (Esc)");
            match (drive.clicked(), stay.clicked()) {
                (true, _) => Some(true),
                (_, true) => Some(false),
                _ => None,
            }
        })
        .inner
    });
    if modal.inner.is_some() || modal.should_close() {
        draft.is_asked = false;
    }
    let leave = draft.leave;
    (modal.inner == Some(true)).then_some(ConnectionOrder::Drive { address, leave })
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui;
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;

    /// The orders after clicks on these, beside this connection.
    fn orders(connection: Connection, clicks: &[&str]) -> Vec<ConnectionOrder> {
        let draft = ConnectionDraft {
            address: " baxter:ws://there:9090 ".into(),
            ..ConnectionDraft::default()
        };
        let frame = move |ui: &mut Ui, (draft, orders): &mut (ConnectionDraft, Vec<_>)| {
            orders.extend(real_robot(ui, &connection, draft));
        };
        let mut harness = Harness::builder()
            .with_size(egui::vec2(500.0, 400.0))
            .build_ui_state(frame, (draft, Vec::new()));
        harness.run_steps(4);
        for click in clicks {
            harness.get_by_label(click).click();
            harness.run_steps(8);
        }
        harness.state().1.clone()
    }

    #[test]
    fn a_robot_is_followed_at_once_and_driven_after_a_question() {
        let address = "baxter:ws://there:9090".to_owned();
        let follow = ConnectionOrder::Follow {
            address: address.clone(),
        };
        assert_eq!(
            orders(Connection::None, &["Real robot", "Follow"]),
            [follow]
        );
        assert_eq!(orders(Connection::None, &["Real robot", "Drive…"]), []);
        let asked = ["Real robot", "Drive…", "Cancel"];
        assert_eq!(orders(Connection::None, &asked), []);
        let drive = ConnectionOrder::Drive {
            address,
            leave: DrivingLeave::default(),
        };
        let asked = ["Real robot", "Drive…", "Drive"];
        assert_eq!(orders(Connection::None, &asked), [drive]);
    }

    #[test]
    fn a_robot_is_let_go() {
        let address = || "baxter:ws://there:9090".to_owned();
        for (connection, label) in [
            (Connection::Driving(address()), "Stop"),
            (Connection::Following(address()), "Disconnect"),
        ] {
            assert_eq!(orders(connection, &[label]), [ConnectionOrder::Stop]);
        }
    }
}
