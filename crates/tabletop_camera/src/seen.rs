//! What of a scene a camera can see.

use bevy::math::{Mat3, Vec3};
use tabletop_core::Solid;

use crate::{
    camera::{View, Window},
    face::{CUBOID, CUBOID_NORMALS, Face},
    round::{Curve, Ends, Round},
    row::{Offset, SampleRow},
    scene::DrawnSolid,
    surface::Surface,
};

/// The surfaces that face a camera, and what they bound.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen {
    /// What the surfaces look like; the first stands for nothing.
    pub surfaces: Vec<Surface>,
    faces: Vec<Face>,
    rounds: Vec<Round>,
}

/// What may be seen in a row, as indices.
#[derive(Clone, Debug, Default)]
pub(crate) struct InRow {
    faces: Vec<usize>,
    rounds: Vec<usize>,
}

impl Seen {
    /// Forgets everything and looks at this scene.
    pub fn look_at(&mut self, scene: impl IntoIterator<Item = DrawnSolid>, view: &View) {
        self.surfaces.clear();
        self.surfaces.push(Surface::NOTHING);
        self.faces.clear();
        self.rounds.clear();
        for drawn in scene {
            let corners = corners(&drawn, view);
            if let Some(window) = view.window_of(&corners) {
                match drawn.solid {
                    Solid::Cuboid(_) => self.add_cuboid(&drawn, view, window, &corners),
                    Solid::Cylinder { radius, yspan } => {
                        self.add_cylinder(&drawn, view, window, radius, yspan);
                    }
                    Solid::Ball(radius) => self.add_ball(&drawn, view, window, radius),
                }
            }
        }
    }

    fn add_cuboid(&mut self, drawn: &DrawnSolid, view: &View, window: Window, corners: &[Vec3; 8]) {
        for (face, normal) in CUBOID.into_iter().zip(CUBOID_NORMALS) {
            let normal = drawn.pose.rotation * normal;
            let corners = face.map(|corner| corners[corner]);
            let surface = self.surfaces.len() as u32;
            if let Some(face) = Face::seen(view, corners, normal, window.rows.clone(), surface) {
                self.faces.push(face);
                let plane = Surface::flat(view, drawn, corners[0], normal);
                self.surfaces.push(plane);
            }
        }
    }

    fn add_cylinder(
        &mut self,
        drawn: &DrawnSolid,
        view: &View,
        window: Window,
        radius: f32,
        yspan: f32,
    ) {
        let center = drawn.pose.location - view.eye;
        let axis = drawn.pose.rotation * Vec3::Y;
        let to_eye = if axis.dot(center) < 0.0 { axis } else { -axis };
        let curve = Curve::around_axis(view, center, axis, radius);
        let ends = Ends::of_cylinder(view, center, axis, yspan);
        let side = self.surfaces.len() as u32;
        self.rounds
            .push(Round::new(curve, ends, window, [side, side + 1]));
        self.surfaces.extend([
            Surface::round(drawn, curve),
            Surface::flat(view, drawn, center + to_eye * yspan / 2.0, to_eye),
        ]);
    }

    fn add_ball(&mut self, drawn: &DrawnSolid, view: &View, window: Window, radius: f32) {
        let curve = Curve::around_point(view, drawn.pose.location - view.eye, radius);
        let surface = self.surfaces.len() as u32;
        self.rounds
            .push(Round::new(curve, Ends::NONE, window, [surface; 2]));
        self.surfaces.push(Surface::round(drawn, curve));
    }

    /// Finds what may be seen in a row.
    pub fn find_in_row(&self, row: u32, in_row: &mut InRow) {
        let InRow { faces, rounds } = in_row;
        faces.clear();
        faces.extend((0..self.faces.len()).filter(|&face| self.faces[face].rows.contains(&row)));
        rounds.clear();
        rounds.extend(
            (0..self.rounds.len()).filter(|&round| self.rounds[round].window.rows.contains(&row)),
        );
    }

    /// Finds which surface is nearest at each of these samples of a row, in which no more may be seen than this.
    pub fn sample(&self, in_row: &InRow, row: u32, offset: Offset, samples: &mut SampleRow) {
        for &face in &in_row.faces {
            self.faces[face].draw(row, offset, samples);
        }
        for &round in &in_row.rounds {
            self.rounds[round].draw(row, offset, samples);
        }
    }
}

/// The corners of the cuboid around a solid, relative to the eye, numbered as [`CUBOID`] has them.
fn corners(drawn: &DrawnSolid, view: &View) -> [Vec3; 8] {
    let half = match drawn.solid {
        Solid::Cuboid(span) => span / 2.0,
        Solid::Cylinder { radius, yspan } => Vec3::new(radius, yspan / 2.0, radius),
        Solid::Ball(radius) => Vec3::splat(radius),
    };
    let center = drawn.pose.location - view.eye;
    let axes = Mat3::from_quat(drawn.pose.rotation);
    std::array::from_fn(|corner| {
        let side = |axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
        center + axes * (half * Vec3::new(side(0), side(1), side(2)))
    })
}
