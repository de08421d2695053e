//! A picture of the window, for tests and documents.

use std::{
    error::Error,
    path::{Path, PathBuf},
};

use bevy::{
    diagnostic::FrameCount,
    prelude::*,
    render::view::screenshot::{Screenshot, ScreenshotCaptured},
};
use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_gui::Unattended;
use tabletop_storage::Storage;

/// Number of frames after which everything on the table is certainly drawn.
const WARM_UP_FRAMES: u32 = 5;

/// A picture of the window at a simulated time. When it is written, the program ends.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct ScreenshotAt {
    /// The PNG file.
    pub path: PathBuf,
    /// Number of seconds of simulated time.
    pub seconds: f32,
}

impl ScreenshotAt {
    pub(super) fn plan(self, app: &mut App) {
        app.insert_resource(self)
            .insert_resource(Unattended)
            .add_systems(Update, take.run_if(is_due.and_then(run_once)));
    }

    fn tick(&self) -> u64 {
        (f64::from(self.seconds) * f64::from(TICKS_PER_SECOND)).ceil() as u64
    }
}

fn is_due(plan: Res<ScreenshotAt>, tick: Res<SimTick>, frames: Res<FrameCount>) -> bool {
    tick.0 >= plan.tick() && frames.0 >= WARM_UP_FRAMES
}

fn take(plan: Res<ScreenshotAt>, mut commands: Commands) {
    commands
        .spawn(Screenshot::primary_window())
        .observe(save_and_exit(plan.path.clone()));
}

fn save_and_exit(path: PathBuf) -> impl FnMut(On<ScreenshotCaptured>, MessageWriter<AppExit>) {
    move |captured, mut exit| match save(&captured.image, &path) {
        Ok(()) => {
            exit.write(AppExit::Success);
        }
        Err(error) => {
            error!("cannot write the picture {}: {error}", path.display());
            exit.write(AppExit::error());
        }
    }
}

fn save(picture: &Image, path: &Path) -> Result<(), Box<dyn Error>> {
    // The window's transparency has no meaning.
    let rgb = picture.clone().try_into_dynamic()?.to_rgb8();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, rgb.width(), rgb.height());
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Storage::default().replace(path, &bytes)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::asset::RenderAssetUsages;
    use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

    fn picture() -> Image {
        Image::new_fill(
            Extent3d {
                width: 3,
                height: 2,
                depth_or_array_layers: 1,
            },
            TextureDimension::D2,
            &[255, 128, 0, 255],
            TextureFormat::Rgba8UnormSrgb,
            RenderAssetUsages::MAIN_WORLD,
        )
    }

    #[test]
    fn a_picture_is_written_as_png() {
        let path = std::env::temp_dir().join(format!("tabletop-{}.png", std::process::id()));
        save(&picture(), &path).unwrap();
        assert!(std::fs::read(&path).unwrap().starts_with(b"\x89PNG"));
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_picture_that_cannot_be_written_ends_the_program_with_an_error() {
        let mut app = App::new();
        app.add_message::<AppExit>();
        let camera = app
            .world_mut()
            .spawn_empty()
            .observe(save_and_exit("/nowhere/picture.png".into()))
            .id();
        app.world_mut().trigger(ScreenshotCaptured {
            entity: camera,
            image: picture(),
        });
        assert_eq!(app.should_exit(), Some(AppExit::error()));
    }

    #[test]
    fn a_time_is_the_tick_that_reaches_it() {
        let at = |seconds| {
            let path = PathBuf::new();
            ScreenshotAt { path, seconds }.tick()
        };
        assert_eq!(at(0.0), 0);
        assert_eq!(at(2.0), 120);
        assert_eq!(at(0.01), 1);
    }
}
