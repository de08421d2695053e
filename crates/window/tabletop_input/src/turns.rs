//! The turns of each hand's object about each axis of the world, which the rotation sliders show.

use bevy::prelude::*;
use tabletop_core::{Hand, HandCommand, HandFact, HistoryFact, SimFact};

/// Greatest angle that a slider shows, in degrees, to either side.
pub const MAX_DEGREES: i32 = 180;

/// The axes, in the order of their sliders.
pub(crate) const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// Sums of the turns since a hand grasped its object, in whole degrees. They are no orientation: every turn is about an
/// axis of the world, on top of those before.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TurnSums([[i32; 3]; 4]);

impl TurnSums {
    /// The sums of a hand about each of the axes.
    pub fn of(&self, hand: Hand) -> [i32; 3] {
        self.0[hand as usize]
    }

    /// Brings one sum as near to these degrees as possible, and returns the turn.
    pub fn turn_to(&mut self, hand: Hand, axis: usize, degrees: i32) -> Option<HandCommand> {
        let sum = &mut self.0[hand as usize][axis];
        let before = *sum;
        *sum = degrees.clamp(-MAX_DEGREES, MAX_DEGREES);
        (*sum != before).then(|| HandCommand::Turn {
            hand,
            axis: AXES[axis],
            degrees: (*sum - before) as f32,
        })
    }

    /// Turns on by these degrees, and returns the turn, if it is one. Sums go round at half a turn.
    pub fn turn_by(&mut self, hand: Hand, axis: usize, degrees: i32) -> Option<HandCommand> {
        let sum = &mut self.0[hand as usize][axis];
        let on = *sum + degrees;
        *sum = match on.abs() > MAX_DEGREES {
            true => on - 2 * MAX_DEGREES * on.signum(),
            false => on,
        };
        (degrees != 0).then(|| HandCommand::Turn {
            hand,
            axis: AXES[axis],
            degrees: degrees as f32,
        })
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<TurnSums>()
        .add_systems(Update, begin_anew);
}

/// Every grasp begins at 0, an empty hand stands at 0, and a grasp that undo brings back begins at 0, too.
fn begin_anew(mut facts: MessageReader<SimFact>, mut turns: ResMut<TurnSums>) {
    for fact in facts.read() {
        match fact {
            SimFact::Hand(
                HandFact::Grasped { hand, .. }
                | HandFact::Released { hand, .. }
                | HandFact::Destroyed { hand, .. },
            ) => turns.0[*hand as usize] = [0; 3],
            SimFact::History(HistoryFact::Undone { .. } | HistoryFact::Redone { .. }) => {
                *turns = TurnSums::default()
            }
            SimFact::Scene(_)
            | SimFact::History(HistoryFact::SegmentBegun { .. } | HistoryFact::Kept { .. })
            | SimFact::Mechanism(_)
            | SimFact::Recording(_)
            | SimFact::Robot(_)
            | SimFact::Refused { .. } => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use tabletop_user::UserPlugin;

    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::{CommandId, CorePlugin};

    fn degrees_of(command: Option<HandCommand>) -> Option<f32> {
        match command {
            Some(HandCommand::Turn { degrees, .. }) => Some(degrees),
            None => None,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_slider_turns_by_the_degrees_it_moves() {
        let mut turns = TurnSums::default();
        for (to, by) in [(45, 45.0), (30, -15.0), (-30, -60.0)] {
            assert_eq!(degrees_of(turns.turn_to(Hand::Left, 1, to)), Some(by));
        }
        assert_eq!(turns.turn_to(Hand::Left, 1, -30), None);
        assert_eq!(turns.of(Hand::Left), [0, -30, 0]);
        assert_eq!(turns.of(Hand::Right), [0; 3]);
    }

    #[test]
    fn no_slider_goes_beyond_half_a_turn() {
        let mut turns = TurnSums::default();
        let turned = turns.turn_to(Hand::Any, 2, 1000);
        assert_eq!(degrees_of(turned), Some(180.0));
        assert_eq!(turns.turn_to(Hand::Any, 2, 181), None);
        let back = turns.turn_to(Hand::Any, 2, -225);
        assert_eq!(degrees_of(back), Some(-360.0));
    }

    #[test]
    fn turns_by_keys_go_round() {
        let mut turns = TurnSums::default();
        for (by, sum) in [(170, 170), (20, -170), (-15, 175), (0, 175)] {
            let turned = degrees_of(turns.turn_by(Hand::Any, 1, by));
            assert_eq!(turned, (by != 0).then_some(by as f32));
            assert_eq!(turns.of(Hand::Any), [0, sum, 0]);
        }
    }

    #[test]
    fn a_grasp_begins_at_zero_for_its_hand_and_an_undo_for_all() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        let mut turns = app.world_mut().resource_mut::<TurnSums>();
        turns.turn_to(Hand::Left, 0, 10);
        turns.turn_to(Hand::Right, 2, 20);
        let cause = CommandId(0);
        app.world_mut()
            .write_message(SimFact::Hand(HandFact::Grasped {
                cause,
                hand: Hand::Left,
                id: "red".into(),
            }));
        app.update();
        let turns = *app.world().resource::<TurnSums>();
        assert_eq!(turns.of(Hand::Left), [0; 3]);
        assert_eq!(turns.of(Hand::Right), [0, 0, 20]);
        app.world_mut()
            .write_message(SimFact::History(HistoryFact::Undone { cause }));
        app.update();
        assert_eq!(*app.world().resource::<TurnSums>(), TurnSums::default());
    }
}
