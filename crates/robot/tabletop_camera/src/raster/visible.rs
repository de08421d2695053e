//! The visible part of a scene.

use std::{ops::Range, sync::Arc};

use bevy::math::{Vec3, Vec4};
use tabletop_geometry::Solid;

use crate::{
    camera::{FourLinear, FourTurned, FourVectors, PictureWindow, PinholeView},
    raster::{
        bounds::{corners_of_box, corners_of_solid},
        edge_table::EdgeTable,
        face::{CUBOID, CUBOID_NORMALS, ROWS, RasterFace},
        lighting::Lighting,
        projection::{FigureProjection, lanes_of},
        quadric::{Curve, Ends, Quadric},
        surface::{FlatLook, RasterSurface},
        triangle::{FourTriangles, Triangle},
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
    view: Option<[u32; 12]>,
    triangles: Vec<Triangle>,
    /// The row in which each triangle comes up: they are drawn in this order.
    comes_up: Vec<u32>,
    edge_table: EdgeTable,
    /// Number of patches.
    patch_count: u32,
    projection: FigureProjection,
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

/// A corner of each of four triangles in the picture.
#[derive(Clone, Copy, Debug)]
struct FourCorners {
    /// Its location relative to the eye.
    places: FourVectors,
    /// The share of the triangle's colour that it shows.
    shares: Vec4,
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
        self.add_figure(drawn, view);
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
        self.comes_up.truncate(extent.triangles);
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
            let window = self.add_figure(drawn, view);
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
        (self.edge_table).sort::<{ ROWS as u32 }>(&self.comes_up, rows, view.height);
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
        self.comes_up.truncate(triangles);
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
        let curved = RasterSurface::curved(drawn, self.quadrics.len(), &self.lighting);
        self.quadrics
            .push(Quadric::new(curve, ends, window, [side, side + 1]));
        self.add_surface(curved);
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
        let curved = RasterSurface::curved(drawn, self.quadrics.len(), &self.lighting);
        self.quadrics
            .push(Quadric::new(curve, Ends::NONE, window, [surface; 2]));
        self.add_surface(curved);
    }

    /// Adds the triangles of a figure that may be seen. Returns the window around them.
    fn add_figure(&mut self, drawn: &DrawnFigure, view: &PinholeView) -> Option<PictureWindow> {
        let corners = corners_of_box(drawn.pose, drawn.facets.bounds, view);
        if !view.may_see(&corners) {
            return None;
        }
        let around = self.projection.find(drawn, view);
        let DrawnFigure { pose, facets, .. } = drawn;
        let turned = FourTurned::by(pose.rotation);
        let (location, eye) = (
            FourVectors::splat(pose.location),
            FourVectors::splat(view.eye),
        );
        let lighting = self.lighting;
        for four in self.projection.seen().chunks(4) {
            let own = lanes_of(four, |seen| &facets.triangles[seen.facet as usize]);
            let normals = own.each_ref().map(|facet| facet.normal);
            let normals = turned.apply(FourVectors::of_each(normals));
            let corner = |number: usize| {
                let vertex = |lane: usize| &facets.vertices[own[lane].corners[number] as usize];
                let (a, b, c, d) = (vertex(0), vertex(1), vertex(2), vertex(3));
                let places = FourVectors::of_each([a.place, b.place, c.place, d.place]);
                let normals = FourVectors::of_each([a.normal, b.normal, c.normal, d.normal]);
                FourCorners {
                    places: turned.apply(places) + location - eye,
                    shares: lighting.four_shares(turned.apply(normals)),
                }
            };
            let corners = [corner(0), corner(1), corner(2)];
            let shares = shares_by_depth(view, &corners, normals).each();
            let [a, b, c] = corners;
            let triangles = FourTriangles::seen(view, &[a.places, b.places, c.places], normals);
            for (lane, seen) in four.iter().enumerate() {
                let surface = self.surfaces.len() as u32;
                self.triangles
                    .push(triangles.triangle(lane, seen.rows.clone(), surface));
                self.comes_up.push(seen.comes_up);
                let color = self.lighting.lit(own[lane].color);
                self.surfaces
                    .push(RasterSurface::gouraud(drawn.object, color, shares[lane]));
                self.patches.push(self.patch_count + own[lane].patch);
            }
        }
        self.patch_count += facets.patches;
        around
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

/// The shares of their colours that four triangles show, divided by the depth: given at the corners, and linear in between.
#[inline]
fn shares_by_depth(
    view: &PinholeView,
    corners: &[FourCorners; 3],
    normals: FourVectors,
) -> FourLinear {
    let [a, b, c] = corners;
    let (more_b, more_c) = (b.shares - a.shares, c.shares - a.shares);
    let (a, share) = (a.places, a.shares);
    let (to_b, to_c) = (b.places - a, c.places - a);
    // The vectors whose products with each point of the planes are the shares there.
    let slope = normals * (share / normals.dot(a));
    let volume = a.dot(to_b.cross(to_c));
    let steeper = slope + (to_c.cross(a) * more_b + a.cross(to_b) * more_c) / volume;
    let is_solid = volume.cmpne(Vec4::ZERO);
    view.rays.four_dots(FourVectors {
        x: Vec4::select(is_solid, steeper.x, slope.x),
        y: Vec4::select(is_solid, steeper.y, slope.y),
        z: Vec4::select(is_solid, steeper.z, slope.z),
    })
}
