//! Ghosts of objects at their goals, translucent; a line leads to the next one.

use bevy::prelude::*;
use tabletop_core::ObjectIndex;
use tabletop_user::{Ghost, Ghosts};

use crate::{mesh, surface::Surface, visual::Looks};

/// A solid of a ghost.
#[derive(Component)]
struct GhostSolid;

/// The lines that lead to ghosts.
#[derive(Default, Reflect, GizmoConfigGroup)]
pub(crate) struct GhostLines;

/// Height of a line above its higher end, in units.
const RISE: f32 = 1.5;
/// Of how many pieces a line is.
const PIECES: u16 = 24;
/// Width of a line, in pixels.
const WIDTH: f32 = 2.0;
const LINE: Color = Color::srgb(0.25, 0.77, 0.71);

pub(crate) fn plugin(app: &mut App) {
    solids(app);
    let config = GizmoConfig {
        line: GizmoLineConfig {
            width: WIDTH,
            ..default()
        },
        ..default()
    };
    app.insert_gizmo_config(GhostLines, config)
        .add_systems(Update, draw_lines);
}

pub(crate) fn solids(app: &mut App) {
    app.add_systems(
        RunFixedMainLoop,
        show_ghosts
            .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop)
            .run_if(resource_changed::<Ghosts>),
    );
}

fn show_ghosts(
    mut commands: Commands,
    ghosts: Res<Ghosts>,
    shown: Query<Entity, With<GhostSolid>>,
    mut looks: ResMut<Looks>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut surfaces: ResMut<Assets<Surface>>,
) {
    for solid in &shown {
        commands.entity(solid).despawn();
    }
    for ghost in &ghosts.0 {
        for primitive in ghost.shape.drawn() {
            let surface = Surface::translucent(primitive.color, Ghost::OPACITY);
            commands.spawn((
                GhostSolid,
                Mesh3d(looks.mesh(&primitive.solid, &mut meshes)),
                MeshMaterial3d(surfaces.add(surface)),
                Transform::from(ghost.pose * primitive.pose)
                    .with_scale(mesh::scale_of(&primitive.solid)),
            ));
        }
    }
}

/// A bow from where an object is to where it is going to be.
fn draw_lines(
    mut gizmos: Gizmos<GhostLines>,
    ghosts: Res<Ghosts>,
    index: Res<ObjectIndex>,
    objects: Query<&Transform>,
) {
    for ghost in ghosts.0.iter().filter(|ghost| ghost.is_next) {
        let object = index.get(&ghost.id).and_then(|id| objects.get(id).ok());
        if let Some(object) = object {
            let points = bow(object.translation, ghost.pose.location);
            gizmos.linestrip(points, LINE);
        }
    }
}

/// The points of a bow between two others.
fn bow(from: Vec3, to: Vec3) -> impl Iterator<Item = Vec3> {
    let middle = from.midpoint(to).with_z(from.z.max(to.z) + 2.0 * RISE);
    (0..=PIECES).map(move |i| {
        let part = f32::from(i) / f32::from(PIECES);
        from.lerp(middle, part).lerp(middle.lerp(to, part), part)
    })
}

#[cfg(test)]
mod tests {
    use tabletop_core::{CorePlugin, Shape};
    use tabletop_geometry::{Pose, Rgb};
    use tabletop_user::UserPlugin;

    use super::*;

    #[test]
    fn a_ghost_is_where_its_object_is_going_to_be() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .init_resource::<Assets<Mesh>>()
            .init_resource::<Assets<Surface>>()
            .add_plugins((crate::visual::plugin, solids));
        app.finish();
        app.cleanup();
        let ghost = |x: f32| Ghost {
            id: "a".into(),
            shape: Shape::Block {
                span: Vec3::ONE,
                color: Rgb::RED,
            },
            pose: Pose::at(Vec3::X * x),
            is_next: true,
        };
        for places in [vec![1.0, 2.0], vec![3.0], vec![]] {
            app.insert_resource(Ghosts(places.iter().copied().map(ghost).collect()));
            app.update();
            let mut solids = app
                .world_mut()
                .query_filtered::<&Transform, With<GhostSolid>>();
            let shown: Vec<_> = solids
                .iter(app.world())
                .map(|solid| solid.translation.x)
                .collect();
            assert_eq!(shown, places);
        }
    }

    #[test]
    fn a_bow_leads_from_one_place_to_the_other_above_both() {
        let (from, to) = (Vec3::new(-3.0, 0.0, 0.5), Vec3::new(2.0, 1.0, 2.5));
        let points: Vec<_> = bow(from, to).collect();
        assert_eq!(points.first(), Some(&from));
        assert_eq!(points.last(), Some(&to));
        let highest = points.iter().map(|point| point.z).fold(0.0, f32::max);
        assert!((3.0..5.0).contains(&highest), "{highest}");
    }
}
