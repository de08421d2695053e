//! Figures of a link's visuals.

use std::sync::Arc;

use bevy::math::{Affine3A, DAffine3, Vec3};
use tabletop_core::{Face, Figure};
use tabletop_geometry::{Rgb, Triangles, UNITS_PER_METER};
use tabletop_kinematics::{Geometry, LinkShape};

use crate::{
    look::{error::LookError, faces::face, meshes, solids},
    source::DescriptionSource,
};

/// The figure of a link's visual, in the frame of the link, in units. `source` is where the description was read from, around
/// which named meshes are found; without it only Baxter's own are known (`package://tabletop/...`).
///
/// # Errors
///
/// A mesh cannot be found or read.
pub fn figure_of(
    visual: &LinkShape,
    source: Option<&DescriptionSource>,
) -> Result<Figure, LookError> {
    let color = visual.color.map_or(Rgb::GRAY, |color| {
        let [red, green, blue, _] = color.map(|part| part as f32);
        Rgb::new(red, green, blue)
    });
    let figure = match &visual.geometry {
        Geometry::Mesh { file, scale } => meshes::figure(file, scale.as_vec3(), color, source)?,
        solid @ (Geometry::Box { .. } | Geometry::Cylinder { .. } | Geometry::Sphere { .. }) => {
            solids::figure(solid, color)
        }
    };
    Ok(placed(figure, visual))
}

/// The stand-in of a link whose look is unknown: its collision shapes, in grey, in the frame
/// of the link, in units. `None` if there are none but meshes.
pub fn stand_in(collisions: &[LinkShape]) -> Option<Figure> {
    let solids = collisions
        .iter()
        .filter(|shape| !matches!(shape.geometry, Geometry::Mesh { .. }));
    merged(solids.map(|shape| placed(solids::figure(&shape.geometry, Rgb::GRAY), shape)))
}

/// One figure that merges all of these; `None` if there are none.
pub fn merged(figures: impl IntoIterator<Item = Figure>) -> Option<Figure> {
    figures.into_iter().reduce(|mut one, other| {
        let append = |surface: &mut Arc<Triangles>, more: &Triangles| {
            Arc::make_mut(surface).append(more);
        };
        append(&mut one.fine, &other.fine);
        append(&mut one.coarse, &other.coarse);
        one
    })
}

/// The robot's screen with a face on it, in the frame of its link, in units. Its visual is
/// `screen.shape.json`.
///
/// # Errors
///
/// The visual cannot be found or read.
pub fn screen_with(
    shown: Face,
    visual: &LinkShape,
    source: Option<&DescriptionSource>,
) -> Result<Figure, LookError> {
    let screen = figure_of(visual, source)?;
    let face = Arc::new(face(shown));
    let face = Figure {
        fine: Arc::clone(&face),
        coarse: face,
    };
    Ok(merged([screen.clone(), placed(face, visual)]).unwrap_or(screen))
}

/// A figure, made in the frame of a visual, in the frame of its link.
fn placed(mut figure: Figure, visual: &LinkShape) -> Figure {
    let DAffine3 {
        matrix3,
        translation,
    } = visual.origin;
    let to_link = Affine3A::from_mat3_translation(
        matrix3.as_mat3(),
        translation.as_vec3() * UNITS_PER_METER as f32,
    );
    if to_link != Affine3A::IDENTITY {
        for surface in [&mut figure.fine, &mut figure.coarse] {
            let surface = Arc::make_mut(surface);
            for point in &mut surface.positions {
                *point = to_link.transform_point3(*point);
            }
            for normal in &mut surface.normals {
                *normal = to_link.transform_vector3(*normal).normalize_or(Vec3::Z);
            }
        }
    }
    figure
}
