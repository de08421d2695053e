//! The left mouse button (report sections 4.2 and 4.3): a click takes an object, dragging moves it, a press anywhere else
//! lets it go. In the level plane a drag does all three at once. A drag of an axis's arrow turns what is held.

use bevy::{input::mouse::MouseWheel, prelude::*};
use tabletop_core::{
    Actor, CommandWriter, HandCommand, Hands, ObjectSpec, Paused, SimTick, TICKS_PER_SECOND, Table,
};
use tabletop_user::{Chosen, DragPlane, Dragging, Measuring, Neighborhood};

use crate::input::{
    around::Around,
    axis_turn::AxisTurn,
    drag::Drag,
    pick::Pickable,
    pointer::{MouseSystems, Pointer, SLACK},
    turns::TurnSums,
    wheel::notches,
};

/// Height, in units, by which a notch of the wheel raises what is dragged in the level plane.
const NOTCH: f32 = 0.25;

/// Change of a place, in units, from which on it is another.
const SAME: f32 = 1e-3;

/// Distance, in units, at which what was dragged has arrived.
const ARRIVED: f32 = 0.01;

/// Ticks within which a hand takes what it has been told to take, unless it cannot.
const LONGEST_TAKING: u64 = 6;

/// Ticks after which what was dragged need not arrive any more: something is in its way.
const LONGEST_SETTLING: u64 = TICKS_PER_SECOND as u64;

/// The purpose of the pressed button.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum MousePress {
    /// Nothing.
    #[default]
    Idle,
    /// A click that takes this object if the button comes up over it.
    Click {
        object: Entity,
        ray: Ray3d,
        cursor: Option<Vec2>,
    },
    /// A drag that began on this object, which the hand has been told to take until this tick.
    Take {
        object: Entity,
        ray: Ray3d,
        until: SimTick,
    },
    /// The object in the selected hand is being moved.
    Drag(Carriage),
    /// The button is up, but the object has not arrived yet.
    Settle { carriage: Carriage, until: SimTick },
    /// The object in the selected hand is being turned.
    Turn(AxisTurn),
}

/// A drag, and where it sends the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Carriage {
    drag: Drag,
    /// The location that the object was last sent to.
    sent: Vec3,
    /// The height, in units, of an object over the highest thing below it in the level plane.
    clearance: f32,
    /// True if the object is let go of in the end.
    lets_go: bool,
}

impl MousePress {
    /// True if the mouse moves or turns something.
    pub fn is_drag(&self) -> bool {
        match self {
            Self::Idle | Self::Click { .. } => false,
            Self::Take { .. } | Self::Drag(_) | Self::Settle { .. } | Self::Turn(_) => true,
        }
    }

    /// True if the wheel raises what the mouse moves.
    pub fn has_wheel(&self) -> bool {
        matches!(self, Self::Drag(carriage) if carriage.drag.is_level())
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<MousePress>()
        .init_resource::<Pointer>()
        .init_resource::<TurnSums>()
        .add_message::<MouseWheel>()
        .configure_sets(
            RunFixedMainLoop,
            MouseSystems.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
        )
        .add_systems(
            RunFixedMainLoop,
            (
                forget_press.run_if(not(acts)),
                (press, begin, raise, drag, turn, come_up, settle)
                    .chain()
                    .run_if(acts),
            )
                .in_set(MouseSystems),
        );
}

/// True if the button is the hands'.
fn acts(paused: Res<Paused>, measuring: Res<Measuring>) -> bool {
    !paused.0 && !measuring.is_on
}

fn forget_press(mut press: ResMut<MousePress>) {
    press.set_if_neq(MousePress::Idle);
}

/// The button goes down: on the held object a drag begins, on an arrow a turn, and anywhere else the hand lets go; with an empty hand a click
/// begins.
fn press(
    buttons: Res<ButtonInput<MouseButton>>,
    pointer: Res<Pointer>,
    pickable: Pickable,
    hands: Res<Hands>,
    plane: Res<DragPlane>,
    dragging: Res<Dragging>,
    turns: Res<TurnSums>,
    around: Around,
    mut chosen: ResMut<Chosen>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    if !buttons.just_pressed(MouseButton::Left) || pointer.is_panels {
        return;
    }
    let Some(ray) = pointer.ray else {
        return;
    };
    chosen.set_if_neq(Chosen(None));
    let hand = hands.selected;
    let picked = pickable.object_along(ray);
    let click = picked.map_or(MousePress::Idle, |object| MousePress::Click {
        object,
        ray,
        cursor: pointer.cursor,
    });
    let Some(held) = hands.held_by(hand) else {
        *press = click;
        return;
    };
    let neighborhood = around.of(held);
    let turned = neighborhood
        .as_ref()
        .and_then(|there| AxisTurn::start(hand, there.here, ray, turns.of(hand)));
    *press = if picked == Some(held) {
        let carriage = Carriage::start(held, &around, *plane, ray, false);
        carriage.map_or(MousePress::Idle, MousePress::Drag)
    } else if let (None, Some(turned)) = (picked, turned) {
        MousePress::Turn(turned)
    } else {
        commands.write(Actor::Mouse, HandCommand::Release(hand));
        match dragging.is_level {
            true => click,
            false => MousePress::Idle,
        }
    };
}

/// In the level plane, a click whose cursor moves becomes a drag: the hand takes the object, and when it has it, the drag begins.
fn begin(
    pointer: Res<Pointer>,
    hands: Res<Hands>,
    plane: Res<DragPlane>,
    dragging: Res<Dragging>,
    around: Around,
    specs: Query<&ObjectSpec>,
    tick: Res<SimTick>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    let hand = hands.selected;
    match *press {
        MousePress::Click {
            object,
            ray,
            cursor,
        } if dragging.is_level && has_moved(cursor, pointer.cursor) => {
            if let Ok(spec) = specs.get(object) {
                let grasp = HandCommand::Grasp {
                    hand,
                    object: spec.id.clone(),
                };
                commands.write(Actor::Mouse, grasp);
                *press = MousePress::Take {
                    object,
                    ray,
                    until: SimTick(tick.0 + LONGEST_TAKING),
                };
            }
        }
        MousePress::Take { object, ray, .. } if hands.held_by(hand) == Some(object) => {
            let carriage = Carriage::start(object, &around, *plane, ray, true);
            *press = carriage.map_or(MousePress::Idle, MousePress::Drag);
        }
        MousePress::Take { until, .. } if *tick >= until => *press = MousePress::Idle,
        MousePress::Idle
        | MousePress::Click { .. }
        | MousePress::Take { .. }
        | MousePress::Drag(_)
        | MousePress::Settle { .. }
        | MousePress::Turn(_) => {}
    }
}

fn has_moved(from: Option<Vec2>, to: Option<Vec2>) -> bool {
    from.zip(to)
        .is_some_and(|(from, to)| from.distance(to) > SLACK)
}

/// The wheel raises or lowers what is dragged in the level plane.
fn raise(
    mut wheel: MessageReader<MouseWheel>,
    pointer: Res<Pointer>,
    mut press: ResMut<MousePress>,
) {
    let by = NOTCH * wheel.read().map(notches).sum::<f32>();
    let (MousePress::Drag(carriage), Some(ray)) = (*press, pointer.ray) else {
        return;
    };
    if by != 0.0 && carriage.drag.is_level() {
        *press = MousePress::Drag(Carriage {
            drag: carriage.drag.raised(by, ray),
            clearance: (carriage.clearance + by).max(0.0),
            ..carriage
        });
    }
}

/// The cursor moves, and the dragged object with it. Outside the window the object stays where it is.
fn drag(
    pointer: Res<Pointer>,
    hands: Res<Hands>,
    plane: Res<DragPlane>,
    dragging: Res<Dragging>,
    around: Around,
    tables: Query<&Table>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    let (MousePress::Drag(carriage), Some(ray)) = (*press, pointer.ray) else {
        return;
    };
    let side = DragPlane::side(&tables.iter().next().copied().unwrap_or_default());
    let hand = hands.selected;
    let moved = around
        .of(carriage.drag.object)
        .filter(|_| hands.held_by(hand) == Some(carriage.drag.object))
        .and_then(|there| {
            let drag = carriage
                .drag
                .follow(ray, there.here, plane.normal(), side)?;
            let clearance = match drag.is_parallel_to(&carriage.drag) {
                true => carriage.clearance,
                false => there.clearance(),
            };
            let carriage = Carriage {
                drag,
                clearance,
                ..carriage
            };
            Some(carriage.sent_on(&there, &dragging))
        });
    let Some(moved) = moved else {
        *press = MousePress::Idle;
        return;
    };
    if moved.sent != carriage.sent {
        commands.write(Actor::Mouse, moved.command(&hands));
    }
    press.set_if_neq(MousePress::Drag(moved));
}

/// The arrow of an axis is dragged.
fn turn(
    pointer: Res<Pointer>,
    hands: Res<Hands>,
    dragging: Res<Dragging>,
    mut turns: ResMut<TurnSums>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    let MousePress::Turn(turn) = *press else {
        return;
    };
    if hands.selected != turn.hand || hands.held_by(turn.hand).is_none() {
        *press = MousePress::Idle;
    } else if let Some(degrees) = pointer.ray.and_then(|ray| turn.degrees(ray)) {
        let degrees = dragging.turned_to(degrees);
        commands.write_batch(Actor::Mouse, turns.turn_to(turn.hand, turn.axis, degrees));
    }
}

/// The button comes up: a drag ends, and a click takes the object that it began on.
fn come_up(
    buttons: Res<ButtonInput<MouseButton>>,
    pointer: Res<Pointer>,
    pickable: Pickable,
    hands: Res<Hands>,
    specs: Query<&ObjectSpec>,
    tick: Res<SimTick>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    if buttons.pressed(MouseButton::Left) {
        return;
    }
    match *press {
        MousePress::Click { object, .. } => {
            if !pointer.is_panels
                && pointer.ray.and_then(|ray| pickable.object_along(ray)) == Some(object)
                && let Ok(spec) = specs.get(object)
            {
                commands.write(
                    Actor::Mouse,
                    HandCommand::Grasp {
                        hand: hands.selected,
                        object: spec.id.clone(),
                    },
                );
            }
            *press = MousePress::Idle;
        }
        MousePress::Drag(carriage) if carriage.drag.is_level() || carriage.lets_go => {
            *press = MousePress::Settle {
                carriage,
                until: SimTick(tick.0 + LONGEST_SETTLING),
            };
        }
        MousePress::Drag(_) | MousePress::Turn(_) => *press = MousePress::Idle,
        // A stroke may be so short that the hand has not taken the object yet.
        MousePress::Idle | MousePress::Take { .. } | MousePress::Settle { .. } => {}
    }
}

/// After a drag in the level plane the object still goes its way, and the hand that took it for the drag lets it go.
fn settle(
    hands: Res<Hands>,
    dragging: Res<Dragging>,
    around: Around,
    tick: Res<SimTick>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    let MousePress::Settle { carriage, until } = *press else {
        return;
    };
    let hand = hands.selected;
    let there = around.of(carriage.drag.object);
    let Some(there) = there.filter(|_| hands.held_by(hand) == Some(carriage.drag.object)) else {
        *press = MousePress::Idle;
        return;
    };
    let moved = carriage.sent_on(&there, &dragging);
    let has_arrived = moved.sent == carriage.sent && there.here.distance(moved.sent) < ARRIVED;
    if moved.sent != carriage.sent {
        commands.write(Actor::Mouse, moved.command(&hands));
    }
    *press = MousePress::Settle {
        carriage: moved,
        until,
    };
    if has_arrived || *tick >= until {
        if carriage.lets_go {
            commands.write(Actor::Mouse, HandCommand::Release(hand));
        }
        *press = MousePress::Idle;
    }
}

impl Carriage {
    fn start(
        object: Entity,
        around: &Around,
        plane: DragPlane,
        ray: Ray3d,
        lets_go: bool,
    ) -> Option<Self> {
        let there = around.of(object)?;
        Some(Self {
            drag: Drag::start(object, there.here, plane.normal(), ray)?,
            sent: there.here,
            clearance: there.clearance(),
            lets_go,
        })
    }

    /// The drag after the object has been sent on towards its goal.
    fn sent_on(self, there: &Neighborhood, dragging: &Dragging) -> Self {
        let goal = self.drag.goal;
        let next = match self.drag.is_level() && dragging.goes_on_top {
            true => there.way_to(there.on_top(dragging, goal, self.clearance)),
            false => there.snapped(dragging, goal),
        };
        match next.distance(self.sent) < SAME {
            true => self,
            false => Self { sent: next, ..self },
        }
    }

    fn command(&self, hands: &Hands) -> HandCommand {
        HandCommand::MoveTo {
            hand: hands.selected,
            location: self.sent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::{TestWorld, towards};
    use tabletop_core::{Hand, SimCommand};

    const ABOVE_TABLE: Vec3 = Vec3::new(6.0, 3.0, 0.0);

    /// A world in which the mouse drags in the level plane.
    fn level() -> TestWorld {
        let mut test = TestWorld::new(plugin);
        test.app.insert_resource(Dragging {
            is_level: true,
            ..default()
        });
        test.app.insert_resource(DragPlane {
            is_level: true,
            ..default()
        });
        test
    }

    /// Points at a point, with the cursor at these pixels.
    fn point(test: &mut TestWorld, cursor: f32, at: Vec3) {
        test.app.insert_resource(Pointer {
            ray: Some(towards(at)),
            cursor: Some(Vec2::splat(cursor)),
            is_panels: false,
        });
    }

    fn hold_at(test: &mut TestWorld, object: Entity, place: Vec3) {
        let world = test.app.world_mut();
        let hand = world.resource::<Hands>().selected;
        world.resource_mut::<Hands>().set_held(hand, Some(object));
        world.get_mut::<Transform>(object).unwrap().translation = place;
    }

    fn sent(commands: &[SimCommand]) -> Vec3 {
        match commands {
            [SimCommand::Hand(HandCommand::MoveTo { location, .. })] => *location,
            other => panic!("{other:?}"),
        }
    }

    fn grasp(hand: Hand, id: &str) -> SimCommand {
        SimCommand::Hand(HandCommand::Grasp {
            hand,
            object: id.into(),
        })
    }

    #[test]
    fn an_object_is_taken_when_the_button_comes_up() {
        let mut test = TestWorld::new(plugin);
        test.block("red", Vec3::Z);
        test.point_at(Vec3::Z);
        assert_eq!(test.press(), []);
        assert_eq!(test.hold_still(), []);
        assert_eq!(test.come_up(), [grasp(Hand::Any, "red")]);
        assert_eq!(test.hold_still(), []);
    }

    #[test]
    fn a_click_begins_and_ends_on_the_same_object() {
        let mut test = TestWorld::new(plugin);
        test.block("red", Vec3::Z);
        test.block("blue", Vec3::new(5.0, 0.0, 1.0));
        for (down, up) in [
            (Vec3::Z, ABOVE_TABLE),
            (ABOVE_TABLE, Vec3::Z),
            (Vec3::Z, Vec3::new(5.0, 0.0, 1.0)),
        ] {
            test.point_at(down);
            test.press();
            test.point_at(up);
            assert_eq!(test.come_up(), []);
        }
    }

    #[test]
    fn a_press_beside_the_held_object_releases_it_and_takes_nothing() {
        let mut test = TestWorld::new(plugin);
        test.hold("red", Vec3::Z);
        test.block("blue", Vec3::new(5.0, 0.0, 1.0));
        for beside in [ABOVE_TABLE, Vec3::new(5.0, 0.0, 1.0)] {
            test.point_at(beside);
            assert_eq!(
                test.press(),
                [SimCommand::Hand(HandCommand::Release(Hand::Any))]
            );
            assert_eq!(test.come_up(), []);
        }
    }

    #[test]
    fn a_press_on_a_panel_is_the_panels() {
        let mut test = TestWorld::new(plugin);
        test.hold("red", Vec3::Z);
        test.point_at(ABOVE_TABLE);
        test.point_at_panel();
        assert_eq!(test.press(), []);
        assert_eq!(test.come_up(), []);
    }

    #[test]
    fn the_held_object_follows_the_cursor_while_the_button_is_down() {
        let mut test = TestWorld::new(plugin);
        let red = test.hold("red", Vec3::Z);
        test.point_at(Vec3::Z);
        assert_eq!(test.press(), []);
        test.point_at(Vec3::new(3.0, 0.0, 4.0));
        let commands = test.hold_still();
        let [SimCommand::Hand(HandCommand::MoveTo { hand, location })] = commands[..] else {
            panic!("{commands:?}");
        };
        assert_eq!(hand, Hand::Any);
        assert!(location.distance(Vec3::new(3.0, 0.0, 4.0)) < 1e-4);
        assert_eq!(test.hold_still(), []);
        assert!(test.app.world().resource::<MousePress>().is_drag());
        assert_eq!(test.come_up(), []);
        test.point_at(Vec3::Z * 3.0);
        assert_eq!(test.hold_still(), []);
        assert_eq!(test.held(), Some(red));
    }

    #[test]
    fn a_drag_ends_with_the_hold_the_selection_or_a_pause() {
        let end_by: [fn(&mut TestWorld); 4] = [
            |test| test.let_go(),
            |test| test.app.world_mut().resource_mut::<Hands>().selected = Hand::Left,
            |test| test.app.world_mut().resource_mut::<Paused>().0 = true,
            |test| test.look_along(Ray3d::new(towards(Vec3::Z).origin, Dir3::NEG_Y)),
        ];
        for end in end_by {
            let mut test = TestWorld::new(plugin);
            test.hold("red", Vec3::Z);
            test.point_at(Vec3::Z);
            test.press();
            assert!(test.app.world().resource::<MousePress>().is_drag());
            end(&mut test);
            assert_eq!(test.hold_still(), []);
            assert!(!test.app.world().resource::<MousePress>().is_drag());
        }
    }

    #[test]
    fn outside_the_window_a_drag_waits() {
        let mut test = TestWorld::new(plugin);
        test.hold("red", Vec3::Z);
        test.point_at(Vec3::Z);
        test.press();
        test.point_nowhere();
        assert_eq!(test.hold_still(), []);
        test.point_at(Vec3::Z * 2.0);
        assert_eq!(test.hold_still().len(), 1);
    }

    #[test]
    fn a_pause_stops_clicks() {
        let mut test = TestWorld::new(plugin);
        test.block("red", Vec3::Z);
        test.app.world_mut().resource_mut::<Paused>().0 = true;
        test.point_at(Vec3::Z);
        assert_eq!(test.press(), []);
        assert_eq!(test.come_up(), []);
    }

    #[test]
    fn in_the_level_plane_a_drag_takes_moves_and_lets_go() {
        let mut test = level();
        let red = test.block("red", Vec3::Z);
        point(&mut test, 100.0, Vec3::Z);
        assert_eq!(test.press(), []);
        let to = Vec3::new(-4.0, 2.0, 1.0);
        point(&mut test, 150.0, to);
        assert_eq!(test.hold_still(), [grasp(Hand::Any, "red")]);
        hold_at(&mut test, red, Vec3::Z);
        let location = sent(&test.hold_still());
        assert!(location.distance(to) < 0.05, "{location}");
        hold_at(&mut test, red, location);
        let released = SimCommand::Hand(HandCommand::Release(Hand::Any));
        assert_eq!(test.come_up(), [released]);
    }

    #[test]
    fn a_stroke_that_is_over_before_the_hand_has_taken_the_object_still_moves_it() {
        let mut test = level();
        let red = test.block("red", Vec3::Z);
        point(&mut test, 100.0, Vec3::Z);
        test.press();
        let to = Vec3::new(-4.0, 2.0, 1.0);
        point(&mut test, 150.0, to);
        assert_eq!(test.come_up(), [grasp(Hand::Any, "red")]);
        hold_at(&mut test, red, Vec3::Z);
        let location = sent(&test.hold_still());
        assert!(location.distance(to) < 0.05, "{location}");
        hold_at(&mut test, red, location);
        let released = SimCommand::Hand(HandCommand::Release(Hand::Any));
        assert_eq!(test.hold_still(), [released]);
    }

    #[test]
    fn what_was_taken_for_a_drag_is_let_go_of_in_the_upright_plane_too() {
        let mut test = level();
        let red = test.block("red", Vec3::Z);
        point(&mut test, 100.0, Vec3::Z);
        test.press();
        point(&mut test, 150.0, Vec3::new(2.0, 0.0, 1.0));
        test.hold_still();
        hold_at(&mut test, red, Vec3::Z);
        test.hold_still();
        test.app.insert_resource(DragPlane::default());
        test.hold_still();
        point(&mut test, 200.0, Vec3::new(2.0, 0.0, 3.0));
        let raised = test.hold_still();
        hold_at(&mut test, red, sent(&raised));
        let released = SimCommand::Hand(HandCommand::Release(Hand::Any));
        assert_eq!(test.come_up(), [released]);
    }

    #[test]
    fn a_hand_that_cannot_take_an_object_drags_nothing() {
        let mut test = level();
        test.block("red", Vec3::Z);
        point(&mut test, 100.0, Vec3::Z);
        test.press();
        point(&mut test, 150.0, Vec3::X);
        test.hold_still();
        (0..=LONGEST_TAKING).for_each(|_| assert_eq!(test.hold_still(), []));
        assert_eq!(*test.app.world().resource::<MousePress>(), MousePress::Idle);
    }

    #[test]
    fn what_is_dragged_over_another_object_goes_up_and_then_onto_it() {
        let mut test = level();
        test.block("blue", Vec3::new(5.0, 0.0, 1.0));
        let red = test.hold("red", Vec3::Z);
        point(&mut test, 100.0, Vec3::Z);
        test.press();
        point(&mut test, 150.0, Vec3::new(5.0, 0.0, 1.0));
        let up = sent(&test.hold_still());
        assert!(up.distance(Vec3::Z * 3.0) < 0.05, "{up}");
        hold_at(&mut test, red, up);
        // The button is up before the object has arrived.
        let onto = sent(&test.come_up());
        assert!(onto.distance(Vec3::new(5.0, 0.0, 3.0)) < 0.05, "{onto}");
        hold_at(&mut test, red, onto);
        assert_eq!(test.hold_still(), [], "it was held before the drag");
        assert_eq!(*test.app.world().resource::<MousePress>(), MousePress::Idle);
    }

    #[test]
    fn the_wheel_raises_what_is_dragged_in_the_level_plane() {
        let mut test = level();
        test.hold("red", Vec3::Z);
        point(&mut test, 100.0, Vec3::Z);
        test.press();
        test.app.world_mut().write_message(MouseWheel {
            unit: bevy::input::mouse::MouseScrollUnit::Line,
            x: 0.0,
            y: 4.0,
            window: Entity::PLACEHOLDER,
            phase: bevy::input::touch::TouchPhase::Moved,
        });
        let raised = sent(&test.hold_still());
        assert!(raised.distance(Vec3::Z * 2.0) < 0.05, "{raised}");
    }

    #[test]
    fn what_is_in_the_way_does_not_hold_a_drag_for_ever() {
        let mut test = level();
        test.hold("red", Vec3::Z);
        point(&mut test, 100.0, Vec3::Z);
        test.press();
        point(&mut test, 150.0, Vec3::new(-4.0, 0.0, 1.0));
        test.hold_still();
        test.come_up();
        assert!(test.app.world().resource::<MousePress>().is_drag());
        (0..=LONGEST_SETTLING).for_each(|_| _ = test.hold_still());
        assert_eq!(*test.app.world().resource::<MousePress>(), MousePress::Idle);
    }

    #[test]
    fn an_arrow_turns_what_is_held_in_steps_if_wished() {
        for (turns_in_steps, least) in [(false, 1.0), (true, 15.0)] {
            let mut test = TestWorld::new(plugin);
            test.app.insert_resource(Dragging {
                turns_in_steps,
                ..default()
            });
            test.hold("red", Vec3::Z);
            let tip = Vec3::Z * 5.8;
            test.point_at(tip);
            assert_eq!(test.press(), []);
            test.point_at(tip + Vec3::X * 0.7);
            let commands = test.hold_still();
            let [SimCommand::Hand(HandCommand::Turn { axis, degrees, .. })] = commands[..] else {
                panic!("{commands:?}");
            };
            assert_eq!(axis, Vec3::Z);
            assert!(degrees >= least && degrees % least == 0.0, "{degrees}");
            assert_eq!(test.come_up(), []);
        }
    }
}
