//! The material of every surface: a colour, lit as the original program lights it (`surface.wgsl`).

use bevy::{
    asset::embedded_asset, prelude::*, render::render_resource::AsBindGroup, shader::ShaderRef,
};
use tabletop_core::Rgb;

/// A surface of one colour, or of the colours of its vertices. Up-facing faces near the centre of the table show it fully, faces turned away from the lamp
/// at (0, 0, 10) show 80 % of it.
#[derive(Asset, AsBindGroup, TypePath, Clone, Debug)]
pub struct Surface {
    /// Red, green, blue as displayed, 0..=1, by which the colours of vertices are multiplied, and the opacity.
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

impl Surface {
    /// A surface that covers this part (0..=1) of what is behind it.
    pub(crate) fn translucent(color: Rgb, opacity: f32) -> Self {
        let Self { color } = color.into();
        Self {
            color: color.with_w(opacity),
        }
    }
}

impl Material for Surface {
    fn fragment_shader() -> ShaderRef {
        "embedded://tabletop_view/surface.wgsl".into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        if self.color.w < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        }
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
