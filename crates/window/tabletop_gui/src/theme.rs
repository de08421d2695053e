//! The theme of the windows: dark or light.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use serde::{Deserialize, Serialize};

use crate::{
    kept::{Kept, keep},
    widgets::style::{dress, fonts},
};

/// The theme that the user has chosen.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Theme {
    /// Light texts on dark panels.
    #[default]
    Dark,
    /// Dark texts on light panels.
    Light,
}

impl Theme {
    /// The other one.
    pub const fn other(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::Dark,
        }
    }

    /// Its name on the screen.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Dark => "Dark",
            Self::Light => "Light",
        }
    }
}

impl Kept for Theme {
    const CONCERN: &'static str = "theme";
}

pub(crate) fn plugin(app: &mut App) {
    keep::<Theme>(app);
    app.add_systems(EguiPrimaryContextPass, apply);
}

fn apply(mut applied: Local<Option<Theme>>, theme: Res<Theme>, mut contexts: EguiContexts) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    if applied.is_none() {
        context.style_mut_of(egui::Theme::Dark, dress);
        context.style_mut_of(egui::Theme::Light, dress);
        context.set_fonts(fonts());
    }
    if applied.replace(*theme) != Some(*theme) {
        context.set_theme(match *theme {
            Theme::Dark => egui::Theme::Dark,
            Theme::Light => egui::Theme::Light,
        });
    }
}
