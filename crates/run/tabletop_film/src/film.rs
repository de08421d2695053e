//! Films: footage in the order and at the pace in which it is shown.

use tabletop_camera::{CameraSpec, Shot};
use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_replay::Replay;
use tabletop_task::{Requirements, Task};

use crate::{
    animation::Animation,
    canvas::{Canvas, wrapped},
    contact_sheet::{Still, contact_sheet},
    error::FilmError,
    footage::Footage,
    mp4::{Mp4Writer, VideoCoding},
    pace::FilmPace,
    video::{VideoEncoder, VideoTrack},
};

/// A film of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Its camera.
    pub camera: CameraSpec,
    /// Its pace.
    pub pace: FilmPace,
    /// Says at the lower edge what is being done.
    pub has_captions: bool,
    /// Pictures side by side on a contact sheet.
    pub columns: u32,
    /// Simulated seconds between the pictures of a contact sheet; `None` for one picture a step of the task.
    pub period: Option<f64>,
}

/// The format of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// A video: AV1 in MP4.
    Mp4,
    /// An animation: GIF.
    Gif,
    /// A contact sheet: PNG.
    Png,
}

/// Most pictures of a contact sheet.
const MOST_MOMENTS: usize = 400;
/// Pictures of a contact sheet of a recording in which nothing is done.
const MOMENTS: f64 = 12.0;
/// The height of a caption's letters, in parts of the picture's height.
const LETTERS: f32 = 0.055;
const INK: [u8; 3] = [255; 3];

impl FilmFormat {
    /// The format that the end of a file's name stands for.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "mp4" => Some(Self::Mp4),
            "gif" => Some(Self::Gif),
            "png" => Some(Self::Png),
            _ => None,
        }
    }

    /// Frames a second, unless others are asked for. Viewers show faster animations slowly.
    pub const fn usual_fps(self) -> u32 {
        match self {
            Self::Gif => 10,
            Self::Mp4 | Self::Png => 30,
        }
    }
}

impl Film {
    /// A film of 30 frames a second in real time, by this camera.
    pub const fn of(camera: CameraSpec) -> Self {
        Self {
            camera,
            pace: FilmPace {
                fps: 30,
                speed: 1.0,
            },
            has_captions: false,
            columns: 4,
            period: None,
        }
    }

    /// The film of a recording as a file. `tell` hears how many of its pictures are done, and of how many.
    ///
    /// # Errors
    /// The recording cannot be read, or the format has no such pictures.
    pub fn develop(
        &self,
        replay: &Replay,
        format: FilmFormat,
        mut tell: impl FnMut(usize, usize),
    ) -> Result<Vec<u8>, FilmError> {
        let story = Story::of(replay)?;
        match format {
            FilmFormat::Png => self.contact_sheet(replay, &story, &mut tell),
            FilmFormat::Mp4 => {
                let mut video = None;
                self.show(replay, &story, &mut tell, |picture| {
                    let (encoder, packets) = match &mut video {
                        Some(video) => video,
                        None => {
                            let track = VideoTrack {
                                width: picture.width,
                                height: picture.height,
                                fps: self.pace.fps,
                            };
                            // A player can go to any second.
                            let encoder = VideoEncoder::new(track, track.fps)?;
                            video.insert(((track, encoder), Vec::new()))
                        }
                    };
                    packets.extend(encoder.1.push(picture)?);
                    Ok(())
                })?;
                let Some(((track, encoder), mut packets)) = video else {
                    return Ok(Vec::new());
                };
                packets.extend(encoder.finish()?);
                let (mut file, mut bytes) = Mp4Writer::begin(track, VideoCoding::of(&track)?)?;
                bytes.extend(file.add(&packets)?);
                bytes.extend(file.end()?);
                Ok(bytes)
            }
            FilmFormat::Gif => {
                let mut animation = None;
                self.show(replay, &story, &mut tell, |picture| {
                    let animation = match &mut animation {
                        Some(animation) => animation,
                        None => {
                            let new = Animation::new(picture.width, picture.height, self.pace.fps);
                            animation.insert(new?)
                        }
                    };
                    animation.push(picture)
                })?;
                animation.map_or(Ok(Vec::new()), Animation::finish)
            }
        }
    }

    /// Shows its frames in their order.
    fn show(
        &self,
        replay: &Replay,
        story: &Story,
        tell: &mut impl FnMut(usize, usize),
        mut each: impl FnMut(&Canvas) -> Result<(), FilmError>,
    ) -> Result<(), FilmError> {
        let recording = replay.recording();
        let ticks = self
            .pace
            .ticks(recording.first_tick(), recording.last_tick());
        let all = ticks.len();
        let mut done = 0;
        Footage::new(replay, vec![self.camera.clone()]).shoot(ticks, |tick, shots| {
            let mut picture = first_of(shots);
            if self.has_captions
                && let Some(words) = story.at(tick)
            {
                caption(&mut picture, words);
            }
            each(&picture)?;
            done += 1;
            tell(done, all);
            Ok(())
        })
    }

    fn contact_sheet(
        &self,
        replay: &Replay,
        story: &Story,
        tell: &mut impl FnMut(usize, usize),
    ) -> Result<Vec<u8>, FilmError> {
        let chosen = self.moments(replay, story);
        let all = chosen.len();
        let mut captions = chosen.iter();
        let mut moments = Vec::new();
        let ticks: Vec<_> = chosen.iter().map(|(tick, _)| *tick).collect();
        Footage::new(replay, vec![self.camera.clone()]).shoot(ticks, |_, shots| {
            let caption = captions.next().map(|(_, caption)| caption.clone());
            moments.push(Still {
                picture: first_of(shots),
                caption: caption.unwrap_or_default(),
            });
            tell(moments.len(), all);
            Ok::<_, FilmError>(())
        })?;
        let sheet = contact_sheet(&moments, self.columns);
        sheet
            .png()
            .map_err(|error| FilmError::Failed(error.to_string()))
    }

    /// The moments of a contact sheet, with what is said of them.
    fn moments(&self, replay: &Replay, story: &Story) -> Vec<(SimTick, String)> {
        let recording = replay.recording();
        let [first, last] = [recording.first_tick(), recording.last_tick()];
        let since =
            |tick: SimTick| (tick.0 - first.0.min(tick.0)) as f64 / f64::from(TICKS_PER_SECOND);
        if self.period.is_none() && !story.steps.is_empty() && story.steps.len() < MOST_MOMENTS {
            let steps = story.steps.iter();
            let steps =
                steps.map(|(tick, words)| (*tick, format!("{:.1} s: {words}", since(*tick))));
            return [(first, "Before".to_owned())]
                .into_iter()
                .chain(steps)
                .collect();
        }
        let all = since(last);
        let period = self
            .period
            .unwrap_or(all / MOMENTS)
            .max(all / MOST_MOMENTS as f64);
        let speed = period.max(1.0 / f64::from(TICKS_PER_SECOND));
        let ticks = FilmPace { fps: 1, speed }.ticks(first, last);
        let moments = ticks.into_iter().map(|tick| {
            let words = story
                .at(tick)
                .map_or_else(String::new, |words| format!(": {words}"));
            (tick, format!("{:.1} s{words}", since(tick)))
        });
        moments.collect()
    }
}

fn first_of(shots: &[Shot]) -> Canvas {
    shots
        .first()
        .map(|shot| Canvas::of(&shot.picture))
        .unwrap_or_default()
}

/// Writes below what is being done.
fn caption(picture: &mut Canvas, words: &str) {
    let letters = (picture.height as f32 * LETTERS).max(10.0);
    let line = Canvas::line_height(letters);
    let margin = line / 2;
    let lines = wrapped(words, picture.width.saturating_sub(2 * margin), letters);
    let top = picture
        .height
        .saturating_sub(lines.len() as u32 * line + margin);
    picture.shade(top);
    for (row, text) in (0..).zip(lines) {
        picture.write(&text, [margin, top + margin / 2 + row * line], letters, INK);
    }
}

/// What happens in a recording, in words.
struct Story {
    /// What is being done, from a tick on.
    parts: Vec<(SimTick, String)>,
    /// What has been done at a tick.
    steps: Vec<(SimTick, String)>,
}

impl Story {
    fn of(replay: &Replay) -> Result<Self, FilmError> {
        let shown = tabletop_task::Demonstration::of(replay.recording())?;
        let mut task = Task::of(&shown);
        // Without them, the sentences are as they are.
        if let Ok(requirements) = Requirements::read_for(&task, replay.folder()) {
            task.phrase(&requirements);
        }
        let steps = task
            .steps
            .iter()
            .map(|step| (step.release, step.sentence.clone()));
        let operations = task
            .operations
            .iter()
            .map(|done| (done.tick, done.sentence()));
        let mut steps: Vec<_> = steps.chain(operations).collect();
        steps.sort_by_key(|(tick, _)| *tick);
        Ok(Self {
            parts: task.parts(replay.recording().first_tick()),
            steps,
        })
    }

    /// What is being done in a tick.
    fn at(&self, tick: SimTick) -> Option<&str> {
        let part = self.parts.iter().rfind(|(since, _)| *since <= tick)?;
        Some(&part.1)
    }
}
