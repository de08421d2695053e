//! Keys that go to the panels.

use bevy::prelude::*;
use bevy_egui::{EguiContext, PrimaryEguiContext};
use tabletop_user::{Action, Chosen, KeySystems, was_struck};

use crate::panels::{Panel, Panels};

pub(crate) fn plugin(app: &mut App) {
    for panel in Panel::ALL {
        let is_asked_for = was_struck(panel.action());
        app.add_systems(
            RunFixedMainLoop,
            go_to(panel).run_if(is_asked_for).in_set(KeySystems),
        );
    }
}

impl Panel {
    /// The action that goes to the panel.
    pub(crate) const fn action(self) -> Action {
        match self {
            Self::Status => Action::StatusWindow,
            Self::Camera => Action::CameraWindow,
            Self::Robot => Action::RobotWindow,
            Self::DemonstrationTools => Action::DemoToolsWindow,
            Self::Pose => Action::PoseWindow,
            Self::Objects => Action::ObjectsWindow,
            Self::Timeline => Action::TimelineWindow,
            Self::Recordings => Action::RecordingsWindow,
            Self::Plots => Action::PlotsWindow,
            Self::Messages => Action::MessagesWindow,
        }
    }
}

/// The panel is open, in front of the others, and has the keyboard: Ctrl+Tab goes to its first widget. Then keys act on no object.
fn go_to(
    panel: Panel,
) -> impl FnMut(Query<&'static mut EguiContext, With<PrimaryEguiContext>>, ResMut<Panels>, ResMut<Chosen>)
{
    move |mut contexts, mut panels, mut chosen| {
        panels.set_open(panel, true);
        chosen.set_if_neq(Chosen(None));
        for mut context in &mut contexts {
            panel.point_out(context.get_mut());
            panel.take_focus(context.get_mut());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use KeyCode::{AltLeft, Digit1, Digit4, Digit7};

    #[test]
    fn keys_open_panels_and_give_up_the_choice_of_an_object() {
        let mut test = TestWorld::new(plugin);
        test.app.init_resource::<Panels>();
        let block = test.block("red", Vec3::Z);
        test.app
            .world_mut()
            .spawn((EguiContext::default(), PrimaryEguiContext));
        for (key, panel) in [
            (Digit1, Panel::Status),
            (Digit4, Panel::DemonstrationTools),
            (Digit7, Panel::Timeline),
        ] {
            test.app.insert_resource(Chosen(Some(block)));
            test.keys().press(AltLeft);
            test.keys().press(key);
            test.hold_still();
            assert!(test.app.world().resource::<Panels>().is_open(panel));
            assert_eq!(*test.app.world().resource::<Chosen>(), Chosen(None));
            test.keys().release_all();
        }
    }
}
