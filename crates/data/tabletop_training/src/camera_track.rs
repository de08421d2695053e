//! The pictures of episodes: those of the recording, or others that are made by simulating it again.

use std::{collections::BTreeMap, sync::Arc};

use tabletop_camera::{CameraPlace, CameraSpec, SeenThing, Shot};
use tabletop_core::{Picture, SimTick};
use tabletop_film::{Canvas, FilmError, Footage, VideoCoding, VideoEncoder, VideoTrack};
use tabletop_geometry::UNITS_PER_METER;
use tabletop_recorder::RecordingReader;
use tabletop_replay::Replay;
use tabletop_storage::InnerFile;
use tabletop_task::Demonstration;

use crate::{
    episode::{CameraTrack, EncodedVideo},
    error::EpisodeError,
    image::Image,
    selection::PictureSelection,
};

/// Of so many frames of a video one at least can be decoded by itself: learners jump to any of them.
const KEYS: u32 = 8;

/// The number of a thing that is neither the table nor an object.
const ANYTHING_ELSE: u16 = u16::MAX;

/// The recorded pictures of every camera at every frame.
pub(crate) fn recorded_cameras(
    recording: &RecordingReader,
    frames: usize,
) -> Result<Vec<CameraTrack>, EpisodeError> {
    let segments = recording.segments()?;
    let recorded = segments.iter().flat_map(|segment| &segment.frames);
    let recorded: BTreeMap<_, _> = recorded.map(|frame| (frame.number, frame)).collect();
    let of_hands = recording.header().hand_cameras.iter();
    let hands = of_hands.map(|camera| camera.name.as_str());
    let mut tracks = Vec::new();
    for name in std::iter::once("head").chain(hands) {
        let picture = |number: u64| -> Option<&InnerFile> {
            let frame = recorded.get(&number)?;
            match name {
                "head" => Some(&frame.picture),
                hand => frame.hand_pictures.get(hand),
            }
        };
        let mut track = CameraTrack::named(name);
        let mut latest: Option<Arc<Image>> = None;
        for number in 0..frames as u64 {
            if let Some(file) = picture(number) {
                let first = latest.as_ref().map(|image| [image.width, image.height]);
                let size = recording.picture_size(name).or(first);
                latest = Some(Arc::new(Image::read_sized(file, size)?));
            }
            let image = latest.clone().ok_or_else(|| EpisodeError::Unfit {
                recording: recording.folder().to_owned(),
                problem: format!("its first frame has no picture of the {name} camera"),
            })?;
            track.images.push(image);
        }
        tracks.push(track);
    }
    Ok(tracks)
}

/// Pictures of every camera at the ends of these ticks, made by simulating the recording again.
pub(crate) fn filmed_cameras(
    replay: &Replay,
    shown: &Demonstration,
    selection: &PictureSelection,
    ticks: &[SimTick],
) -> Result<Vec<CameraTrack>, EpisodeError> {
    let cameras = match &selection.cameras {
        Some(cameras) => cameras.clone(),
        None => recorded_as(replay),
    };
    let cameras = cameras.into_iter().map(|camera| CameraSpec {
        size: selection.size.or(camera.size),
        ..camera
    });
    let cameras: Vec<_> = cameras.collect();
    let names = cameras.iter().map(|camera| camera.name.as_str());
    let mut tracks: Vec<_> = names.map(CameraTrack::named).collect();
    let shoot = |tick, shots: &[Shot]| {
        for (track, shot) in tracks.iter_mut().zip(shots) {
            track.add(shot, shown, tick, selection, replay)?;
        }
        Ok::<_, EpisodeError>(())
    };
    Footage::new(replay, cameras).shoot(ticks.iter().copied(), shoot)?;
    Ok(tracks)
}

/// The cameras of a recording.
fn recorded_as(replay: &Replay) -> Vec<CameraSpec> {
    let camera = |name: &str, viewpoint| CameraSpec {
        name: name.into(),
        viewpoint,
        size: None,
        vertical_fov: None,
    };
    let hands = replay.hand_cameras().iter();
    let hands = hands.map(|hand| camera(&hand.name, CameraPlace::Hand(hand.name.clone())));
    std::iter::once(camera("head", CameraPlace::Head))
        .chain(hands)
        .collect()
}

impl CameraTrack {
    /// A camera without pictures.
    pub(crate) fn named(name: &str) -> Self {
        Self {
            name: name.into(),
            images: Vec::new(),
            depths: Vec::new(),
            video: None,
            ids: Vec::new(),
        }
    }

    /// Adds a picture, which it shares with the one before if it is the same.
    fn add(
        &mut self,
        shot: &Shot,
        shown: &Demonstration,
        tick: SimTick,
        selection: &PictureSelection,
        replay: &Replay,
    ) -> Result<(), EpisodeError> {
        let Shot { picture, things } = shot;
        let unfit = |problem: String| EpisodeError::Unfit {
            recording: replay.folder().to_owned(),
            problem,
        };
        if picture.rgb.is_empty() {
            return Err(unfit(format!(
                "its robot does not carry the camera {}",
                self.name
            )));
        }
        let last = self.images.last().filter(|last| last.rgb == picture.rgb);
        let image = match last {
            Some(last) => Arc::clone(last),
            None => {
                let image = Image::new(picture.width, picture.height, picture.rgb.clone());
                Arc::new(image.map_err(|error| unfit(error.to_string()))?)
            }
        };
        self.images.push(image);
        if selection.has_depth {
            push_shared(&mut self.depths, depths_of(picture));
        }
        if selection.has_ids {
            let numbers: Vec<_> = things
                .iter()
                .map(|thing| number_of(thing, shown, tick))
                .collect();
            let number = |object: &u32| match object.checked_sub(1) {
                None => 0,
                Some(place) => numbers
                    .get(place as usize)
                    .copied()
                    .unwrap_or(ANYTHING_ELSE),
            };
            push_shared(&mut self.ids, picture.objects.iter().map(number).collect());
        }
        Ok(())
    }
}

impl EncodedVideo {
    /// The video of these pictures.
    ///
    /// # Errors
    /// They are too small, or have different sizes.
    pub(crate) fn of(images: &[Arc<Image>], fps: u32) -> Result<Self, FilmError> {
        let size = images
            .first()
            .map_or([0, 0], |image| [image.width, image.height]);
        let track = VideoTrack {
            width: size[0],
            height: size[1],
            fps,
        };
        let mut encoder = VideoEncoder::new(track, KEYS)?;
        let mut packets = Vec::new();
        for image in images {
            packets.extend(encoder.push(&Canvas {
                width: image.width,
                height: image.height,
                rgb: image.rgb.clone(),
            })?);
        }
        packets.extend(encoder.finish()?);
        Ok(Self {
            track,
            coding: VideoCoding::of(&track)?,
            packets,
            colors: None,
        })
    }
}

/// Adds values, which are shared with the last ones if they are the same.
fn push_shared<T: PartialEq>(all: &mut Vec<Arc<Vec<T>>>, values: Vec<T>) {
    let values = match all.last().filter(|last| ***last == values) {
        Some(last) => Arc::clone(last),
        None => Arc::new(values),
    };
    all.push(values);
}

fn depths_of(picture: &Picture) -> Vec<f32> {
    let in_meters = |depth: &f32| match *depth {
        f32::INFINITY => 0.0,
        depth => depth / UNITS_PER_METER as f32,
    };
    picture.depth.iter().map(in_meters).collect()
}

/// The number of a thing, as `--ids` of recordings counts.
fn number_of(thing: &SeenThing, shown: &Demonstration, tick: SimTick) -> u16 {
    let place = match thing {
        SeenThing::Table => return 1,
        SeenThing::Figure => None,
        SeenThing::Object(id) => shown.objects.iter().position(|object| {
            object.spec.id == id.as_str()
                && object.created <= tick
                && object.deleted.is_none_or(|deleted| tick < deleted)
        }),
    };
    let number = place.and_then(|place| u16::try_from(place + 2).ok());
    number.unwrap_or(ANYTHING_ELSE)
}
