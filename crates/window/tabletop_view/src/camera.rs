//! The user's camera, its keys, and the requests of panels and mouse.

use bevy::{
    camera::{ClearColorConfig, PerspectiveProjection},
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    light::cluster::ClusterConfig,
    prelude::*,
    render::view::NoIndirectDrawing,
};
use tabletop_core::{Hands, HeadCamera, Paused, Table};
use tabletop_user::{
    Action, CameraMotion, CameraView, FirstView, KeySystems, Keys, Steering, UserCamera,
};

use crate::viewpoint::Viewpoint;

/// Vertical field of view in degrees.
const FIELD_OF_VIEW: f32 = 45.0;

/// Nearest visible distance in units.
const NEAR: f32 = 0.01;

/// Speed of the keys in units/s, and in rad/s.
const SPEED: f32 = 10.0;
const TURN: f32 = 1.0;

/// The longest time for which a frame steers, in seconds.
const LONGEST_FRAME: f32 = 0.25;

/// The longest time for which the first one does: before it, nobody did for most of the time since the last frame.
const LONGEST_FIRST_FRAME: f32 = 1.0 / 60.0;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<FirstView>()
        .add_systems(Startup, spawn_camera)
        .add_systems(
            RunFixedMainLoop,
            (
                steer_with_keys.run_if(Paused::is_running),
                choose_view_with_keys,
            )
                .chain()
                .in_set(KeySystems),
        )
        .add_systems(
            RunFixedMainLoop,
            (
                look_at_first_table,
                steer_with_panels.run_if(Paused::is_running),
                carry_out_motions,
                place_camera,
            )
                .chain()
                .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
        );
}

fn spawn_camera(mut commands: Commands) {
    commands.spawn((
        UserCamera,
        Viewpoint::of_table(&Table::default()),
        Camera3d::default(),
        Camera {
            clear_color: ClearColorConfig::Custom(Color::BLACK),
            ..default()
        },
        Projection::Perspective(PerspectiveProjection {
            fov: FIELD_OF_VIEW.to_radians(),
            near: NEAR,
            ..default()
        }),
        Msaa::Sample4,
        // Surfaces are lit in display values; nothing may change them afterwards.
        (Tonemapping::None, DebandDither::Disabled),
        // There are no lights to sort, and too few things to be worth sorting on the graphics card: without both, a
        // picture is drawn faster where the processor draws it.
        (ClusterConfig::Single, NoIndirectDrawing),
    ));
}

fn look_at_first_table(
    mut has_looked: Local<bool>,
    tables: Query<&Table>,
    first: Res<FirstView>,
    mut motions: MessageWriter<CameraMotion>,
) {
    if !*has_looked && !tables.is_empty() {
        motions.write(CameraMotion::Look(first.0));
        *has_looked = true;
    }
}

fn steer_with_keys(
    keys: Keys,
    time: Res<Time<Real>>,
    mut is_steered: Local<bool>,
    mut cameras: Query<&mut Viewpoint, With<UserCamera>>,
) {
    steer(steering(&keys), &time, &mut is_steered, &mut cameras);
}

fn steer_with_panels(
    steering: Res<Steering>,
    time: Res<Time<Real>>,
    mut is_steered: Local<bool>,
    mut cameras: Query<&mut Viewpoint, With<UserCamera>>,
) {
    steer(*steering, &time, &mut is_steered, &mut cameras);
}

fn steer(
    steering: Steering,
    time: &Time<Real>,
    is_steered: &mut bool,
    cameras: &mut Query<&mut Viewpoint, With<UserCamera>>,
) {
    let longest = match *is_steered {
        true => LONGEST_FRAME,
        false => LONGEST_FIRST_FRAME,
    };
    *is_steered = steering != Steering::default();
    for mut viewpoint in cameras {
        let steered = viewpoint.steered(steering, time.delta_secs().min(longest));
        viewpoint.set_if_neq(steered);
    }
}

fn choose_view_with_keys(keys: Keys, mut motions: MessageWriter<CameraMotion>) {
    for (action, view) in [
        (Action::ViewStart, CameraView::Start),
        (Action::ViewTop, CameraView::Top),
        (Action::ViewFront, CameraView::Front),
        (Action::ViewRobotEye, CameraView::RobotEye),
    ] {
        if keys.was_struck(action) {
            motions.write(CameraMotion::Look(view));
        }
    }
}

fn carry_out_motions(
    mut motions: MessageReader<CameraMotion>,
    tables: Query<&Table>,
    head: Option<Res<HeadCamera>>,
    hands: Res<Hands>,
    places: Query<&Transform, Without<UserCamera>>,
    mut cameras: Query<(&mut Viewpoint, &Projection), With<UserCamera>>,
) {
    let table = tables.iter().next().copied().unwrap_or_default();
    let held = hands.held_by(hands.selected);
    let center = held.and_then(|object| places.get(object).ok());
    for motion in motions.read() {
        for (mut viewpoint, projection) in &mut cameras {
            let moved = match *motion {
                CameraMotion::Orbit {
                    center,
                    angle,
                    rise,
                } => viewpoint.orbited(center, angle, rise),
                CameraMotion::Shift(by) => viewpoint.shifted(by),
                CameraMotion::Approach { point, factor } => viewpoint.approached(point, factor),
                CameraMotion::Look(CameraView::Start) => Viewpoint::of_table(&table),
                CameraMotion::Look(CameraView::Top) => {
                    Viewpoint::from_above(&table, picture_of(projection))
                }
                CameraMotion::Look(CameraView::Front) => {
                    Viewpoint::from_front(&table, picture_of(projection))
                }
                CameraMotion::Look(CameraView::Across) => Viewpoint::across(&table),
                CameraMotion::Look(CameraView::RobotEye) => {
                    let head = head.as_deref().copied().unwrap_or_default();
                    Viewpoint::of_camera(head.pose(&table))
                }
                CameraMotion::Look(CameraView::Center) => {
                    viewpoint.centered(center.map_or(Vec3::ZERO, |place| place.translation))
                }
            };
            viewpoint.set_if_neq(moved);
        }
    }
}

/// The picture's size to the right and upwards at a distance of 1.
fn picture_of(projection: &Projection) -> Vec2 {
    let (up, aspect) = match projection {
        Projection::Perspective(PerspectiveProjection {
            fov, aspect_ratio, ..
        }) => ((fov / 2.0).tan(), *aspect_ratio),
        Projection::Orthographic(_) | Projection::Custom(_) => (1.0, 1.0),
    };
    Vec2::new(up * aspect, up)
}

fn place_camera(mut cameras: Query<(&Viewpoint, &mut Transform), Changed<Viewpoint>>) {
    for (viewpoint, mut transform) in &mut cameras {
        *transform = (*viewpoint).into();
    }
}

/// The camera's motion that the keys ask for.
fn steering(keys: &Keys) -> Steering {
    Steering {
        forward: SPEED * keys.axis(Action::CameraForward, Action::CameraBack),
        right: SPEED * keys.axis(Action::CameraRight, Action::CameraLeft),
        up: SPEED * keys.axis(Action::CameraUp, Action::CameraDown),
        turn_left: TURN * keys.axis(Action::LookLeft, Action::LookRight),
        turn_up: TURN * keys.axis(Action::LookUp, Action::LookDown),
    }
}

#[cfg(test)]
mod tests {
    use tabletop_user::UserPlugin;

    use super::*;
    use bevy::{ecs::system::RunSystemOnce as _, time::TimeUpdateStrategy};
    use std::time::Duration;
    use tabletop_core::CorePlugin;

    fn app(milliseconds_a_frame: u64) -> App {
        let mut app = App::new();
        let frame = Duration::from_millis(milliseconds_a_frame);
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame))
            .init_resource::<ButtonInput<KeyCode>>()
            .add_plugins(plugin);
        app.finish();
        app.cleanup();
        app.update();
        app
    }

    fn press(app: &mut App, key: KeyCode) {
        let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
        keys.press(key);
    }

    fn location(app: &mut App) -> Vec3 {
        let mut cameras = app.world_mut().query::<(&UserCamera, &Transform)>();
        cameras.single(app.world()).unwrap().1.translation
    }

    #[test]
    fn a_key_moves_the_camera_as_far_at_any_frame_rate() {
        for (milliseconds, frames) in [(10, 100), (50, 20)] {
            let mut app = app(milliseconds);
            press(&mut app, KeyCode::KeyQ);
            app.update();
            let start = location(&mut app).z;
            for _ in 0..frames {
                app.update();
            }
            let climbed = location(&mut app).z - start;
            assert!(
                (climbed - 10.0).abs() < 1e-3,
                "{climbed} at {milliseconds} ms a frame"
            );
        }
    }

    #[test]
    fn a_pause_holds_the_camera() {
        let mut app = app(10);
        press(&mut app, KeyCode::KeyQ);
        app.insert_resource(Paused(true));
        app.update();
        assert_eq!(location(&mut app).z, 14.0);
        app.insert_resource(Paused(false));
        app.update();
        assert!(location(&mut app).z > 14.0);
    }

    #[test]
    fn the_first_frame_of_a_press_counts_no_longer_than_the_press() {
        let mut app = app(200);
        press(&mut app, KeyCode::KeyQ);
        app.update();
        assert!(location(&mut app).z < 14.2);
    }

    #[test]
    fn panels_steer_the_camera_as_long_as_they_ask_for_it() {
        let mut app = app(10);
        app.insert_resource(Steering {
            up: 9.0,
            ..default()
        });
        for _ in 0..100 {
            app.update();
        }
        assert!((location(&mut app).z - 23.0).abs() < 1e-3);
        app.insert_resource(Steering::default());
        app.update();
        assert!((location(&mut app).z - 23.0).abs() < 1e-3);
    }

    #[test]
    fn the_camera_moves_at_once_when_asked() {
        let [x, y, z] = [0.0, -12.0, 14.0];
        for (motion, to) in [
            (
                CameraMotion::Orbit {
                    center: Vec3::X,
                    angle: std::f32::consts::PI,
                    rise: 0.0,
                },
                Vec3::new(2.0, -y, z),
            ),
            (
                CameraMotion::Shift(Vec3::new(1.0, 2.0, 3.0)),
                Vec3::new(x + 1.0, y + 2.0, z + 3.0),
            ),
            (
                CameraMotion::Approach {
                    point: Vec3::ZERO,
                    factor: 0.5,
                },
                Vec3::new(x, y, z) / 2.0,
            ),
        ] {
            let mut app = app(10);
            app.world_mut().write_message(motion);
            app.update();
            let location = location(&mut app);
            assert!((location - to).length() < 1e-4, "{location} by {motion:?}");
        }
    }

    /// The camera's location and direction of view.
    fn view(app: &mut App) -> (Vec3, Vec3) {
        let mut cameras = app.world_mut().query::<(&UserCamera, &Transform)>();
        let place = cameras.single(app.world()).unwrap().1;
        (place.translation, *place.forward())
    }

    #[test]
    fn keys_choose_views_also_in_a_pause() {
        use KeyCode::*;
        let mut app = app(10);
        app.insert_resource(Paused(true));
        for (key, height, direction) in [
            (Digit4, 10.0..60.0, Vec3::NEG_Z),
            (Digit5, 1.0..5.0, Vec3::Y),
            (Digit6, 11.0..12.0, Vec3::new(0.0, 0.5584, -0.8296)),
            (
                Digit3,
                13.99..14.01,
                Vec3::new(0.0, 12.0, -14.0).normalize(),
            ),
        ] {
            press(&mut app, key);
            app.update();
            app.insert_resource(ButtonInput::<KeyCode>::default());
            let (location, forward) = view(&mut app);
            assert!(height.contains(&location.z), "{location} with {key:?}");
            assert!(forward.distance(direction) < 0.02, "{forward} with {key:?}");
        }
    }

    #[test]
    fn the_held_object_comes_to_the_middle_of_the_picture() {
        let mut app = app(10);
        let held = Vec3::new(5.0, 3.0, 2.0);
        let object = app
            .world_mut()
            .spawn(Transform::from_translation(held))
            .id();
        for center in [Vec3::ZERO, held] {
            app.world_mut()
                .write_message(CameraMotion::Look(CameraView::Center));
            app.update();
            let (location, forward) = view(&mut app);
            assert!((center - location).normalize().distance(forward) < 1e-4);
            let mut hands = app.world_mut().resource_mut::<Hands>();
            let hand = hands.selected;
            hands.set_held(hand, Some(object));
        }
    }

    #[test]
    fn only_the_first_table_places_the_camera() {
        let mut app = app(10);
        let table = |yspan| Table { xspan: 10.0, yspan };
        app.world_mut().spawn(table(20.0));
        app.update();
        assert_eq!(location(&mut app), Vec3::new(0.0, -16.0, 14.0));
        app.world_mut().spawn(table(40.0));
        app.update();
        assert_eq!(location(&mut app), Vec3::new(0.0, -16.0, 14.0));
    }

    #[test]
    fn the_first_view_may_be_from_the_other_side() {
        let mut app = app(10);
        app.insert_resource(FirstView(CameraView::Across));
        app.world_mut().spawn(Table::default());
        app.update();
        assert!(location(&mut app).y > 0.0);
    }

    #[test]
    fn each_key_steers_in_its_direction() {
        use KeyCode::*;
        let mut app = app(10);
        let mut steering_with = |pressed: &[KeyCode]| {
            let mut keys = ButtonInput::default();
            pressed.iter().for_each(|&key| keys.press(key));
            app.insert_resource(keys);
            let steering = |keys: Keys| steering(&keys);
            app.world_mut().run_system_once(steering).unwrap()
        };
        let parts = |s: Steering| [s.forward, s.right, s.up, s.turn_left, s.turn_up];
        for (part, plus, minus) in [
            (0, KeyW, KeyS),
            (1, KeyD, KeyA),
            (2, KeyQ, KeyZ),
            (3, ArrowLeft, ArrowRight),
            (4, ArrowUp, ArrowDown),
        ] {
            let mut expected = [0.0; 5];
            assert_eq!(parts(steering_with(&[plus, minus])), expected);
            expected[part] = if part < 3 { SPEED } else { TURN };
            assert_eq!(parts(steering_with(&[plus])), expected);
            expected[part] *= -1.0;
            assert_eq!(parts(steering_with(&[minus])), expected);
        }
        assert_eq!(steering_with(&[KeyW, ControlLeft]), Steering::default());
        assert_eq!(steering_with(&[KeyW, AltRight]), Steering::default());
    }
}
