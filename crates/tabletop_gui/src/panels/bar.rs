//! The bar at the bottom of the window, which brings the panels back.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

/// Width of every panel in points.
const PANEL_WIDTH: f32 = 320.0;

/// A panel that the user can open and close.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Panel {
    /// Speeds, and what the script does.
    Status,
    /// The robot's joints, and what is known of it.
    Robot,
    /// Hands, rotations and recording.
    DemonstrationTools,
}

impl Panel {
    /// The panels, in the order of their buttons.
    pub const ALL: [Self; 3] = [Self::Status, Self::Robot, Self::DemonstrationTools];

    /// The text of its button.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Status => "Status",
            Self::Robot => "Robot",
            Self::DemonstrationTools => "Demo Tools",
        }
    }

    /// The text of its title bar.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Status => "Status",
            Self::Robot => "Robot",
            Self::DemonstrationTools => "Demonstration Tools",
        }
    }

    /// Where it appears first.
    const fn place(self) -> egui::Pos2 {
        match self {
            Self::Status => egui::pos2(340.0, 176.0),
            Self::Robot => egui::pos2(8.0, 286.0),
            Self::DemonstrationTools => egui::pos2(8.0, 8.0),
        }
    }

    fn id(self) -> egui::Id {
        egui::Id::new(self.title())
    }

    /// Shows the panel unless it is closed.
    pub(crate) fn show(
        self,
        context: &egui::Context,
        panels: &mut Panels,
        content: impl FnOnce(&mut egui::Ui),
    ) {
        let mut is_open = panels.is_open(self);
        let frame = egui::Frame::window(&context.global_style());
        let inner_width = PANEL_WIDTH - frame.total_margin().sum().x;
        egui::Window::new(self.title())
            .id(self.id())
            .open(&mut is_open)
            .frame(frame)
            .resizable(false)
            .default_width(inner_width)
            .collapsible(false)
            .default_pos(self.place())
            .show(context, |ui| {
                ui.set_width(inner_width);
                content(ui);
            });
        if is_open != panels.is_open(self) {
            panels.set_open(self, is_open);
        }
    }
}

/// Which panels are open. At first none is.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Panels {
    open: [bool; Panel::ALL.len()],
}

impl Panels {
    /// Whether a panel is open.
    pub fn is_open(&self, panel: Panel) -> bool {
        self.open[panel as usize]
    }

    /// Opens or closes a panel.
    pub fn set_open(&mut self, panel: Panel, is_open: bool) {
        self.open[panel as usize] = is_open;
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Panels>()
        .add_systems(EguiPrimaryContextPass, show_bar);
}

fn id() -> egui::Id {
    egui::Id::new("bar")
}

/// Upper edge of the bar, in points from the top of the window.
pub(crate) fn top(context: &egui::Context) -> f32 {
    let bar = context.memory(|memory| memory.area_rect(id()));
    bar.map_or_else(|| context.viewport_rect().bottom(), |bar| bar.top())
}

fn show_bar(mut contexts: EguiContexts, mut panels: ResMut<Panels>) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let width = context.viewport_rect().width();
    egui::Area::new(id())
        .anchor(egui::Align2::LEFT_BOTTOM, egui::Vec2::ZERO)
        .show(context, |ui| {
            let frame = egui::Frame::side_top_panel(ui.style());
            frame.show(ui, |ui| {
                ui.set_width(width - frame.total_margin().sum().x);
                ui.horizontal(|ui| {
                    for panel in Panel::ALL {
                        if ui.button(panel.label()).clicked() {
                            panels.set_open(panel, true);
                            bring_to_front(ui.ctx(), panel);
                        }
                    }
                });
            });
        });
}

fn bring_to_front(context: &egui::Context, panel: Panel) {
    context.move_to_top(egui::LayerId::new(egui::Order::Middle, panel.id()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_panel_opens_and_closes_by_itself() {
        let mut panels = Panels::default();
        for panel in Panel::ALL {
            assert!(!panels.is_open(panel));
            panels.set_open(panel, true);
            let open = Panel::ALL.iter().filter(|&&panel| panels.is_open(panel));
            assert_eq!(open.count(), 1);
            panels.set_open(panel, false);
        }
    }
}
