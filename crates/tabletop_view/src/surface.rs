//! The material of every surface: one colour, lit as the original program lights it (`surface.wgsl`).

use bevy::{
    asset::embedded_asset, prelude::*, render::render_resource::AsBindGroup, shader::ShaderRef,
};
use tabletop_core::Rgb;

/// A surface of one colour. Up-facing faces near the centre of the table show it fully, faces turned away from the lamp
/// at (0, 0, 10) show 80 % of it.
#[derive(Asset, AsBindGroup, TypePath, Clone, Debug)]
pub struct Surface {
    /// Red, green, blue as displayed, 0..=1, and 1.
    #[uniform(0)]
    color: Vec4,
}

impl From<Rgb> for Surface {
    fn from(color: Rgb) -> Self {
        Self {
            color: Vec4::new(color.red, color.green, color.blue, 1.0),
        }
    }
}

impl Material for Surface {
    fn fragment_shader() -> ShaderRef {
        "embedded://tabletop_view/surface.wgsl".into()
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }
}

pub(crate) fn plugin(app: &mut App) {
    embedded_asset!(app, "surface.wgsl");
    app.add_plugins(MaterialPlugin::<Surface>::default());
}
