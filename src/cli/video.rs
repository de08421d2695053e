//! `tabletop video`: a recording as a video, an animation or a contact sheet.

use std::{path::PathBuf, process::ExitCode};

use crate::{
    camera::{CameraPlace, CameraSpec, StudioError},
    film::{Film, FilmError, FilmFormat, FilmPace},
    replay::Replay,
};
use clap::Args;

use super::{
    Failure,
    allowed_paths::AllowedPaths,
    cameras::{ANGLES_OF_VIEW, camera},
    cut_off::say_if_cut_off,
    picture_size::picture_size,
    progress::ProgressLine,
    range::NumberRange,
    result_file::{ResultFile, ResultKind},
    terminal::{say, show_warnings},
};

#[derive(Args)]
pub(super) struct VideoArgs {
    /// The recording
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// The file: `.mp4` for a video (AV1), `.gif` for an animation, `.png` for a contact sheet
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// The camera: `head`, a hand camera such as `left_hand`, or a name with its location and, if it is not the centre of the table, the
    /// point that it looks at, in units of 10 cm: `side=14,0,8` or `side=14,0,8,0,0,1`
    #[arg(long, value_name = "CAMERA", value_parser = camera, default_value = "head")]
    camera: CameraSpec,
    /// The size of a picture, with sides from 1 to 8192 pixels, and 16777216 pixels at most [default: 640x480; on a contact sheet 320x240]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = picture_size)]
    size: Option<(u32, u32)>,
    /// The angle of view from top to bottom, from 1 to 179 degrees
    #[arg(long, value_name = "DEGREES", value_parser = ANGLES_OF_VIEW, allow_negative_numbers = true)]
    fov: Option<f32>,
    /// Frames a second, from 1 to 60 [default: 30; of an animation 10]
    #[arg(long, value_name = "N", value_parser = RATES, allow_negative_numbers = true)]
    fps: Option<u32>,
    /// Simulated seconds a second of the video, from 0.01 to 100
    #[arg(long, value_name = "FACTOR", value_parser = SPEEDS, default_value_t = 1.0, allow_negative_numbers = true)]
    speed: f64,
    /// Say at the lower edge what is being done
    #[arg(long)]
    captions: bool,
    /// Pictures side by side on a contact sheet, from 1 to 100
    #[arg(long, value_name = "N", value_parser = COLUMNS, default_value_t = 4, allow_negative_numbers = true)]
    columns: u32,
    /// Simulated seconds from one picture of a contact sheet to the next, from 0.05 to 86400 [default: a picture a step of the task]
    #[arg(long, value_name = "S", value_parser = PERIODS, allow_negative_numbers = true)]
    every: Option<f64>,
    #[command(flatten)]
    allowed: AllowedPaths,
    /// Replace the video, animation or contact sheet that is there
    #[arg(long)]
    replace: bool,
}

const RATES: NumberRange<u32> = NumberRange::whole(1, 60);
const SPEEDS: NumberRange<f64> = NumberRange::decimal(0.01, 100.0);
const COLUMNS: NumberRange<u32> = NumberRange::whole(1, 100);
const PERIODS: NumberRange<f64> = NumberRange::decimal(0.05, 86400.0).of("seconds");

/// Makes the video.
pub(super) fn run(args: &VideoArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let extension = args.out.extension().unwrap_or_default().to_string_lossy();
    let format = FilmFormat::of_extension(&extension).ok_or_else(|| {
        let out = args.out.display();
        Failure::input(format!(
            "{out}: expected a name that ends in .mp4, .gif or .png"
        ))
    })?;
    let kind = match format {
        FilmFormat::Mp4 => ResultKind::Video,
        FilmFormat::Gif => ResultKind::Animation,
        FilmFormat::Png => ResultKind::Picture,
    };
    let out = match args.replace {
        true => ResultFile::replacing(&args.out, kind),
        false => ResultFile::new(&args.out, kind),
    }?;
    let replay = Replay::read_allowing(&args.recording, &args.allowed.folders);
    let replay = replay.map_err(Failure::input)?;
    say_if_cut_off(replay.recording(), "filmed");
    let mut line = ProgressLine::new(0, " pictures");
    let developed = args.film(format).develop(&replay, format, |done, all| {
        line.expect(all as u64);
        line.reach(done as u64, "");
    });
    line.end();
    let bytes = developed.map_err(failed)?;
    out.write(&bytes)?;
    say(format_args!(
        "{}: {} bytes",
        args.out.display(),
        bytes.len()
    ));
    Ok(ExitCode::SUCCESS)
}

impl VideoArgs {
    fn film(&self, format: FilmFormat) -> Film {
        let (width, height) = self.size.unwrap_or(match (format, &self.camera.viewpoint) {
            (FilmFormat::Png, _) => (320, 240),
            (FilmFormat::Mp4 | FilmFormat::Gif, CameraPlace::Head | CameraPlace::Standing(_)) => {
                (640, 480)
            }
            // As wide as they are.
            (FilmFormat::Mp4 | FilmFormat::Gif, CameraPlace::Hand(_)) => (640, 400),
        });
        let camera = CameraSpec {
            size: Some([width, height]),
            vertical_fov: self.fov.map(f32::to_radians),
            ..self.camera.clone()
        };
        Film {
            pace: FilmPace {
                fps: self.fps.unwrap_or(format.usual_fps()),
                speed: self.speed,
            },
            has_captions: self.captions,
            columns: self.columns,
            period: self.every,
            ..Film::of(camera)
        }
    }
}

fn failed(error: FilmError) -> Failure {
    match error {
        FilmError::Recording(_)
        | FilmError::Replay(_)
        | FilmError::Camera(StudioError::NoCamera { .. })
        | FilmError::Size { .. }
        | FilmError::Foreign(_) => Failure::input(error),
        FilmError::Camera(StudioError::Failed(_))
        | FilmError::Unreadable(_)
        | FilmError::Failed(_) => Failure::run(error),
    }
}
