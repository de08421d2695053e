//! The way of an object that keys move along the table: over what is between, and onto what is below its goal.

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, HandCommand, Hands};
use tabletop_user::{Chosen, Dragging, Neighborhood};

use crate::around::Around;

/// Change of a place, in units, from which on it is another; so far from its goal an object has arrived.
const SAME: f32 = 1e-3;

/// The way of the chosen object, until it has arrived.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Travel(Option<TravelWay>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct TravelWay {
    object: Entity,
    /// Where it is to come, seen from above.
    goal: Vec3,
    /// Its height, in units, over the highest thing below it.
    clearance: f32,
    /// The location that it was last sent to.
    sent: Vec3,
}

impl Travel {
    /// Sends an object, whose neighborhood this is, farther by this offset from its present goal; `to` puts the goal where it may be.
    pub fn go_on(
        &mut self,
        object: Entity,
        there: &Neighborhood,
        offset: Vec3,
        to: impl Fn(Vec3) -> Vec3,
    ) {
        let way = self.0.filter(|way| way.object == object);
        let way = way.unwrap_or_else(|| TravelWay {
            object,
            goal: there.here,
            clearance: there.clearance(),
            sent: there.here,
        });
        self.0 = Some(TravelWay {
            goal: to(way.goal + offset.with_z(0.0)),
            clearance: (way.clearance + offset.z).max(0.0),
            ..way
        });
    }
}

impl TravelWay {
    /// The last place, and the next one on the way there.
    fn places(&self, there: &Neighborhood) -> [Vec3; 2] {
        // Snapping would hold back what goes on by steps.
        let plain = Dragging {
            snaps_to_faces: false,
            snaps_to_centers: false,
            snaps_to_grid: false,
            ..default()
        };
        let last = there.on_top(&plain, self.goal, self.clearance);
        [last, there.way_to(last)]
    }
}

/// The hand that holds the chosen object takes it on.
pub(crate) fn follow(
    chosen: Res<Chosen>,
    hands: Res<Hands>,
    around: Around,
    mut travel: ResMut<Travel>,
    mut commands: CommandWriter,
) {
    let Some(way) = travel.0 else {
        return;
    };
    let there = around
        .of(way.object)
        .filter(|_| chosen.0 == Some(way.object));
    let Some(there) = there else {
        travel.0 = None;
        return;
    };
    let hand = hands.selected;
    if hands.held_by(hand) != Some(way.object) {
        return;
    }
    let [last, next] = way.places(&there);
    if next.distance(way.sent) >= SAME {
        let location = next;
        commands.write(Actor::Key, HandCommand::MoveTo { hand, location });
        travel.0 = Some(TravelWay { sent: next, ..way });
    } else if there.here.distance(last) < SAME {
        travel.0 = None;
    }
}

#[cfg(test)]
mod tests {
    use KeyCode::{ArrowRight, Enter, PageUp, Tab};
    use tabletop_core::{Hand, SimCommand};

    use super::*;
    use crate::{key_moves, test_world::TestWorld};

    const STEP: f32 = 0.1;

    /// A world in which the hand holds a red block, chosen by the keyboard, a step to the left of where it meets a blue one.
    fn world() -> (TestWorld, Entity) {
        let mut test = TestWorld::new(key_moves::plugin);
        let red = test.hold("red", Vec3::Z);
        test.block("blue", Vec3::new(2.0 + STEP, 0.0, 1.0));
        strike(&mut test, Tab);
        (test, red)
    }

    fn strike(test: &mut TestWorld, key: KeyCode) -> Vec<SimCommand> {
        test.keys().press(key);
        let commands = test.hold_still();
        test.keys().release(key);
        commands
    }

    /// Where the commands send the object, which then gets there.
    fn sent(test: &mut TestWorld, object: Entity, commands: &[SimCommand]) -> Vec3 {
        let [SimCommand::Hand(HandCommand::MoveTo { hand, location })] = commands else {
            panic!("{commands:?}");
        };
        assert_eq!(*hand, Hand::Any);
        let world = test.app.world_mut();
        world.get_mut::<Transform>(object).unwrap().translation = *location;
        *location
    }

    fn assert_near(actual: Vec3, expected: Vec3) {
        assert!(actual.distance(expected) < 0.05, "{actual} {expected}");
    }

    #[test]
    fn keys_move_an_object_onto_what_is_in_its_way_and_down_again() {
        let (mut test, red) = world();
        let beside = strike(&mut test, ArrowRight);
        assert_near(sent(&mut test, red, &beside), Vec3::new(STEP, 0.0, 1.0));
        assert_eq!(test.hold_still(), [], "it has arrived");
        let up = strike(&mut test, ArrowRight);
        assert_near(sent(&mut test, red, &up), Vec3::new(STEP, 0.0, 3.0));
        let onto = test.hold_still();
        assert_near(sent(&mut test, red, &onto), Vec3::new(2.0 * STEP, 0.0, 3.0));
        assert_eq!(test.hold_still(), []);
        let mut last = Vec3::ZERO;
        for _ in 0..45 {
            for commands in [strike(&mut test, ArrowRight), test.hold_still()] {
                if !commands.is_empty() {
                    last = sent(&mut test, red, &commands);
                }
            }
        }
        assert_near(last, Vec3::new(47.0 * STEP, 0.0, 1.0));
    }

    #[test]
    fn what_is_raised_stays_so_high_over_what_is_below_it() {
        let (mut test, red) = world();
        let raised = strike(&mut test, PageUp);
        assert_near(sent(&mut test, red, &raised), Vec3::Z * (1.0 + STEP));
        test.hold_still();
        let beside = strike(&mut test, ArrowRight);
        sent(&mut test, red, &beside);
        test.hold_still();
        strike(&mut test, ArrowRight);
        // Before it has come up, the key is struck again.
        let up = strike(&mut test, ArrowRight);
        assert_eq!(up, [], "it is on its way");
        let world = test.app.world_mut();
        let place = Vec3::new(STEP, 0.0, 3.0 + STEP);
        world.get_mut::<Transform>(red).unwrap().translation = place;
        let onto = test.hold_still();
        let there = Vec3::new(3.0 * STEP, 0.0, 3.0 + STEP);
        assert_near(sent(&mut test, red, &onto), there);
    }

    #[test]
    fn letting_go_ends_the_way() {
        let (mut test, _) = world();
        strike(&mut test, ArrowRight);
        strike(&mut test, Enter);
        test.let_go();
        let chosen = test.app.world().resource::<Chosen>().0;
        assert_eq!(test.hold_still(), []);
        let mut hands = test.app.world_mut().resource_mut::<Hands>();
        let hand = hands.selected;
        hands.set_held(hand, chosen);
        assert_eq!(test.hold_still(), []);
    }
}
