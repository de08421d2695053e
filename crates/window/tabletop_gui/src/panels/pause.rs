//! The pause overlay, which covers view, panels and bar (report section 2.4); with the Timeline open, the view alone; an open
//! recording is not covered at all. Foreground windows stay in front of it.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use tabletop_core::{Paused, Timeline, TimelineStage};
use tabletop_input::ContextMenu;
use tabletop_user::{Action, Keymap};

use crate::panels::{Panel, Panels};

/// Size of the text in points.
const TEXT_SIZE: f32 = 36.0;

/// Everything below the overlay keeps a third of its display values. The graphics card blends linear values, of which that
/// is about a third to the power of 2.2.
const DIMMING: egui::Color32 = egui::Color32::from_black_alpha(232);

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(
        EguiPrimaryContextPass,
        show_overlay
            .run_if(not(Paused::is_running))
            .run_if(not(shows_recording))
            .run_if(ContextMenu::is_closed),
    );
}

/// An open recording mostly stands still, to be looked at.
fn shows_recording(timeline: Res<Timeline>) -> bool {
    timeline.stage == TimelineStage::Open
}

fn show_overlay(mut contexts: EguiContexts, panels: Res<Panels>, keymap: Res<Keymap>) {
    if let Ok(context) = contexts.ctx_mut() {
        show(context, &panels, &text(&keymap));
    }
}

fn show(context: &egui::Context, panels: &Panels, text: &str) {
    let screen = context.viewport_rect();
    // The buttons of the timeline step through a pause.
    let order = match panels.is_open(Panel::Timeline) {
        true => egui::Order::Background,
        false => egui::Order::Middle,
    };
    let id = egui::Id::new("pause");
    context.move_to_top(egui::LayerId::new(order, id));
    egui::Area::new(id)
        .order(order)
        .fixed_pos(screen.min)
        .fade_in(false)
        .show(context, |ui| {
            let overlay = ui.allocate_rect(screen, egui::Sense::click());
            overlay.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::Other, true, "Simulation Paused")
            });
            let painter = ui.painter();
            painter.rect_filled(screen, 0.0, DIMMING);
            let text = painter.layout_job(centered(text.to_owned(), screen.width()));
            let top_center = screen.center() - egui::vec2(0.0, text.size().y / 2.0);
            painter.galley(top_center, text, egui::Color32::WHITE);
        });
}

fn text(keymap: &Keymap) -> String {
    let [pause, quit] = [Action::Pause, Action::Quit].map(|action| keymap.hint(action));
    let (pause, quit) = (pause.to_uppercase(), quit.to_uppercase());
    format!("Simulation Paused\n\nPress {pause} to resume\nPress {quit} to quit")
}

fn centered(text: String, width: f32) -> egui::text::LayoutJob {
    let font = egui::FontId::proportional(TEXT_SIZE);
    egui::text::LayoutJob {
        halign: egui::Align::Center,
        ..egui::text::LayoutJob::simple(text, font, egui::Color32::WHITE, width)
    }
}

#[cfg(test)]
mod tests {
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;

    #[test]
    fn the_text_names_the_keys() {
        let reported = "Simulation Paused\n\nPress SPACE to resume\nPress ESC to quit";
        assert_eq!(text(&Keymap::default()), reported);
    }

    /// Number of clicks that a button in a panel of this order receives while the simulation is paused.
    fn clicks_through(order: egui::Order, panels: Panels) -> u32 {
        let frame = move |ui: &mut egui::Ui, clicks: &mut u32| {
            let panel = egui::Area::new(egui::Id::new("panel")).order(order);
            panel.show(ui.ctx(), |ui| {
                *clicks += u32::from(ui.button("press me").clicked());
            });
            show(ui.ctx(), &panels, "Simulation Paused");
        };
        let mut harness = Harness::new_ui_state(frame, 0);
        for _ in 0..2 {
            harness.get_by_label("press me").click();
            harness.run();
        }
        *harness.state()
    }

    #[test]
    fn the_overlay_covers_panels_but_not_the_foreground() {
        assert_eq!(clicks_through(egui::Order::Middle, Panels::default()), 0);
        assert_eq!(
            clicks_through(egui::Order::Foreground, Panels::default()),
            2
        );
    }

    #[test]
    fn panels_can_be_used_with_the_timeline() {
        let mut panels = Panels::default();
        panels.set_open(Panel::Timeline, true);
        assert_eq!(clicks_through(egui::Order::Middle, panels), 2);
    }
}
