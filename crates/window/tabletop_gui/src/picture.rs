//! The number of drawn pictures.

use bevy::{ecs::entity::EntityHashMap, prelude::*};
use bevy_egui::{EguiInput, EguiPreUpdateSet, egui};

/// The pictures of the window. Whoever draws says so here; the Status window reads it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PictureStatus {
    /// The number of times that it has been drawn since the start.
    pub drawn: u64,
    /// True if nothing moves in it, so that texts which change all the time should not have it drawn all the time.
    pub is_still: bool,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<PictureStatus>().add_systems(
        PreUpdate,
        drop_repeated_modifiers
            .after(EguiPreUpdateSet::ProcessInput)
            .before(EguiPreUpdateSet::BeginPass),
    );
}

/// `bevy_egui` reports the held modifiers to egui in every frame, and egui wants another frame after each event.
fn drop_repeated_modifiers(
    mut reported: Local<EntityHashMap<egui::Modifiers>>,
    mut inputs: Query<(Entity, &mut EguiInput)>,
) {
    for (context, mut input) in &mut inputs {
        let reported = reported.entry(context).or_default();
        input.events.retain(|event| {
            let egui::Event::ModifiersChanged(modifiers) = event else {
                return true;
            };
            std::mem::replace(reported, *modifiers) != *modifiers
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn egui_learns_of_modifiers_when_they_change() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, plugin));
        let context = app.world_mut().spawn(EguiInput::default()).id();
        let mut events = |modifiers| {
            let changed = egui::Event::ModifiersChanged(modifiers);
            let mut input = app.world_mut().get_mut::<EguiInput>(context).unwrap();
            input.events = vec![egui::Event::Copy, changed];
            app.update();
            app.world().get::<EguiInput>(context).unwrap().events.len()
        };
        assert_eq!(events(egui::Modifiers::NONE), 1);
        assert_eq!(events(egui::Modifiers::SHIFT), 2);
        assert_eq!(events(egui::Modifiers::SHIFT), 1);
        assert_eq!(events(egui::Modifiers::NONE), 2);
    }
}
