//! The material of every surface: a colour in the scene's [`Light`](tabletop_core::Light) (`surface.wgsl`).

use bevy::{
    asset::embedded_asset,
    prelude::*,
    render::render_resource::AsBindGroup,
    shader::{ShaderRef, load_shader_library},
};
use tabletop_core::LIGHT;
use tabletop_geometry::Rgb;

/// A surface of one colour, or of the colours of its vertices. Faces that look up show it exactly, others a fixed share of it.
#[derive(Asset, AsBindGroup, TypePath, Clone, Debug)]
pub struct Surface {
    /// Red, green, blue as displayed, 0..=1, by which the colours of vertices are multiplied, and the opacity.
    #[uniform(0)]
    color: Vec4,
    /// The shares of its colour that it shows along and against the axes.
    #[uniform(0)]
    along: Vec3,
    #[uniform(0)]
    against: Vec3,
}

impl From<Rgb> for Surface {
    fn from(color: Rgb) -> Self {
        Self::translucent(color, 1.0)
    }
}

impl Surface {
    /// A surface that covers this part (0..=1) of the picture behind it.
    pub(crate) fn translucent(color: Rgb, opacity: f32) -> Self {
        Self {
            color: Vec4::new(color.red, color.green, color.blue, opacity),
            along: LIGHT.along,
            against: LIGHT.against,
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
    load_shader_library!(app, "display.wgsl");
    embedded_asset!(app, "surface.wgsl");
    app.add_plugins(MaterialPlugin::<Surface>::default());
}
