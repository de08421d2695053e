//! Symmetries: the turns after which an object looks the same.

use std::f32::consts::TAU;

use bevy::math::{Quat, Vec3, Vec3Swizzles as _};
use tabletop_geometry::{Bounds, Pose, Primitive, Rgb, Solid, turn_about};

/// The largest difference, in units, between points that count as the same.
pub(crate) const SAME: f32 = 2e-3;

/// The turns about the vertical after which an object looks the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum YawSymmetry {
    /// All: its yaw cannot be seen, and counts as 0.
    Any,
    /// Those by a whole number of parts of a full turn, which is divided into this many; 1 for an object without symmetry.
    Turns(u32),
}

impl YawSymmetry {
    /// That of solids which are drawn so, and touched so.
    pub(crate) fn of(drawn: &[Primitive], touched: &[Primitive]) -> Self {
        const MOST_TURNS: u32 = 12;
        if drawn.iter().all(is_round) {
            return Self::Any;
        }
        let turns = (2..=MOST_TURNS).rev().find(|&turns| {
            let turn = turn_about(Vec3::Z, TAU / turns as f32);
            fills_alike(touched, touched, turn)
        });
        Self::Turns(turns.unwrap_or(1))
    }

    /// The angle, in rad, after which the object looks the same; none if any does.
    pub(crate) fn period(self) -> Option<f32> {
        match self {
            Self::Any => None,
            Self::Turns(turns) => Some(TAU / turns as f32),
        }
    }

    /// The least angle, in rad, after which the object looks as after `yaw`: at most half of its period to either side.
    pub fn reduced(self, yaw: f32) -> f32 {
        match self.period() {
            None => 0.0,
            Some(period) => yaw - (yaw / period).round() * period,
        }
    }
}

/// True if solids fill the same room, with the same colours, as others do after a turn.
pub(crate) fn fills_alike(one: &[Primitive], other: &[Primitive], turn: Quat) -> bool {
    /// Points along each axis, and how many of all may differ: those next to a surface, by rounding.
    const POINTS: i32 = 16;
    const DIFFERING: usize = 16;
    let bounds = one
        .iter()
        .map(|solid| Bounds::of_primitive(solid, Pose::IDENTITY));
    let Some(bounds) = bounds.reduce(Bounds::union) else {
        return other.is_empty();
    };
    let back = turn.inverse();
    let mut differing = (0..POINTS * POINTS * POINTS).filter(|i| {
        let cell = [i % POINTS, i / POINTS % POINTS, i / POINTS / POINTS];
        let part = cell.map(|at| (at as f32 + 0.5) / POINTS as f32);
        let point = bounds.low + (bounds.high - bounds.low) * Vec3::from(part);
        color_at(one, point) != color_at(other, back * point)
    });
    differing.nth(DIFFERING).is_none()
}

/// The colour of the first solid that contains a point.
fn color_at(solids: &[Primitive], point: Vec3) -> Option<Rgb> {
    let around = solids.iter().find(|solid| contains(solid, point));
    around.map(|solid| solid.color)
}

fn contains(solid: &Primitive, point: Vec3) -> bool {
    let point = solid.pose.inverse() * point;
    match &solid.solid {
        Solid::Cuboid(span) => point.abs().cmple(*span / 2.0).all(),
        Solid::Cylinder { radius, yspan } => {
            point.y.abs() <= yspan / 2.0 && point.xz().length() <= *radius
        }
        Solid::Ball(radius) => point.length() <= *radius,
        Solid::Polyhedron(polyhedron) => polyhedron
            .faces()
            .all(|[a, b, c]| (b - a).cross(c - a).dot(point - a) <= 0.0),
    }
}

/// True if a solid looks the same after every turn about the vertical through the origin.
fn is_round(solid: &Primitive) -> bool {
    let is_central = solid.pose.location.truncate().length() < SAME;
    let is_upright = |axis: Vec3| (solid.pose.rotation * axis).truncate().length() < SAME;
    match &solid.solid {
        Solid::Ball(_) => is_central,
        Solid::Cylinder { .. } => is_central && is_upright(Vec3::Y),
        Solid::Polyhedron(polyhedron) => is_central && polyhedron.axis().is_some_and(is_upright),
        Solid::Cuboid(_) => false,
    }
}
