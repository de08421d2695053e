//! Curves as a table, and as a picture.

use std::{
    fmt::Display,
    path::{Path, PathBuf},
};

use bevy::{
    prelude::*,
    render::view::screenshot::{Screenshot, ScreenshotCaptured},
};
use tabletop_storage::Storage;
use tabletop_user::{Notices, ShownCurves, Tone};

/// Saves the curves that Plots shows as a table.
pub(super) fn save_table(world: &mut World, path: &Path) {
    let table = world.resource::<ShownCurves>().csv();
    let saved = Storage::default().replace(path, table.as_bytes());
    report(&mut world.resource_mut::<Notices>(), path, saved);
}

/// Saves a picture of the plot, once it is seen without the dialog that has asked for its file.
pub(super) fn save_picture(world: &mut World, path: PathBuf) {
    let place = world.resource::<ShownCurves>().place;
    world.spawn(Screenshot::primary_window()).observe(
        move |captured: On<ScreenshotCaptured>, mut notices: ResMut<Notices>| {
            let saved = encoded(&captured.image, place)
                .and_then(|bytes| Ok(Storage::default().replace(&path, &bytes)?));
            report(&mut notices, &path, saved);
        },
    );
}

fn report(notices: &mut Notices, path: &Path, saved: Result<(), impl Display>) {
    let path = path.display();
    match saved {
        Ok(()) => notices.renew(Tone::Event, &format!("{path} is saved")),
        Err(error) => notices.renew(Tone::Fault, &format!("{path} cannot be saved: {error}")),
    }
}

/// A part of a picture of the window, as PNG: from left and top to right and bottom, in pixels.
fn encoded(picture: &Image, place: [f32; 4]) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let picture = picture.clone().try_into_dynamic()?;
    let [left, top, right, bottom] = place.map(|side| side.max(0.0).round() as u32);
    let right = right.min(picture.width());
    let bottom = bottom.min(picture.height());
    let (width, height) = (right.saturating_sub(left), bottom.saturating_sub(top));
    if width == 0 || height == 0 {
        return Err("the plot is outside the window".into());
    }
    let rgb = picture.crop_imm(left, top, width, height).to_rgb8();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}
