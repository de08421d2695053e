//! The robot's beliefs as wire frames over its picture.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::egui::{Color32, Painter, Pos2, Rect, Stroke};
use tabletop_camera::Camera;
use tabletop_core::{HeadCamera, ObjectSpec, Table};
use tabletop_geometry::{Bounds, Pose, Primitive, Solid};
use tabletop_vision::Perception;

/// Straight pieces of a circle.
const PIECES: u16 = 16;
const SURE: Color32 = Color32::WHITE;
const UNSURE: Color32 = Color32::RED;

/// What the robot believes, and the camera through which it looks.
#[derive(SystemParam)]
pub(super) struct Beliefs<'w, 's> {
    perception: Res<'w, Perception>,
    head: Res<'w, HeadCamera>,
    tables: Query<'w, 's, &'static Table>,
    objects: Query<'w, 's, &'static ObjectSpec>,
}

impl Beliefs<'_, '_> {
    /// Draws the outlines of the objects over the picture in this rectangle: white, or red where the robot is not sure.
    pub fn paint(&self, painter: &Painter, inside: Rect) {
        let table = self.tables.iter().next().copied().unwrap_or_default();
        let camera = Camera::of_head(&self.head, &table);
        let pixel_of = camera.projection();
        let size = Vec2::new(camera.width as f32, camera.height as f32);
        let place = |point: Vec3| {
            let part = (pixel_of(point)? + 0.5) / size;
            Some(inside.lerp_inside(bevy_egui::egui::vec2(part.x, part.y)))
        };
        let painter = painter.with_clip_rect(inside);
        for believed in &self.perception.objects {
            let spec = self.objects.get(believed.object).ok();
            let Some((pose, spec)) = believed.seen.pose.zip(spec) else {
                continue;
            };
            let color = if believed.seen.is_sure { SURE } else { UNSURE };
            for primitive in spec.shape.drawn() {
                for [from, to] in outline(&primitive, pose) {
                    if let Some(ends) = place(from).zip(place(to)) {
                        line(&painter, ends.into(), color);
                    }
                }
            }
        }
    }
}

/// A line that is seen on bright and on dark.
fn line(painter: &Painter, ends: [Pos2; 2], color: Color32) {
    painter.line_segment(ends, Stroke::new(2.5, Color32::BLACK));
    painter.line_segment(ends, Stroke::new(1.0, color));
}

/// The edges of a solid of an object at a pose; of a polyhedron those of its bounds.
fn outline(primitive: &Primitive, object: Pose) -> Vec<[Vec3; 2]> {
    let place = object * primitive.pose;
    let edges = match &primitive.solid {
        Solid::Cuboid(span) => edges_of(Bounds {
            low: -*span / 2.0,
            high: *span / 2.0,
        }),
        Solid::Polyhedron(polyhedron) => edges_of(polyhedron.bounds()),
        Solid::Ball(radius) => [Vec3::X, Vec3::Y, Vec3::Z]
            .into_iter()
            .flat_map(|axis| circle(axis, Vec3::ZERO, *radius))
            .collect(),
        Solid::Cylinder { radius, yspan } => {
            let end = Vec3::Y * (yspan / 2.0);
            let sides = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z];
            let along = sides.map(|side| [side * *radius - end, side * *radius + end]);
            let ends = [end, -end];
            let ends = ends
                .into_iter()
                .flat_map(|end| circle(Vec3::Y, end, *radius));
            ends.chain(along).collect()
        }
    };
    edges
        .into_iter()
        .map(|edge| edge.map(|end| place * end))
        .collect()
}

/// The twelve edges of a box.
fn edges_of(Bounds { low, high }: Bounds) -> Vec<[Vec3; 2]> {
    let corner = |bits: usize| {
        let part = |axis: usize| match bits >> axis & 1 {
            0 => low[axis],
            _ => high[axis],
        };
        Vec3::new(part(0), part(1), part(2))
    };
    let pairs = (0..8_usize).flat_map(|from| [1, 2, 4].map(|bit| (from, from | bit)));
    pairs
        .filter(|(from, to)| from != to)
        .map(|(from, to)| [corner(from), corner(to)])
        .collect()
}

fn circle(axis: Vec3, middle: Vec3, radius: f32) -> impl Iterator<Item = [Vec3; 2]> {
    let right = axis.any_orthonormal_vector();
    let up = axis.cross(right);
    let at = move |piece: u16| {
        let angle = f32::from(piece) / f32::from(PIECES) * std::f32::consts::TAU;
        middle + (right * angle.cos() + up * angle.sin()) * radius
    };
    (0..PIECES).map(move |piece| [at(piece), at(piece + 1)])
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::Rgb;

    use super::*;

    #[test]
    fn the_outline_of_a_block_has_its_twelve_edges_in_its_place() {
        let block = Primitive {
            pose: Pose::at(Vec3::Z),
            solid: Solid::Cuboid(Vec3::new(1.0, 2.0, 3.0)),
            color: Rgb::RED,
        };
        let edges = outline(&block, Pose::at(Vec3::X * 10.0));
        assert_eq!(edges.len(), 12);
        for span in [1.0, 2.0, 3.0] {
            let alike = edges.iter().filter(|[from, to]| from.distance(*to) == span);
            assert_eq!(alike.count(), 4);
        }
        let sum: Vec3 = edges.iter().flatten().sum();
        assert_eq!(sum / 24.0, Vec3::new(10.0, 0.0, 1.0));
    }
}
