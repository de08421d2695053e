//! The points that a script wants to see, as balls that one can see through.

use bevy::prelude::*;
use tabletop_core::Markers;

use crate::{mesh, surface::Surface};

/// The ball around a marked point.
#[derive(Component)]
struct Marker;

/// The look of all markers.
#[derive(Resource)]
struct MarkerLooks {
    ball: Handle<Mesh>,
    surface: Handle<Surface>,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<MarkerLooks>().add_systems(
        RunFixedMainLoop,
        show_markers
            .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop)
            .run_if(resource_changed::<Markers>),
    );
}

fn show_markers(
    mut commands: Commands,
    looks: Res<MarkerLooks>,
    markers: Res<Markers>,
    shown: Query<Entity, With<Marker>>,
) {
    for marker in &shown {
        commands.entity(marker).despawn();
    }
    commands.spawn_batch(markers.0.clone().into_iter().map({
        let (ball, surface) = (looks.ball.clone(), looks.surface.clone());
        move |center| {
            (
                Marker,
                Mesh3d(ball.clone()),
                MeshMaterial3d(surface.clone()),
                Transform::from_translation(center).with_scale(Vec3::splat(Markers::RADIUS)),
            )
        }
    }));
}

impl FromWorld for MarkerLooks {
    fn from_world(world: &mut World) -> Self {
        let ball = world.resource_mut::<Assets<Mesh>>().add(mesh::unit_ball());
        let surface = Surface::translucent(Markers::COLOR, Markers::OPACITY);
        let surface = world.resource_mut::<Assets<Surface>>().add(surface);
        Self { ball, surface }
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::CorePlugin;
    use tabletop_user::UserPlugin;

    use super::*;

    #[test]
    fn there_is_a_ball_around_each_point() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .init_resource::<Assets<Mesh>>()
            .init_resource::<Assets<Surface>>()
            .add_plugins(plugin);
        app.finish();
        app.cleanup();
        for points in [vec![Vec3::X, Vec3::Y], vec![Vec3::Z], vec![]] {
            app.insert_resource(Markers(points.clone()));
            app.update();
            let mut balls = app.world_mut().query_filtered::<&Transform, With<Marker>>();
            let shown: Vec<_> = balls
                .iter(app.world())
                .map(|ball| ball.translation)
                .collect();
            assert_eq!(shown, points);
        }
    }
}
