//! What the user must know: the faults of task files, what could not be done, and what the robot has done.

pub(crate) mod robot;

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use tabletop_core::SimFact;

use crate::widgets::clipboard::Clipboard;

/// Older notices are forgotten, so that a script that is refused a million times does not fill the memory.
const MAX_NOTICES: usize = 1000;

/// How the colours tell notices apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Something has happened.
    News,
    /// Somebody warns.
    Warning,
    /// Something is wrong.
    Fault,
}

#[derive(Clone, Debug, PartialEq)]
struct Notice {
    tone: Tone,
    text: String,
}

/// The notices in the order in which they came, until the user closes their window.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Notices {
    notices: Vec<Notice>,
    /// Whether the newest fault has not been shown yet.
    is_unseen: bool,
}

impl Notices {
    /// Adds a notice unless it is there already.
    pub fn add(&mut self, tone: Tone, text: &str) {
        if !self.iter().any(|there| there == text) {
            self.append(tone, text);
        }
    }

    /// Adds a notice after all others, as often as it comes.
    pub fn append(&mut self, tone: Tone, text: &str) {
        if self.notices.len() == MAX_NOTICES {
            self.notices.remove(0);
        }
        let text = text.to_owned();
        self.notices.push(Notice { tone, text });
        self.is_unseen |= tone == Tone::Fault;
    }

    /// Adds a notice after all others, also if it was there already.
    pub fn renew(&mut self, tone: Tone, text: &str) {
        self.notices.retain(|there| there.text != text);
        self.append(tone, text);
    }

    /// The notices, oldest first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> {
        self.notices.iter().map(|notice| notice.text.as_str())
    }

    /// Whether there is nothing to be said.
    pub fn is_empty(&self) -> bool {
        self.notices.is_empty()
    }

    /// All of them, one below the other.
    pub fn text(&self) -> String {
        self.iter().flat_map(|text| [text, "\n"]).collect()
    }

    /// Forgets them all.
    pub fn clear(&mut self) {
        self.notices.clear();
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Notices>()
        .init_resource::<Clipboard>()
        .add_systems(Update, (note_facts, note_clipboard))
        .add_systems(EguiPrimaryContextPass, show_notices);
}

fn note_facts(mut facts: MessageReader<SimFact>, mut notices: ResMut<Notices>) {
    for fact in facts.read() {
        match fact {
            SimFact::TaskLoaded { faults, .. } => {
                faults
                    .iter()
                    .for_each(|fault| notices.add(Tone::Fault, fault));
            }
            SimFact::Refused { reason } | SimFact::RecordingFailed { reason, .. } => {
                notices.add(Tone::Fault, reason);
            }
            _ => {}
        }
    }
}

fn note_clipboard(clipboard: Res<Clipboard>, mut notices: ResMut<Notices>) {
    if let Some(problem) = clipboard.take_problem() {
        notices.add(Tone::Fault, &problem);
    }
}

fn show_notices(
    mut contexts: EguiContexts,
    mut notices: ResMut<Notices>,
    clipboard: Res<Clipboard>,
) {
    if notices.is_empty() {
        return;
    }
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let mut is_open = true;
    egui::Window::new("Messages")
        .open(&mut is_open)
        .default_pos(egui::pos2(340.0, 8.0))
        .default_width(640.0)
        .default_height(160.0)
        .show(context, |ui| {
            if ui.button("Copy").clicked() {
                clipboard.copy(notices.text());
            }
            ui.spacing_mut().scroll = egui::style::ScrollStyle::solid();
            let lines = egui::ScrollArea::vertical().stick_to_bottom(true);
            lines.auto_shrink(false).show(ui, |ui| {
                let mut newest_fault = None;
                for Notice { tone, text } in &notices.notices {
                    let text = egui::RichText::new(text).monospace().color(color(*tone));
                    let label = ui.add(egui::Label::new(text).selectable(true));
                    newest_fault = Some(label)
                        .filter(|_| *tone == Tone::Fault)
                        .or(newest_fault);
                }
                // Of a long fault, what is said first is to be seen.
                if let Some(fault) = newest_fault.filter(|_| notices.is_unseen) {
                    fault.scroll_to_me(Some(egui::Align::TOP));
                }
            });
        });
    if !is_open {
        notices.clear();
    }
    notices.is_unseen = false;
}

const fn color(tone: Tone) -> egui::Color32 {
    match tone {
        Tone::News => egui::Color32::LIGHT_GRAY,
        Tone::Warning => egui::Color32::from_rgb(255, 200, 90),
        Tone::Fault => egui::Color32::from_rgb(255, 130, 120),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::CorePlugin;

    #[test]
    fn facts_become_notices_each_once() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<Notices>()
            .add_systems(Update, note_facts);
        let refused = |reason: &str| SimFact::Refused {
            reason: reason.into(),
        };
        for fact in [
            refused("no such object"),
            SimFact::TaskLoaded {
                path: "a.xml".into(),
                faults: vec!["a.xml:1:2: one".into(), "a.xml:3:4: two".into()],
            },
            refused("no such object"),
            SimFact::ObjectDeleted { id: "x".into() },
        ] {
            app.world_mut().write_message(fact);
            app.update();
        }
        let notices = app.world().resource::<Notices>();
        assert_eq!(
            notices.iter().collect::<Vec<_>>(),
            ["no such object", "a.xml:1:2: one", "a.xml:3:4: two"]
        );
    }

    #[test]
    fn the_oldest_notices_are_forgotten() {
        let mut notices = Notices::default();
        for number in 0..=MAX_NOTICES {
            notices.add(Tone::News, &number.to_string());
        }
        assert_eq!(notices.iter().len(), MAX_NOTICES);
        assert_eq!(notices.iter().next(), Some("1"));
        assert!(notices.text().starts_with("1\n2\n"));
    }
}
