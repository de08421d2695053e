//! The turns of the plane in which objects are dragged (report section 4.3, figure 8d).

use bevy::prelude::*;
use tabletop_core::{Hand, Hands, Paused};
use tabletop_user::{Action, CameraMotion, DragPlane, Dragging, Keys, UserCamera};

use crate::{mouse::MousePress, pointer::MouseSystems};

/// Speed of the plane in radians a second.
const SPEED: f32 = 0.3;

/// The panel's buttons for the plane that are held down.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlaneButtons {
    /// It turns counter-clockwise, seen from above.
    pub counter_clockwise: bool,
    /// It turns clockwise.
    pub clockwise: bool,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<PlaneButtons>().add_systems(
        RunFixedMainLoop,
        (face_camera, turn, swap)
            .chain()
            .in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop)
            .before(MouseSystems)
            .run_if(Paused::is_running),
    );
}

/// Turns the plane towards the camera when the selected hand holds something else than before.
fn face_camera(
    mut before: Local<Option<(Hand, Entity)>>,
    hands: Res<Hands>,
    camera: Single<&Transform, With<UserCamera>>,
    mut plane: ResMut<DragPlane>,
) {
    let held = hands.held_by(hands.selected);
    let now = held.map(|object| (hands.selected, object));
    if now.is_some() && now != *before {
        *plane = DragPlane {
            is_level: plane.is_level,
            ..DragPlane::facing(*camera.forward())
        };
    }
    *before = now;
}

/// Turns the plane about the vertical through the held object, and the camera with it, so that the view of the plane
/// stays the same.
fn turn(
    keys: Keys,
    buttons: Res<PlaneButtons>,
    time: Res<Time>,
    hands: Res<Hands>,
    press: Res<MousePress>,
    places: Query<&Transform>,
    mut plane: ResMut<DragPlane>,
    mut motions: MessageWriter<CameraMotion>,
) {
    let held = hands.held_by(hands.selected);
    let Some(place) = held.and_then(|object| places.get(object).ok()) else {
        return;
    };
    let by_keys = keys.axis(Action::PlaneCounterClockwise, Action::PlaneClockwise);
    let direction = by_keys + direction_of_buttons(*buttons);
    if direction == 0.0 || press.is_drag() {
        return;
    }
    let angle = direction.signum() * SPEED * time.delta_secs();
    plane.heading += angle;
    motions.write(CameraMotion::Orbit {
        center: place.translation,
        angle,
        rise: 0.0,
    });
}

/// While its key is held, the plane at right angles stands in, or for the level plane the upright one that faces the camera; the camera
/// stays.
fn swap(
    keys: Keys,
    dragging: Res<Dragging>,
    camera: Single<&Transform, With<UserCamera>>,
    mut plane: ResMut<DragPlane>,
) {
    let is_level = dragging.is_level && !keys.is_held(Action::PlaneUpright);
    let is_stood_up = plane.is_level && !is_level;
    let heading = match is_stood_up {
        true => DragPlane::facing(*camera.forward()).heading,
        false => plane.heading,
    };
    plane.set_if_neq(DragPlane {
        heading,
        is_perpendicular: keys.is_held(Action::PlanePerpendicular),
        is_level,
    });
}

/// 1 is counter-clockwise as seen from above, -1 is clockwise.
fn direction_of_buttons(buttons: PlaneButtons) -> f32 {
    f32::from(u8::from(buttons.counter_clockwise)) - f32::from(u8::from(buttons.clockwise))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{mouse, test_world::TestWorld};
    use KeyCode::{ControlLeft, ShiftLeft, ShiftRight, Slash};
    use bevy::time::TimeUpdateStrategy;
    use std::{f32::consts::FRAC_PI_2, time::Duration};

    fn holding() -> TestWorld {
        let mut test = TestWorld::new(|app: &mut App| {
            app.add_plugins((mouse::plugin, plugin));
        });
        let frame = Duration::from_millis(10);
        test.app
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
        test.hold("red", Vec3::Z);
        test.hold_still();
        test
    }

    fn plane(test: &TestWorld) -> DragPlane {
        *test.app.world().resource()
    }

    /// Angle of the camera's orbit in a second.
    fn orbited_in_a_second(test: &mut TestWorld) -> f32 {
        let mut angle = 0.0;
        for _ in 0..100 {
            test.app
                .world_mut()
                .resource_mut::<Messages<CameraMotion>>()
                .clear();
            test.hold_still();
            let motions = test.app.world().resource::<Messages<CameraMotion>>();
            for motion in motions.iter_current_update_messages() {
                let CameraMotion::Orbit {
                    center: Vec3::Z,
                    angle: more,
                    rise: 0.0,
                } = motion
                else {
                    panic!("{motion:?}");
                };
                angle += more;
            }
        }
        angle
    }

    fn look_along(test: &mut TestWorld, direction: Vec3) {
        let world = test.app.world_mut();
        let mut cameras = world.query_filtered::<&mut Transform, With<UserCamera>>();
        for mut camera in cameras.iter_mut(world) {
            camera.look_to(direction, Vec3::Z);
        }
    }

    #[test]
    fn the_plane_faces_the_camera_when_something_is_taken_or_selected() {
        let mut test = holding();
        assert!(plane(&test).normal().distance(Vec3::Y) < 1e-6);
        look_along(&mut test, Vec3::new(1.0, 0.0, -1.0));
        test.hold_still();
        assert!(plane(&test).normal().distance(Vec3::Y) < 1e-6);
        let mut hands = test.app.world_mut().resource_mut::<Hands>();
        hands.selected = Hand::Left;
        test.hold("blue", Vec3::Z * 5.0);
        test.hold_still();
        assert!(plane(&test).normal().distance(Vec3::X) < 1e-6);
    }

    #[test]
    fn slash_turns_plane_and_camera_counter_clockwise_and_with_shift_clockwise() {
        for (keys, angle) in [
            (&[Slash][..], 0.3),
            (&[Slash, ShiftRight], -0.3),
            (&[], 0.0),
        ] {
            let mut test = holding();
            keys.iter().for_each(|&key| test.keys().press(key));
            assert!((orbited_in_a_second(&mut test) - angle).abs() < 1e-4);
            assert!((plane(&test).heading - angle).abs() < 1e-4);
        }
    }

    #[test]
    fn the_panels_buttons_act_like_the_keys() {
        let mut test = holding();
        test.app.insert_resource(PlaneButtons {
            clockwise: true,
            ..default()
        });
        assert!((orbited_in_a_second(&mut test) + 0.3).abs() < 1e-4);
    }

    #[test]
    fn an_empty_hand_a_drag_or_a_pause_turns_nothing() {
        let prevent_by: [fn(&mut TestWorld); 3] = [
            |test| test.let_go(),
            |test| {
                test.point_at(Vec3::Z);
                test.press();
            },
            |test| test.app.world_mut().resource_mut::<Paused>().0 = true,
        ];
        for prevent in prevent_by {
            let mut test = holding();
            prevent(&mut test);
            test.keys().press(Slash);
            assert_eq!(orbited_in_a_second(&mut test), 0.0);
            assert_eq!(plane(&test).heading, 0.0);
        }
    }

    #[test]
    fn left_ctrl_shows_the_perpendicular_plane_while_it_is_held() {
        let mut test = holding();
        test.keys().press(ControlLeft);
        assert_eq!(orbited_in_a_second(&mut test), 0.0);
        let turned = Quat::from_rotation_z(FRAC_PI_2) * Vec3::Y;
        assert!(plane(&test).normal().distance(turned) < 1e-6);
        test.keys().release(ControlLeft);
        test.hold_still();
        assert!(plane(&test).normal().distance(Vec3::Y) < 1e-6);
    }

    #[test]
    fn shift_stands_the_level_plane_up_before_the_camera() {
        let mut test = holding();
        test.keys().press(ShiftLeft);
        test.hold_still();
        assert!(
            plane(&test).normal().distance(Vec3::Y) < 1e-6,
            "upright anyway"
        );
        test.keys().release(ShiftLeft);
        test.app.insert_resource(Dragging {
            is_level: true,
            ..default()
        });
        test.hold_still();
        assert!(plane(&test).normal().distance(Vec3::Z) < 1e-6);
        look_along(&mut test, Vec3::new(1.0, 0.0, -1.0));
        test.keys().press(ShiftLeft);
        test.hold_still();
        assert!(plane(&test).normal().distance(Vec3::X) < 1e-6);
        test.keys().release(ShiftLeft);
        test.hold_still();
        assert!(plane(&test).normal().distance(Vec3::Z) < 1e-6);
    }

    #[test]
    fn a_drag_goes_on_in_the_perpendicular_plane() {
        let mut test = holding();
        test.let_go();
        // Beside the camera, which therefore does not see the perpendicular plane edge-on.
        let location = Vec3::new(4.0, 0.0, 1.0);
        test.hold("blue", location);
        test.hold_still();
        test.point_at(location);
        test.press();
        test.keys().press(ControlLeft);
        assert_eq!(test.hold_still(), []);
        test.point_at(location + Vec3::new(0.0, 2.0, 3.0));
        let commands = test.hold_still();
        let [
            tabletop_core::SimCommand::Hand(tabletop_core::HandCommand::MoveTo {
                location: to,
                ..
            }),
        ] = commands[..]
        else {
            panic!("{commands:?}");
        };
        let moved = to - location;
        assert!(moved.distance(Vec3::new(0.0, 2.0, 3.0)) < 1e-3, "{moved}");
    }
}
