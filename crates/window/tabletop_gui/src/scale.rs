//! The scale of panels and their texts: the one that fits the window, or the user's choice.

use bevy::{prelude::*, window::PrimaryWindow};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass};
use tabletop_user::{Action, KeySystems, Keys, Notices, Tone};

use crate::preferences::Preferences;

/// Its name in the preferences.
const CONCERN: &str = "scale";

/// The scales that can be chosen; 1 is 13 points a line on a screen that is not scaled.
const SCALES: [f32; 10] = [0.75, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0];

/// The size of window, in logical pixels, that the panels are made for.
const DESIGN_SIZE: Vec2 = Vec2::new(1280.0, 960.0);

/// The least size of window that the panels are not made smaller for.
const SMALLEST_SIZE: Vec2 = Vec2::new(800.0, 600.0);

/// The user's choice, if there is one; else the scale is made to fit the window.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct UiScale(Option<f32>);

/// A change of the scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ScaleStep {
    Smaller,
    Automatic,
    Larger,
}

impl ScaleStep {
    #[cfg(test)]
    pub const ALL: [Self; 3] = [Self::Smaller, Self::Automatic, Self::Larger];

    /// The name of the step where it cannot be seen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Smaller => "Smaller",
            Self::Automatic => "Fit the window",
            Self::Larger => "Larger",
        }
    }
}

impl UiScale {
    /// Goes a step on from the scale that is shown.
    pub fn change(&mut self, step: ScaleStep, shown: f32) {
        let next = match step {
            ScaleStep::Automatic => None,
            ScaleStep::Smaller => SCALES.into_iter().rfind(|&scale| scale < shown - 0.01),
            ScaleStep::Larger => SCALES.into_iter().find(|&scale| scale > shown + 0.01),
        };
        if next.is_some() || step == ScaleStep::Automatic {
            self.0 = next;
        }
    }

    /// The scale in a window of this size in logical pixels.
    fn in_window(self, size: Vec2) -> f32 {
        self.0.unwrap_or_else(|| automatic(size))
    }
}

/// Quarters are sharp.
fn automatic(size: Vec2) -> f32 {
    if size.cmplt(SMALLEST_SIZE).any() {
        return SCALES[0];
    }
    let fit = (size / DESIGN_SIZE).min_element();
    ((fit * 4.0).floor() / 4.0).clamp(1.0, 2.0)
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<UiScale>()
        .add_systems(Startup, recall)
        .add_systems(RunFixedMainLoop, change_by_keys.in_set(KeySystems))
        .add_systems(EguiPrimaryContextPass, apply)
        .add_systems(Update, keep.run_if(resource_changed::<UiScale>));
}

fn recall(preferences: Res<Preferences>, mut scale: ResMut<UiScale>, mut notices: ResMut<Notices>) {
    match preferences.read::<Option<f32>>(CONCERN) {
        Ok(kept) => {
            let (least, most) = (SCALES[0], SCALES[SCALES.len() - 1]);
            let chosen = kept.flatten().filter(|scale| scale.is_finite());
            scale.0 = chosen.map(|scale| scale.clamp(least, most));
        }
        Err(error) => notices.add(Tone::Fault, &error.to_string()),
    }
}

fn keep(
    mut kept: Local<Option<UiScale>>,
    scale: Res<UiScale>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
) {
    let before = kept.replace(*scale);
    if before.is_some_and(|before| before != *scale)
        && let Err(error) = preferences.keep(CONCERN, &scale.0)
    {
        notices.add(Tone::Fault, &error.to_string());
    }
}

fn change_by_keys(
    keys: Keys,
    windows: Query<&Window, With<PrimaryWindow>>,
    mut scale: ResMut<UiScale>,
) {
    let Some(window) = windows.iter().next() else {
        return;
    };
    for (action, step) in [
        (Action::DrawLarger, ScaleStep::Larger),
        (Action::DrawSmaller, ScaleStep::Smaller),
        (Action::DrawToFit, ScaleStep::Automatic),
    ] {
        if keys.was_struck(action) {
            let shown = scale.in_window(window.size());
            scale.change(step, shown);
        }
    }
}

fn apply(
    mut contexts: EguiContexts,
    windows: Query<&Window, With<PrimaryWindow>>,
    scale: Res<UiScale>,
) {
    let (Ok(context), Some(window)) = (contexts.ctx_mut(), windows.iter().next()) else {
        return;
    };
    // Else egui would scale by itself, and forget it.
    context.options_mut(|options| options.zoom_with_keyboard = false);
    context.set_zoom_factor(scale.in_window(window.size()));
}

#[cfg(test)]
mod tests {
    use std::{env, fs, path::PathBuf};

    use tabletop_core::CorePlugin;
    use tabletop_user::UserPlugin;

    use super::*;

    #[test]
    fn the_automatic_scale_fits_the_window() {
        for (width, height, expected) in [
            (640.0, 480.0, 0.75),
            (1024.0, 768.0, 1.0),
            (1920.0, 1080.0, 1.0),
            (2560.0, 1440.0, 1.5),
            (3840.0, 2160.0, 2.0),
            (1000.0, 3000.0, 1.0),
        ] {
            let scale = UiScale::default().in_window(Vec2::new(width, height));
            assert_eq!(scale, expected, "{width} × {height}");
        }
    }

    #[test]
    fn steps_go_from_scale_to_scale_and_end_at_either_end() {
        let mut scale = UiScale::default();
        let large = Vec2::new(2560.0, 1440.0);
        let mut after = |step| {
            let shown = scale.in_window(large);
            scale.change(step, shown);
            scale.in_window(large)
        };
        assert_eq!(after(ScaleStep::Larger), 1.75);
        assert_eq!(after(ScaleStep::Smaller), 1.5);
        for _ in 0..20 {
            after(ScaleStep::Smaller);
        }
        assert_eq!(after(ScaleStep::Smaller), 0.75);
        for _ in 0..20 {
            after(ScaleStep::Larger);
        }
        assert_eq!(after(ScaleStep::Larger), 3.0);
        assert_eq!(after(ScaleStep::Automatic), 1.5);
    }

    #[test]
    fn keys_change_the_scale() {
        use KeyCode::{ControlLeft, Digit0, Equal, Minus, NumpadAdd, ShiftLeft};
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .init_resource::<UiScale>()
            .add_systems(Update, change_by_keys);
        app.world_mut().spawn((Window::default(), PrimaryWindow));
        for (keys, expected) in [
            (&[Equal][..], None),
            (&[ControlLeft, Equal], Some(1.25)),
            (&[ControlLeft, ShiftLeft, Equal], Some(1.25)),
            (&[ControlLeft, NumpadAdd], Some(1.25)),
            (&[ControlLeft, Minus], Some(1.0)),
            (&[ControlLeft, Digit0], None),
        ] {
            let before = if keys == [Equal] { None } else { Some(1.1) };
            app.insert_resource(UiScale(before));
            let mut input = ButtonInput::default();
            keys.iter().for_each(|&key| input.press(key));
            app.insert_resource(input);
            app.update();
            assert_eq!(
                *app.world().resource::<UiScale>(),
                UiScale(expected),
                "{keys:?}"
            );
        }
    }

    fn folder() -> PathBuf {
        env::temp_dir().join(format!("tabletop-scale-{}", std::process::id()))
    }

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<UiScale>()
            .init_resource::<Notices>()
            .insert_resource(Preferences::in_folder(folder()))
            .add_systems(Startup, recall)
            .add_systems(Update, keep);
        app.update();
        app
    }

    #[test]
    fn the_scale_is_remembered() {
        let mut first = app();
        assert!(!folder().exists());
        first
            .world_mut()
            .resource_mut::<UiScale>()
            .change(ScaleStep::Larger, 1.0);
        first.update();
        assert_eq!(*app().world().resource::<UiScale>(), UiScale(Some(1.1)));
        fs::write(folder().join("scale.ron"), "Some(1000.0)").unwrap();
        assert_eq!(*app().world().resource::<UiScale>(), UiScale(Some(3.0)));
        fs::remove_dir_all(folder()).unwrap();
    }
}
