//! Likeness: whether a turned shape looks as before.

use bevy::math::{Quat, Vec3};
use tabletop_geometry::{Polyhedron, Pose, Primitive, Solid};

use super::boxes::{boxes, fill_the_same};
use crate::rotation::angle_between;

/// Largest difference, in units, of lengths that look the same.
pub(super) const SAME_LENGTH: f32 = 0.01;

/// True if every solid lands on one that looks like it, or all are boxes which, turned, fill the same space.
pub(super) fn looks_the_same(solids: &[Primitive], centre: Vec3, turn: Quat) -> bool {
    let about = Pose::new(centre - turn * centre, turn);
    let lands_on_like = |solid: &Primitive| {
        let turned = about * solid.pose;
        solids.iter().any(|other| is_like(solid, turned, other))
    };
    solids.iter().all(lands_on_like) || {
        let as_it_was = boxes(solids, Pose::IDENTITY);
        let turned = boxes(solids, about);
        as_it_was
            .zip(turned)
            .is_some_and(|(boxes, turned)| fill_the_same(&boxes, &turned, SAME_LENGTH))
    }
}

/// True if a solid at a pose takes the place of another.
fn is_like(solid: &Primitive, at: Pose, other: &Primitive) -> bool {
    let same = |a: f32, b: f32| (a - b).abs() < SAME_LENGTH;
    let is_there = at.location.distance(other.pose.location) < SAME_LENGTH;
    let relative = other.pose.rotation.inverse() * at.rotation;
    let is_same_solid = match (&solid.solid, &other.solid) {
        (Solid::Cuboid(a), Solid::Cuboid(b)) => {
            // Every edge lies along one of the other's.
            let turned =
                [Vec3::X * a.x, Vec3::Y * a.y, Vec3::Z * a.z].map(|edge| (relative * edge).abs());
            let edges = [Vec3::X * b.x, Vec3::Y * b.y, Vec3::Z * b.z];
            turned.iter().all(|edge| {
                edges
                    .iter()
                    .any(|other| edge.distance(*other) < SAME_LENGTH)
            })
        }
        (
            Solid::Cylinder {
                radius: a,
                yspan: c,
            },
            Solid::Cylinder {
                radius: b,
                yspan: d,
            },
        ) => same(*a, *b) && same(*c, *d) && (relative * Vec3::Y).cross(Vec3::Y).length() < 1e-3,
        (Solid::Ball(a), Solid::Ball(b)) => same(*a, *b),
        (Solid::Polyhedron(a), Solid::Polyhedron(b)) => {
            is_there && is_same_polyhedron(a, b, relative)
        }
        (Solid::Cuboid(_) | Solid::Cylinder { .. } | Solid::Ball(_) | Solid::Polyhedron(_), _) => {
            false
        }
    };
    is_there && is_same_solid && solid.color == other.color
}

/// True if every corner of a turned polyhedron lands on a corner of the other; of round ones, on a place where a corner could be.
fn is_same_polyhedron(turned: &Polyhedron, other: &Polyhedron, turn: Quat) -> bool {
    /// Largest number of corners that are compared, as more would take too long. A finer mesh has no symmetry.
    const MOST: usize = 300;
    let count = turned.corners().len();
    if count != other.corners().len() || count > MOST {
        return turned == other && angle_between(turn, Quat::IDENTITY) < 1e-3;
    }
    let has_like = |corner: Vec3, place: &dyn Fn(Vec3) -> Vec3| {
        let is_like = |like: &Vec3| place(*like).distance(place(corner)) < SAME_LENGTH;
        other.corners().iter().any(is_like)
    };
    let corners = turned.corners().iter().map(|corner| turn * *corner);
    match (turned.axis(), other.axis()) {
        (Some(own), Some(axis)) => {
            let around_axis = |corner: Vec3| {
                let height = corner.dot(axis);
                Vec3::new(corner.cross(axis).length(), height, 0.0)
            };
            (turn * own).cross(axis).length() < 1e-3
                && corners
                    .into_iter()
                    .all(|corner| has_like(corner, &around_axis))
        }
        (None, _) | (_, None) => corners.into_iter().all(|corner| has_like(corner, &|at| at)),
    }
}
