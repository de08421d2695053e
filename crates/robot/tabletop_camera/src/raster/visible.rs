//! The visible part of a scene.

use std::{ops::Range, sync::Arc};

use bevy::math::{Mat3, Vec2, Vec3, Vec4};
use tabletop_geometry::Solid;

use crate::{
    camera::{FourTurned, Linear, PictureWindow, PinholeView},
    raster::{
        bounds::{corners_of_box, corners_of_solid},
        edge_table::EdgeTable,
        face::{CUBOID, CUBOID_NORMALS, EDGE_ON, ROWS, RasterFace, first_column},
        lighting::Lighting,
        quadric::{Curve, Ends, Quadric},
        surface::{FlatLook, RasterSurface},
        triangle::Triangle,
    },
    scene::{DrawnFigure, DrawnSolid, Facets, Scene},
};

/// The surfaces that face a camera, with their faces and triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibleSurfaces {
    /// The light in which they are seen. As long as it stays the same, so do their looks.
    pub lighting: Lighting,
    /// Looks of the surfaces; the first is the background.
    pub surfaces: Vec<RasterSurface>,
    /// The patches of the surfaces. Surfaces of one patch form a smooth surface without edges between them.
    patches: Vec<u32>,
    /// Flat faces; the first is the background.
    pub faces: Vec<RasterFace>,
    /// The face that most likely stays the same in the next picture: the upper one of the first solid.
    pub backdrop: Option<u32>,
    pub quadrics: Vec<Quadric>,
    /// The rows in which each solid of the scene may be seen.
    solid_rows: Vec<Range<u32>>,
    /// The figures in the order of the scene. As long as they and the view stay the same, so do their triangles and surfaces, which
    /// therefore come first.
    figures: Vec<ProjectedFigure>,
    /// The bits of the view in which they are seen.
    view: Option<[u32; 11]>,
    triangles: Vec<Triangle>,
    edge_table: EdgeTable,
    /// Number of patches.
    patch_count: u32,
    /// The vertices of a figure, four by four.
    vertices: Vec<VisibleFour>,
}

/// The number of surfaces, faces, quadrics, triangles and patches.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SurfaceExtent {
    surfaces: usize,
    pub faces: usize,
    pub quadrics: usize,
    triangles: usize,
    patches: u32,
}

/// A figure in the picture.
#[derive(Clone, Debug)]
struct ProjectedFigure {
    facets: Arc<Facets>,
    pose: [u32; 7],
    object: u32,
    /// The window in which it may be seen.
    window: Option<PictureWindow>,
    /// Number of surfaces, triangles and patches up to and including it.
    surfaces: usize,
    triangles: usize,
    patches: u32,
}

/// Four vertices in the picture, each a lane.
#[derive(Clone, Copy, Debug)]
struct VisibleFour {
    /// Their columns and rows; NaN if they are not in front of the camera.
    pixels: [[f32; 4]; 2],
    /// Their locations relative to the eye, along X, Y and Z.
    places: [[f32; 4]; 3],
    /// The shares of the triangles' colours that they show.
    shares: [f32; 4],
}

/// A corner of a triangle in the picture.
#[derive(Clone, Copy, Debug)]
struct VisibleCorner {
    /// Its location relative to the eye.
    place: Vec3,
    /// The share of the triangle's colour that it shows.
    share: f32,
}

impl VisibleSurfaces {
    /// Replaces everything by this scene; `polyhedra` are its polyhedra as figures.
    pub fn project(&mut self, scene: &Scene, polyhedra: &[DrawnFigure], view: &PinholeView) {
        self.project_figures(scene.figures.iter().chain(polyhedra), view);
        self.faces.clear();
        self.faces.push(RasterFace::NOTHING);
        self.quadrics.clear();
        self.solid_rows.clear();
        self.backdrop = None;
        for (i, drawn) in scene.solids.iter().enumerate() {
            let window = self.add_solid(drawn, view);
            self.solid_rows.push(rows_in(window.as_ref()));
            if i == 0 && self.faces.len() > 1 {
                self.backdrop = Some(self.faces.len() as u32 - 1);
            }
        }
    }

    /// Adds a solid, but for polyhedra, which are figures. Returns the window in which it may be seen.
    pub fn add_solid(&mut self, drawn: &DrawnSolid, view: &PinholeView) -> Option<PictureWindow> {
        let corners = corners_of_solid(drawn, view);
        let window = view.window_of(&corners)?;
        match drawn.solid {
            Solid::Cuboid(_) => self.add_cuboid(drawn, view, window.clone(), &corners),
            Solid::Cylinder { radius, yspan } => {
                self.add_cylinder(drawn, view, window.clone(), radius, yspan);
            }
            Solid::Ball(radius) => self.add_ball(drawn, view, window.clone(), radius),
            Solid::Polyhedron(_) => {}
        }
        Some(window)
    }

    /// Adds a figure until the surfaces are [truncated](Self::truncate).
    pub fn add_passing_figure(&mut self, drawn: &DrawnFigure, view: &PinholeView) {
        let corners = corners_of_box(drawn.pose, drawn.facets.bounds, view);
        if let Some(window) = view.window_of(&corners) {
            self.add_figure(drawn, view, &window);
        }
    }

    /// How much there is of everything.
    pub fn extent(&self) -> SurfaceExtent {
        SurfaceExtent {
            surfaces: self.surfaces.len(),
            faces: self.faces.len(),
            quadrics: self.quadrics.len(),
            triangles: self.triangles.len(),
            patches: self.patch_count,
        }
    }

    /// Forgets what was added after there was this much.
    pub fn truncate(&mut self, extent: SurfaceExtent) {
        self.surfaces.truncate(extent.surfaces);
        self.patches.truncate(extent.surfaces);
        self.faces.truncate(extent.faces);
        self.quadrics.truncate(extent.quadrics);
        self.triangles.truncate(extent.triangles);
        self.patch_count = extent.patches;
    }

    /// The triangles that were added after there was this much.
    pub fn triangles_after(&self, extent: SurfaceExtent) -> &[Triangle] {
        &self.triangles[extent.triangles..]
    }

    /// Projects the figures, except the first ones that are as in the previous picture.
    fn project_figures<'f>(
        &mut self,
        figures: impl Iterator<Item = &'f DrawnFigure> + Clone,
        view: &PinholeView,
    ) {
        let same_view = self.view.replace(view.bits()) == Some(view.bits());
        let pairs = self.figures.iter().zip(figures.clone());
        let unchanged = pairs.take_while(|(before, now)| same_view && before.is_of(now));
        let unchanged = unchanged.count();
        if same_view && unchanged == self.figures.len() && unchanged == figures.clone().count() {
            self.forget_figures_from(unchanged);
            return;
        }
        self.forget_figures_from(unchanged);
        for drawn in figures.skip(unchanged) {
            let corners = corners_of_box(drawn.pose, drawn.facets.bounds, view);
            let window = view.window_of(&corners);
            let window = window.and_then(|window| self.add_figure(drawn, view, &window));
            self.figures.push(ProjectedFigure {
                facets: Arc::clone(&drawn.facets),
                pose: drawn.pose_bits(),
                object: drawn.object,
                window,
                surfaces: self.surfaces.len(),
                triangles: self.triangles.len(),
                patches: self.patch_count,
            });
        }
        let rows = self.triangles.iter().map(|triangle| &triangle.rows);
        self.edge_table.sort(rows, view.height, ROWS as u32);
    }

    /// Forgets all figures from a number on.
    fn forget_figures_from(&mut self, end: usize) {
        let last = end.checked_sub(1).map(|last| &self.figures[last]);
        let (surfaces, triangles, patches) = last.map_or((0, 0, 0), |last| {
            (last.surfaces, last.triangles, last.patches)
        });
        self.surfaces.truncate(surfaces);
        self.patches.truncate(surfaces);
        self.triangles.truncate(triangles);
        self.patch_count = patches;
        self.figures.truncate(end);
        if surfaces == 0 {
            self.add_surface(RasterSurface::NOTHING);
        }
    }

    /// The windows in which figures may be seen.
    pub fn figure_windows(&self) -> impl Iterator<Item = &PictureWindow> {
        self.figures
            .iter()
            .filter_map(|figure| figure.window.as_ref())
    }

    /// The rows in which each solid of the scene may be seen.
    pub fn solid_rows(&self) -> impl Iterator<Item = Range<u32>> {
        self.solid_rows.iter().cloned()
    }

    /// The rows in which each figure of the scene may be seen.
    pub fn figure_rows(&self) -> impl Iterator<Item = Range<u32>> {
        self.figures
            .iter()
            .map(|figure| rows_in(figure.window.as_ref()))
    }

    fn add_cuboid(
        &mut self,
        drawn: &DrawnSolid,
        view: &PinholeView,
        window: PictureWindow,
        corners: &[Vec3; 8],
    ) {
        let lighting = self.lighting;
        for (face, normal) in CUBOID.into_iter().zip(CUBOID_NORMALS) {
            let normal = drawn.pose.rotation * normal;
            let corners = face.map(|corner| corners[corner]);
            let surface = self.surfaces.len() as u32;
            let rows = window.rows.clone();
            let look = || FlatLook::of(drawn, normal, &lighting);
            if let Some(face) = RasterFace::seen(view, corners, normal, rows, surface, look) {
                self.faces.push(face);
                self.add_surface(RasterSurface::flat(drawn, normal, &lighting));
            }
        }
    }

    fn add_cylinder(
        &mut self,
        drawn: &DrawnSolid,
        view: &PinholeView,
        window: PictureWindow,
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
        self.add_surface(RasterSurface::curved(drawn, curve, &self.lighting));
        self.add_surface(RasterSurface::flat(drawn, to_eye, &self.lighting));
    }

    fn add_ball(
        &mut self,
        drawn: &DrawnSolid,
        view: &PinholeView,
        window: PictureWindow,
        radius: f32,
    ) {
        let curve = Curve::around_point(view, drawn.pose.location - view.eye, radius);
        let surface = self.surfaces.len() as u32;
        self.quadrics
            .push(Quadric::new(curve, Ends::NONE, window, [surface; 2]));
        self.add_surface(RasterSurface::curved(drawn, curve, &self.lighting));
    }

    /// Adds the triangles of a figure that may be seen in a window. Returns the window around them.
    fn add_figure(
        &mut self,
        drawn: &DrawnFigure,
        view: &PinholeView,
        window: &PictureWindow,
    ) -> Option<PictureWindow> {
        let facets = &*drawn.facets;
        self.find_vertices(drawn, view);
        let lighting = self.lighting;
        let axes = Mat3::from_quat(drawn.pose.rotation);
        let eye = drawn.pose.inverse() * view.eye;
        let mut seen: Option<PictureWindow> = None;
        for facet in &facets.triangles {
            if facet.normal.dot(eye) - facet.height < EDGE_ON {
                continue;
            }
            let [a, b, c] = facet.corners;
            let pixels = [self.pixel(a), self.pixel(b), self.pixel(c)];
            let Some(own) = window_around(pixels, view, window) else {
                continue;
            };
            let corners = [self.corner(a), self.corner(b), self.corner(c)];
            let places = [corners[0].place, corners[1].place, corners[2].place];
            if pixels.iter().any(|pixel| pixel.is_nan()) && view.is_beside(&places) {
                continue;
            }
            let normal = axes * facet.normal;
            let surface = self.surfaces.len() as u32;
            let rows = own.rows.clone();
            self.triangles
                .push(Triangle::seen(view, places, normal, rows, surface));
            self.surfaces.push(RasterSurface::gouraud(
                drawn.object,
                lighting.lit(facet.color),
                share_by_depth(view, &corners, normal),
            ));
            self.patches.push(self.patch_count + facet.patch);
            seen = Some(seen.map_or(own.clone(), |seen| seen.joined(&own)));
        }
        self.patch_count += facets.patches;
        seen
    }

    /// Finds the vertices of a figure in the picture.
    fn find_vertices(&mut self, drawn: &DrawnFigure, view: &PinholeView) {
        let turned = FourTurned::by(drawn.pose.rotation);
        let [location, eye] =
            [drawn.pose.location, view.eye].map(|at| at.to_array().map(Vec4::splat));
        let pixels_of = view.pixels_of(drawn.pose);
        self.vertices.clear();
        let fours = drawn.facets.vertices.iter().map(|four| {
            let mut places = turned.apply(four.positions);
            for (axis, place) in places.iter_mut().enumerate() {
                *place = *place + location[axis] - eye[axis];
            }
            let shares = self.lighting.four_shares(turned.apply(four.normals));
            VisibleFour {
                pixels: pixels_of(four.positions).map(|at| at.to_array()),
                places: places.map(|at| at.to_array()),
                shares: shares.to_array(),
            }
        });
        self.vertices.extend(fours);
    }

    /// The pixel of a vertex of the figure whose vertices were found last; NaN if it is not in front of the camera.
    #[inline]
    fn pixel(&self, vertex: u32) -> Vec2 {
        let (four, lane) = self.four_with(vertex);
        let [column, row] = &four.pixels;
        Vec2::new(column[lane], row[lane])
    }

    /// A vertex of that figure as the corner of a triangle.
    #[inline]
    fn corner(&self, vertex: u32) -> VisibleCorner {
        let (four, lane) = self.four_with(vertex);
        let [x, y, z] = &four.places;
        VisibleCorner {
            place: Vec3::new(x[lane], y[lane], z[lane]),
            share: four.shares[lane],
        }
    }

    #[inline]
    fn four_with(&self, vertex: u32) -> (&VisibleFour, usize) {
        (&self.vertices[vertex as usize / 4], vertex as usize % 4)
    }

    /// Adds a surface that is a patch of its own.
    fn add_surface(&mut self, surface: RasterSurface) {
        self.surfaces.push(surface);
        self.patches.push(self.patch_count);
        self.patch_count += 1;
    }

    /// The triangles that may be seen in a band of rows.
    pub fn triangles_in_band(&self, band: u32) -> impl Iterator<Item = &Triangle> {
        let triangles = self.edge_table.in_band(band).iter();
        triangles.map(|&i| &self.triangles[i as usize])
    }

    /// True if there is an edge between any of these surfaces.
    pub fn is_edge_between(&self, surfaces: [u32; 5]) -> bool {
        let [first, others @ ..] = surfaces.map(|i| self.patches[i as usize]);
        others.iter().any(|&patch| patch != first)
    }
}

impl ProjectedFigure {
    /// True if it is this one.
    fn is_of(&self, drawn: &DrawnFigure) -> bool {
        Arc::ptr_eq(&self.facets, &drawn.facets)
            && self.pose == drawn.pose_bits()
            && self.object == drawn.object
    }
}

/// The rows of a window; none, if there is no window.
fn rows_in(window: Option<&PictureWindow>) -> Range<u32> {
    window.map_or(0..0, |window| window.rows.clone())
}

/// The window in which a triangle may be seen whose corners have these pixels; `None` if no sample lies in it. If a corner is not in front of the
/// camera, that is the window of the whole figure.
fn window_around(
    corners: [Vec2; 3],
    view: &PinholeView,
    figure: &PictureWindow,
) -> Option<PictureWindow> {
    /// Reach of a pixel's outermost samples, with a bit for rounding.
    const REACH: f32 = 0.375 + 0.01;
    let [a, b, c] = corners;
    if a.is_nan() || b.is_nan() || c.is_nan() {
        return (!figure.rows.is_empty()).then(|| figure.clone());
    }
    let (least, most) = (a.min(b).min(c) - REACH, a.max(b).max(c) + REACH);
    let between = |least, most, count: u32| {
        let first = first_column(least, count as usize) as u32;
        let end = first_column(most, count as usize) as u32;
        (first < end).then_some(first..end)
    };
    let columns = between(least.x, most.x, view.width)?;
    let rows = between(least.y, most.y, view.height)?;
    Some(PictureWindow {
        // A column more on both sides, for rounding errors.
        columns: columns.start.saturating_sub(1)..(columns.end + 1).min(view.width),
        rows,
    })
}

/// The share of its colour that a triangle shows, divided by the depth: given at the corners, and linear in between.
fn share_by_depth(view: &PinholeView, corners: &[VisibleCorner; 3], normal: Vec3) -> Linear {
    let [
        VisibleCorner {
            place: a, share, ..
        },
        VisibleCorner {
            place: b,
            share: share_b,
            ..
        },
        VisibleCorner {
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
