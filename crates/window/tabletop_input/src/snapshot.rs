//! The head view as a file (report section 5): the head camera's picture of the next tick, at its own size.

use std::{
    io, iter,
    path::{Path, PathBuf},
};

use bevy::{
    prelude::*,
    tasks::{IoTaskPool, Task, TaskPool, futures::check_ready},
};
use jiff::Timestamp;
use tabletop_core::{
    OrderSystems, Picture, PictureDemand, RestApp as _, RestingSystems, SensorImage, SimSystems,
    SimTick,
};
use tabletop_storage::Storage;

use tabletop_user::{Notices, Tone};

/// The pictures that are to be saved and those that are being saved.
#[derive(Resource, Debug, Default)]
pub(crate) struct Snapshots {
    /// Their folder: the working directory if it is empty.
    folder: PathBuf,
    is_wanted: bool,
    /// The outcome of those that are being written, in words.
    writing: Vec<Task<(Tone, String)>>,
}

impl Snapshots {
    /// Saves the head camera's picture after the next tick.
    pub const fn take_one(&mut self) {
        self.is_wanted = true;
    }

    /// True if a picture is to be saved after the next tick.
    pub const fn are_wanted(&self) -> bool {
        self.is_wanted
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Snapshots>()
        .init_resource::<PictureDemand>()
        .init_resource::<SensorImage>()
        .add_systems(
            FixedUpdate,
            (
                ask_for_picture.in_set(OrderSystems::User),
                begin_writing.in_set(SimSystems::Record),
            )
                .in_set(RestingSystems)
                .run_if(any_is_wanted),
        )
        .wake_while(any_is_wanted)
        .add_systems(Update, tell);
}

fn any_is_wanted(snapshots: Res<Snapshots>) -> bool {
    snapshots.are_wanted()
}

fn ask_for_picture(demand: Res<PictureDemand>) {
    demand.ask();
}

/// Writes the picture in the background, as soon as it is there.
fn begin_writing(tick: Res<SimTick>, image: Res<SensorImage>, mut snapshots: ResMut<Snapshots>) {
    if image.tick != *tick || image.picture.rgb.is_empty() {
        return;
    }
    snapshots.is_wanted = false;
    let folder = snapshots.folder.clone();
    let picture = Picture {
        depth: Vec::new(),
        objects: Vec::new(),
        ..image.picture.clone()
    };
    let now = Timestamp::now();
    let pool = IoTaskPool::get_or_init(TaskPool::new);
    let task = pool.spawn(async move {
        match save(&picture, &folder, now) {
            Ok(path) => {
                let reported = format!("the head view was saved as {}", path.display());
                (Tone::Event, reported)
            }
            Err(error) => {
                let reported = format!("the head view could not be saved: {error}");
                (Tone::Fault, reported)
            }
        }
    });
    snapshots.writing.push(task);
}

fn tell(mut snapshots: ResMut<Snapshots>, mut notices: ResMut<Notices>) {
    if snapshots.writing.is_empty() {
        return;
    }
    snapshots.writing.retain_mut(|task| {
        let words = check_ready(task);
        if let Some((tone, words)) = &words {
            notices.add(*tone, words);
        }
        words.is_none()
    });
}

/// Writes a picture to a new file, and returns its path.
fn save(picture: &Picture, folder: &Path, now: Timestamp) -> io::Result<PathBuf> {
    let png = encode(picture).map_err(io::Error::other)?;
    let path = write_new(&std::path::absolute(folder.join(name(now)))?, &png)?;
    Ok(path)
}

fn encode(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.rgb)?;
    writer.finish()?;
    Ok(bytes)
}

/// Writes a file that was not there: this one, or with a number in its name.
fn write_new(path: &Path, bytes: &[u8]) -> io::Result<PathBuf> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let numbered = (2..).map(|number: u32| path.with_file_name(format!("{stem}-{number}.png")));
    for path in iter::once(path.to_owned()).chain(numbered) {
        let reported =
            |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
        match Storage::default().write_new(&path, bytes) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(reported(error)),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Names a file after a time: `headcamyyyyMMdd-HHmmss.png`, UTC.
fn name(time: Timestamp) -> String {
    time.strftime("headcam%Y%m%d-%H%M%S.png").to_string()
}

#[cfg(test)]
mod tests {
    use std::fs::{self, File};
    use tabletop_user::UserPlugin;

    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use std::time::Duration;
    use tabletop_core::{CorePlugin, PictureSystems};

    fn at(seconds: i64) -> Timestamp {
        Timestamp::from_second(seconds).unwrap()
    }

    #[test]
    fn a_file_is_named_after_its_time() {
        for (seconds, expected) in [
            (0, "headcam19700101-000000.png"),
            (951_782_399, "headcam20000228-235959.png"),
            (951_782_400, "headcam20000229-000000.png"),
            (951_868_800, "headcam20000301-000000.png"),
            (1_400_000_000, "headcam20140513-165320.png"),
            (4_107_542_400, "headcam21000301-000000.png"),
            (1_735_689_599, "headcam20241231-235959.png"),
        ] {
            assert_eq!(name(at(seconds)), expected);
        }
    }

    fn picture() -> Picture {
        let mut picture = Picture::default();
        picture.resize(3, 2);
        for (i, value) in picture.rgb.iter_mut().enumerate() {
            *value = i as u8;
        }
        picture
    }

    /// An empty folder of its own for a test.
    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("tabletop_{name}_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn pixels_of(path: &Path) -> Vec<u8> {
        let file = io::BufReader::new(File::open(path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (3, 2));
        assert_eq!(info.color_type, png::ColorType::Rgb);
        pixels
    }

    #[test]
    fn pictures_of_one_second_are_different_files() {
        let folder = folder("snapshots");
        let names = ["", "-2", "-3"].map(|number| format!("headcam20140513-165320{number}.png"));
        for name in names {
            let path = save(&picture(), &folder, at(1_400_000_000)).unwrap();
            assert_eq!(path, folder.join(name));
            assert_eq!(pixels_of(&path), picture().rgb);
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_failed_save_is_reported_with_its_path() {
        let error = save(&picture(), Path::new("/no such folder"), at(0)).unwrap_err();
        let words = error.to_string();
        assert!(words.contains("/no such folder/headcam1970"), "{words}");
        assert!(save(&Picture::default(), Path::new(""), at(0)).is_err());
    }

    #[test]
    fn the_picture_of_the_next_tick_is_saved_once_and_reported() {
        let folder = folder("next_tick");
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(2))
            .init_resource::<Notices>()
            .add_systems(
                FixedUpdate,
                (|mut demand: ResMut<PictureDemand>,
                  tick: Res<SimTick>,
                  mut image: ResMut<SensorImage>| {
                    if demand.take() {
                        *image = SensorImage {
                            tick: *tick,
                            picture: picture(),
                            ..default()
                        };
                    }
                })
                .in_set(PictureSystems::Draw),
            );
        app.finish();
        app.cleanup();
        for _ in 0..3 {
            app.update();
        }
        let mut snapshots = app.world_mut().resource_mut::<Snapshots>();
        snapshots.folder.clone_from(&folder);
        snapshots.take_one();
        for _ in 0..1000 {
            app.update();
            if !app.world().resource::<Notices>().is_empty() {
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        let files: Vec<_> = fs::read_dir(&folder).unwrap().collect();
        assert_eq!(files.len(), 1);
        let path = files.into_iter().next().unwrap().unwrap().path();
        assert_eq!(pixels_of(&path), picture().rgb);
        let reported = format!("the head view was saved as {}", path.display());
        let notices = app.world().resource::<Notices>();
        assert_eq!(notices.iter().collect::<Vec<_>>(), [reported]);
        fs::remove_dir_all(folder).unwrap();
    }
}
