//! What of a scene a camera can see.

use std::ops::Range;

use bevy::math::{Mat3, Vec2, Vec3};
use tabletop_core::{LIGHT, Solid};

use crate::{
    camera::{Linear, SampleOffset, View, Window},
    raster::{
        bounds::{corners_of_box, corners_of_solid},
        edge_table::EdgeTable,
        face::{CUBOID, CUBOID_NORMALS, EDGE_ON, Face, first_column},
        quadric::{Curve, Ends, Quadric},
        scanline::SampleRow,
        surface::{Surface, clamp_share},
        triangle::Triangle,
    },
    scene::{DrawnFigure, DrawnSolid, Scene, Vertex},
};

/// The surfaces that face a camera, and what they bound.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibleSurfaces {
    /// What the surfaces look like; the first stands for nothing.
    pub surfaces: Vec<Surface>,
    faces: Vec<Face>,
    quadrics: Vec<Quadric>,
    triangles: Vec<Triangle>,
    edge_table: EdgeTable,
    /// So many patches there are.
    patches: u32,
    /// Where in the picture the vertices of a figure are.
    pixels: Vec<Option<Vec2>>,
}

/// What may be seen in a row, as indices.
#[derive(Clone, Debug, Default)]
pub(crate) struct ActiveSurfaces {
    faces: Vec<usize>,
    quadrics: Vec<usize>,
    triangles: Vec<u32>,
}

/// A corner of a triangle as it is seen.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Where it is relative to the eye.
    place: Vec3,
    /// What it shows of the triangle's colour.
    share: f32,
}

impl VisibleSurfaces {
    /// Forgets everything and looks at this scene.
    pub fn project(&mut self, scene: &Scene, view: &View) {
        self.surfaces.clear();
        self.surfaces.push(Surface::NOTHING);
        self.patches = 1;
        self.faces.clear();
        self.quadrics.clear();
        self.triangles.clear();
        for drawn in &scene.solids {
            let corners = corners_of_solid(drawn, view);
            if let Some(window) = view.window_of(&corners) {
                match drawn.solid {
                    Solid::Cuboid(_) => self.add_cuboid(drawn, view, window, &corners),
                    Solid::Cylinder { radius, yspan } => {
                        self.add_cylinder(drawn, view, window, radius, yspan);
                    }
                    Solid::Ball(radius) => self.add_ball(drawn, view, window, radius),
                }
            }
        }
        for drawn in &scene.figures {
            let corners = corners_of_box(drawn.pose, drawn.facets.bounds, view);
            if let Some(window) = view.window_of(&corners) {
                self.add_figure(drawn, view, &window);
            }
        }
        let first_rows = self.triangles.iter().map(|triangle| triangle.rows.start);
        self.edge_table.sort(first_rows, view.height);
    }

    fn add_cuboid(&mut self, drawn: &DrawnSolid, view: &View, window: Window, corners: &[Vec3; 8]) {
        for (face, normal) in CUBOID.into_iter().zip(CUBOID_NORMALS) {
            let normal = drawn.pose.rotation * normal;
            let corners = face.map(|corner| corners[corner]);
            let surface = self.surfaces.len() as u32;
            if let Some(face) = Face::seen(view, corners, normal, window.rows.clone(), surface) {
                self.faces.push(face);
                let patch = self.next_patch();
                self.surfaces.push(Surface::flat(drawn, patch, normal));
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
        self.quadrics
            .push(Quadric::new(curve, ends, window, [side, side + 1]));
        let patches = [self.next_patch(), self.next_patch()];
        self.surfaces.extend([
            Surface::curved(drawn, patches[0], curve),
            Surface::flat(drawn, patches[1], to_eye),
        ]);
    }

    fn add_ball(&mut self, drawn: &DrawnSolid, view: &View, window: Window, radius: f32) {
        let curve = Curve::around_point(view, drawn.pose.location - view.eye, radius);
        let surface = self.surfaces.len() as u32;
        self.quadrics
            .push(Quadric::new(curve, Ends::NONE, window, [surface; 2]));
        let patch = self.next_patch();
        self.surfaces.push(Surface::curved(drawn, patch, curve));
    }

    fn add_figure(&mut self, drawn: &DrawnFigure, view: &View, window: &Window) {
        let facets = &*drawn.facets;
        let axes = Mat3::from_quat(drawn.pose.rotation);
        let pixel_of = view.pixels_of(drawn.pose);
        let positions = facets.vertices.iter().map(|vertex| vertex.position);
        self.pixels.clear();
        self.pixels.extend(positions.map(pixel_of));
        let eye = drawn.pose.inverse() * view.eye;
        for facet in &facets.triangles {
            if facet.normal.dot(eye) - facet.height < EDGE_ON {
                continue;
            }
            let pixels = facet.corners.map(|i| self.pixels[i as usize]);
            let Some(rows) = rows_of(pixels, view, window) else {
                continue;
            };
            let corners = facet.corners.map(|i| {
                let vertex = &facets.vertices[i as usize];
                Corner::of(vertex, drawn.pose.location, &axes, view)
            });
            let places = corners.map(|corner| corner.place);
            let normal = axes * facet.normal;
            let surface = self.surfaces.len() as u32;
            self.triangles
                .push(Triangle::seen(view, places, normal, rows, surface));
            self.surfaces.push(Surface::gouraud(
                drawn.object,
                self.patches + facet.patch,
                facet.color,
                share_by_depth(view, &corners, normal),
            ));
        }
        self.patches += facets.patches;
    }

    fn next_patch(&mut self) -> u32 {
        self.patches += 1;
        self.patches - 1
    }

    /// Finds which triangles come up above a row, so that it can be taken next.
    pub fn activate_above(&self, row: u32, active: &mut ActiveSurfaces) {
        active.triangles.clear();
        active.triangles.extend(self.edge_table.above_row(row));
    }

    /// Finds what may be seen in a row. Rows are taken one after the other.
    pub fn activate_row(&self, row: u32, active: &mut ActiveSurfaces) {
        let ActiveSurfaces {
            faces,
            quadrics,
            triangles,
        } = active;
        faces.clear();
        faces.extend((0..self.faces.len()).filter(|&face| self.faces[face].rows.contains(&row)));
        quadrics.clear();
        quadrics.extend(
            (0..self.quadrics.len())
                .filter(|&quadric| self.quadrics[quadric].window.rows.contains(&row)),
        );
        triangles.retain(|&triangle| row < self.triangles[triangle as usize].rows.end);
        triangles.extend(self.edge_table.in_row(row));
    }

    /// Finds which surface is nearest at each of these samples of a row, in which no more may be seen than this.
    pub fn sample(
        &self,
        active: &ActiveSurfaces,
        row: u32,
        offset: SampleOffset,
        samples: &mut SampleRow,
    ) {
        for &face in &active.faces {
            self.faces[face].draw(row, offset, samples);
        }
        for &quadric in &active.quadrics {
            self.quadrics[quadric].draw(row, offset, samples);
        }
    }

    /// Finds where figures are nearer than what was found at each of these samples of a row.
    pub fn sample_figures<const N: usize>(
        &self,
        active: &ActiveSurfaces,
        row: u32,
        offsets: [SampleOffset; N],
        samples: &mut [SampleRow; N],
    ) {
        for &triangle in &active.triangles {
            self.triangles[triangle as usize].draw(row, offsets, samples);
        }
    }

    /// Whether there is an edge between any of these surfaces.
    pub fn is_edge_between(&self, surfaces: [u32; 5]) -> bool {
        let [first, others @ ..] = surfaces.map(|i| self.surfaces[i as usize].patch);
        others.iter().any(|&patch| patch != first)
    }
}

impl Corner {
    fn of(vertex: &Vertex, location: Vec3, axes: &Mat3, view: &View) -> Self {
        Self {
            place: location + *axes * vertex.position - view.eye,
            share: clamp_share(LIGHT.share(*axes * vertex.normal)),
        }
    }
}

/// The rows in which a triangle with these corners may be seen; `None` if no sample lies in it.
fn rows_of(corners: [Option<Vec2>; 3], view: &View, window: &Window) -> Option<Range<u32>> {
    /// The outermost samples of a pixel, and a bit for rounding.
    const REACH: f32 = 0.375 + 0.01;
    let [Some(a), Some(b), Some(c)] = corners else {
        return (!window.rows.is_empty()).then(|| window.rows.clone());
    };
    let (least, most) = (a.min(b).min(c) - REACH, a.max(b).max(c) + REACH);
    let between = |least, most, count: u32| {
        let [first, end] = [least, most].map(|x| first_column(x, count as usize) as u32);
        (first < end).then_some(first..end)
    };
    between(least.x, most.x, view.width)?;
    between(least.y, most.y, view.height)
}

/// What a triangle shows of its colour, divided by the depth: as it is at the corners, and linear in between.
fn share_by_depth(view: &View, corners: &[Corner; 3], normal: Vec3) -> Linear {
    let [a, b, c] = corners.map(|corner| corner.place);
    let [share, more_b, more_c] = [0, 1, 2].map(|i| match i {
        0 => corners[0].share,
        _ => corners[i].share - corners[0].share,
    });
    // The vector whose product with each point of the plane is the share there.
    let mut slope = normal * (share / normal.dot(a));
    let volume = a.dot((b - a).cross(c - a));
    if volume != 0.0 {
        slope += ((c - a).cross(a) * more_b + a.cross(b - a) * more_c) / volume;
    }
    view.rays.dot(slope)
}
