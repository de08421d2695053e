//! What of a scene a camera can see.

use std::ops::Range;

use bevy::math::{Mat3, Vec2, Vec3};
use tabletop_core::{LIGHT, Solid};

use crate::{
    camera::{Linear, View, Window},
    raster::{
        bounds::{corners_of_box, corners_of_solid},
        edge_table::EdgeTable,
        face::{CUBOID, CUBOID_NORMALS, EDGE_ON, Face, ROWS, first_column},
        quadric::{Curve, Ends, Quadric},
        surface::{FlatLook, Surface, clamp_share},
        triangle::Triangle,
    },
    scene::{DrawnFigure, DrawnSolid, Scene},
};

/// The surfaces that face a camera, and what they bound.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibleSurfaces {
    /// What the surfaces look like; the first stands for nothing.
    pub surfaces: Vec<Surface>,
    /// The patches of the surfaces. Surfaces of the same one are parts of a smooth surface, and between them is no edge.
    patches: Vec<u32>,
    /// Flat faces; the first stands for nothing.
    pub faces: Vec<Face>,
    pub quadrics: Vec<Quadric>,
    /// Where figures may be seen.
    pub figures: Vec<Window>,
    triangles: Vec<Triangle>,
    edge_table: EdgeTable,
    /// So many patches there are.
    patch_count: u32,
    /// The vertices of a figure.
    vertices: Vec<Corner>,
}

/// A corner of a triangle as it is seen.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Where it is seen.
    pixel: Option<Vec2>,
    /// Where it is relative to the eye.
    place: Vec3,
    /// What it shows of the triangle's colour.
    share: f32,
}

impl VisibleSurfaces {
    /// Forgets everything and looks at this scene.
    pub fn project(&mut self, scene: &Scene, view: &View) {
        self.surfaces.clear();
        self.patches.clear();
        self.patch_count = 0;
        self.faces.clear();
        self.add_surface(Surface::NOTHING);
        self.faces.push(Face::NOTHING);
        self.figures.clear();
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
                self.figures.push(window);
            }
        }
        let rows = self.triangles.iter().map(|triangle| &triangle.rows);
        self.edge_table.sort(rows, view.height, ROWS as u32);
    }

    fn add_cuboid(&mut self, drawn: &DrawnSolid, view: &View, window: Window, corners: &[Vec3; 8]) {
        for (face, normal) in CUBOID.into_iter().zip(CUBOID_NORMALS) {
            let normal = drawn.pose.rotation * normal;
            let corners = face.map(|corner| corners[corner]);
            let surface = self.surfaces.len() as u32;
            let rows = window.rows.clone();
            let look = || FlatLook::of(drawn, normal);
            if let Some(face) = Face::seen(view, corners, normal, rows, surface, look) {
                self.faces.push(face);
                self.add_surface(Surface::flat(drawn, normal));
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
        self.add_surface(Surface::curved(drawn, curve));
        self.add_surface(Surface::flat(drawn, to_eye));
    }

    fn add_ball(&mut self, drawn: &DrawnSolid, view: &View, window: Window, radius: f32) {
        let curve = Curve::around_point(view, drawn.pose.location - view.eye, radius);
        let surface = self.surfaces.len() as u32;
        self.quadrics
            .push(Quadric::new(curve, Ends::NONE, window, [surface; 2]));
        self.add_surface(Surface::curved(drawn, curve));
    }

    fn add_figure(&mut self, drawn: &DrawnFigure, view: &View, window: &Window) {
        let facets = &*drawn.facets;
        let axes = Mat3::from_quat(drawn.pose.rotation);
        let pixel_of = view.pixels_of(drawn.pose);
        self.vertices.clear();
        self.vertices
            .extend(facets.vertices.iter().map(|vertex| Corner {
                pixel: pixel_of(vertex.position),
                place: drawn.pose.location + axes * vertex.position - view.eye,
                share: clamp_share(LIGHT.share(axes * vertex.normal)),
            }));
        let eye = drawn.pose.inverse() * view.eye;
        for facet in &facets.triangles {
            if facet.normal.dot(eye) - facet.height < EDGE_ON {
                continue;
            }
            let [a, b, c] = facet.corners;
            let corners = [
                self.vertices[a as usize],
                self.vertices[b as usize],
                self.vertices[c as usize],
            ];
            let Some(rows) = rows_of(&corners, view, window) else {
                continue;
            };
            let places = [corners[0].place, corners[1].place, corners[2].place];
            let normal = axes * facet.normal;
            let surface = self.surfaces.len() as u32;
            self.triangles
                .push(Triangle::seen(view, places, normal, rows, surface));
            self.surfaces.push(Surface::gouraud(
                drawn.object,
                facet.color,
                share_by_depth(view, &corners, normal),
            ));
            self.patches.push(self.patch_count + facet.patch);
        }
        self.patch_count += facets.patches;
    }

    /// Adds a surface that is a patch of its own.
    fn add_surface(&mut self, surface: Surface) {
        self.surfaces.push(surface);
        self.patches.push(self.patch_count);
        self.patch_count += 1;
    }

    /// The triangles that may be seen in a band of rows.
    pub fn triangles_in_band(&self, band: u32) -> impl Iterator<Item = &Triangle> {
        let triangles = self.edge_table.in_band(band).iter();
        triangles.map(|&i| &self.triangles[i as usize])
    }

    /// Whether there is an edge between any of these surfaces.
    pub fn is_edge_between(&self, surfaces: [u32; 5]) -> bool {
        let [first, others @ ..] = surfaces.map(|i| self.patches[i as usize]);
        others.iter().any(|&patch| patch != first)
    }
}

/// The rows in which a triangle with these corners may be seen; `None` if no sample lies in it.
fn rows_of(corners: &[Corner; 3], view: &View, window: &Window) -> Option<Range<u32>> {
    /// The outermost samples of a pixel, and a bit for rounding.
    const REACH: f32 = 0.375 + 0.01;
    let [a, b, c] = corners;
    let (Some(a), Some(b), Some(c)) = (a.pixel, b.pixel, c.pixel) else {
        return (!window.rows.is_empty()).then(|| window.rows.clone());
    };
    let (least, most) = (a.min(b).min(c) - REACH, a.max(b).max(c) + REACH);
    let between = |least, most, count: u32| {
        let first = first_column(least, count as usize) as u32;
        let end = first_column(most, count as usize) as u32;
        (first < end).then_some(first..end)
    };
    between(least.x, most.x, view.width)?;
    between(least.y, most.y, view.height)
}

/// What a triangle shows of its colour, divided by the depth: as it is at the corners, and linear in between.
fn share_by_depth(view: &View, corners: &[Corner; 3], normal: Vec3) -> Linear {
    let [
        Corner {
            place: a, share, ..
        },
        Corner {
            place: b,
            share: share_b,
            ..
        },
        Corner {
            place: c,
            share: share_c,
            ..
        },
    ] = *corners;
    let (more_b, more_c) = (share_b - share, share_c - share);
    // The vector whose product with each point of the plane is the share there.
    let mut slope = normal * (share / normal.dot(a));
    let volume = a.dot((b - a).cross(c - a));
    if volume != 0.0 {
        slope += ((c - a).cross(a) * more_b + a.cross(b - a) * more_c) / volume;
    }
    view.rays.dot(slope)
}
