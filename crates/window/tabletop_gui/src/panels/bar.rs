//! The bar at the bottom of the window, which shows, aligns and hides the panels (report figure 4).

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Button, Context, RichText, Ui},
};

use tabletop_user::{Action, Keymap, Notices};

use crate::{
    display::DisplayOffer,
    panels::{
        arrangement::{PanelAlignment, Panels},
        display::DisplayOverlay,
        help::Help,
        panel::Panel,
    },
    scale::{ScaleStep, UiScale},
    theme::Theme,
    widgets::{
        icon::{Icon, icon_button},
        style::ThemeColors,
    },
};

/// Between two buttons, in points: less than elsewhere, so that all of them are in a row of 1024 points.
const GAP: f32 = 4.0;

/// In a narrower window, the gap and the room beside the words of a button, in points, which suffice down to 900 points.
const NARROW: f32 = 1024.0;
const NARROW_GAP: f32 = 2.0;
const NARROW_PADDING: f32 = 4.0;

/// Size of the buttons with pictures, in points.
const ICON_SIZE: egui::Vec2 = egui::vec2(27.0, 23.0);

/// The buttons that align the windows.
const ALIGNMENTS: [(Icon, &str, PanelAlignment); 2] = [
    (
        Icon::AlignLeft,
        "Align the open windows at the left",
        PanelAlignment::Left,
    ),
    (
        Icon::AlignSides,
        "Align the open windows at both sides",
        PanelAlignment::Sides,
    ),
];

/// The content of the bar.
struct Model<'a> {
    panels: &'a Panels,
    /// The number of faults that the user has not seen yet.
    unseen_faults: usize,
    /// The scale at which everything is drawn.
    scale: f32,
    keymap: &'a Keymap,
    theme: Theme,
    /// True if the display has settings.
    has_display: bool,
}

/// A wish of the user to the bar.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Request {
    ShowAll,
    Show(Panel),
    Align(PanelAlignment),
    HideAll,
    Scale(ScaleStep),
    Theme(Theme),
    Display,
    Help,
}

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, show_bar);
}

fn id() -> egui::Id {
    egui::Id::new("bar")
}

/// Upper edge of the bar, in points from the top of the window.
pub(crate) fn top(context: &Context) -> f32 {
    let bar = context.memory(|memory| memory.area_rect(id()));
    bar.map_or_else(|| context.viewport_rect().bottom(), |bar| bar.top())
}

fn show_bar(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    notices: Res<Notices>,
    keymap: Res<Keymap>,
    mut scale: ResMut<UiScale>,
    mut theme: ResMut<Theme>,
    offer: Option<Res<DisplayOffer>>,
    mut display: ResMut<DisplayOverlay>,
    mut help: ResMut<Help>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let model = Model {
        panels: &panels,
        unseen_faults: notices.unseen_faults().count(),
        scale: context.zoom_factor(),
        keymap: &keymap,
        theme: *theme,
        has_display: offer.is_some(),
    };
    if let Some(request) = show(context, &model) {
        carry_out(
            request,
            context,
            &mut panels,
            &mut scale,
            &mut theme,
            &mut display,
            &mut help,
        );
    }
}

fn carry_out(
    request: Request,
    context: &Context,
    panels: &mut Panels,
    scale: &mut UiScale,
    theme: &mut Theme,
    display: &mut DisplayOverlay,
    help: &mut Help,
) {
    match request {
        Request::ShowAll => panels.set_all_open(true),
        Request::Show(panel) => {
            panels.set_open(panel, true);
            panel.point_out(context);
        }
        Request::Align(alignment) => panels.align(alignment),
        Request::HideAll => panels.set_all_open(false),
        Request::Scale(step) => scale.change(step, context.zoom_factor()),
        Request::Theme(wished) => *theme = wished,
        Request::Display => display.open(),
        Request::Help => help.toggle(),
    }
}

fn show(context: &Context, model: &Model) -> Option<Request> {
    let width = context.viewport_rect().width();
    let area = egui::Area::new(id())
        .anchor(egui::Align2::LEFT_BOTTOM, egui::Vec2::ZERO)
        .fade_in(false);
    area.show(context, |ui| {
        let frame = egui::Frame::side_top_panel(ui.style());
        let shown = frame.show(ui, |ui| {
            ui.set_width(width - frame.total_margin().sum().x);
            ui.spacing_mut().item_spacing.x = GAP;
            if width < NARROW {
                ui.spacing_mut().item_spacing.x = NARROW_GAP;
                ui.spacing_mut().button_padding.x = NARROW_PADDING;
            }
            ui.horizontal_wrapped(|ui| buttons(ui, model)).inner
        });
        shown.inner
    })
    .inner
}

fn buttons(ui: &mut Ui, model: &Model) -> Option<Request> {
    let mut request = None;
    let mut when = |is_clicked: bool, what: Request| {
        if is_clicked {
            request = Some(what);
        }
    };
    when(
        picture(ui, Icon::List, "Show all windows"),
        Request::ShowAll,
    );
    for panel in Panel::ALL {
        when(panel_button(ui, panel, model), Request::Show(panel));
    }
    for (icon, name, alignment) in ALIGNMENTS {
        when(picture(ui, icon, name), Request::Align(alignment));
    }
    when(
        picture(ui, Icon::Cross, "Hide all windows"),
        Request::HideAll,
    );
    ui.separator();
    let percent = format!("{:.0} %", 100.0 * model.scale);
    let mut button = |text: &str, action, name, what| {
        let tooltip = model.keymap.tooltip(action);
        let button = ui.button(text).on_hover_text(tooltip);
        button.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, name));
        when(button.clicked(), what);
    };
    for (text, action, step) in [
        ("−", Action::DrawSmaller, ScaleStep::Smaller),
        (&*percent, Action::DrawToFit, ScaleStep::Automatic),
        ("+", Action::DrawLarger, ScaleStep::Larger),
    ] {
        button(text, action, step.name(), Request::Scale(step));
    }
    button("?", Action::ShowHelp, "Help", Request::Help);
    let other = model.theme.other();
    let colours = format!(
        "Show the windows in {} colours",
        other.label().to_lowercase()
    );
    let icon = match other {
        Theme::Light => Icon::Sun,
        Theme::Dark => Icon::Moon,
    };
    let theme = named_picture(ui, icon, other.label(), &colours);
    when(theme, Request::Theme(other));
    if model.has_display {
        let tooltip = "Display: resolution, full screen, refresh rate, anti-aliasing";
        let display = named_picture(ui, Icon::Screen, "Display", tooltip);
        when(display, Request::Display);
    }
    request
}

fn panel_button(ui: &mut Ui, panel: Panel, model: &Model) -> bool {
    let mut text = RichText::new(panel.label());
    if panel == Panel::Messages && model.unseen_faults > 0 {
        text = RichText::new(format!("{} ({})", panel.label(), model.unseen_faults))
            .color(ThemeColors::of(ui.visuals()).fault);
    }
    let is_open = model.panels.is_open(panel);
    let button = ui.add(Button::new(text).selected(is_open));
    let tooltip = match model.keymap.hint(panel.action()) {
        hint if hint.is_empty() => panel.tooltip().to_owned(),
        hint => format!("{} ({hint})", panel.tooltip()),
    };
    button.on_hover_text(tooltip).clicked()
}

fn picture(ui: &mut Ui, icon: Icon, name: &str) -> bool {
    named_picture(ui, icon, name, name)
}

fn named_picture(ui: &mut Ui, icon: Icon, name: &str, tooltip: &str) -> bool {
    let (_, rect) = ui.allocate_space(ICON_SIZE);
    icon_button(ui, rect, icon, name, tooltip).clicked()
}

#[cfg(test)]
mod tests {
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;
    use crate::panels::test_click::after_click;

    #[derive(Default)]
    struct Stage {
        panels: Panels,
        unseen_faults: usize,
        keymap: Keymap,
        request: Option<Request>,
    }

    fn harness() -> Harness<'static, Stage> {
        let frame = |ui: &mut Ui, stage: &mut Stage| {
            let model = Model {
                panels: &stage.panels,
                unseen_faults: stage.unseen_faults,
                scale: 1.25,
                keymap: &stage.keymap,
                theme: Theme::Dark,
                has_display: true,
            };
            let request = show(ui.ctx(), &model);
            stage.request = request.or(stage.request);
        };
        Harness::builder()
            .with_size(egui::vec2(1024.0, 768.0))
            .build_ui_state(frame, Stage::default())
    }

    fn clicked(name: &str) -> Option<Request> {
        after_click(harness(), name).request
    }

    #[test]
    fn every_panel_has_its_button() {
        for panel in Panel::ALL {
            assert_eq!(clicked(panel.label()), Some(Request::Show(panel)));
        }
    }

    #[test]
    fn every_panel_tells_its_purpose() {
        for panel in Panel::ALL {
            let mut harness = harness();
            harness.get_by_label(panel.label()).hover();
            harness.run_steps(8);
            let reported = harness.query_by_label_contains(panel.tooltip());
            assert!(reported.is_some(), "{panel:?}");
        }
    }

    #[test]
    fn all_are_shown_aligned_and_hidden() {
        for (name, expected) in [
            ("Show all windows", Request::ShowAll),
            (
                "Align the open windows at the left",
                Request::Align(PanelAlignment::Left),
            ),
            (
                "Align the open windows at both sides",
                Request::Align(PanelAlignment::Sides),
            ),
            ("Hide all windows", Request::HideAll),
        ] {
            assert_eq!(clicked(name), Some(expected));
        }
    }

    #[test]
    fn the_scale_is_changed() {
        for step in ScaleStep::ALL {
            assert_eq!(clicked(step.name()), Some(Request::Scale(step)));
        }
    }

    #[test]
    fn a_question_mark_asks_for_help() {
        assert_eq!(clicked("Help"), Some(Request::Help));
    }

    #[test]
    fn the_buttons_stand_in_the_order_of_the_report() {
        let harness = harness();
        let labels = Panel::ALL.map(Panel::label);
        let names = ["Show all windows"]
            .into_iter()
            .chain(labels)
            .chain(["Align the open windows at the left", "Hide all windows"]);
        let lefts: Vec<_> = names
            .map(|name| harness.get_by_label(name).rect().left())
            .collect();
        assert!(lefts.is_sorted(), "{lefts:?}");
    }

    #[test]
    fn all_buttons_are_in_a_row_of_1024_points_and_of_900() {
        for width in [1024.0, 900.0] {
            let mut harness = harness();
            harness.set_size(egui::vec2(width, 600.0));
            harness.state_mut().unseen_faults = 99;
            harness.run();
            let bar = harness.ctx.memory(|memory| memory.area_rect(id())).unwrap();
            assert!(bar.height() < 2.0 * ICON_SIZE.y, "{bar}");
            let last = harness.get_by_label("Display").rect();
            assert!(bar.contains_rect(last), "{last} in {bar}");
        }
    }

    #[test]
    fn faults_that_were_not_seen_are_counted() {
        let mut harness = harness();
        harness.state_mut().unseen_faults = 3;
        harness.run();
        assert!(harness.query_by_label("Messages (3)").is_some());
    }

    #[test]
    fn requests_are_carried_out() {
        let context = Context::default();
        let mut panels = Panels::default();
        let mut scale = UiScale::default();
        let mut theme = Theme::default();
        let mut display = DisplayOverlay::default();
        let mut help = Help::default();
        let mut carried_out = |request| {
            carry_out(
                request,
                &context,
                &mut panels,
                &mut scale,
                &mut theme,
                &mut display,
                &mut help,
            );
            Panel::ALL.map(|panel| panels.is_open(panel))
        };
        let all = [true; Panel::ALL.len()];
        let none = [false; Panel::ALL.len()];
        assert_eq!(carried_out(Request::ShowAll), all);
        assert_eq!(carried_out(Request::Align(PanelAlignment::Left)), all);
        assert_eq!(carried_out(Request::HideAll), none);
        for (i, panel) in Panel::ALL.into_iter().enumerate() {
            let open = carried_out(Request::Show(panel));
            assert!(open[..=i].iter().all(|&is_open| is_open));
            assert!(open[i + 1..].iter().all(|&is_open| !is_open));
        }
        carried_out(Request::Theme(Theme::Light));
        carried_out(Request::Display);
        carried_out(Request::Help);
        assert!(display.is_open() && help.is_open());
        assert_eq!(theme, Theme::Light);
    }

    #[test]
    fn the_other_theme_is_asked_for() {
        assert_eq!(clicked("Light"), Some(Request::Theme(Theme::Light)));
    }

    #[test]
    fn the_display_settings_are_opened() {
        assert_eq!(clicked("Display"), Some(Request::Display));
    }

    #[test]
    fn the_bar_is_as_wide_as_the_window_and_at_its_bottom() {
        let harness = harness();
        let context = &harness.ctx;
        let bar = context.memory(|memory| memory.area_rect(id())).unwrap();
        assert_eq!((bar.left(), bar.right()), (0.0, 1024.0));
        assert_eq!(bar.bottom(), 768.0);
        assert_eq!(top(context), bar.top());
    }
}
