//! The arrangement of the panels, kept from run to run.

use bevy::prelude::*;
use tabletop_user::{Notices, Tone};

use crate::{panels::arrangement::Panels, preferences::Preferences};

/// Their name in the preferences.
const CONCERN: &str = "windows";

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Panels>()
        .add_systems(Startup, recall)
        .add_systems(Update, keep);
}

fn recall(preferences: Res<Preferences>, mut panels: ResMut<Panels>, mut notices: ResMut<Notices>) {
    match preferences.read::<Panels>(CONCERN) {
        Ok(kept) => *panels = kept.unwrap_or_default().completed(),
        Err(error) => notices.add(Tone::Fault, &error.to_string()),
    }
}

/// Keeps changes once the mouse button is up.
fn keep(
    mut kept: Local<Option<Panels>>,
    panels: Res<Panels>,
    mouse: Option<Res<ButtonInput<MouseButton>>>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
) {
    let is_pressed = mouse.is_some_and(|mouse| mouse.get_pressed().len() > 0);
    if is_pressed || kept.as_ref() == Some(&*panels) {
        return;
    }
    let is_new = kept.replace(panels.clone()).is_some();
    if is_new && let Err(error) = preferences.keep(CONCERN, &*panels) {
        notices.add(Tone::Fault, &error.to_string());
    }
}

#[cfg(test)]
mod tests {
    use std::{env, fs, path::PathBuf};

    use bevy_egui::egui::{Rect, pos2, vec2};

    use super::*;
    use crate::panels::panel::Panel;

    fn folder(name: &str) -> PathBuf {
        env::temp_dir().join(format!("tabletop-windows-{name}-{}", std::process::id()))
    }

    fn app(folder: &PathBuf) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, plugin))
            .init_resource::<ButtonInput<MouseButton>>()
            .init_resource::<Notices>()
            .insert_resource(Preferences::in_folder(folder));
        app.update();
        app
    }

    #[test]
    fn panels_are_where_they_were_left() {
        let folder = folder("left");
        let mut first = app(&folder);
        let mut panels = first.world_mut().resource_mut::<Panels>();
        panels.set_open(Panel::Status, false);
        panels.set_open(Panel::Robot, true);
        panels.move_to(Panel::Robot, pos2(321.0, 45.5));
        first.update();
        let second = app(&folder);
        let panels = second.world().resource::<Panels>();
        assert_eq!(panels, first.world().resource::<Panels>());
        let desk = Rect::from_min_size(pos2(0.0, 0.0), vec2(1000.0, 700.0));
        let place = panels.place(Panel::Robot, desk, |_| vec2(300.0, 200.0));
        assert_eq!(place, pos2(321.0, 45.5));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn nothing_is_written_while_nothing_changes_or_a_panel_is_dragged() {
        let folder = folder("dragged");
        let mut app = app(&folder);
        app.update();
        assert!(!folder.exists());
        let mut mouse = app.world_mut().resource_mut::<ButtonInput<MouseButton>>();
        mouse.press(MouseButton::Left);
        let mut panels = app.world_mut().resource_mut::<Panels>();
        panels.move_to(Panel::Status, pos2(50.0, 50.0));
        app.update();
        assert!(!folder.exists());
        let mut mouse = app.world_mut().resource_mut::<ButtonInput<MouseButton>>();
        mouse.release(MouseButton::Left);
        app.update();
        assert!(folder.join("windows.ron").exists());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_damaged_file_is_reported_and_panels_begin_as_at_first() {
        let folder = folder("damaged");
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("windows.ron"), "(open: [Staus])").unwrap();
        let app = app(&folder);
        assert_eq!(*app.world().resource::<Panels>(), Panels::default());
        let notices = app.world().resource::<Notices>();
        let reported = notices.iter().next().unwrap();
        assert!(reported.contains("windows.ron:1:"), "{reported}");
        fs::remove_dir_all(folder).unwrap();
    }
}
