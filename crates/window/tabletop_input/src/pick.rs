//! Picking: the nearest visible surface under the mouse cursor counts. The table and figures, unless the user sees through them, hide
//! objects behind them, but are no objects.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Figure, ObjectIndex, ObjectSpec, Table};
use tabletop_geometry::{Pose, Primitive};
use tabletop_user::RobotLook;

/// Everything that can be seen or hide it.
#[derive(SystemParam)]
pub(crate) struct Pickable<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<'w, 's, (Entity, &'static ObjectSpec, &'static Transform)>,
    tables: Query<'w, 's, &'static Table>,
    figures: Query<'w, 's, (&'static Figure, &'static GlobalTransform)>,
    look: Option<Res<'w, RobotLook>>,
}

impl Pickable<'_, '_> {
    /// The object that is seen along this line of sight.
    pub fn object_along(&self, ray: Ray3d) -> Option<Entity> {
        let objects =
            self.objects
                .iter_many(self.index.iter())
                .filter_map(|(object, spec, place)| {
                    let distance = distance_along(ray, &spec.shape.drawn(), place.into())?;
                    Some((distance, object))
                });
        let (nearest, object) = objects.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let is_hidden = self
            .others_along(ray)
            .is_some_and(|distance| distance < nearest);
        (!is_hidden).then_some(object)
    }

    /// The point of the first surface along this line of sight.
    pub fn surface_along(&self, ray: Ray3d) -> Option<Vec3> {
        let objects = self.objects.iter_many(self.index.iter());
        objects
            .filter_map(|(_, spec, place)| distance_along(ray, &spec.shape.drawn(), place.into()))
            .chain(self.others_along(ray))
            .min_by(f32::total_cmp)
            .map(|distance| ray.get_point(distance))
    }

    /// The distance along a line of sight to the first surface that is of no object.
    fn others_along(&self, ray: Ray3d) -> Option<f32> {
        let tables = self.tables.iter();
        let tables =
            tables.filter_map(|table| distance_along(ray, &[table.slab()], Pose::IDENTITY));
        let is_seen_through = self.look.as_ref().is_some_and(|look| look.is_translucent);
        let figure = self.figure_along(ray).filter(|_| !is_seen_through);
        tables.chain(figure).min_by(f32::total_cmp)
    }

    /// True if a figure is between an eye and a point.
    pub fn is_behind_figure(&self, eye: Vec3, point: Vec3) -> bool {
        let Ok(direction) = Dir3::new(point - eye) else {
            return false;
        };
        self.figure_along(Ray3d::new(eye, direction))
            .is_some_and(|distance| distance < eye.distance(point))
    }

    fn figure_along(&self, ray: Ray3d) -> Option<f32> {
        let figures = self.figures.iter().filter_map(|(figure, place)| {
            let place = place.compute_transform();
            figure.coarse.distance_along(ray, (&place).into())
        });
        figures.min_by(f32::total_cmp)
    }
}

/// The distance along the line of sight to a body of these solids.
fn distance_along(ray: Ray3d, solids: &[Primitive], body: Pose) -> Option<f32> {
    solids
        .iter()
        .filter_map(|solid| solid.distance_along(ray, body))
        .min_by(f32::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::block;
    use bevy::ecs::system::RunSystemOnce;
    use tabletop_geometry::{Rgb, Triangles};

    fn picked(world: &mut World, origin: Vec3, direction: Vec3) -> Option<Entity> {
        let ray = Ray3d::new(origin, Dir3::new(direction).unwrap());
        world
            .run_system_once(move |pickable: Pickable| pickable.object_along(ray))
            .unwrap()
    }

    fn world() -> World {
        let mut world = World::new();
        world.init_resource::<ObjectIndex>();
        world.spawn(Table::default());
        world
    }

    #[test]
    fn the_first_surface_is_of_an_object_or_not() {
        let mut world = world();
        block(&mut world, "red", Vec3::Z);
        let mut surface = |x: f32, y: f32| {
            let ray = Ray3d::new(Vec3::new(x, y, 20.0), Dir3::NEG_Z);
            world
                .run_system_once(move |pickable: Pickable| pickable.surface_along(ray))
                .unwrap()
        };
        assert_eq!(surface(0.5, 0.0), Some(Vec3::new(0.5, 0.0, 2.0)));
        assert_eq!(surface(5.0, 0.0), Some(Vec3::X * 5.0));
        assert_eq!(surface(50.0, 0.0), None);
    }

    #[test]
    fn the_nearest_object_is_picked() {
        let mut world = world();
        let high = block(&mut world, "high", Vec3::Z * 5.0);
        let low = block(&mut world, "low", Vec3::Z);
        let above = Vec3::Z * 20.0;
        assert_eq!(picked(&mut world, above, Vec3::NEG_Z), Some(high));
        let beside = Vec3::new(10.0, 0.0, 1.0);
        assert_eq!(picked(&mut world, beside, Vec3::NEG_X), Some(low));
        assert_eq!(picked(&mut world, beside, Vec3::X), None);
    }

    #[test]
    fn the_table_hides_objects_below_it() {
        let mut world = world();
        let below = block(&mut world, "below", Vec3::Z * -10.0);
        assert_eq!(picked(&mut world, Vec3::Z * 20.0, Vec3::NEG_Z), None);
        assert_eq!(picked(&mut world, Vec3::Z * -20.0, Vec3::Z), Some(below));
    }

    #[test]
    fn a_figure_hides_objects_behind_it() {
        let mut world = world();
        let block = block(&mut world, "block", Vec3::Z);
        let plate = Triangles {
            positions: vec![Vec3::ZERO, Vec3::X * 9.0, Vec3::Y * 9.0],
            normals: vec![Vec3::Z; 3],
            colors: vec![Rgb::GRAY; 3],
            indices: vec![[0, 1, 2]],
        };
        let figure = Figure {
            fine: Triangles::default().into(),
            coarse: plate.into(),
        };
        let place = Transform::from_xyz(-3.0, -3.0, 5.0);
        let link = world
            .spawn((figure, place, GlobalTransform::from(place)))
            .id();
        let above = Vec3::Z * 20.0;
        assert_eq!(picked(&mut world, above, Vec3::NEG_Z), None);
        assert_eq!(picked(&mut world, Vec3::Z * 4.0, Vec3::NEG_Z), Some(block));
        world.insert_resource(RobotLook {
            is_translucent: true,
        });
        assert_eq!(picked(&mut world, above, Vec3::NEG_Z), Some(block));
        world.remove_resource::<RobotLook>();
        world.despawn(link);
        assert_eq!(picked(&mut world, above, Vec3::NEG_Z), Some(block));
    }

    #[test]
    fn removed_objects_are_not_picked() {
        let mut world = world();
        block(&mut world, "gone", Vec3::Z);
        world.resource_mut::<ObjectIndex>().remove("gone");
        assert_eq!(picked(&mut world, Vec3::Z * 20.0, Vec3::NEG_Z), None);
    }
}
