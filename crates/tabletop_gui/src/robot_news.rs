//! What the robot has done, in words.

use bevy::prelude::*;
use tabletop_core::SimFact;

use crate::notices::{Notices, Tone};

/// The angle of the report's figure 11 has to be below this, in degrees.
const LARGEST_GRIP_ANGLE: f32 = 180.0 / 16.0;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, note_facts);
}

fn note_facts(mut facts: MessageReader<SimFact>, mut notices: ResMut<Notices>) {
    for words in facts.read().filter_map(words) {
        notices.renew(Tone::News, &words);
    }
}

/// Says what the robot has done; nothing of what others have.
fn words(fact: &SimFact) -> Option<String> {
    Some(match fact {
        SimFact::GripMade { arm, id } => format!("the {arm} gripper holds {id}"),
        SimFact::GripRefused { arm, id, angle } => format!(
            "the {arm} gripper cannot hold {id}: its fingers touch it at θ = {:.1}°, which must be below \
             {LARGEST_GRIP_ANGLE}°",
            angle.to_degrees()
        ),
        SimFact::GripReleased { arm, id } => format!("the {arm} gripper holds {id} no longer"),
        SimFact::ArmBlocked { arm, by } if by == "table" => {
            format!("the {arm} arm is stopped by the table")
        }
        SimFact::ArmBlocked { arm, by } => format!("the {arm} arm is stopped by {by}"),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::{Arm, CorePlugin};

    fn made(id: &str) -> SimFact {
        SimFact::GripMade {
            arm: Arm::Left,
            id: id.into(),
        }
    }

    #[test]
    fn facts_of_the_robot_have_words() {
        for (fact, expected) in [
            (made("red"), "the left gripper holds red"),
            (
                SimFact::GripRefused {
                    arm: Arm::Right,
                    id: "red".into(),
                    angle: 0.5,
                },
                "the right gripper cannot hold red: its fingers touch it at θ = 28.6°, which must be below 11.25°",
            ),
            (
                SimFact::GripReleased {
                    arm: Arm::Right,
                    id: "red".into(),
                },
                "the right gripper holds red no longer",
            ),
            (
                SimFact::ArmBlocked {
                    arm: Arm::Left,
                    by: "table".into(),
                },
                "the left arm is stopped by the table",
            ),
        ] {
            assert_eq!(words(&fact).as_deref(), Some(expected));
        }
        assert_eq!(words(&SimFact::Undone), None);
    }

    #[test]
    fn what_happens_again_is_told_last() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), plugin))
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
