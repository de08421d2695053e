//! The Messages window: faults of task files, failed commands, and events of the robot and its script.

mod past_deeds;
pub(crate) mod robot;
mod rows;

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Color32, Label, RichText, ScrollArea, TextStyle, Ui},
};
use tabletop_core::{History, HistoryFact, Paused, RecordingFact, SceneFact, SimFact};
use tabletop_input::Clipboard;
use tabletop_user::{Notice, Notices, Tone};

use crate::{
    panels::{Panel, Panels},
    widgets::{
        button::{button, switch},
        style::ThemeColors,
        typed_number::take_refusals,
    },
};
use past_deeds::PastDeeds;
use rows::Rows;

/// Height of the list in points, until the user changes it.
const LIST_HEIGHT: f32 = 180.0;

/// Width of the column of times, in letters.
const TIME_LETTERS: f32 = 9.0;

/// The notices that the list shows.
#[derive(Resource, Clone, Debug)]
pub(crate) struct MessageList {
    /// The listed tones, in order.
    tones: [bool; Tone::ALL.len()],
    /// The notice to be shown at the top of the list.
    sought: Option<u64>,
    rows: Rows,
}

impl Default for MessageList {
    fn default() -> Self {
        Self {
            tones: [true; Tone::ALL.len()],
            sought: None,
            rows: Rows::default(),
        }
    }
}

impl MessageList {
    /// Brings a notice to the top of the list.
    pub fn seek(&mut self, notice: &Notice) {
        self.sought = Some(notice.number);
        self.tones[notice.tone as usize] = true;
    }

    fn shows(&self, notice: &Notice) -> bool {
        self.tones[notice.tone as usize]
    }
}

/// The color of notices of this tone.
pub(crate) const fn color(tone: Tone, colors: &ThemeColors) -> Color32 {
    match tone {
        Tone::Event => colors.text(),
        Tone::Warning => colors.warning,
        Tone::Fault => colors.fault,
    }
}

/// A wish of the user to the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    Copy,
    Clear,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Notices>()
        .init_resource::<History>()
        .init_resource::<PastDeeds>()
        .init_resource::<MessageList>()
        .init_resource::<Clipboard>()
        .add_systems(Update, (note_facts, note_clipboard))
        .add_systems(
            EguiPrimaryContextPass,
            (note_refused_numbers, show_panel).chain(),
        );
}

fn note_facts(
    mut facts: MessageReader<SimFact>,
    history: Res<History>,
    paused: Res<Paused>,
    mut deeds: ResMut<PastDeeds>,
    mut notices: ResMut<Notices>,
) {
    if facts.is_empty() {
        return;
    }
    for fact in facts.read() {
        deeds.follow(fact);
        match fact {
            SimFact::Scene(SceneFact::TaskLoaded { faults, .. }) => {
                faults
                    .iter()
                    .for_each(|fault| notices.add(Tone::Fault, fault));
            }
            // Whoever acts in a pause has only forgotten it.
            SimFact::Refused { reason, .. } if paused.0 => notices.add(Tone::Warning, reason),
            SimFact::Refused { reason, .. }
            | SimFact::Recording(RecordingFact::Failed { reason, .. }) => {
                notices.add(Tone::Fault, reason);
            }
            SimFact::Recording(RecordingFact::Started {
                folder,
                moved_aside: Some(aside),
                ..
            }) => {
                let (folder, aside) = (folder.display(), aside.display());
                let text = format!("{folder}: the earlier recording there is now {aside}");
                notices.add(Tone::Event, &text);
            }
            SimFact::Recording(RecordingFact::Finished { folder, .. }) => {
                let text = format!("the recording is in {}", folder.display());
                notices.append(Tone::Event, &text);
            }
            SimFact::History(HistoryFact::Undone { .. }) => {
                let undone = with_deed("undone", deeds.undone());
                let text = match history.undoable {
                    0 => format!("{undone}; nothing is left to undo"),
                    left => format!("{undone}; {left} more can be undone"),
                };
                notices.append(Tone::Event, &text);
            }
            SimFact::History(HistoryFact::Redone { .. }) => {
                let text = with_deed("brought back", deeds.done());
                notices.append(Tone::Event, &text);
            }
            SimFact::Scene(SceneFact::ObjectCreated { .. } | SceneFact::ObjectDeleted { .. })
            | SimFact::History(HistoryFact::SegmentBegun { .. } | HistoryFact::Kept { .. })
            | SimFact::Mechanism(_)
            | SimFact::Hand(_)
            | SimFact::Recording(RecordingFact::Started { .. })
            | SimFact::Robot(_) => {}
        }
    }
    deeds.forget(&history);
}

/// What has happened to a deed, and the deed if it is known.
fn with_deed(what: &str, deed: Option<String>) -> String {
    deed.map_or_else(|| what.to_owned(), |deed| format!("{what}: {deed}"))
}

fn note_clipboard(clipboard: Res<Clipboard>, mut notices: ResMut<Notices>) {
    if let Some(problem) = clipboard.take_problem() {
        notices.add(Tone::Fault, &problem);
    }
}

fn note_refused_numbers(mut contexts: EguiContexts, mut notices: ResMut<Notices>) {
    let refusals = contexts.ctx_mut().map(|context| take_refusals(context));
    for reason in refusals.unwrap_or_default() {
        notices.add(Tone::Warning, &reason);
    }
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    mut notices: ResMut<Notices>,
    mut list: ResMut<MessageList>,
    clipboard: Res<Clipboard>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let shown = Panel::Messages.show(context, &mut panels, |ui| show(ui, &notices, &mut list));
    let Some(request) = shown else {
        return;
    };
    match request {
        Some(Request::Copy) => clipboard.copy(text(&notices, &list)),
        Some(Request::Clear) => notices.clear(),
        None => {}
    }
    if notices.unseen_faults().next().is_some() {
        notices.see();
    }
}

/// The text of the list, a notice below the other, each with its time.
fn text(notices: &Notices, list: &MessageList) -> String {
    let shown = notices.all().filter(|notice| list.shows(notice));
    shown
        .map(|notice| format!("{} {}\n", notice.time(), notice.text))
        .collect()
}

fn show(ui: &mut Ui, notices: &Notices, list: &mut MessageList) -> Option<Request> {
    let request = ui.horizontal(|ui| tools(ui, notices, list)).inner;
    // The beginning of a long fault is to be visible.
    let newest_fault = notices.unseen_faults().last().map(|fault| fault.number);
    let sought = list.sought.take().or(newest_fault);
    ui.separator();
    let size = egui::vec2(ui.available_width(), LIST_HEIGHT);
    egui::Resize::default()
        .id_salt("messages")
        .default_size(size)
        .min_size(egui::vec2(size.x, 40.0))
        .resizable([false, true])
        .with_stroke(false)
        .show(ui, |ui| rows(ui, notices, list, sought));
    request
}

/// The tools that filter notices and act on them.
fn tools(ui: &mut Ui, notices: &Notices, list: &mut MessageList) -> Option<Request> {
    ui.spacing_mut().item_spacing.x = 4.0;
    for (tone, is_shown) in Tone::ALL.into_iter().zip(&mut list.tones) {
        let text = format!("{} ({})", tone.plural(), notices.count(tone));
        if switch(ui, *is_shown, &text, tone.filter()).clicked() {
            *is_shown = !*is_shown;
        }
    }
    ui.separator();
    let has_some = !notices.is_empty();
    let copy = button(ui, has_some, "Copy", "Copy the list to the clipboard");
    let clear = button(ui, has_some, "Clear", "Forget all messages");
    match (copy.clicked(), clear.clicked()) {
        (true, _) => Some(Request::Copy),
        (false, true) => Some(Request::Clear),
        (false, false) => None,
    }
}

/// The rows that are seen.
fn rows(ui: &mut Ui, notices: &Notices, list: &mut MessageList, sought: Option<u64>) {
    let font = TextStyle::Monospace.resolve(ui.style());
    let (letter, height) = ui.fonts_mut(|fonts| {
        let letter = fonts.glyph_width(&font, '0');
        (letter, fonts.row_height(&font))
    });
    ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
    ui.spacing_mut().interact_size.y = height;
    ui.spacing_mut().scroll = egui::style::ScrollStyle::solid();
    let bar = ui.spacing().scroll.allocated_width();
    let room = ui.available_width() - bar - TIME_LETTERS * letter;
    let columns = (room / letter).floor() as usize;
    let rows = list.rows.of(notices, list.tones, columns);
    let mut scroll = ScrollArea::vertical()
        .auto_shrink(false)
        .stick_to_bottom(true);
    let notice_of = |row: &rows::Row| notices.get(row.notice);
    let is_sought =
        |row: &rows::Row| notice_of(row).is_some_and(|notice| Some(notice.number) == sought);
    if let Some(first) = rows.iter().position(is_sought) {
        scroll = scroll.vertical_scroll_offset(first as f32 * height);
    }
    scroll.show_rows(ui, height, rows.len(), |ui, seen| {
        for row in rows.get(seen).unwrap_or_default() {
            if let Some(notice) = notice_of(row) {
                let color = color(notice.tone, ThemeColors::of(ui.visuals()));
                let text = RichText::new(&notice.text[row.part.clone()]);
                let text = text.font(font.clone()).color(color);
                ui.horizontal(|ui| {
                    let from = ui.cursor().left();
                    if row.part.start == 0 {
                        let time = RichText::new(notice.time()).font(font.clone());
                        ui.add(Label::new(time.weak()).selectable(false));
                    }
                    ui.add_space(from + TIME_LETTERS * letter - ui.cursor().left());
                    ui.add(Label::new(text).extend().selectable(true));
                });
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use bevy::time::TimeUpdateStrategy;
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_core::{CommandId, CorePlugin};
    use tabletop_user::UserPlugin;

    use super::*;

    #[test]
    fn facts_become_notices_each_once() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<Notices>()
            .init_resource::<PastDeeds>()
            .add_systems(Update, note_facts);
        let refused = |reason: &str| SimFact::Refused {
            cause: None,
            reason: reason.into(),
        };
        for fact in [
            refused("no such object"),
            SimFact::Scene(SceneFact::TaskLoaded {
                cause: CommandId(0),
                path: "a.xml".into(),
                faults: vec!["a.xml:1:2: one".into(), "a.xml:3:4: two".into()],
            }),
            refused("no such object"),
            SimFact::Scene(SceneFact::ObjectDeleted {
                cause: None,
                id: "x".into(),
            }),
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
    fn undo_and_redo_say_what_is_undone_and_brought_back() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<Notices>()
            .init_resource::<PastDeeds>()
            .add_systems(Update, note_facts);
        let cause = CommandId(3);
        let deleted = SceneFact::ObjectDeleted {
            cause: Some(cause),
            id: "red".into(),
        };
        for (fact, undoable, redoable) in [
            (HistoryFact::Kept { cause }.into(), 2, 0),
            (SimFact::Scene(deleted), 2, 0),
            (HistoryFact::Undone { cause }.into(), 1, 1),
            (HistoryFact::Redone { cause }.into(), 2, 0),
            (HistoryFact::Undone { cause }.into(), 1, 1),
            (HistoryFact::Undone { cause }.into(), 0, 2),
        ] {
            app.insert_resource(History {
                undoable,
                redoable,
                ..default()
            });
            app.world_mut().write_message::<SimFact>(fact);
            app.update();
        }
        let notices = app.world().resource::<Notices>();
        let expected = [
            "undone: red is removed; 1 more can be undone",
            "brought back: red is removed",
            "undone: red is removed; 1 more can be undone",
            "undone; nothing is left to undo",
        ];
        assert_eq!(notices.iter().collect::<Vec<_>>(), expected);
    }

    #[derive(Default)]
    struct Stage {
        notices: Notices,
        list: MessageList,
        request: Option<Request>,
    }

    fn harness(notices: &[(Tone, &str)]) -> Harness<'static, Stage> {
        let mut stage = Stage::default();
        for (tone, text) in notices {
            stage.notices.append(*tone, text);
        }
        let frame = |ui: &mut Ui, stage: &mut Stage| {
            let request = show(ui, &stage.notices, &mut stage.list);
            stage.request = request.or(stage.request);
        };
        Harness::new_ui_state(frame, stage)
    }

    const THREE: [(Tone, &str); 3] = [
        (Tone::Event, "all is well"),
        (Tone::Warning, "take care"),
        (Tone::Fault, "a.xml:1:2: broken"),
    ];

    #[test]
    fn the_list_is_copied_and_cleared() {
        for (name, expected) in [("Copy", Request::Copy), ("Clear", Request::Clear)] {
            let mut harness = harness(&THREE);
            harness.get_by_label(name).click();
            harness.run();
            assert_eq!(harness.state().request, Some(expected));
        }
    }

    #[test]
    fn nothing_can_be_done_with_no_messages() {
        let mut harness = harness(&[]);
        for name in ["Copy", "Clear"] {
            harness.get_by_label(name).click();
            harness.run();
            assert_eq!(harness.state().request, None);
        }
    }

    #[test]
    fn each_tone_can_be_left_out() {
        for (name, (tone, left_out)) in ["Events (1)", "Warnings (1)", "Faults (1)"]
            .into_iter()
            .zip(THREE)
        {
            let mut harness = harness(&THREE);
            harness.get_by_label(name).click();
            harness.run();
            for (_, text) in THREE {
                let is_shown = harness.query_by_label(text).is_some();
                assert_eq!(is_shown, text != left_out, "{tone:?}: {text}");
            }
            let stage = harness.state();
            let copied = text(&stage.notices, &stage.list);
            assert_eq!(copied.lines().count(), 2);
            assert!(!copied.contains(left_out));
        }
    }

    fn labels(harness: &Harness<Stage>) -> usize {
        harness.query_all_by_label("x").count()
    }

    #[test]
    fn only_rows_that_are_seen_are_laid_out() {
        let many = vec![(Tone::Event, "x"); 1000];
        let harness = harness(&many);
        assert!((5..100).contains(&labels(&harness)), "{}", labels(&harness));
    }

    #[test]
    fn the_newest_or_the_sought_message_is_seen() {
        let texts: Vec<_> = (0..500).map(|number| format!("number {number}.")).collect();
        let notices: Vec<_> = texts.iter().map(|text| (Tone::Event, &**text)).collect();
        let mut harness = harness(&notices);
        assert!(harness.query_by_label("number 499.").is_some());
        assert!(harness.query_by_label("number 7.").is_none());
        let stage = harness.state_mut();
        let seventh = stage.notices.get(7).cloned().unwrap();
        stage.list.tones = [false; 3];
        stage.list.seek(&seventh);
        harness.run();
        assert!(harness.query_by_label("number 7.").is_some());
        assert!(harness.query_by_label("number 499.").is_none());
    }

    #[test]
    fn the_beginning_of_the_newest_unseen_fault_is_seen() {
        let mut notices = vec![(Tone::Event, "x"); 100];
        let long = format!("the beginning\n{}", "at\n".repeat(100));
        notices.push((Tone::Fault, &long));
        let harness = harness(&notices);
        assert!(harness.query_by_label("the beginning").is_some());
    }
}
