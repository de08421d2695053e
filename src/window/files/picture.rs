//! Pictures of the view, of any size and without panels.

use std::path::Path;

use bevy::prelude::*;
use tabletop_camera::{Camera, FiguresSeen, Rasterizer, Scene, VisibleWorld};
use tabletop_core::{HeadCamera, Picture};
use tabletop_film::Canvas;
use tabletop_geometry::Pose;
use tabletop_gui::{Notices, Tone};
use tabletop_storage::Storage;

/// The user's camera: its pose in the table's frame, and its angle of view from top to bottom in rad.
pub(super) fn view(world: &mut World) -> Option<(Pose, f32)> {
    let mut cameras = world.query_filtered::<(&Transform, &Projection), With<Camera3d>>();
    let (place, projection) = cameras.iter(world).next()?;
    let fov = match projection {
        Projection::Perspective(perspective) => perspective.fov,
        Projection::Orthographic(_) | Projection::Custom(_) => return None,
    };
    Some((place.into(), fov))
}

/// Saves a picture of the view.
pub(super) fn save(world: &mut World, path: &Path, [width, height]: [u32; 2]) {
    let Some((pose, vertical_fov)) = view(world) else {
        return;
    };
    let camera = Camera {
        pose,
        vertical_fov,
        square_fov: false,
        width,
        height,
        antialiasing: true,
        light: HeadCamera::default().light,
    };
    let drawn = world.run_system_cached_with(draw, camera);
    let written = drawn
        .map_err(|error| error.to_string())
        .and_then(|picture| {
            let bytes = Canvas::of(&picture)
                .png()
                .map_err(|error| error.to_string())?;
            let written = Storage::default().replace(path, &bytes);
            written.map_err(|error| error.to_string())
        });
    let path = path.display();
    let (tone, text) = match written {
        Ok(()) => (Tone::Event, format!("{path} is saved")),
        Err(error) => (Tone::Fault, format!("{path} cannot be saved: {error}")),
    };
    world.resource_mut::<Notices>().renew(tone, &text);
}

fn draw(In(camera): In<Camera>, world: VisibleWorld) -> Picture {
    let (mut scene, mut picture) = (Scene::default(), Picture::default());
    world.draw(FiguresSeen::FromElsewhere, &mut scene, &mut Vec::new());
    Rasterizer::default().draw(&scene, &camera, &mut picture);
    picture
}
