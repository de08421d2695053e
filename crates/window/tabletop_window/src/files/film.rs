//! Videos of recordings, made while the window goes on.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_camera::{CameraPlace, CameraSpec};
use tabletop_core::Timeline;
use tabletop_film::{Film, FilmFormat, FilmPace};
use tabletop_replay::Replay;
use tabletop_storage::Storage;
use tabletop_user::{Notices, Tone};
use tabletop_xml::AllowedFolders;

use super::picture::view;
use crate::background::BackgroundWork;

/// The size of its pictures, in columns and rows.
const SIZE: [u32; 2] = [960, 720];
/// Those of an animation and a contact sheet.
const SMALL: [u32; 2] = [480, 360];

/// The video that is being made.
#[derive(Resource, Default)]
pub(super) struct Filming(Option<(PathBuf, BackgroundWork<()>)>);

/// Begins a video of the recording that the Timeline shows, seen from the user's camera.
pub(super) fn begin(world: &mut World, path: PathBuf) {
    if world.resource::<Filming>().0.is_some() {
        let reason = "another video is being made; wait until it is saved";
        world.resource_mut::<Notices>().renew(Tone::Fault, reason);
        return;
    }
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let Some(format) = FilmFormat::of_extension(&extension) else {
        let path = path.display();
        let reason = format!("{path}: expected a name that ends in .mp4, .gif or .png");
        world.resource_mut::<Notices>().renew(Tone::Fault, &reason);
        return;
    };
    let Some((pose, fov)) = view(world) else {
        return;
    };
    let size = match format {
        FilmFormat::Mp4 => SIZE,
        FilmFormat::Gif | FilmFormat::Png => SMALL,
    };
    let camera = CameraSpec {
        name: "view".into(),
        viewpoint: CameraPlace::Standing(pose),
        size: Some(size),
        vertical_fov: Some(fov),
    };
    let usual = Film::of(camera);
    let fps = format.usual_fps();
    let film = Film {
        pace: FilmPace { fps, ..usual.pace },
        has_captions: true,
        ..usual
    };
    let folder = world.resource::<Timeline>().folder.clone();
    let allowed = world.resource::<AllowedFolders>().0.clone();
    let place = path.clone();
    let work = BackgroundWork::begin(move || make(&film, format, &folder, &allowed, &place));
    let text = format!("{} is being made", path.display());
    world.resource_mut::<Notices>().renew(Tone::Event, &text);
    world.resource_mut::<Filming>().0 = Some((path, work));
}

fn make(
    film: &Film,
    format: FilmFormat,
    recording: &Path,
    allowed: &[PathBuf],
    path: &Path,
) -> Result<(), String> {
    let replay = Replay::read_allowing(recording, allowed).map_err(|error| error.to_string())?;
    let bytes = film.develop(&replay, format, |_, _| {});
    let bytes = bytes.map_err(|error| error.to_string())?;
    let written = Storage::default().replace(path, &bytes);
    written.map_err(|error| error.to_string())
}

/// Says that a video is saved, or why not.
pub(super) fn take_result(mut filming: ResMut<Filming>, mut notices: ResMut<Notices>) {
    let filming = filming.bypass_change_detection();
    let Some((path, work)) = &mut filming.0 else {
        return;
    };
    let Some(result) = work.result() else { return };
    let path = path.display();
    match result {
        Ok(()) => notices.renew(Tone::Event, &format!("{path} is saved")),
        Err(error) => notices.renew(Tone::Fault, &format!("{path} cannot be saved: {error}")),
    }
    filming.0 = None;
}
