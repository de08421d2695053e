//! The head camera's picture, warped onto the table: as if seen from straight above, where only what lies on the table is in its place.

use bevy::math::{Vec2, Vec3};
use tabletop_camera::Camera;
use tabletop_core::Picture;

use crate::planes::Planes;

/// Columns and rows.
const SIZE: [usize; 2] = [160, 128];
/// Pixels of the view per unit of the table.
const PIXELS_PER_UNIT: f32 = 7.0;
/// The point of the table's plane in the middle of the view. Behind what stands high at the back of a table of 20 x 12 units, the plane goes on.
const MIDDLE: Vec2 = Vec2::new(0.0, 3.0);
/// Red, green and blue, and the pixel's column and row, by which a network knows places of the table.
pub(crate) const PLANES: usize = 5;

/// The pixel of a point of the table's plane; Y is up.
pub(crate) fn pixel_of(point: Vec2) -> Vec2 {
    let from_middle = point - MIDDLE;
    middle() + Vec2::new(from_middle.x, -from_middle.y) * PIXELS_PER_UNIT
}

/// The point of the table's plane at a pixel.
pub(crate) fn point_of(pixel: Vec2) -> Vec2 {
    let from_middle = (pixel - middle()) / PIXELS_PER_UNIT;
    MIDDLE + Vec2::new(from_middle.x, -from_middle.y)
}

/// The pixel in the middle.
fn middle() -> Vec2 {
    (Vec2::from(SIZE.map(|side| side as f32)) - 1.0) / 2.0
}

/// The pixel at which an eye sees a point above the table: that of the table's plane behind it.
pub(crate) fn pixel_behind(eye: Vec3, point: Vec3) -> Vec2 {
    let way = point - eye;
    pixel_of((eye + way * (eye.z / -way.z)).truncate())
}

/// The point of this height that an eye sees at a pixel.
pub(crate) fn point_before(eye: Vec3, pixel: Vec2, height: f32) -> Vec3 {
    let way = point_of(pixel).extend(0.0) - eye;
    eye + way * ((eye.z - height) / eye.z)
}

/// The view of a picture that this camera took. Where the picture shows nothing of the table's plane, the colour is zero, which is grey.
pub(crate) fn view_of(picture: &Picture, camera: &Camera) -> Planes {
    let projection = camera.projection();
    let [width, height] = SIZE;
    let mut view = Planes::new(PLANES, width, height);
    for row in 0..height {
        for column in 0..width {
            let pixel = Vec2::new(column as f32, row as f32);
            let seen = projection(point_of(pixel).extend(0.0));
            let color = seen.and_then(|seen| interpolated(picture, seen));
            let color = color.map_or([0.0; 3], |color| color.map(|part| part / 255.0 - 0.5));
            let place = (pixel - middle()) / middle();
            let numbers = color.into_iter().chain(place.to_array());
            for (plane, number) in numbers.enumerate() {
                *view.get_mut(plane, column, row) = number;
            }
        }
    }
    view
}

/// The bilinearly interpolated colour at a point of a picture, if that is between its pixels.
fn interpolated(picture: &Picture, at: Vec2) -> Option<[f32; 3]> {
    let (corner, part) = (at.floor(), at - at.floor());
    if corner.min_element() < 0.0 {
        return None;
    }
    let (column, row) = (corner.x as u32, corner.y as u32);
    let shares = [1.0 - part.x, part.x];
    let mut color = [0.0; 3];
    for (row, share_of_row) in (row..).zip([1.0 - part.y, part.y]) {
        for (column, share) in (column..).zip(shares) {
            let pixel = picture.color(column, row)?;
            for (sum, part) in color.iter_mut().zip(pixel) {
                *sum += share * share_of_row * f32::from(part);
            }
        }
    }
    Some(color)
}

#[cfg(test)]
mod tests {
    use tabletop_camera::{DrawnSolid, Rasterizer, Scene};
    use tabletop_core::{HeadCamera, Table};
    use tabletop_geometry::{Pose, Primitive, Rgb, Solid};

    use super::*;

    #[test]
    fn pixels_and_points_above_the_table_belong_together() {
        let eye = Vec3::new(1.0, -9.0, 11.0);
        let point = Vec3::new(-3.0, 2.0, 1.5);
        let pixel = pixel_behind(eye, point);
        assert!(point_before(eye, pixel, 1.5).distance(point) < 1e-4);
        let corner = Vec2::new(-80.0 / 7.0, 3.0 + 64.0 / 7.0);
        assert!(pixel_of(corner).distance(Vec2::splat(-0.5)) < 1e-4);
        assert!(point_of(pixel_of(point.truncate())).distance(point.truncate()) < 1e-4);
    }

    #[test]
    fn what_stands_on_a_block_at_the_back_of_the_table_has_its_place_in_the_view() {
        let eye = Camera::of_head(&HeadCamera::default(), &Table::default())
            .pose
            .location;
        for x in [-8.0, 8.0] {
            let behind = pixel_behind(eye, Vec3::new(x, 5.5, 2.5));
            let last = Vec2::from(SIZE.map(|side| side as f32)) - 1.0;
            assert!(behind == behind.clamp(Vec2::ZERO, last), "{behind}");
        }
    }

    #[test]
    fn a_flat_tile_is_seen_in_its_place_from_anywhere() {
        let table = Table::default();
        let tile = Vec2::new(2.0, -1.0);
        let looking_aside =
            Pose::looking_at(Vec3::new(-3.0, -9.0, 10.0), Vec3::new(0.0, -1.0, 0.0));
        for mount in [None, Some(looking_aside)] {
            let head = HeadCamera {
                mount,
                ..HeadCamera::default()
            };
            let camera = Camera::of_head(&head, &table);
            let solid = Primitive {
                pose: Pose::IDENTITY,
                solid: Solid::Cuboid(Vec3::new(1.0, 1.0, 0.002)),
                color: Rgb::RED,
            };
            let scene = Scene {
                solids: vec![
                    DrawnSolid::of_table(&table, 1),
                    DrawnSolid::of(Pose::at(tile.extend(0.001)), &solid, 2),
                ],
                ..Scene::default()
            };
            let mut picture = Picture::default();
            Rasterizer::alone().draw(&scene, &camera, &mut picture);
            let view = view_of(&picture, &camera);
            let is_red = |point: Vec2| {
                let pixel = pixel_of(point).round();
                view.get(1, pixel.x as usize, pixel.y as usize) < 0.0
            };
            for way in [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y] {
                assert!(is_red(tile + way * 0.35), "{mount:?} {way}");
                assert!(!is_red(tile + way * 0.75), "{mount:?} {way}");
            }
        }
    }
}
