//! `tabletop watch`: the task that pictures show.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    RecordedRobot,
    camera::Camera,
    dataset::record_watched,
    recorder::{RecorderError, RecordingReader, read_picture},
    replay::Replay,
    scene::IdAllocator,
    shipped::read_faultless_task,
    storage::{InnerFile, InnerPath, Storage},
    task::{Demonstration, Requirements, Task, color_name},
    vision::{DescribedObject, Descriptions, KnownScenery, calibrated},
    watching::{Doubt, Watcher},
};
use bevy::math::Vec3;
use clap::Args;
use serde_json::{Value, json};
use tabletop_core::{HeadCamera, JointSpec, ObjectSpec, SimTick, TICKS_PER_SECOND, Table};
use tabletop_geometry::{Pose, Rgb};

use super::{
    Failure,
    allowed_paths::AllowedPaths,
    counted::counted,
    cut_off::say_if_cut_off,
    explain::{furniture, print, print_json, reported},
    head_camera::taking,
    import::failed,
    range::NumberRange,
    recorded::say_moved_aside,
    result_file::require_outside,
    terminal::{say, show_warnings},
};

const RATE: NumberRange<u64> = NumberRange::whole(1, TICKS_PER_SECOND as u64);

#[derive(Args)]
pub(super) struct WatchArgs {
    /// A recording's folder, or one with PNG pictures of the head camera, in the order of their names
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The task file that says which objects there are [default: those of the recording; of pictures alone, what the first one shows]; not read: where they are
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
    /// Pictures per second, from 1 to 60, of a folder that is no recording
    #[arg(long, value_name = "N", value_parser = RATE, default_value_t = 4, allow_negative_numbers = true)]
    rate: u64,
    /// Find where the camera is by the edges of the table in the first picture, if it is some centimetres from where it is thought to be
    #[arg(long)]
    calibrate: bool,
    /// Write what was understood as a recording, for the window's timeline and everything else that reads recordings
    #[arg(long, value_name = "OUT")]
    record: Option<PathBuf>,
    /// Print everything that was understood as JSON
    #[arg(long)]
    json: bool,
}

/// Pictures, and what is known of what they show.
struct PictureRoll {
    table: Table,
    camera: HeadCamera,
    objects: Vec<ObjectSpec>,
    joints: Vec<JointSpec>,
    /// True if the first picture alone tells the shapes of the objects.
    is_described: bool,
    /// The pictures, each with its tick, from 0.
    frames: Vec<(SimTick, InnerFile)>,
    /// The tick of the recording that is the first of the pictures.
    begin: SimTick,
    /// The robot, if its joints are known.
    robot: Option<RecordedRobot>,
    /// The true poses of the objects, by id, of each picture; empty if nobody knows them.
    truth: Vec<BTreeMap<String, Pose>>,
}

/// What a watcher has seen.
struct WatchedRoll {
    demonstration: Demonstration,
    /// The times in which it was not sure.
    doubts: Vec<Doubt>,
    /// The greatest distance, in units, of an object from where it was seen, picture by picture; infinite if one was not seen yet.
    errors: Vec<f32>,
}

/// Prints the task that pictures show. Exit code 1 if it is not sure of something.
pub(super) fn watch(args: &WatchArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let setup = match &args.setup {
        Some(setup) => {
            let scene =
                read_faultless_task(setup, &args.allowed.folders).map_err(Failure::input)?;
            let furniture = furniture(&scene);
            Some((scene.table, furniture.objects, furniture.joints))
        }
        None => None,
    };
    if let Some(out) = &args.record {
        require_outside(out, &[&args.folder])?;
    }
    let pictures = pictures_in(&args.folder)?;
    let roll = match pictures.is_empty() {
        true => PictureRoll::of_recording(&args.folder, setup)?,
        false => PictureRoll::of_pictures(&args.folder, pictures, setup, args.rate)?,
    };
    let (frames, camera) = (roll.frames.clone(), roll.camera);
    let watched = roll.watch(args.calibrate)?;
    if let Some(out) = &args.record {
        let import =
            record_watched(out, &watched.demonstration, &frames, camera).map_err(failed)?;
        import
            .remarks
            .iter()
            .for_each(|remark| say(format_args!("tabletop: {remark}")));
        say_moved_aside(&import.report.moved_aside);
    }
    let mut task = Task::of(&watched.demonstration);
    task.phrase(&Requirements::default());
    let code = match watched.doubts.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    };
    if args.json {
        let doubts: Vec<_> = watched.doubts.iter().map(json_of).collect();
        let json = json!({ "task": task, "doubts": doubts, "errors": watched.errors });
        return print_json(&json).map(|_| code);
    }
    let mut lines = reported(&task);
    if lines.is_empty() {
        lines.push("Nothing is moved for good.".into());
    }
    lines.extend(watched.doubts.iter().map(sentence));
    if let Some(summary) = watched.summary() {
        lines.push(summary);
    }
    print(&(lines.join("\n") + "\n")).map(|_| code)
}

/// A doubt, in words.
fn sentence(doubt: &Doubt) -> String {
    let Doubt {
        object,
        from,
        to,
        is_never_seen,
    } = doubt;
    let [from, to] = [from, to].map(|tick| tick.0 as f64 / f64::from(TICKS_PER_SECOND));
    match is_never_seen {
        true => format!("Unsure: {object} was never surely seen."),
        false => format!("Unsure: where {object} was from {from:.2} to {to:.2} s."),
    }
}

fn json_of(doubt: &Doubt) -> Value {
    json!({
        "object": doubt.object,
        "from": doubt.from,
        "to": doubt.to,
        "never_seen": doubt.is_never_seen,
    })
}

/// The task that the pictures of a recording show, with its requirements in its sentences.
pub(super) fn read_watched(recording: &Path) -> Result<(Task, Requirements), Failure> {
    let watched = PictureRoll::of_recording(recording, None)?.watch(false)?;
    for doubt in &watched.doubts {
        say(format_args!("tabletop: {}", sentence(doubt)));
    }
    let mut task = Task::of(&watched.demonstration);
    let requirements = Requirements::read_for(&task, recording).map_err(Failure::input)?;
    task.phrase(&requirements);
    Ok((task, requirements))
}

type Setup = (Table, Vec<ObjectSpec>, Vec<JointSpec>);

impl PictureRoll {
    /// The pictures of a recording, and the objects that it begins with, or those of a task file.
    fn of_recording(folder: &Path, setup: Option<Setup>) -> Result<Self, Failure> {
        let recording = RecordingReader::open(folder).map_err(Failure::input)?;
        say_if_cut_off(&recording, "watched");
        let session = recording.session();
        let camera = session.header.camera.ok_or_else(|| {
            Failure::input(format!(
                "{}: the recording has no head camera, so it has no pictures to watch",
                folder.display()
            ))
        })?;
        let own = || {
            let objects = session.scene.objects.iter().map(|object| ObjectSpec {
                pose: object.pose,
                ..object.spec.clone()
            });
            let joints = session.scene.joints.clone();
            (
                session.scene.table.unwrap_or_default(),
                objects.collect(),
                joints,
            )
        };
        let (table, objects, joints) = setup.unwrap_or_else(own);
        let mut frames = Vec::new();
        for segment in recording.segments().map_err(Failure::input)? {
            for frame in segment.frames {
                frames.push((frame.tick, frame.picture));
            }
        }
        let truth = truth(&recording, &frames).map_err(Failure::input)?;
        // What cannot be replayed does not tell which robot it shows.
        let robot = match Replay::read(folder) {
            Ok(replay) => RecordedRobot::of(&replay).map_err(Failure::input)?,
            Err(_) => None,
        };
        let first = recording.first_tick().0;
        let frames = frames.into_iter();
        let frames = frames.map(|(tick, path)| (SimTick(tick.0 - first), path));
        Ok(Self {
            table,
            camera,
            objects,
            joints,
            is_described: false,
            frames: frames.collect(),
            begin: SimTick(first),
            robot,
            truth,
        })
    }

    /// The pictures of a folder, which are all that there is.
    fn of_pictures(
        folder: &Path,
        pictures: Vec<InnerFile>,
        setup: Option<Setup>,
        rate: u64,
    ) -> Result<Self, Failure> {
        let first = pictures.first().map(read_picture);
        let first = first.transpose().map_err(Failure::input)?;
        let first = first.unwrap_or_default();
        let camera = taking(&HeadCamera::default(), &first);
        let is_described = setup.is_none();
        let (table, objects, joints) = match setup {
            Some(setup) => setup,
            None => {
                let table = Table::default();
                let mut descriptions =
                    Descriptions::of(&first, &Camera::of_head(&camera, &table), &table);
                for path in pictures.iter().skip(1) {
                    descriptions.see(&read_picture(path).map_err(Failure::input)?);
                }
                let objects = named(&descriptions);
                if objects.is_empty() {
                    return Err(Failure::input(format!(
                        "{}: the first picture shows no object; name those that come later with --setup FILE",
                        folder.display()
                    )));
                }
                (table, objects, Vec::new())
            }
        };
        let step = u64::from(TICKS_PER_SECOND) / rate;
        let pictures = pictures.into_iter().zip(0..);
        let frames = pictures.map(|(path, number)| (SimTick(number * step), path));
        Ok(Self {
            table,
            camera,
            objects,
            joints,
            is_described,
            frames: frames.collect(),
            begin: SimTick(0),
            robot: None,
            truth: Vec::new(),
        })
    }

    /// Watches all pictures.
    ///
    /// # Errors
    /// One cannot be read.
    fn watch(mut self, is_calibrated: bool) -> Result<WatchedRoll, Failure> {
        let mut camera = Camera::of_head(&self.camera, &self.table);
        if let (true, Some((_, path))) = (is_calibrated, self.frames.first()) {
            let picture = read_picture(path).map_err(Failure::input)?;
            camera = calibrated(&picture, &camera, &self.table);
        }
        let mut watcher = Watcher::new(self.objects, self.joints, self.table, camera);
        if self.is_described {
            watcher = watcher.of_described();
        }
        let mut errors = Vec::new();
        for (number, (tick, path)) in self.frames.iter().enumerate() {
            let picture = read_picture(path).map_err(Failure::input)?;
            let [size, expected] = [
                [picture.width, picture.height],
                [self.camera.width, self.camera.height],
            ];
            if size != expected {
                return Err(Failure::input(format!(
                    "{}: the picture has {} x {} pixels, and the camera {} x {}",
                    path.path().display(),
                    size[0],
                    size[1],
                    expected[0],
                    expected[1],
                )));
            }
            let links = self.robot.as_mut();
            let scenery = KnownScenery {
                figures: links.map_or_else(Vec::new, |robot| {
                    robot.figures(SimTick(self.begin.0 + tick.0))
                }),
                solids: Vec::new(),
            };
            watcher.watch(*tick, &picture, &scenery);
            if let Some(truth) = self.truth.get(number) {
                let distances = watcher.poses().filter_map(|(id, pose)| {
                    let true_pose = truth.get(id)?;
                    let distance = |pose: Pose| true_pose.location.distance(pose.location);
                    Some(pose.map_or(f32::INFINITY, distance))
                });
                errors.push(distances.fold(0.0, f32::max));
            }
        }
        Ok(WatchedRoll {
            doubts: watcher.doubts(),
            demonstration: watcher.demonstration(),
            errors,
        })
    }
}

impl WatchedRoll {
    /// How far the objects were from where they were seen.
    fn summary(&self) -> Option<String> {
        let pictures = self.errors.len();
        let seen = self.errors.iter().filter(|error| error.is_finite());
        let mut errors: Vec<_> = seen.copied().collect();
        errors.sort_by(f32::total_cmp);
        let unseen = match pictures - errors.len() {
            0 => String::new(),
            unseen => format!("; an object was not seen yet in {unseen}"),
        };
        let Some(last) = errors.len().checked_sub(1) else {
            return (pictures > 0).then(|| "an object was not seen in any of the pictures".into());
        };
        let share = |percent: usize| errors[last * percent / 100];
        Some(format!(
            "{}; greatest error of a pose: median {:.4}, 90 % {:.4}, 99 % {:.3}, at most {:.3} units{unseen}",
            counted(pictures, "picture"),
            share(50),
            share(90),
            share(99),
            errors[last],
        ))
    }
}

/// Described objects, named by their colours. Says what each is taken for.
fn named(descriptions: &Descriptions) -> Vec<ObjectSpec> {
    let mut ids = IdAllocator::default();
    let objects = descriptions.objects().cloned();
    let objects = objects.map(|DescribedObject { shape, pose }| {
        let solids = shape.drawn();
        let color = solids.first().map_or(Rgb::GRAY, |solid| solid.color);
        let id = ids.unique(color_name(color));
        let [x, y, _] = pose.location.to_array();
        let size = shape.bounds(Pose::new(Vec3::ZERO, pose.rotation));
        let [wide, deep, high] = (size.high - size.low).to_array();
        say(format_args!(
            "tabletop: {id}: a {} at ({x:.2}, {y:.2}), {wide:.2} x {deep:.2} x {high:.2} units with its turn",
            shape.name()
        ));
        ObjectSpec::new(id, pose, 1.0, shape)
    });
    objects.collect()
}

/// The PNG files directly in a folder, in the order of their names. A recording has its pictures in folders of its segments.
fn pictures_in(folder: &Path) -> Result<Vec<InnerFile>, Failure> {
    let entries = Storage::default().entries(folder);
    let entries = entries
        .map_err(|error| Failure::input(format!("cannot read {}: {error}", folder.display())))?;
    let is_png = |path: &Path| path.extension().is_some_and(|kind| kind == "png");
    let names = entries.iter().filter(|path| is_png(path));
    let names = names.filter_map(|path| InnerPath::name(path.file_name()?).ok());
    Ok(names.map(|name| InnerFile::new(folder, name)).collect())
}

/// The true poses of the objects at each frame.
fn truth(
    recording: &RecordingReader,
    frames: &[(SimTick, InnerFile)],
) -> Result<Vec<BTreeMap<String, Pose>>, RecorderError> {
    let objects = recording.session().scene.objects.iter();
    let mut poses: BTreeMap<_, _> = objects
        .map(|object| (object.spec.id.clone(), object.pose))
        .collect();
    let mut rows = recording.states()?.into_iter().peekable();
    let at_frame = frames.iter().map(|(tick, _)| {
        while let Some(row) = rows.next_if(|row| row.tick <= *tick) {
            poses.insert(row.id, row.pose);
        }
        poses.clone()
    });
    Ok(at_frame.collect())
}
