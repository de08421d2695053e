//! The user's camera and its keys.

use bevy::{
    camera::{ClearColorConfig, PerspectiveProjection},
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    light::cluster::ClusterConfig,
    prelude::*,
    render::view::NoIndirectDrawing,
};
use tabletop_core::{Action, KeySystems, Keys, Orbit, Paused, Table, UserCamera};

use crate::viewpoint::{Steering, Viewpoint};

/// Vertical field of view in degrees.
const FIELD_OF_VIEW: f32 = 45.0;

/// Nearest visible distance in units.
const NEAR: f32 = 0.01;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Startup, spawn_camera)
        .add_systems(
            RunFixedMainLoop,
            steer.in_set(KeySystems).run_if(Paused::is_running),
        )
        .add_systems(
            RunFixedMainLoop,
            (look_at_first_table, orbit, place_camera)
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

/// The first table decides where the camera starts; later ones leave it where the user has brought it.
fn look_at_first_table(
    mut has_looked: Local<bool>,
    tables: Query<&Table>,
    mut cameras: Query<&mut Viewpoint, With<UserCamera>>,
) {
    if *has_looked {
        return;
    }
    if let Some(table) = tables.iter().next() {
        for mut viewpoint in &mut cameras {
            *viewpoint = Viewpoint::of_table(table);
            *has_looked = true;
        }
    }
}

fn steer(keys: Keys, time: Res<Time>, mut cameras: Query<&mut Viewpoint, With<UserCamera>>) {
    let steering = steering(&keys);
    for mut viewpoint in &mut cameras {
        let steered = viewpoint.steered(steering, time.delta_secs());
        viewpoint.set_if_neq(steered);
    }
}

fn orbit(mut orbits: MessageReader<Orbit>, mut cameras: Query<&mut Viewpoint, With<UserCamera>>) {
    for orbit in orbits.read() {
        for mut viewpoint in &mut cameras {
            *viewpoint = viewpoint.orbited(orbit.center, orbit.angle);
        }
    }
}

fn place_camera(mut cameras: Query<(&Viewpoint, &mut Transform), Changed<Viewpoint>>) {
    for (viewpoint, mut transform) in &mut cameras {
        *transform = (*viewpoint).into();
    }
}

/// What the keys ask of the camera.
fn steering(keys: &Keys) -> Steering {
    Steering {
        forward: keys.axis(Action::CameraForward, Action::CameraBack),
        right: keys.axis(Action::CameraRight, Action::CameraLeft),
        up: keys.axis(Action::CameraUp, Action::CameraDown),
        turn_left: keys.axis(Action::LookLeft, Action::LookRight),
        turn_up: keys.axis(Action::LookUp, Action::LookDown),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::{ecs::system::RunSystemOnce as _, time::TimeUpdateStrategy};
    use std::time::Duration;
    use tabletop_core::CorePlugin;

    fn app(milliseconds_a_frame: u64) -> App {
        let mut app = App::new();
        let frame = Duration::from_millis(milliseconds_a_frame);
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
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
            for _ in 0..frames {
                app.update();
            }
            let z = location(&mut app).z;
            assert!((z - 24.0).abs() < 1e-3, "{z} at {milliseconds} ms a frame");
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
    fn the_camera_goes_round_a_point_when_asked() {
        let mut app = app(10);
        app.world_mut().write_message(Orbit {
            center: Vec3::X,
            angle: std::f32::consts::PI,
        });
        app.update();
        let location = location(&mut app);
        assert!((location - Vec3::new(2.0, 12.0, 14.0)).length() < 1e-4);
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
            expected[part] = 1.0;
            assert_eq!(parts(steering_with(&[plus])), expected);
            expected[part] = -1.0;
            assert_eq!(parts(steering_with(&[minus])), expected);
        }
        assert_eq!(steering_with(&[KeyW, ControlLeft]), Steering::default());
        assert_eq!(steering_with(&[KeyW, AltRight]), Steering::default());
    }
}
