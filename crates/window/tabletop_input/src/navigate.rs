//! The mouse moves the user's camera: dragging with the right button orbits the point under the cursor, with Shift or with the middle button
//! it drags the scene along, and the wheel or two fingers approach the point under the cursor. The left button is the hands'.

use bevy::{
    input::{gestures::PinchGesture, mouse::MouseWheel},
    prelude::*,
};
use tabletop_user::{CameraMotion, UserCamera};

use crate::{
    mouse::MousePress,
    pick::Pickable,
    pointer::{Buttons, MouseSystems, Pointer, SLACK, aim},
    wheel::notches,
};

/// The angle of a pixel's way round, in radians.
const TURN: f32 = 0.006;

/// The share of the distance that a notch of the wheel leaves.
const NOTCH: f32 = 0.9;

/// No frame zooms by more notches than this.
const MOST_NOTCHES: f32 = 10.0;

/// The least distance, in units, of the point under a cursor that is on nothing.
const LEAST_DEPTH: f32 = 10.0;

/// The camera's motion while a button is held.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Gesture {
    /// Nothing.
    #[default]
    Idle,
    /// It may still become a click.
    Press {
        button: MouseButton,
        cursor: Vec2,
        /// The surface under the cursor, if there is any.
        surface: Option<Vec3>,
        /// The point under it.
        point: Vec3,
    },
    /// The camera goes round a point.
    Orbit {
        button: MouseButton,
        cursor: Vec2,
        center: Vec3,
    },
    /// A point stays under the cursor.
    Pan { button: MouseButton, point: Vec3 },
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Gesture>()
        .init_resource::<MousePress>()
        .init_resource::<Pointer>()
        .init_resource::<Buttons>()
        .add_message::<MouseWheel>()
        .add_message::<PinchGesture>()
        .add_systems(
            RunFixedMainLoop,
            (come_up, press, drag, zoom)
                .chain()
                .in_set(MouseSystems)
                .after(aim),
        );
}

pub(crate) fn come_up(buttons: Res<Buttons>, mut gesture: ResMut<Gesture>) {
    if gesture
        .button()
        .is_some_and(|button| !buttons.pressed(button))
    {
        *gesture = Gesture::Idle;
    }
}

fn press(
    buttons: Res<Buttons>,
    pointer: Res<Pointer>,
    pickable: Pickable,
    camera: Single<&Transform, With<UserCamera>>,
    mut gesture: ResMut<Gesture>,
) {
    let mut used = [MouseButton::Right, MouseButton::Middle].into_iter();
    let (Some(button), Gesture::Idle) =
        (used.find(|&button| buttons.just_pressed(button)), *gesture)
    else {
        return;
    };
    if let (Some(cursor), Some(ray), false) = (pointer.cursor, pointer.ray, pointer.is_panels) {
        let surface = pickable.surface_along(ray);
        *gesture = Gesture::Press {
            button,
            cursor,
            surface,
            point: surface.unwrap_or_else(|| before_background(ray, camera.forward())),
        };
    }
}

/// The cursor moves: so does the camera. Outside the window it stays where it is.
fn drag(
    keys: Res<ButtonInput<KeyCode>>,
    pointer: Res<Pointer>,
    camera: Single<&Transform, With<UserCamera>>,
    mut gesture: ResMut<Gesture>,
    mut motions: MessageWriter<CameraMotion>,
) {
    let (Some(to), Some(ray)) = (pointer.cursor, pointer.ray) else {
        return;
    };
    let is_shifted = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let begun = gesture.begun(to, is_shifted);
    gesture.set_if_neq(begun);
    match begun {
        Gesture::Orbit {
            button,
            cursor,
            center,
        } if cursor != to => {
            let moved = (to - cursor) * TURN;
            motions.write(CameraMotion::Orbit {
                center,
                angle: -moved.x,
                rise: moved.y,
            });
            *gesture = Gesture::Orbit {
                button,
                cursor: to,
                center,
            };
        }
        Gesture::Pan { point, .. } => {
            let plane = InfinitePlane3d::new(camera.forward());
            let distance = ray.intersect_plane(point, plane);
            let shift = distance.map_or(Vec3::ZERO, |distance| point - ray.get_point(distance));
            if shift != Vec3::ZERO {
                motions.write(CameraMotion::Shift(shift));
            }
        }
        Gesture::Idle | Gesture::Press { .. } | Gesture::Orbit { .. } => {}
    }
}

/// The wheel turns, or two fingers move on the touchpad.
fn zoom(
    mut wheel: MessageReader<MouseWheel>,
    mut pinches: MessageReader<PinchGesture>,
    pointer: Res<Pointer>,
    pickable: Pickable,
    left: Res<MousePress>,
    camera: Single<&Transform, With<UserCamera>>,
    mut motions: MessageWriter<CameraMotion>,
) {
    let notches: f32 = wheel.read().map(notches).sum();
    let magnified: f32 = pinches.read().map(|pinch| pinch.0).sum();
    let factor = NOTCH.powf(notches.clamp(-MOST_NOTCHES, MOST_NOTCHES)) * (-magnified).exp();
    let Some(ray) = pointer
        .ray
        .filter(|_| !pointer.is_panels && !left.has_wheel() && factor != 1.0)
    else {
        return;
    };
    let surface = pickable.surface_along(ray);
    motions.write(CameraMotion::Approach {
        point: surface.unwrap_or_else(|| before_background(ray, camera.forward())),
        factor,
    });
}

/// A point of a line of sight on which nothing is seen: as deep in the picture as the table's centre.
fn before_background(ray: Ray3d, forward: Dir3) -> Vec3 {
    let depth = (-ray.origin).dot(*forward).max(LEAST_DEPTH);
    ray.get_point(depth / ray.direction.dot(*forward).max(f32::EPSILON))
}

impl Gesture {
    fn button(self) -> Option<MouseButton> {
        match self {
            Self::Idle => None,
            Self::Press { button, .. } | Self::Orbit { button, .. } | Self::Pan { button, .. } => {
                Some(button)
            }
        }
    }

    /// The gesture that a press has become when the cursor is here.
    fn begun(self, to: Vec2, is_shifted: bool) -> Self {
        match self {
            Self::Press {
                button,
                cursor,
                surface,
                point,
            } if cursor.distance(to) > SLACK => {
                if is_shifted || button == MouseButton::Middle {
                    Self::Pan { button, point }
                } else {
                    Self::Orbit {
                        button,
                        cursor,
                        center: surface.unwrap_or(Vec3::ZERO),
                    }
                }
            }
            Self::Idle | Self::Press { .. } | Self::Orbit { .. } | Self::Pan { .. } => self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::{EYE, TestWorld, towards};
    use MouseButton::{Left, Middle, Right};
    use bevy::input::mouse::MouseScrollUnit;

    /// A world in which the cursor, at these pixels, points at this point.
    fn world() -> TestWorld {
        TestWorld::new(plugin)
    }

    fn point(test: &mut TestWorld, cursor: [f32; 2], at: Vec3) {
        test.app.insert_resource(Pointer {
            ray: Some(towards(at)),
            cursor: Some(cursor.into()),
            is_panels: false,
        });
    }

    fn press(test: &mut TestWorld, button: MouseButton) {
        let mut buttons = test.app.world_mut().resource_mut::<Buttons>();
        buttons.press(button);
    }

    /// The camera's motions in a frame.
    fn frame(test: &mut TestWorld) -> Vec<CameraMotion> {
        let world = test.app.world_mut();
        world.resource_mut::<Messages<CameraMotion>>().clear();
        test.hold_still();
        let motions = test.app.world().resource::<Messages<CameraMotion>>();
        motions.iter_current_update_messages().copied().collect()
    }

    fn turn_wheel(test: &mut TestWorld, unit: MouseScrollUnit, y: f32) {
        test.app.world_mut().write_message(MouseWheel {
            unit,
            x: 0.0,
            y,
            window: Entity::PLACEHOLDER,
            phase: bevy::input::touch::TouchPhase::Moved,
        });
    }

    #[test]
    fn a_right_drag_orbits_the_point_under_the_cursor() {
        let mut test = world();
        test.block("red", Vec3::Z);
        point(&mut test, [100.0, 100.0], Vec3::Z);
        press(&mut test, Right);
        assert_eq!(frame(&mut test), []);
        point(&mut test, [150.0, 80.0], Vec3::new(3.0, 0.0, 2.0));
        let motions = frame(&mut test);
        let [
            CameraMotion::Orbit {
                center,
                angle,
                rise,
            },
        ] = motions[..]
        else {
            panic!("{motions:?}");
        };
        // The near face of the block, on the way from the eye to its centre.
        assert!(
            (center.y + 1.0).abs() < 1e-4 && center.x.abs() < 1e-4,
            "{center}"
        );
        assert!((angle + 50.0 * TURN).abs() < 1e-6);
        assert!((rise + 20.0 * TURN).abs() < 1e-6);
        assert_eq!(frame(&mut test), []);
        point(&mut test, [150.0, 90.0], Vec3::new(3.0, 0.0, 2.0));
        let motions = frame(&mut test);
        assert!(
            matches!(motions[..], [CameraMotion::Orbit { center: same, .. }] if same == center),
            "{motions:?}"
        );
    }

    #[test]
    fn on_the_background_it_goes_round_the_centre_of_the_table() {
        let mut test = world();
        point(&mut test, [100.0, 100.0], EYE + Vec3::Y + Vec3::Z);
        press(&mut test, Right);
        frame(&mut test);
        point(&mut test, [130.0, 100.0], EYE + Vec3::Y + Vec3::Z);
        let motions = frame(&mut test);
        assert!(
            matches!(
                motions[..],
                [CameraMotion::Orbit {
                    center: Vec3::ZERO,
                    ..
                }]
            ),
            "{motions:?}"
        );
    }

    #[test]
    fn a_click_moves_nothing() {
        for button in [Right, Middle] {
            let mut test = world();
            point(&mut test, [100.0, 100.0], Vec3::ZERO);
            press(&mut test, button);
            assert_eq!(frame(&mut test), []);
            point(&mut test, [102.0, 101.0], Vec3::X * 0.1);
            assert_eq!(frame(&mut test), []);
            let mut buttons = test.app.world_mut().resource_mut::<Buttons>();
            buttons.release(button);
            point(&mut test, [200.0, 100.0], Vec3::X);
            assert_eq!(frame(&mut test), []);
            assert_eq!(*test.app.world().resource::<Gesture>(), Gesture::Idle);
        }
    }

    #[test]
    fn the_left_button_is_the_hands() {
        let mut test = world();
        point(&mut test, [100.0, 100.0], Vec3::ZERO);
        press(&mut test, Left);
        frame(&mut test);
        point(&mut test, [200.0, 100.0], Vec3::X);
        assert_eq!(frame(&mut test), []);
    }

    #[test]
    fn the_middle_button_and_shift_keep_a_point_under_the_cursor() {
        for (button, is_shifted) in [(Middle, false), (Right, true)] {
            let mut test = world();
            let grabbed = Vec3::new(1.0, 2.0, 0.0);
            point(&mut test, [100.0, 100.0], grabbed);
            press(&mut test, button);
            if is_shifted {
                test.keys().press(KeyCode::ShiftLeft);
            }
            frame(&mut test);
            let to = Vec3::new(-2.0, 3.0, 0.0);
            point(&mut test, [150.0, 100.0], to);
            let motions = frame(&mut test);
            let [CameraMotion::Shift(shift)] = motions[..] else {
                panic!("{motions:?}");
            };
            let seen = grabbed - (EYE + shift);
            assert!(seen.angle_between(to - EYE) < 1e-3, "{shift}");
            // The camera looks along Y and does not move that way.
            assert!(shift.y.abs() < 1e-4, "{shift}");
        }
    }

    #[test]
    fn the_wheel_approaches_the_point_under_the_cursor() {
        let mut test = world();
        let at = Vec3::new(1.0, 2.0, 0.0);
        point(&mut test, [100.0, 100.0], at);
        for (unit, y, expected) in [
            (MouseScrollUnit::Line, 1.0, 0.9),
            (MouseScrollUnit::Pixel, 100.0, 0.9),
            (MouseScrollUnit::Line, -2.0, 1.0 / 0.81),
            (MouseScrollUnit::Line, 1e9, NOTCH.powf(MOST_NOTCHES)),
        ] {
            turn_wheel(&mut test, unit, y);
            let motions = frame(&mut test);
            let [CameraMotion::Approach { point, factor }] = motions[..] else {
                panic!("{motions:?}");
            };
            assert!(point.distance(at) < 1e-4, "{point}");
            assert!((factor - expected).abs() < 1e-5, "{factor}");
        }
        test.app.world_mut().write_message(PinchGesture(0.1));
        let motions = frame(&mut test);
        assert!(
            matches!(motions[..], [CameraMotion::Approach { factor, .. }] if factor < 1.0),
            "{motions:?}"
        );
        assert_eq!(frame(&mut test), []);
    }

    #[test]
    fn on_a_panel_the_mouse_is_the_panels() {
        let mut test = world();
        point(&mut test, [100.0, 100.0], Vec3::ZERO);
        test.point_at_panel();
        press(&mut test, Right);
        turn_wheel(&mut test, MouseScrollUnit::Line, 1.0);
        assert_eq!(frame(&mut test), []);
        point(&mut test, [150.0, 100.0], Vec3::X);
        assert_eq!(frame(&mut test), []);
    }
}
