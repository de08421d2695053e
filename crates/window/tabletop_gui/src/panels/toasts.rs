//! New notices, for some seconds, in the upper right corner of the window, below the hints.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{
        self, Align2, Area, Context, Frame, Id, Label, Order, Rect, Response, Sense, TextFormat,
        TextStyle, Ui, WidgetInfo, WidgetType, text::LayoutJob, vec2,
    },
};
use tabletop_user::{Notice, Notices, Tone};

use crate::{
    panels::{
        Panel, Panels, hints,
        messages::{MessageList, color},
    },
    widgets::style::{GAP, MARGIN, ThemeColors},
};

/// The most that are shown. The newest ones count.
const MOST: usize = 4;

/// Width of their texts, and thickness of the line in their colour, in points.
const WIDTH: f32 = 300.0;
const EDGE: f32 = 3.0;

/// The lines of a notice that are shown.
const LINES: usize = 3;

/// The time for which a notice is shown, in seconds.
const fn seconds(tone: Tone) -> f64 {
    match tone {
        Tone::Event => 4.0,
        Tone::Warning => 7.0,
        Tone::Fault => 10.0,
    }
}

/// The notices that are shown at the moment.
#[derive(Resource, Clone, Debug, Default)]
struct Toasts {
    shown: Vec<Toast>,
    /// The number of the first notice that was not shown yet.
    next: u64,
}

#[derive(Clone, Debug, PartialEq)]
struct Toast {
    notice: Notice,
    /// The time at which it disappears, in seconds.
    until: f64,
}

impl Toasts {
    /// Takes the notices that are new at this time, and drops those that were there long enough.
    fn update(&mut self, notices: &Notices, now: f64) {
        self.shown.retain(|toast| now < toast.until);
        for notice in notices.since(self.next).filter(|new| !new.is_quiet) {
            self.shown.retain(|toast| toast.notice.text != notice.text);
            self.shown.push(Toast {
                notice: notice.clone(),
                until: now + seconds(notice.tone),
            });
        }
        self.next = notices.next();
        let surplus = self.shown.len().saturating_sub(MOST);
        self.shown.drain(..surplus);
    }

    /// Takes away a notice that the user has seen.
    fn dismiss(&mut self, number: u64) -> Option<Notice> {
        let mut shown = self.shown.iter();
        let index = shown.position(|toast| toast.notice.number == number)?;
        Some(self.shown.remove(index).notice)
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Toasts>()
        .add_systems(EguiPrimaryContextPass, show_toasts);
}

fn show_toasts(
    mut contexts: EguiContexts,
    mut toasts: ResMut<Toasts>,
    notices: Res<Notices>,
    mut list: ResMut<MessageList>,
    mut panels: ResMut<Panels>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    toasts.update(&notices, context.input(|input| input.time));
    let clicked = show(context, &toasts);
    if let Some(notice) = clicked.and_then(|number| toasts.dismiss(number)) {
        list.seek(&notice);
        panels.set_open(Panel::Messages, true);
        Panel::Messages.point_out(context);
    }
}

/// Shows the notices, and returns the number of one that is clicked.
fn show(context: &Context, toasts: &Toasts) -> Option<u64> {
    if toasts.shown.is_empty() {
        return None;
    }
    let above = hints::bottom(context).unwrap_or_default();
    Area::new(Id::new("toasts"))
        .order(Order::Foreground)
        .anchor(Align2::RIGHT_TOP, vec2(-GAP, above + GAP))
        .fade_in(false)
        .show(context, |ui| {
            ui.spacing_mut().item_spacing.y = GAP;
            let notices = toasts.shown.iter().map(|toast| &toast.notice);
            let clicked = notices.filter(|notice| show_notice(ui, notice).clicked());
            clicked.last().map(|notice| notice.number)
        })
        .inner
}

fn show_notice(ui: &mut Ui, notice: &Notice) -> Response {
    let color = color(notice.tone, ThemeColors::of(ui.visuals()));
    let frame = Frame::window(ui.style()).inner_margin(MARGIN);
    let shown = frame.show(ui, |ui| {
        ui.set_width(WIDTH);
        let format = TextFormat::simple(TextStyle::Body.resolve(ui.style()), color);
        let mut text = LayoutJob::single_section(notice.text.clone(), format);
        text.wrap.max_rows = LINES;
        ui.add(Label::new(text).wrap().selectable(false));
    });
    let rect = shown.response.rect;
    let edge = Rect::from_min_size(rect.min, vec2(EDGE, rect.height()));
    ui.painter().rect_filled(edge, 0.0, color);
    let id = ui.id().with(notice.number);
    let click = ui.interact(rect, id, Sense::click());
    click.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &notice.text));
    click
        .on_hover_text("Click to see it in Messages")
        .on_hover_cursor(egui::CursorIcon::PointingHand)
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::accesskit::Role;
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;

    fn texts(toasts: &Toasts) -> Vec<&str> {
        let notices = toasts.shown.iter().map(|toast| &toast.notice);
        notices.map(|notice| notice.text.as_str()).collect()
    }

    #[test]
    fn faults_stay_longer_than_remarks() {
        let mut notices = Notices::default();
        let mut toasts = Toasts::default();
        notices.append(Tone::Event, "news");
        notices.append(Tone::Fault, "fault");
        toasts.update(&notices, 100.0);
        assert_eq!(texts(&toasts), ["news", "fault"]);
        toasts.update(&notices, 105.0);
        assert_eq!(texts(&toasts), ["fault"]);
        toasts.update(&notices, 110.5);
        assert_eq!(texts(&toasts), [""; 0]);
    }

    #[test]
    fn only_the_newest_are_shown_and_none_twice() {
        let mut notices = Notices::default();
        let mut toasts = Toasts::default();
        for text in ["0", "1", "2", "3", "4", "5", "5"] {
            notices.append(Tone::Event, text);
        }
        toasts.update(&notices, 0.0);
        assert_eq!(texts(&toasts), ["2", "3", "4", "5"]);
        toasts.update(&notices, 1.0);
        assert_eq!(texts(&toasts), ["2", "3", "4", "5"]);
    }

    #[test]
    fn a_notice_that_is_clicked_is_reported() {
        let mut notices = Notices::default();
        notices.append(Tone::Event, "first");
        notices.append(Tone::Fault, "second");
        let mut toasts = Toasts::default();
        toasts.update(&notices, 0.0);
        let frame = move |ui: &mut Ui, clicked: &mut Option<u64>| {
            *clicked = show(ui.ctx(), &toasts).or(*clicked);
        };
        let mut harness = Harness::new_ui_state(frame, None);
        harness
            .get_by_role_and_label(Role::Button, "second")
            .click();
        harness.run();
        assert_eq!(*harness.state(), Some(1));
    }

    #[test]
    fn notices_are_in_the_upper_right_corner_one_below_the_other() {
        let mut notices = Notices::default();
        for text in ["first", "second"] {
            notices.append(Tone::Event, text);
        }
        let mut toasts = Toasts::default();
        toasts.update(&notices, 0.0);
        let frame = move |ui: &mut Ui| {
            show(ui.ctx(), &toasts);
        };
        let harness = Harness::builder()
            .with_size(vec2(800.0, 600.0))
            .build_ui(frame);
        let first = harness.get_by_role_and_label(Role::Button, "first").rect();
        let second = harness.get_by_role_and_label(Role::Button, "second").rect();
        assert_eq!((first.right(), first.top()), (800.0 - GAP, GAP));
        assert!(second.top() > first.bottom());
    }

    #[test]
    fn a_notice_that_was_seen_goes_away() {
        let mut notices = Notices::default();
        notices.append(Tone::Fault, "wrong");
        notices.append(Tone::Fault, "bad");
        let mut toasts = Toasts::default();
        toasts.update(&notices, 0.0);
        let seen = toasts.dismiss(0).unwrap();
        assert_eq!(seen.text, "wrong");
        toasts.update(&notices, 1.0);
        assert_eq!(texts(&toasts), ["bad"]);
        assert_eq!(toasts.dismiss(0), None);
    }

    #[test]
    fn printed_lines_are_only_listed() {
        let mut notices = Notices::default();
        notices.log(Tone::Event, "printed");
        let mut toasts = Toasts::default();
        toasts.update(&notices, 0.0);
        assert_eq!(texts(&toasts), [""; 0]);
        assert_eq!(notices.iter().len(), 1);
    }
}
