//! The left mouse button (report sections 4.2 and 4.3): a click takes an object, dragging moves it, a press anywhere else
//! lets it go.

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, HandCommand, Hands, ObjectSpec, Paused, Table};
use tabletop_user::DragPlane;

use crate::input::{
    drag::Drag,
    pick::Pickable,
    pointer::{MouseSystems, Pointer},
};

/// The purpose of the pressed button.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum MousePress {
    /// Nothing.
    #[default]
    Idle,
    /// A click that takes this object if the button comes up over it.
    Click(Entity),
    /// The object in the selected hand is being moved.
    Drag(Drag),
}

impl MousePress {
    /// True if the mouse moves something.
    pub fn is_drag(&self) -> bool {
        matches!(self, Self::Drag(_))
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<MousePress>()
        .init_resource::<Pointer>()
        .configure_sets(
            RunFixedMainLoop,
            MouseSystems.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
        )
        .add_systems(
            RunFixedMainLoop,
            (
                forget_press.run_if(not(Paused::is_running)),
                (press, drag, come_up).chain().run_if(Paused::is_running),
            )
                .in_set(MouseSystems),
        );
}

fn forget_press(mut press: ResMut<MousePress>) {
    press.set_if_neq(MousePress::Idle);
}

/// The button goes down: on the held object a drag begins, and anywhere else the hand lets go; with an empty hand a click
/// begins.
fn press(
    buttons: Res<ButtonInput<MouseButton>>,
    pointer: Res<Pointer>,
    pickable: Pickable,
    hands: Res<Hands>,
    plane: Res<DragPlane>,
    places: Query<&Transform>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    if !buttons.just_pressed(MouseButton::Left) || pointer.is_panels {
        return;
    }
    let Some(ray) = pointer.ray else {
        return;
    };
    let picked = pickable.object_along(ray);
    *press = match hands.held_by(hands.selected) {
        None => picked.map_or(MousePress::Idle, MousePress::Click),
        Some(held) if picked == Some(held) => places
            .get(held)
            .ok()
            .and_then(|place| Drag::start(held, place.translation, plane.normal(), ray))
            .map_or(MousePress::Idle, MousePress::Drag),
        Some(_) => {
            commands.write(Actor::Mouse, HandCommand::Release(hands.selected));
            MousePress::Idle
        }
    };
}

/// The cursor moves, and the dragged object with it. Outside the window the object stays where it is.
fn drag(
    pointer: Res<Pointer>,
    hands: Res<Hands>,
    plane: Res<DragPlane>,
    places: Query<&Transform>,
    tables: Query<&Table>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    let (MousePress::Drag(drag), Some(ray)) = (*press, pointer.ray) else {
        return;
    };
    let side = DragPlane::side(&tables.iter().next().copied().unwrap_or_default());
    let hand = hands.selected;
    let moved = places
        .get(drag.object)
        .ok()
        .filter(|_| hands.held_by(hand) == Some(drag.object))
        .and_then(|place| drag.follow(ray, place.translation, plane.normal(), side));
    let Some(moved) = moved else {
        *press = MousePress::Idle;
        return;
    };
    if moved.target != drag.target {
        commands.write(
            Actor::Mouse,
            HandCommand::MoveTo {
                hand,
                location: moved.target,
            },
        );
    }
    press.set_if_neq(MousePress::Drag(moved));
}

/// The button comes up: a drag ends, and a click takes the object that it began on.
fn come_up(
    buttons: Res<ButtonInput<MouseButton>>,
    pointer: Res<Pointer>,
    pickable: Pickable,
    hands: Res<Hands>,
    specs: Query<&ObjectSpec>,
    mut press: ResMut<MousePress>,
    mut commands: CommandWriter,
) {
    if buttons.pressed(MouseButton::Left) {
        return;
    }
    if let MousePress::Click(object) = *press
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
    press.set_if_neq(MousePress::Idle);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::{TestWorld, towards};
    use tabletop_core::{Hand, SimCommand};

    const ABOVE_TABLE: Vec3 = Vec3::new(6.0, 3.0, 0.0);

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
}
