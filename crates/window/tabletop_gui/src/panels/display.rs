//! The display settings (report 2.3, figure 3).

use bevy::{
    camera::ClearColorConfig,
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    ecs::schedule::ScheduleLabel,
    prelude::*,
};
use bevy_egui::{
    EguiContext, EguiContexts, EguiPrimaryContextPass, EguiSchedule,
    egui::{
        self, Button, CentralPanel, ComboBox, Grid, Key, LayerId, Modal, RichText, Ui, UiBuilder,
        Vec2, vec2,
    },
};
use tabletop_input::TakesKeys;
use tabletop_user::{Notices, Tone};

use crate::{
    Preferences, Renderer,
    display::{CONCERN, DisplayOffer, DisplaySettings},
    widgets::style::dress,
};

/// The title of the settings.
pub const TITLE: &str = "Display Settings for tabletop";

/// The size of each of the buttons below the settings, in points.
const BUTTON: (f32, f32) = (120.0, 28.0);

/// The reason why there is no choice.
const NO_OTHER_SIZE: &str = "The screen has no other";
const NO_OTHER_RATE: &str = "The screen has no other at this resolution";
const NO_OTHER_DEPTH: &str = "The screen has no other at this resolution and refresh rate";
const DEPTH_OF_DESKTOP: &str = "A window has the colours of the desktop";
const NO_ANTIALIASING: &str = "The graphics driver offers none";

/// The choices, and the renderer.
#[derive(Clone, Copy, Debug)]
struct Model<'a> {
    offer: &'a DisplayOffer,
    renderer: &'a Renderer,
}

/// The user's decision. Over the main window, to cancel means to leave it as it is.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayRequest {
    /// To start with these settings.
    Continue,
    /// Not to start at all.
    Cancel,
}

/// A window that shows nothing but the settings, as a camera without a scene. The user's choice is the resource [`DisplaySettings`],
/// his decision a [`DisplayRequest`].
#[derive(Component, Clone, Copy, Debug, Default)]
#[require(
    Camera3d,
    Camera = Camera { clear_color: ClearColorConfig::Custom(Color::BLACK), ..default() },
    Msaa = Msaa::Off,
    Tonemapping = Tonemapping::None,
    DebandDither = DebandDither::Disabled,
    EguiContext,
    TakesKeys,
    EguiSchedule = EguiSchedule::new(DisplayDialogPass)
)]
pub struct DisplayDialog;

impl DisplayDialog {
    /// The size of its window.
    pub const SIZE: (u32, u32) = (400, 340);
}

/// The pass in which the panel of a [`DisplayDialog`] is shown.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct DisplayDialogPass;

pub(crate) fn plugin(app: &mut App) {
    app.add_message::<DisplayRequest>()
        .init_resource::<DisplayOverlay>()
        .add_systems(DisplayDialogPass, show_dialog)
        .add_systems(
            EguiPrimaryContextPass,
            show_overlay.run_if(|overlay: Res<DisplayOverlay>| overlay.is_open),
        );
}

/// The settings over the main window.
#[derive(Resource, Default)]
pub(crate) struct DisplayOverlay {
    is_open: bool,
    /// The choice that is not decided upon yet.
    draft: Option<DisplaySettings>,
}

impl DisplayOverlay {
    pub fn open(&mut self) {
        self.is_open = true;
    }

    #[cfg(test)]
    pub fn is_open(&self) -> bool {
        self.is_open
    }
}

fn show_overlay(
    mut contexts: EguiContexts,
    mut overlay: ResMut<DisplayOverlay>,
    offer: If<Res<DisplayOffer>>,
    renderer: If<Res<Renderer>>,
    settings: If<ResMut<DisplaySettings>>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let mut settings = settings.0;
    let model = Model {
        offer: &offer,
        renderer: &renderer,
    };
    let draft = overlay.draft.get_or_insert(*settings);
    let id = egui::Id::new("display overlay");
    context.move_to_top(Modal::default_area(id).layer());
    let modal = Modal::new(id).show(context, |ui| {
        ui.set_width(DisplayDialog::SIZE.0 as f32);
        show(ui, model, draft)
    });
    let is_left = modal.should_close().then_some(DisplayRequest::Cancel);
    match modal.inner.or(is_left) {
        Some(DisplayRequest::Continue) => {
            if let Err(error) = preferences.keep(CONCERN, draft) {
                notices.add(Tone::Warning, &error.to_string());
            }
            settings.set_if_neq(*draft);
            *overlay = default();
        }
        Some(DisplayRequest::Cancel) => *overlay = default(),
        None => (),
    }
}

fn show_dialog(
    mut is_dressed: Local<bool>,
    mut dialog: Single<&mut EguiContext, With<DisplayDialog>>,
    offer: Res<DisplayOffer>,
    renderer: Res<Renderer>,
    mut settings: ResMut<DisplaySettings>,
    mut requests: MessageWriter<DisplayRequest>,
) {
    let context = dialog.get_mut().clone();
    if !*is_dressed {
        context.set_theme(egui::Theme::Dark);
        context.style_mut_of(egui::Theme::Dark, dress);
        *is_dressed = true;
    }
    let whole = UiBuilder::new()
        .layer_id(LayerId::background())
        .max_rect(context.viewport_rect());
    let mut ui = Ui::new(context, egui::Id::new(TITLE), whole);
    let model = Model {
        offer: &offer,
        renderer: &renderer,
    };
    CentralPanel::default().show(&mut ui, |ui| {
        requests.write_batch(show(ui, model, &mut settings));
    });
}

/// Shows the settings, which the user changes to others that are offered, until he has decided.
fn show(ui: &mut Ui, model: Model, settings: &mut DisplaySettings) -> Option<DisplayRequest> {
    // A list that is open takes Enter and Esc for itself, and is then closed already when the buttons look for them.
    let list = egui::Id::new("open list of the display settings");
    let was_list_open: bool = ui.data(|data| data.get_temp(list).unwrap_or_default());
    ui.vertical_centered(|ui| ui.heading(TITLE));
    ui.separator();
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.fullscreen, "Fullscreen?")
            .on_hover_text("Fill the screen");
        ui.add_space(24.0);
        ui.checkbox(&mut settings.vsync, "Vsync?")
            .on_hover_text("Show a picture only when the screen has shown the last one wholly");
    });
    ui.add_space(4.0);
    let grid = Grid::new("display settings")
        .num_columns(2)
        .spacing(vec2(16.0, 8.0));
    grid.show(ui, |ui| choices(ui, model.offer, settings));
    ui.add_space(4.0);
    ui.checkbox(&mut settings.ask, "Show this at start")
        .on_hover_text("The command tabletop --settings shows it once more");
    ui.separator();
    tell_renderer(ui, model.renderer);
    ui.add_space(8.0);
    let request = ui.horizontal(|ui| {
        ui.add_space((ui.available_width() - 2.0 * BUTTON.0 - ui.spacing().item_spacing.x) / 2.0);
        decision(ui, !was_list_open)
    });
    let is_list_open = ui.ctx().any_popup_open();
    ui.data_mut(|data| data.insert_temp(list, is_list_open));
    request.inner
}

/// The rows of settings with more than two values. A setting that depends on another one keeps an offered value.
fn choices(ui: &mut Ui, offer: &DisplayOffer, settings: &mut DisplaySettings) {
    *settings = offer.nearest(*settings).0;
    let fullscreen = settings.fullscreen;
    let of_desktop = match fullscreen {
        true => NO_OTHER_DEPTH,
        false => DEPTH_OF_DESKTOP,
    };
    Choice {
        name: "Screen Resolution",
        offered: offer.resolutions(fullscreen),
        why_none: NO_OTHER_SIZE,
    }
    .show(ui, &mut settings.resolution, |size| size.to_string());
    Choice {
        name: "Refresh Rate",
        offered: offer.refresh_rates(fullscreen, settings.resolution),
        why_none: NO_OTHER_RATE,
    }
    .show(ui, &mut settings.refresh_rate, |rate| format!("{rate} Hz"));
    Choice {
        name: "Color Depth",
        offered: offer.color_depths(fullscreen, settings.resolution, settings.refresh_rate),
        why_none: of_desktop,
    }
    .show(ui, &mut settings.color_depth, |depth| {
        format!("{depth} bpp")
    });
    Choice {
        name: "Anti-Aliasing",
        offered: offer.antialiasing.clone(),
        why_none: NO_ANTIALIASING,
    }
    .show(ui, &mut settings.antialiasing, ToString::to_string);
    *settings = offer.nearest(*settings).0;
}

/// One of several values.
struct Choice<T> {
    name: &'static str,
    offered: Vec<T>,
    /// The reason why there is at most one.
    why_none: &'static str,
}

impl<T: PartialEq + Copy> Choice<T> {
    fn show(self, ui: &mut Ui, value: &mut T, text: impl Fn(&T) -> String) {
        let label = ui.label(self.name);
        ui.add_enabled_ui(self.offered.len() > 1, |ui| {
            let list = ComboBox::from_id_salt(self.name)
                .width(150.0)
                .selected_text(text(value));
            list.show_ui(ui, |ui| {
                for offered in &self.offered {
                    ui.selectable_value(value, *offered, text(offered));
                }
            })
            .response
            .labelled_by(label.id)
            .on_disabled_hover_text(self.why_none);
        });
        ui.end_row();
    }
}

fn tell_renderer(ui: &mut Ui, renderer: &Renderer) {
    let text = match renderer.is_software {
        true => format!("Drawn by the processor ({})", renderer.name),
        false => format!("Drawn by {}", renderer.name),
    };
    ui.label(RichText::new(text).weak());
    if renderer.is_software {
        let advice = "A low resolution without anti-aliasing is fluent.";
        ui.label(RichText::new(advice).weak());
    }
}

fn decision(ui: &mut Ui, are_keys_free: bool) -> Option<DisplayRequest> {
    let size = Vec2::from(BUTTON);
    let go_on = ui
        .add(Button::new("Continue").min_size(size))
        .on_hover_text("Show the main window like this (Enter)");
    let cancel = ui
        .add(Button::new("Cancel").min_size(size))
        .on_hover_text("Quit, or leave the window as it is (Esc)");
    let is_struck = |key| are_keys_free && ui.input(|input| input.key_pressed(key));
    if cancel.clicked() || is_struck(Key::Escape) {
        Some(DisplayRequest::Cancel)
    } else if go_on.clicked() || is_struck(Key::Enter) {
        Some(DisplayRequest::Continue)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use bevy_egui::egui::{self, accesskit::Role};
    use egui_kittest::{
        Harness,
        kittest::{NodeT as _, Queryable as _},
    };

    use super::*;
    use crate::display::{Antialiasing, Resolution, ScreenMode};

    #[derive(Debug)]
    struct Stage {
        offer: DisplayOffer,
        settings: DisplaySettings,
        request: Option<DisplayRequest>,
    }

    fn mode(width: u32, height: u32, rate: u32, color_depth: u16) -> ScreenMode {
        ScreenMode {
            resolution: Resolution::new(width, height),
            refresh_rate: NonZeroU32::new(rate).unwrap(),
            color_depth,
        }
    }

    fn harness(change: impl FnOnce(&mut Stage)) -> Harness<'static, Stage> {
        let screen = mode(1280, 1024, 75, 24);
        let mut stage = Stage {
            offer: DisplayOffer {
                desktop: screen.resolution,
                screen,
                modes: vec![
                    screen,
                    mode(1280, 1024, 60, 24),
                    mode(1280, 1024, 60, 30),
                    mode(640, 480, 60, 24),
                ],
                antialiasing: Antialiasing::ALL.to_vec(),
                is_software: false,
            },
            settings: DisplaySettings::default(),
            request: None,
        };
        change(&mut stage);
        let frame = |ui: &mut egui::Ui, stage: &mut Stage| {
            let renderer = Renderer {
                name: "Painter".into(),
                is_software: stage.offer.is_software,
            };
            let model = Model {
                offer: &stage.offer,
                renderer: &renderer,
            };
            let request = show(ui, model, &mut stage.settings);
            stage.request = stage.request.or(request);
        };
        let (width, height) = DisplayDialog::SIZE;
        let size = vec2(width as f32, height as f32);
        Harness::builder()
            .with_size(size)
            .build_ui_state(frame, stage)
    }

    fn is_fullscreen(stage: &mut Stage) {
        stage.settings.fullscreen = true;
        stage.settings.resolution = Resolution::new(1280, 1024);
    }

    /// Opens a list and takes a value from it.
    fn choose(harness: &mut Harness<Stage>, list: &str, value: &str) {
        harness.get_by_role_and_label(Role::ComboBox, list).click();
        harness.run();
        harness.get_by_role_and_label(Role::Button, value).click();
        harness.run();
    }

    #[test]
    fn boxes_are_checked() {
        let mut harness = harness(|_| ());
        let flags = |harness: &Harness<Stage>| {
            let settings = harness.state().settings;
            [settings.fullscreen, settings.vsync, settings.ask]
        };
        let mut expected = flags(&harness);
        for (index, label) in ["Fullscreen?", "Vsync?", "Show this at start"]
            .into_iter()
            .enumerate()
        {
            harness.get_by_label(label).click();
            harness.run();
            expected[index] = !expected[index];
            assert_eq!(flags(&harness), expected, "{label}");
        }
    }

    #[test]
    fn values_are_chosen_from_lists() {
        let mut harness = harness(is_fullscreen);
        choose(&mut harness, "Refresh Rate", "60 Hz");
        choose(&mut harness, "Color Depth", "30 bpp");
        choose(&mut harness, "Anti-Aliasing", "8x");
        let settings = harness.state().settings;
        assert_eq!(settings.refresh_rate.get(), 60);
        assert_eq!(settings.color_depth, 30);
        assert_eq!(settings.antialiasing, Antialiasing::X8);
        choose(&mut harness, "Screen Resolution", "640 × 480");
        let settings = harness.state().settings;
        assert_eq!(settings.resolution, Resolution::new(640, 480));
        assert_eq!(settings.color_depth, 24, "the only one of that size");
    }

    #[test]
    fn a_list_without_a_choice_is_disabled_and_gives_the_reason() {
        let disabled = |list: &str, reason: &str, change: fn(&mut Stage)| {
            let mut harness = harness(change);
            let found = harness.get_by_role_and_label(Role::ComboBox, list);
            assert!(found.accesskit_node().is_disabled(), "{list}");
            found.hover();
            harness.run_steps(60);
            assert!(harness.query_by_label(reason).is_some(), "{list}");
        };
        disabled("Color Depth", DEPTH_OF_DESKTOP, |_| ());
        disabled("Anti-Aliasing", NO_ANTIALIASING, |stage| {
            stage.offer.antialiasing = vec![Antialiasing::Off];
        });
        let small = |stage: &mut Stage| {
            is_fullscreen(stage);
            stage.settings.resolution = Resolution::new(640, 480);
        };
        disabled("Refresh Rate", NO_OTHER_RATE, small);
        disabled("Color Depth", NO_OTHER_DEPTH, small);
        disabled("Screen Resolution", NO_OTHER_SIZE, |stage| {
            is_fullscreen(stage);
            stage.offer.modes.clear();
        });
    }

    #[test]
    fn buttons_and_keys_decide() {
        for (label, key, expected) in [
            ("Continue", Key::Enter, DisplayRequest::Continue),
            ("Cancel", Key::Escape, DisplayRequest::Cancel),
        ] {
            let mut with_mouse = harness(|_| ());
            with_mouse.get_by_label(label).click();
            with_mouse.run();
            assert_eq!(with_mouse.state().request, Some(expected));
            let mut with_key = harness(|_| ());
            with_key.key_press(key);
            with_key.run();
            assert_eq!(with_key.state().request, Some(expected));
        }
    }

    #[test]
    fn esc_closes_an_open_list_first() {
        let mut harness = harness(|_| ());
        harness
            .get_by_role_and_label(Role::ComboBox, "Screen Resolution")
            .click();
        harness.run();
        harness.key_press(Key::Escape);
        harness.run();
        assert_eq!(harness.state().request, None);
    }

    #[test]
    fn a_processor_that_draws_is_named() {
        let harness = harness(|stage| stage.offer.is_software = true);
        let named = harness.query_by_label("Drawn by the processor (Painter)");
        assert!(named.is_some());
    }
}
