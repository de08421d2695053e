//! The view of the window: the table, the objects on it and all figures, in the light of the original program, through the user's
//! camera.

mod aids;
mod camera;
mod ghosts;
mod held;
mod hull;
mod markers;
mod measured;
mod mesh;
mod motion;
mod polyhedron;
mod room;
mod section;
mod shadow;
mod sheet;
mod silhouette;
mod spans;
mod surface;
#[cfg(test)]
mod test_app;
mod tickless_lines;
mod viewpoint;
mod visual;

pub use surface::Surface;
pub use viewpoint::Viewpoint;
pub use visual::Visual;

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Surface, ViewPlugin, Viewpoint, Visual};
}

use bevy::prelude::*;
use tabletop_user::UserPlugin;

/// Draws the simulation and moves the user's camera. Needs Bevy's renderer and [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewPlugin;

impl Plugin for ViewPlugin {
    fn build(&self, app: &mut App) {
        UserPlugin::add_to(app);
        app.add_plugins((
            surface::plugin,
            visual::plugin,
            markers::plugin,
            ghosts::plugin,
            camera::plugin,
            room::plugin,
            shadow::plugin,
            sheet::plugin,
            aids::plugin,
            measured::plugin,
        ));
    }

    fn finish(&self, app: &mut App) {
        tickless_lines::finish(app);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use bevy::{ecs::query::QueryFilter, time::TimeUpdateStrategy};
    use tabletop_core::{CorePlugin, Hands, ObjectSpec, Shape, Table};
    use tabletop_geometry::{Pose, Rgb};
    use tabletop_user::DragPlane;

    use super::*;

    /// The number of entities that have changed since the last frame.
    #[derive(Resource, Default)]
    struct Changes(usize);

    fn count<F: QueryFilter + 'static>(changed: Query<(), F>, mut changes: ResMut<Changes>) {
        changes.0 += changed.iter().count();
    }

    fn count_assets<A: Asset>(assets: Res<Assets<A>>, mut changes: ResMut<Changes>) {
        changes.0 += usize::from(assets.is_changed());
    }

    fn app() -> App {
        let mut app = App::new();
        // Frames are shorter than ticks, so that moments between two ticks are drawn, too.
        let frame = Duration::from_millis(7);
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame))
            .init_resource::<ButtonInput<KeyCode>>()
            .init_resource::<Assets<Mesh>>()
            .init_resource::<Assets<Surface>>()
            .init_resource::<Changes>()
            .add_plugins((
                visual::plugin,
                markers::plugin,
                camera::plugin,
                room::systems,
                shadow::systems,
                sheet::systems,
            ))
            .add_systems(
                Last,
                (
                    count::<Or<(Changed<Transform>, Changed<Visibility>)>>,
                    count::<Or<(Changed<Mesh3d>, Changed<MeshMaterial3d<Surface>>)>>,
                    count::<Or<(Changed<Projection>, Changed<Viewpoint>)>>,
                    count_assets::<Mesh>,
                    count_assets::<Surface>,
                    count_assets::<room::Floor>,
                    count_assets::<shadow::Shade>,
                    count_assets::<sheet::Translucent>,
                )
                    .chain(),
            );
        app.finish();
        app.cleanup();
        app
    }

    fn changes_in(app: &mut App, frames: usize) -> usize {
        (0..frames)
            .map(|_| {
                app.insert_resource(Changes::default());
                app.update();
                app.world().resource::<Changes>().0
            })
            .sum()
    }

    #[test]
    fn nothing_that_is_drawn_changes_while_the_world_is_at_rest() {
        let mut app = app();
        app.world_mut().spawn(Table::default());
        let pose = Pose::from_degrees(Vec3::new(0.1, 0.7, 1.3), Vec3::new(10.0, 20.0, 30.0));
        let shape = Shape::Sphere {
            radius: 1.0,
            color: Rgb::GRAY,
        };
        let ball = ObjectSpec::new("ball", pose, 1.0, shape);
        let object = app.world_mut().spawn((ball, Transform::from(pose))).id();
        for is_held in [false, true] {
            let mut hands = app.world_mut().resource_mut::<Hands>();
            let hand = hands.selected;
            hands.set_held(hand, is_held.then_some(object));
            assert!(changes_in(&mut app, 20) > 0);
            assert_eq!(changes_in(&mut app, 100), 0);
        }
        app.world_mut().resource_mut::<DragPlane>().heading = 1.0;
        assert_eq!(changes_in(&mut app, 20), 1, "the sheet has turned");
        let mut places = app.world_mut().query::<&mut Transform>();
        let mut place = places.get_mut(app.world_mut(), object).unwrap();
        place.translation.x += 1.0;
        assert!(changes_in(&mut app, 20) > 1);
    }
}
