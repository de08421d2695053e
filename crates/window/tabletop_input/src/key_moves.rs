//! The hands by the keyboard alone: one is selected, an object is chosen, taken, moved, turned and let go.

use std::time::Duration;

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    Actor, CommandWriter, Hand, HandCommand, Hands, ObjectIndex, ObjectSpec, Paused,
};
use tabletop_user::{Action, Chosen, Dragging, KeySystems, Keys, UserCamera, was_struck};

use crate::{
    around::Around,
    repeats::{Repeats, StepKeys},
    travel::{self, Travel},
    turns::{AXES, TurnSums},
};

/// A step of a moved object, in units, and of a turned one, in degrees.
const STEP: f32 = 0.1;
const TURN_STEP: i32 = 1;

/// Greatest speed while a key stays down, in units/s and degrees/s.
const SPEED: f32 = 3.0;
const TURN_SPEED: f32 = 60.0;

/// The keys that move, along the axes of the viewer: to the right, away, up.
const MOVES: [[Action; 2]; 3] = [
    [Action::ObjectRight, Action::ObjectLeft],
    [Action::ObjectAway, Action::ObjectNearer],
    [Action::ObjectUp, Action::ObjectDown],
];

/// The keys that turn counterclockwise and clockwise about them.
const TURNS: [[Action; 2]; 3] = [
    [Action::TipNearer, Action::TipAway],
    [Action::RollRight, Action::RollLeft],
    [Action::TurnLeft, Action::TurnRight],
];

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<TurnSums>()
        .init_resource::<Travel>()
        .add_systems(
            RunFixedMainLoop,
            (
                forget_lost,
                select(Hand::Left).run_if(was_struck(Action::HandLeft)),
                select(Hand::Right).run_if(was_struck(Action::HandRight)),
                select(Hand::Both).run_if(was_struck(Action::HandBoth)),
                select(Hand::Any).run_if(was_struck(Action::HandAny)),
                choose(false).run_if(was_struck(Action::NextObject)),
                choose(true).run_if(was_struck(Action::PreviousObject)),
                (
                    take_or_release.run_if(was_struck(Action::TakeOrRelease)),
                    shift,
                    turn,
                    travel::follow,
                )
                    .chain()
                    .run_if(Paused::is_running),
            )
                .chain()
                .in_set(KeySystems),
        );
}

fn forget_lost(index: Res<ObjectIndex>, mut chosen: ResMut<Chosen>) {
    if chosen
        .0
        .is_some_and(|object| index.iter().all(|there| there != object))
    {
        chosen.0 = None;
    }
}

fn select(hand: Hand) -> impl FnMut(CommandWriter) {
    move |mut commands| {
        commands.write(Actor::Key, HandCommand::Select(hand));
    }
}

/// The held object is the first that is chosen.
fn choose(is_back: bool) -> impl FnMut(Res<ObjectIndex>, Res<Hands>, ResMut<Chosen>) {
    move |index, hands, mut chosen| match (chosen.0, hands.held_by(hands.selected)) {
        (None, Some(held)) => chosen.0 = Some(held),
        (None, None) | (Some(_), _) => chosen.go_on(&index, is_back),
    }
}

/// The chosen object and the hand for it.
#[derive(SystemParam)]
struct Handling<'w, 's> {
    chosen: Res<'w, Chosen>,
    hands: Res<'w, Hands>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
    camera: Query<'w, 's, &'static Transform, With<UserCamera>>,
}

impl Handling<'_, '_> {
    /// The location of the chosen object, in units.
    fn location(&self) -> Option<Vec3> {
        let (_, place) = self.objects.get(self.chosen.0?).ok()?;
        Some(place.translation)
    }

    fn is_held(&self) -> bool {
        self.chosen.0.is_some() && self.hands.held_by(self.hands.selected) == self.chosen.0
    }

    /// The command with which the hand takes the object, unless it has it.
    fn grasp(&self) -> Option<HandCommand> {
        let (spec, _) = self.objects.get(self.chosen.0?).ok()?;
        (!self.is_held()).then(|| HandCommand::Grasp {
            hand: self.hands.selected,
            object: spec.id.clone(),
        })
    }

    /// The axes of the table that are nearest to the viewer's right, away from him, and up.
    fn viewer_axes(&self) -> [Vec3; 3] {
        let forward = self.camera.iter().next().map(|camera| *camera.forward());
        let forward = forward.unwrap_or(Vec3::Y);
        let away = match forward.x.abs() > forward.y.abs() {
            true => Vec3::X * forward.x.signum(),
            false => Vec3::Y * forward.y.signum(),
        };
        [away.cross(Vec3::Z), away, Vec3::Z]
    }
}

fn take_or_release(handling: Handling, mut travel: ResMut<Travel>, mut commands: CommandWriter) {
    *travel = Travel::default();
    let release = HandCommand::Release(handling.hands.selected);
    let command = match handling.is_held() {
        true => Some(release),
        false => handling.grasp(),
    };
    commands.write_batch(Actor::Key, command);
}

fn shift(
    keys: Keys,
    time: Res<Time<Real>>,
    handling: Handling,
    dragging: Res<Dragging>,
    around: Around,
    mut travel: ResMut<Travel>,
    mut repeats: Local<Repeats>,
    mut commands: CommandWriter,
) {
    let step = match dragging.snaps_to_grid {
        true => Dragging::GRID,
        false => STEP,
    };
    let every = Duration::from_secs_f32(step / SPEED);
    let steps = repeats.steps(&StepKeys {
        keys: &keys,
        actions: &MOVES,
        every,
        now: time.elapsed(),
    });
    let Some(object) = handling.chosen.0.filter(|_| steps != [0; 3]) else {
        return;
    };
    let Some(there) = around.of(object) else {
        return;
    };
    let hand = handling.hands.selected;
    let axes = handling.viewer_axes();
    let offset: Vec3 = axes
        .into_iter()
        .zip(steps)
        .map(|(axis, steps)| axis * steps as f32 * step)
        .sum();
    let to = |place| match dragging.snaps_to_grid {
        true => on_grid(place, offset),
        false => place,
    };
    commands.write_batch(Actor::Key, handling.grasp());
    if dragging.goes_on_top {
        if !handling.is_held() {
            *travel = Travel::default();
        }
        travel.go_on(object, &there, offset, to);
        return;
    }
    let command = match dragging.snaps_to_grid {
        true => HandCommand::MoveTo {
            hand,
            location: to(there.here + offset),
        },
        false => HandCommand::MoveBy { hand, offset },
    };
    commands.write(Actor::Key, command);
}

/// The place on the lines of the grid along the table that is next to one that was reached by an offset.
fn on_grid(mut place: Vec3, offset: Vec3) -> Vec3 {
    for axis in (0..2).filter(|&axis| offset[axis] != 0.0) {
        place[axis] = (place[axis] / Dragging::GRID).round() * Dragging::GRID;
    }
    place
}

fn turn(
    keys: Keys,
    time: Res<Time<Real>>,
    handling: Handling,
    dragging: Res<Dragging>,
    mut repeats: Local<Repeats>,
    mut turns: ResMut<TurnSums>,
    mut commands: CommandWriter,
) {
    let step = match dragging.turns_in_steps {
        true => Dragging::ANGLE_STEP,
        false => TURN_STEP,
    };
    let every = Duration::from_secs_f32(step as f32 / TURN_SPEED);
    let steps = repeats.steps(&StepKeys {
        keys: &keys,
        actions: &TURNS,
        every,
        now: time.elapsed(),
    });
    if steps == [0; 3] || handling.location().is_none() {
        return;
    }
    let hand = handling.hands.selected;
    commands.write_batch(Actor::Key, handling.grasp());
    for (direction, steps) in handling.viewer_axes().into_iter().zip(steps) {
        for (axis, along) in AXES.into_iter().enumerate() {
            let degrees = steps * step * along.dot(direction).round() as i32;
            commands.write_batch(Actor::Key, turns.turn_by(hand, axis, degrees));
        }
    }
}

#[cfg(test)]
mod tests {
    use KeyCode::{ArrowLeft, ArrowRight, ArrowUp, Digit7, Digit8, Enter, PageUp, ShiftLeft, Tab};
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::SimCommand;
    use tabletop_user::{Gamepad, GamepadControl, StickWay};

    use super::*;
    use crate::test_world::TestWorld;

    fn world() -> TestWorld {
        let mut test = TestWorld::new(plugin);
        let frame = Duration::from_millis(10);
        test.app
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
        test.block("red", Vec3::Z);
        test.block("blue", Vec3::new(5.1, 0.0, 1.0));
        test.app.insert_resource(Dragging {
            goes_on_top: false,
            ..default()
        });
        test
    }

    fn strike(test: &mut TestWorld, keys: &[KeyCode]) -> Vec<SimCommand> {
        keys.iter().for_each(|&key| test.keys().press(key));
        let commands = test.hold_still();
        keys.iter().for_each(|&key| test.keys().release(key));
        test.hold_still();
        commands
    }

    fn take(test: &mut TestWorld) {
        let chosen = test.app.world().resource::<Chosen>().0;
        let mut hands = test.app.world_mut().resource_mut::<Hands>();
        let hand = hands.selected;
        hands.set_held(hand, chosen);
    }

    fn grasp(object: &str) -> SimCommand {
        HandCommand::Grasp {
            hand: Hand::Any,
            object: object.into(),
        }
        .into()
    }

    #[test]
    fn an_object_is_chosen_taken_moved_turned_and_let_go() {
        let mut test = world();
        assert_eq!(strike(&mut test, &[ArrowRight]), []);
        assert_eq!(strike(&mut test, &[Tab]), []);
        assert_eq!(strike(&mut test, &[Tab]), []);
        assert_eq!(strike(&mut test, &[Enter]), [grasp("blue")]);
        take(&mut test);
        let hand = Hand::Any;
        for (keys, command) in [
            (
                &[ArrowLeft][..],
                HandCommand::MoveBy {
                    hand,
                    offset: Vec3::NEG_X * STEP,
                },
            ),
            (
                &[ArrowUp],
                HandCommand::MoveBy {
                    hand,
                    offset: Vec3::Y * STEP,
                },
            ),
            (
                &[PageUp],
                HandCommand::MoveBy {
                    hand,
                    offset: Vec3::Z * STEP,
                },
            ),
            (
                &[ShiftLeft, ArrowLeft],
                HandCommand::Turn {
                    hand,
                    axis: Vec3::Z,
                    degrees: 1.0,
                },
            ),
            (
                &[ShiftLeft, ArrowUp],
                HandCommand::Turn {
                    hand,
                    axis: Vec3::X,
                    degrees: -1.0,
                },
            ),
            (&[Enter], HandCommand::Release(hand)),
        ] {
            assert_eq!(strike(&mut test, keys), [command.into()]);
        }
        assert_eq!(strike(&mut test, &[ShiftLeft, Tab]), []);
        assert_eq!(strike(&mut test, &[Enter]), [grasp("red")]);
    }

    #[test]
    fn a_motion_takes_what_is_chosen_and_goes_on_while_the_key_is_held() {
        let mut test = world();
        strike(&mut test, &[Tab]);
        test.keys().press(ArrowRight);
        let first = test.hold_still();
        assert_eq!(first.len(), 2);
        assert_eq!(first[0], grasp("red"));
        take(&mut test);
        let mut moved = 0.0;
        for _ in 0..129 {
            for command in test.hold_still() {
                let SimCommand::Hand(HandCommand::MoveBy { offset, .. }) = command else {
                    panic!("{command:?}");
                };
                moved += offset.x;
            }
        }
        assert!((2.8..3.2).contains(&moved), "{moved} units in a second");
    }

    #[test]
    fn a_stick_moves_the_chosen_object_the_faster_the_farther_it_is_pushed() {
        let moved = |push: f32| {
            let mut test = world();
            strike(&mut test, &[Tab]);
            take(&mut test);
            let mut pad = test.app.world_mut().resource_mut::<Gamepad>();
            let along = [StickWay::Left, StickWay::Right];
            pad.push_stick(GamepadControl::LeftStick, along, push);
            let offset = |command| {
                let SimCommand::Hand(HandCommand::MoveBy { offset, .. }) = command else {
                    panic!("{command:?}");
                };
                offset.x
            };
            let frames = (0..100).flat_map(|_| test.hold_still());
            frames.map(offset).sum::<f32>()
        };
        let [half, full] = [moved(-0.5), moved(1.0)];
        assert!((-1.6..-1.4).contains(&half), "{half} units in a second");
        assert!((2.8..3.1).contains(&full), "{full} units in a second");
    }

    #[test]
    fn with_the_grid_a_step_goes_to_its_next_line() {
        let mut test = world();
        test.app.insert_resource(Dragging {
            goes_on_top: false,
            snaps_to_grid: true,
            turns_in_steps: true,
            ..default()
        });
        for key in [Tab, Tab] {
            strike(&mut test, &[key]);
        }
        take(&mut test);
        let hand = Hand::Any;
        let location = Vec3::new(5.5, 0.0, 1.0);
        let to = HandCommand::MoveTo { hand, location };
        assert_eq!(strike(&mut test, &[ArrowRight]), [to.into()]);
        let turn = HandCommand::Turn {
            hand,
            axis: Vec3::Z,
            degrees: -15.0,
        };
        assert_eq!(strike(&mut test, &[ShiftLeft, ArrowRight]), [turn.into()]);
    }

    #[test]
    fn hands_have_keys() {
        let mut test = world();
        for (keys, hand) in [
            (&[Digit7][..], Hand::Left),
            (&[Digit8], Hand::Right),
            (&[ShiftLeft, Digit7], Hand::Both),
            (&[ShiftLeft, Digit8], Hand::Any),
        ] {
            let select = SimCommand::Hand(HandCommand::Select(hand));
            assert_eq!(strike(&mut test, keys), [select]);
        }
    }

    #[test]
    fn an_object_that_is_gone_is_chosen_no_longer() {
        let mut test = world();
        strike(&mut test, &[Tab]);
        test.app
            .world_mut()
            .resource_mut::<ObjectIndex>()
            .remove("red");
        assert_eq!(strike(&mut test, &[Enter]), []);
        assert_eq!(*test.app.world().resource::<Chosen>(), Chosen(None));
    }
}
