//! Deeds of the robot, in words.

use bevy::prelude::*;
use tabletop_core::SimFact;

use tabletop_user::{Notices, Tone};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, note_facts);
}

fn note_facts(mut facts: MessageReader<SimFact>, mut notices: ResMut<Notices>) {
    for words in facts.read().filter_map(SimFact::robot_event) {
        notices.renew(Tone::Event, &words);
    }
}

#[cfg(test)]
mod tests {
    use tabletop_user::UserPlugin;

    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::{Arm, CorePlugin, RobotFact};

    fn made(id: &str) -> SimFact {
        SimFact::Robot(RobotFact::GripMade {
            arm: Arm::Left.name(),
            id: id.into(),
        })
    }

    #[test]
    fn a_repeated_event_is_reported_last() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<Notices>();
        for id in ["red", "blue", "red"] {
            app.world_mut().write_message(made(id));
            app.update();
        }
        let notices = app.world().resource::<Notices>();
        assert_eq!(
            notices.iter().collect::<Vec<_>>(),
            ["the left gripper holds blue", "the left gripper holds red"]
        );
    }
}
