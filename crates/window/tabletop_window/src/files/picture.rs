//! Pictures of the view, of any size and without panels.

use std::path::Path;

use bevy::prelude::*;
use tabletop_camera::{Camera, FiguresSeen, Rasterizer, Scene, VisibleWorld};
use tabletop_core::{HeadCamera, Picture};
use tabletop_film::Canvas;
use tabletop_geometry::Pose;
use tabletop_storage::Storage;
use tabletop_user::{Notices, RobotLook, Tone};

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

fn draw(In(camera): In<Camera>, world: VisibleWorld, look: Res<RobotLook>) -> Picture {
    let mut scene = Scene::default();
    world.draw(FiguresSeen::FromElsewhere, &mut scene, &mut Vec::new());
    drawn(scene, &camera, *look)
}

/// The picture of a scene whose figures are the robot.
fn drawn(mut scene: Scene, camera: &Camera, look: RobotLook) -> Picture {
    let mut rasterizer = Rasterizer::default();
    let mut picture = Picture::default();
    rasterizer.draw(&scene, camera, &mut picture);
    if look.is_translucent {
        let mut behind = Picture::default();
        scene.figures.clear();
        rasterizer.draw(&scene, camera, &mut behind);
        for (color, &behind) in picture.rgb.iter_mut().zip(&behind.rgb) {
            let [front, behind] = [*color, behind].map(f32::from);
            *color = behind.lerp(front, RobotLook::OPACITY).round() as u8;
        }
    }
    picture
}

#[cfg(test)]
mod tests {
    use tabletop_camera::{DrawnFigure, DrawnSolid, Facets};
    use tabletop_geometry::{Rgb, Solid, Triangles};

    use super::*;

    #[test]
    fn what_is_behind_a_translucent_robot_is_seen() {
        let plate = Triangles {
            positions: [[-2.0, -2.0], [2.0, -2.0], [0.0, 2.0]]
                .map(|[x, y]| Vec3::new(x, y, 0.0))
                .into(),
            normals: vec![Vec3::Z; 3],
            colors: vec![Rgb::BLUE; 3],
            indices: vec![[0, 1, 2]],
        };
        let scene = Scene {
            solids: vec![DrawnSolid {
                pose: Pose::IDENTITY,
                solid: Solid::Cuboid(Vec3::splat(6.0)),
                color: Rgb::RED,
                object: 1,
            }],
            figures: vec![DrawnFigure {
                pose: Pose::at(Vec3::Z * 5.0),
                facets: Facets::from(&plate).into(),
                object: 2,
            }],
            markers: Vec::new(),
        };
        let camera = Camera {
            pose: Pose::at(Vec3::Z * 20.0),
            vertical_fov: 0.3,
            square_fov: false,
            width: 9,
            height: 9,
            antialiasing: false,
            light: HeadCamera::default().light,
        };
        let middle = |is_translucent| {
            let picture = drawn(scene.clone(), &camera, RobotLook { is_translucent });
            let first = 3 * (4 * 9 + 4);
            (picture.rgb[first], picture.rgb[first + 2])
        };
        let (red, blue) = middle(false);
        assert!(red < blue, "{red} {blue}");
        let (red, blue) = middle(true);
        assert!(0 < blue && blue < red, "{red} {blue}");
    }
}
