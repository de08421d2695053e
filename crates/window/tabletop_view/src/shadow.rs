//! Shadows of objects on the table, straight below them: sharp and dark where an object stands, wide and pale where it hovers, so that
//! its place and height can be seen (`shadow.wgsl`).

use std::f32::consts::TAU;

use bevy::{
    asset::{RenderAssetUsages, embedded_asset},
    camera::visibility::NoFrustumCulling,
    mesh::{Indices, MeshVertexBufferLayoutRef, PrimitiveTopology},
    pbr::{MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    render::render_resource::{
        AsBindGroup, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites,
        RenderPipelineDescriptor, SpecializedMeshPipelineError,
    },
    shader::ShaderRef,
};
use tabletop_core::Table;
use tabletop_geometry::{PlacedSolid, Pose, Primitive, Solid};
use tabletop_user::Ambience;

use crate::{
    hull::convex_hull,
    polyhedron,
    spans::Spans as _,
    visual::{Filled, Visual},
};

/// Height of shadows over the table's top, in units: no picture tells it from the top itself.
const LIFT: f32 = 0.0005;

/// Width of the border of a shadow in which it fades, in units: where the object stands, and more a unit of height.
const BORDER: f32 = 0.35;
const BORDER_GROWTH: f32 = 0.3;

/// The part of the light that a shadow takes where the object stands, 0..=1, and the height, in units, at which it is half of that.
const DARKNESS: f32 = 0.5;
const HALF_DARK: f32 = 5.0;

/// Corners of the border around a corner of a shadow.
const ROUND: u32 = 3;

/// The material of all shadows, within the top of a table of these spans in units.
#[derive(Asset, AsBindGroup, TypePath, Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shade {
    #[uniform(0)]
    span: Vec2,
}

/// Marks the entity that is all shadows.
#[derive(Component)]
pub(crate) struct Shadows;

/// The triangles of shadows.
#[derive(Clone, Debug, Default, PartialEq)]
struct Dusk {
    positions: Vec<Vec3>,
    /// Of each position, the part of the light that its shadow takes where it is fully dark, 0..=1, and the part of that which it takes there.
    shades: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

pub(crate) fn plugin(app: &mut App) {
    embedded_asset!(app, "shadow.wgsl");
    app.add_plugins((MaterialPlugin::<Shade>::default(), systems));
}

/// All systems but those that draw them.
pub(crate) fn systems(app: &mut App) {
    app.init_resource::<Assets<Shade>>()
        .add_systems(Startup, spawn)
        .add_systems(Update, (show.run_if(resource_changed::<Ambience>), cast));
}

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<Shade>>,
) {
    let table = Table::default();
    commands.spawn((
        Shadows,
        Visibility::default(),
        Mesh3d(meshes.add(Dusk::over(&table).mesh())),
        MeshMaterial3d(materials.add(Shade::over(&table))),
        // Its bounds change with whatever moves.
        NoFrustumCulling,
    ));
}

fn show(ambience: Res<Ambience>, mut shadows: Single<&mut Visibility, With<Shadows>>) {
    shadows.set_if_neq(match ambience.is_room() {
        true => Visibility::Inherited,
        false => Visibility::Hidden,
    });
}

/// Casts the shadows anew when something has moved, come or gone.
fn cast(
    ambience: Res<Ambience>,
    tables: Query<Ref<Table>>,
    objects: Query<(Ref<Transform>, &Filled, &Visual)>,
    mut gone: RemovedComponents<Filled>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<Shade>>,
    shadows: Single<(&Mesh3d, &MeshMaterial3d<Shade>), With<Shadows>>,
) {
    let has_gone = gone.read().count() > 0;
    let has_moved = objects.iter().any(|(place, ..)| place.is_changed());
    let table = tables.iter().next();
    let is_new = table.as_ref().is_some_and(|table| table.is_changed());
    if !ambience.is_room() || !(has_gone || has_moved || is_new || ambience.is_changed()) {
        return;
    }
    let table = table.map_or_else(Table::default, |table| *table);
    let mut dusk = Dusk::over(&table);
    for (place, filled, visual) in &objects {
        if !tables.contains(visual.of) {
            dusk.add(&filled.0, Pose::from(&*place));
        }
    }
    let (mesh, material) = *shadows;
    drop(meshes.insert(mesh.id(), dusk.mesh()));
    let shade = Shade::over(&table);
    if materials.get(material) != Some(&shade) {
        drop(materials.insert(material.id(), shade));
    }
}

impl Shade {
    fn over(table: &Table) -> Self {
        Self {
            span: table.spans(),
        }
    }
}

impl Dusk {
    /// The light that falls on the top of a table on which nothing is.
    fn over(table: &Table) -> Self {
        let corner = table.spans() / 2.0;
        let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let positions = signs.map(|(x, y)| (corner * Vec2::new(x, y)).extend(LIFT));
        Self {
            positions: positions.to_vec(),
            shades: vec![[0.0; 2]; 4],
            indices: vec![0, 1, 2, 0, 2, 3],
        }
    }

    /// Adds the shadow of a body.
    fn add(&mut self, solids: &[Primitive], body: Pose) {
        for primitive in solids {
            let [bottom, top] = PlacedSolid::of(primitive, body).heights();
            if top > 0.0 {
                let pose = body * primitive.pose;
                self.add_polygon(&covered(&primitive.solid, pose), bottom.max(0.0));
            }
        }
    }

    /// Adds the shadow of a convex polygon at this height.
    fn add_polygon(&mut self, corners: &[Vec2], height: f32) {
        let count = corners.len();
        if count < 3 {
            return;
        }
        let darkness = DARKNESS * HALF_DARK / (HALF_DARK + height);
        let border = BORDER + BORDER_GROWTH * height;
        let at = |number: usize| corners[number % count];
        let outwards = |number: usize| {
            let along = (at(number + 1) - at(number)).normalize_or_zero();
            Vec2::new(along.y, -along.x)
        };
        let inner = self.positions.len() as u32;
        for number in 0..count {
            self.push(at(number), [darkness, 1.0]);
        }
        for number in 2..count as u32 {
            self.indices
                .extend([inner, inner + number - 1, inner + number]);
        }
        // Around each corner from the direction of one edge to that of the next.
        let outer = self.positions.len() as u32;
        for number in 0..count {
            let from = outwards(number + count - 1).to_angle();
            let turn = (outwards(number).to_angle() - from).rem_euclid(TAU);
            for step in 0..=ROUND {
                let angle = from + turn * step as f32 / ROUND as f32;
                self.push(
                    at(number) + border * Vec2::from_angle(angle),
                    [darkness, 0.0],
                );
            }
        }
        let a_corner = ROUND + 1;
        let around = count as u32 * a_corner;
        for number in 0..count as u32 {
            let next = (number + 1) % count as u32;
            let first = number * a_corner;
            for step in 0..ROUND {
                self.indices.extend([
                    inner + number,
                    outer + first + step,
                    outer + first + step + 1,
                ]);
            }
            let (last, beyond) = (outer + first + ROUND, outer + (first + a_corner) % around);
            self.indices.extend([inner + number, last, beyond]);
            self.indices.extend([inner + number, beyond, inner + next]);
        }
    }

    fn push(&mut self, place: Vec2, shade: [f32; 2]) {
        self.positions.push(place.extend(LIFT));
        self.shades.push(shade);
    }

    fn mesh(self) -> Mesh {
        let colors: Vec<_> = self
            .shades
            .iter()
            .map(|&[dark, part]| [dark, part, 0.0, 1.0])
            .collect();
        let normals = vec![Vec3::Z; self.positions.len()];
        Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::default(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(Indices::U32(self.indices))
    }
}

/// The convex polygon of the table above which a solid is.
fn covered(solid: &Solid, pose: Pose) -> Vec<Vec2> {
    let corners = match *solid {
        Solid::Ball(radius) => polyhedron::rim(radius)
            .map(|point| pose.location.truncate() + point.xz())
            .collect(),
        Solid::Cuboid(_) | Solid::Cylinder { .. } | Solid::Polyhedron(_) => {
            let corners = polyhedron::corners(solid).into_iter();
            corners.map(|corner| (pose * corner).truncate()).collect()
        }
    };
    convex_hull(corners, |corner| corner)
}

impl Material for Shade {
    fn fragment_shader() -> ShaderRef {
        "embedded://tabletop_view/shadow.wgsl".into()
    }

    /// Masked surfaces are drawn after the opaque ones and before all lines.
    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::Mask(0.0)
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    /// Of shadows that lie upon each other, the darkest is seen.
    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        _: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let darkest = BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
            operation: BlendOperation::Min,
        };
        if let Some(depth) = &mut descriptor.depth_stencil {
            depth.depth_write_enabled = Some(false);
        }
        if let Some(fragment) = &mut descriptor.fragment {
            for target in fragment.targets.iter_mut().flatten() {
                target.blend = Some(BlendState {
                    color: darkest,
                    alpha: darkest,
                });
                target.write_mask = ColorWrites::COLOR;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{test_app::test_app, visual};
    use tabletop_core::{ObjectSpec, Shape};
    use tabletop_geometry::Rgb;

    fn cube(height: f32) -> Dusk {
        let mut dusk = Dusk::default();
        let body = Pose::at(Vec3::new(3.0, 2.0, height + 0.5));
        let solid = Solid::Cuboid(Vec3::ONE);
        let (pose, color) = (Pose::IDENTITY, Rgb::GRAY);
        dusk.add(&[Primitive { pose, solid, color }], body);
        dusk
    }

    /// The half width of a shadow, and its greatest darkness.
    fn extent(dusk: &Dusk) -> (f32, f32) {
        let widths = dusk.positions.iter().map(|place| (place.x - 3.0).abs());
        let darkness = dusk.shades.iter().map(|[darkness, _]| *darkness);
        (widths.fold(0.0, f32::max), darkness.fold(0.0, f32::max))
    }

    #[test]
    fn a_shadow_is_below_its_object_and_gets_wide_and_pale_with_its_height() {
        let (standing, hovering) = (extent(&cube(0.0)), extent(&cube(3.0)));
        assert!((standing.0 - 0.5 - BORDER).abs() < 1e-4, "{standing:?}");
        assert!((standing.1 - DARKNESS).abs() < 1e-6, "{standing:?}");
        assert!(hovering.0 > standing.0 && hovering.1 < standing.1);
    }

    #[test]
    fn its_triangles_look_up_and_fill_it() {
        let dusk = cube(0.0);
        let area: f32 = dusk
            .indices
            .chunks(3)
            .map(|corners| {
                let [a, b, c] = [0, 1, 2].map(|i| dusk.positions[corners[i] as usize].truncate());
                let area = (b - a).perp_dot(c - a) / 2.0;
                assert!(area > -1e-6, "{corners:?}");
                area
            })
            .sum();
        // The square, a strip at each side, and a quarter of a twelve-sided circle at each corner.
        let expected = 1.0 + 4.0 * BORDER + 3.0 * BORDER * BORDER;
        assert!((area - expected).abs() < 1e-3, "{area}, not {expected}");
    }

    #[test]
    fn what_is_below_the_table_has_none() {
        assert_eq!(cube(-1.1), Dusk::default());
        assert_ne!(cube(-0.9), Dusk::default());
    }

    #[test]
    fn shadows_follow_what_moves_and_go_with_it() {
        let mut app = test_app((visual::plugin, systems));
        let corners = |app: &mut App| {
            app.update();
            let world = app.world_mut();
            let mut shadows = world.query_filtered::<&Mesh3d, With<Shadows>>();
            let mesh = shadows.single(world).unwrap().id();
            let meshes = world.resource::<Assets<Mesh>>();
            meshes.get(mesh).unwrap().count_vertices()
        };
        let empty = corners(&mut app);
        app.world_mut().spawn(Table::default());
        assert_eq!(corners(&mut app), empty);
        let shape = Shape::Sphere {
            radius: 1.0,
            color: Rgb::GRAY,
        };
        let ball = ObjectSpec::new("ball", Pose::at(Vec3::Z), 1.0, shape);
        let object = app.world_mut().spawn((ball, Transform::IDENTITY)).id();
        assert!(corners(&mut app) > empty);
        app.world_mut().entity_mut(object).despawn();
        corners(&mut app);
        assert_eq!(corners(&mut app), empty);
    }
}
