//! The left mouse button (report sections 4.2 and 4.3): a click or a drag takes an object, dragging moves it, a press anywhere else
//! lets it go. In the level plane a drag does all three at once. A drag of an axis's arrow turns what is held.

mod carriage;
#[cfg(test)]
mod tests;

use bevy::{input::mouse::MouseWheel, prelude::*};
use tabletop_core::{
    Actor, CommandWriter, HandCommand, Hands, ObjectSpec, Paused, SimTick, TICKS_PER_SECOND, Table,
};
use tabletop_user::{Chosen, DragPlane, Dragging, KeyboardFocus, Measuring};

use self::carriage::Carriage;
use crate::{
    around::Around,
    axis_turn::AxisTurn,
    pick::Pickable,
    pointer::{Buttons, MouseSystems, Pointer, SLACK},
    turns::TurnSums,
    wheel::notches,
};

/// Height, in units, by which a notch of the wheel raises what is dragged in the level plane.
const NOTCH: f32 = 0.25;

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
    /// A press on this object, which a drag takes.
    Click {
        object: Entity,
        ray: Ray3d,
        cursor: Option<Vec2>,
        /// True if the hand takes it, too, if the button comes up over it.
        grasps: bool,
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
        .init_resource::<Buttons>()
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

/// The button goes down: on the held object a drag begins, on an arrow a turn, and anywhere else the hand lets go. On another object a click
/// begins. If something is being typed, the hand does not let go: what was typed may be where it moves what it holds.
fn press(
    buttons: Res<Buttons>,
    focus: Res<KeyboardFocus>,
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
    let click = |grasps| {
        picked.map_or(MousePress::Idle, |object| MousePress::Click {
            object,
            ray,
            cursor: pointer.cursor,
            grasps,
        })
    };
    let Some(held) = hands.held_by(hand) else {
        *press = click(true);
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
    } else if *focus == KeyboardFocus::Text {
        MousePress::Idle
    } else {
        commands.write(Actor::Mouse, HandCommand::Release(hand));
        click(dragging.is_level)
    };
}

/// A click whose cursor moves becomes a drag: the hand takes the object, and when it has it, the drag begins.
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
            ..
        } if has_moved(cursor, pointer.cursor) => {
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
            let carriage = Carriage::start(object, &around, *plane, ray, dragging.is_level);
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
    buttons: Res<Buttons>,
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
        MousePress::Click { object, grasps, .. } => {
            if grasps
                && !pointer.is_panels
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
