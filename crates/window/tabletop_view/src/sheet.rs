//! The plane in which the mouse drags: a translucent sheet over the table, seen from both sides (`sheet.wgsl`).

use bevy::{
    asset::embedded_asset,
    mesh::MeshVertexBufferLayoutRef,
    pbr::{MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    render::render_resource::{
        AsBindGroup, BlendState, RenderPipelineDescriptor, SpecializedMeshPipelineError,
    },
    shader::ShaderRef,
};
use tabletop_core::Table;
use tabletop_user::DragPlane;

use crate::{held::HeldVisual, spans::Spans as _, visual::Filled};

/// Chosen to look on the white table as the original's sheet does, which is blended in display values, and not to
/// outshine the black around the table: the graphics card blends linear values.
const COLOR: LinearRgba = LinearRgba::new(0.12, 0.12, 0.8, 0.25);

/// The border in which the sheet fades: its width within the table's edges, and above the held object, in units.
const RIM: f32 = 2.0;
const HEADROOM: f32 = 1.0;

/// Over how many units it does: it ends a unit beyond the table.
const FADE: f32 = 3.0;

/// A sheet that is seen fully within a box.
#[derive(Asset, AsBindGroup, TypePath, Clone, Copy, Debug, PartialEq)]
pub(crate) struct Translucent {
    #[uniform(0)]
    color: LinearRgba,
    /// The least and the largest coordinates of the box, in units.
    #[uniform(0)]
    least: Vec3,
    #[uniform(0)]
    most: Vec3,
    /// So far from the box nothing is left of it, in units.
    #[uniform(0)]
    fade: f32,
}

impl Translucent {
    /// A sheet over a table, up to a little above the held object.
    fn over(table: &Table, held: Vec3) -> Self {
        let corner = (table.spans() / 2.0 - RIM).max(Vec2::ZERO);
        Self {
            color: COLOR,
            least: held.min((-corner).extend(0.0)),
            most: (held + Vec3::Z * HEADROOM).max(corner.extend(HEADROOM)),
            fade: FADE,
        }
    }

    /// Nothing of it is seen farther from a point than this.
    fn radius(&self, center: Vec3) -> f32 {
        let farthest = (center - self.least).max(self.most - center);
        farthest.length() + self.fade
    }
}

/// Marks the entity that is the sheet.
#[derive(Component)]
struct Sheet;

pub(crate) fn plugin(app: &mut App) {
    embedded_asset!(app, "sheet.wgsl");
    app.add_plugins((MaterialPlugin::<Translucent>::default(), systems));
}

/// All systems but those that draw it.
pub(crate) fn systems(app: &mut App) {
    app.init_resource::<Assets<Translucent>>()
        .add_systems(Startup, spawn_sheet)
        .add_systems(Update, show_sheet);
}

fn spawn_sheet(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<Translucent>>,
) {
    let upright = Plane3d::new(Vec3::Y, Vec2::splat(0.5));
    commands.spawn((
        Sheet,
        Mesh3d(meshes.add(upright)),
        MeshMaterial3d(materials.add(Translucent::over(&Table::default(), Vec3::ZERO))),
        Visibility::Hidden,
    ));
}

/// The sheet is there while the selected hand holds something, and goes through it.
fn show_sheet(
    held: HeldVisual,
    plane: Res<DragPlane>,
    tables: Query<&Table>,
    mut materials: ResMut<Assets<Translucent>>,
    sheet: Single<
        (
            &mut Transform,
            &mut Visibility,
            &MeshMaterial3d<Translucent>,
        ),
        (With<Sheet>, Without<Filled>),
    >,
) {
    let (mut transform, mut visibility, material) = sheet.into_inner();
    let Some(held) = held.get() else {
        visibility.set_if_neq(Visibility::Hidden);
        return;
    };
    visibility.set_if_neq(Visibility::Visible);
    let table = tables.iter().next().copied().unwrap_or_default();
    let center = held.pose.location;
    let seen = Translucent::over(&table, center);
    transform.set_if_neq(Transform {
        translation: center,
        rotation: plane.rotation(),
        scale: Vec3::splat(2.0 * seen.radius(center)),
    });
    if materials.get(material) != Some(&seen)
        && let Some(mut material) = materials.get_mut(material)
    {
        *material = seen;
    }
}

impl Material for Translucent {
    fn fragment_shader() -> ShaderRef {
        "embedded://tabletop_view/sheet.wgsl".into()
    }

    /// Masked surfaces are drawn after the opaque ones and before all lines, so that lines behind the sheet stay as clear
    /// as those before it.
    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::Mask(0.0)
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        _: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.primitive.cull_mode = None;
        if let Some(depth) = &mut descriptor.depth_stencil {
            depth.depth_write_enabled = Some(false);
        }
        if let Some(fragment) = &mut descriptor.fragment {
            for target in fragment.targets.iter_mut().flatten() {
                target.blend = Some(BlendState::ALPHA_BLENDING);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{test_app::test_app, visual};
    use std::f32::consts::FRAC_PI_2;
    use tabletop_core::{Hands, ObjectSpec, Shape};
    use tabletop_geometry::{Pose, Rgb};

    fn app() -> App {
        test_app((visual::plugin, systems))
    }

    fn sheet(app: &mut App) -> (Transform, Visibility) {
        let world = app.world_mut();
        let mut sheets = world.query_filtered::<(&Transform, &Visibility), With<Sheet>>();
        let (transform, visibility) = sheets.single(world).unwrap();
        (*transform, *visibility)
    }

    #[test]
    fn the_sheet_ends_a_little_beyond_the_table_and_the_held_object() {
        let table = Table {
            xspan: 30.0,
            yspan: 10.0,
        };
        for (held, least, most) in [
            (
                Vec3::new(1.0, 2.0, 3.0),
                Vec3::new(-13.0, -3.0, 0.0),
                Vec3::new(13.0, 3.0, 4.0),
            ),
            (
                Vec3::new(20.0, 0.0, -1.0),
                Vec3::new(-13.0, -3.0, -1.0),
                Vec3::new(20.0, 3.0, 1.0),
            ),
        ] {
            let sheet = Translucent::over(&table, held);
            assert_eq!((sheet.least, sheet.most), (least, most));
            let radius = sheet.radius(held);
            for corner in [least, most, least.with_x(most.x), most.with_x(least.x)] {
                assert!(corner.distance(held) + FADE <= radius + 1e-3);
            }
        }
    }

    #[test]
    fn the_sheet_goes_through_the_object_in_the_selected_hand() {
        let mut app = app();
        app.world_mut().spawn(Table {
            xspan: 30.0,
            yspan: 10.0,
        });
        let location = Vec3::new(1.0, 2.0, 3.0);
        let ball = ObjectSpec {
            id: "ball".into(),
            pose: Pose::at(location),
            mass: 1.0,
            shape: Shape::Sphere {
                radius: 1.0,
                color: Rgb::GRAY,
            },
            dynamics: Default::default(),
            descriptions: Vec::new(),
        };
        let place = Transform::from_translation(location);
        let object = app.world_mut().spawn((ball, place)).id();
        app.update();
        assert_eq!(sheet(&mut app).1, Visibility::Hidden);

        let mut hands = app.world_mut().resource_mut::<Hands>();
        let hand = hands.selected;
        hands.set_held(hand, Some(object));
        app.world_mut().resource_mut::<DragPlane>().heading = FRAC_PI_2;
        app.update();
        let (transform, visibility) = sheet(&mut app);
        assert_eq!(visibility, Visibility::Visible);
        assert_eq!(transform.translation, location);
        // The far corners of the table, and no more than that.
        assert!((32.0..40.0).contains(&transform.scale.x), "{transform:?}");
        assert!((transform.rotation * Vec3::X).distance(Vec3::Y) < 1e-6);

        let mut hands = app.world_mut().resource_mut::<Hands>();
        hands.set_held(hand, None);
        app.update();
        assert_eq!(sheet(&mut app).1, Visibility::Hidden);
    }
}
