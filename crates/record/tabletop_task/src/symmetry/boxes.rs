//! Boxes: cuboids along the axes, and whether some fill the same space in the same colours as others.

use bevy::math::{Quat, Vec3};
use tabletop_geometry::{Bounds, Pose, Primitive, Rgb, Solid};

/// A cuboid along the axes, in units.
pub(super) struct ColoredBox {
    bounds: Bounds,
    color: Rgb,
}

/// These solids at a pose, if they are cuboids along the axes there.
pub(super) fn boxes(solids: &[Primitive], at: Pose) -> Option<Vec<ColoredBox>> {
    let colored_box = |solid: &Primitive| {
        let is_box = matches!(solid.solid, Solid::Cuboid(_));
        (is_box && is_along_axes(at.rotation * solid.pose.rotation)).then(|| ColoredBox {
            bounds: Bounds::of_primitive(solid, at),
            color: solid.color,
        })
    };
    solids.iter().map(colored_box).collect()
}

fn is_along_axes(rotation: Quat) -> bool {
    [Vec3::X, Vec3::Y, Vec3::Z]
        .map(|axis| (rotation * axis).abs().max_element())
        .into_iter()
        .all(|along| along > 1.0 - 1e-5)
}

/// True if the boxes fill the same space as the others, in the same colours: their faces divide space into cells, each of which has the colours of the boxes
/// around it. Lengths that differ by up to `same` units look the same.
pub(super) fn fill_the_same(boxes: &[ColoredBox], others: &[ColoredBox], same: f32) -> bool {
    let is_same_size = bounds_of(boxes)
        .zip(bounds_of(others))
        .is_some_and(|(a, b)| a.low.distance(b.low).max(a.high.distance(b.high)) < 2.0 * same);
    is_same_size && {
        let [xs, ys, zs] = [0, 1, 2].map(|axis| middles(boxes, others, axis, same));
        let rows = xs.iter().flat_map(|x| ys.iter().map(move |y| (x, y)));
        let mut cells = rows.flat_map(|(x, y)| zs.iter().map(|z| Vec3::new(*x, *y, *z)));
        cells.all(|cell| shows_colors(cell, boxes, others) && shows_colors(cell, others, boxes))
    }
}

fn bounds_of(boxes: &[ColoredBox]) -> Option<Bounds> {
    let all = boxes.iter().map(|one| one.bounds);
    all.reduce(Bounds::union)
}

/// The coordinates of the centres of cells wider than `same` along an axis.
fn middles(boxes: &[ColoredBox], others: &[ColoredBox], axis: usize, same: f32) -> Vec<f32> {
    let faces = boxes.iter().chain(others);
    let faces = faces.flat_map(|one| [one.bounds.low[axis], one.bounds.high[axis]]);
    let mut faces: Vec<_> = faces.collect();
    faces.sort_by(f32::total_cmp);
    let between = faces.array_windows::<2>();
    let wide = between.filter(|[low, high]| high - low > same);
    wide.map(|[low, high]| low.midpoint(*high)).collect()
}

/// True if each colour that the first boxes have at a point is one that the others have there.
fn shows_colors(point: Vec3, boxes: &[ColoredBox], others: &[ColoredBox]) -> bool {
    let around =
        |one: &&ColoredBox| point.cmpge(one.bounds.low).all() && point.cmple(one.bounds.high).all();
    let mut colors = boxes.iter().filter(around).map(|one| one.color);
    colors.all(|color| {
        let mut others = others.iter().filter(around);
        others.any(|other| other.color == color)
    })
}
