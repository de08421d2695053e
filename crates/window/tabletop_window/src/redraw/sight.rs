//! The visible state, summed up.

use std::{
    hash::{BuildHasher as _, Hash, Hasher as _},
    iter,
};

use bevy::{
    ecs::system::SystemParam,
    gizmos::{GizmoAsset, GizmoHandles},
    math::Affine3A,
    platform::hash::{DefaultHasher, FixedHasher},
    prelude::*,
    window::PrimaryWindow,
};
use bevy_egui::{
    EguiRenderOutput,
    egui::epaint::{ClippedPrimitive, Primitive, Rect, Vertex},
};
use tabletop_view::Surface;

use super::cause::RedrawCause;

/// Distance (in units) by which a thing, or part of its size by which a side of it, moves unseen: about a hundredth of a pixel. Bodies at rest
/// tremble by less than that.
const UNSEEN: f32 = 1e-4;

/// The visible state: the things, and a number for each other part, which changes when the part looks different.
#[derive(Clone, Debug, Default)]
pub(super) struct Appearance {
    window: u64,
    camera: u64,
    scene: Vec<VisibleMesh>,
    lines: u64,
    panels: u64,
}

/// A visible part of the scene.
#[derive(Clone, Copy, Debug)]
struct VisibleMesh {
    entity: Entity,
    mesh: AssetId<Mesh>,
    surface: Option<AssetId<Surface>>,
    place: Affine3A,
}

impl VisibleMesh {
    fn looks_like(&self, other: &Self) -> bool {
        self.entity == other.entity
            && self.mesh == other.mesh
            && self.surface == other.surface
            && self.place.abs_diff_eq(other.place, UNSEEN)
    }
}

impl Appearance {
    /// The cause of a difference from another state.
    pub fn difference(&self, other: &Self) -> Option<RedrawCause> {
        [
            (self.window != other.window, RedrawCause::Window),
            (self.camera != other.camera, RedrawCause::Camera),
            (self.scene_differs(other), RedrawCause::Scene),
            (self.lines != other.lines, RedrawCause::Lines),
            (self.panels != other.panels, RedrawCause::Panels),
        ]
        .into_iter()
        .find_map(|(differs, cause)| differs.then_some(cause))
    }

    fn scene_differs(&self, other: &Self) -> bool {
        self.scene.len() != other.scene.len()
            || iter::zip(&self.scene, &other.scene).any(|(one, other)| !one.looks_like(other))
    }
}

/// Everything that is drawn.
#[derive(SystemParam)]
pub(super) struct DrawnQueries<'w, 's> {
    windows: Query<'w, 's, &'static Window, With<PrimaryWindow>>,
    cameras: Query<
        'w,
        's,
        (
            Entity,
            &'static Camera,
            &'static GlobalTransform,
            &'static Msaa,
        ),
    >,
    things: Query<
        'w,
        's,
        (
            Entity,
            &'static GlobalTransform,
            &'static ViewVisibility,
            &'static Mesh3d,
            Option<&'static MeshMaterial3d<Surface>>,
        ),
    >,
    lines: Res<'w, GizmoHandles>,
    line_assets: Res<'w, Assets<GizmoAsset>>,
    panels: Query<'w, 's, &'static EguiRenderOutput>,
}

impl DrawnQueries<'_, '_> {
    pub fn sight(&self) -> Appearance {
        Appearance {
            window: self.window(),
            camera: self.camera(),
            scene: self.scene(),
            lines: self.lines(),
            panels: self.panels(),
        }
    }

    fn window(&self) -> u64 {
        let mut digest = Digest::new();
        for window in &self.windows {
            digest.add(window.physical_size());
            digest.add(window.scale_factor().to_bits());
            digest.add(window.present_mode);
        }
        digest.finish()
    }

    fn camera(&self) -> u64 {
        let mut digest = Digest::new();
        for (entity, camera, place, msaa) in &self.cameras {
            digest.add((entity, camera.is_active, msaa.samples()));
            digest.numbers(&place.to_matrix().to_cols_array());
            digest.numbers(&camera.clip_from_view().to_cols_array());
        }
        digest.finish()
    }

    fn scene(&self) -> Vec<VisibleMesh> {
        let visible = self.things.iter().filter(|(.., seen, _, _)| seen.get());
        visible
            .map(|(entity, place, _, mesh, surface)| VisibleMesh {
                entity,
                mesh: mesh.id(),
                surface: surface.map(|surface| surface.id()),
                place: place.affine(),
            })
            .collect()
    }

    fn lines(&self) -> u64 {
        let mut digest = Digest::new();
        for handle in self.lines.handles().values().flatten() {
            if let Some(lines) = self.line_assets.get(handle) {
                let lines = lines.buffer();
                for points in [&lines.list_positions, &lines.strip_positions] {
                    points
                        .iter()
                        .for_each(|point| digest.numbers(&point.to_array()));
                }
                for colors in [&lines.list_colors, &lines.strip_colors] {
                    colors
                        .iter()
                        .for_each(|color| digest.numbers(&color.to_f32_array()));
                }
            }
        }
        digest.finish()
    }

    fn panels(&self) -> u64 {
        let mut digest = Digest::new();
        for output in &self.panels {
            output
                .paint_jobs
                .iter()
                .for_each(|job| digest.paint_job(job));
        }
        digest.finish()
    }
}

struct Digest(DefaultHasher<'static>);

impl Digest {
    fn new() -> Self {
        Self(FixedHasher.build_hasher())
    }

    fn add(&mut self, value: impl Hash) {
        value.hash(&mut self.0);
    }

    fn numbers(&mut self, numbers: &[f32]) {
        for number in numbers {
            self.0.write_u32(number.to_bits());
        }
    }

    fn paint_job(&mut self, job: &ClippedPrimitive) {
        self.rectangle(job.clip_rect);
        match &job.primitive {
            Primitive::Mesh(mesh) => {
                self.add(mesh.texture_id);
                mesh.indices
                    .iter()
                    .for_each(|index| self.0.write_u32(*index));
                mesh.vertices.iter().for_each(|vertex| self.vertex(vertex));
            }
            Primitive::Callback(callback) => self.rectangle(callback.rect),
        }
    }

    fn vertex(&mut self, vertex: &Vertex) {
        let Vertex { pos, uv, color } = vertex;
        self.numbers(&[pos.x, pos.y, uv.x, uv.y]);
        self.add(color.to_array());
    }

    fn rectangle(&mut self, Rect { min, max }: Rect) {
        self.numbers(&[min.x, min.y, max.x, max.y]);
    }

    fn finish(self) -> u64 {
        self.0.finish()
    }
}
