//! The places in which is written, and what is there before.

use std::{
    fs,
    path::{Path, PathBuf},
    process,
    sync::{Arc, LazyLock},
};

use bevy::prelude::*;
use tabletop_core::{RecordingCommand, SimTick, StepApp as _, WriteCommand as _};
use tabletop_recorder::RecorderPlugin;
use tabletop_sim::{TabletopSimPlugins, headless_app_with};
use tabletop_training::{ActionKind, CameraTrack, FrameVectors, Image, TrainingEpisode};

/// A folder for files that nobody keeps, in memory where there is one.
fn memory() -> PathBuf {
    let shared = PathBuf::from("/dev/shm");
    let folder = if shared.is_dir() {
        shared
    } else {
        std::env::temp_dir()
    };
    folder.join(format!("tabletop_storage_faults_{}", process::id()))
}

/// A recording of half a second, which is read.
pub fn demo() -> &'static Path {
    static DEMO: LazyLock<PathBuf> = LazyLock::new(|| {
        let folder = memory().join("demo");
        let _not_there = fs::remove_dir_all(&folder);
        let recorder = RecorderPlugin {
            folder: folder.clone(),
            ..default()
        };
        let mut app = headless_app_with(TabletopSimPlugins.build().set(recorder));
        app.world_mut().write_command(RecordingCommand::Start);
        app.step(30);
        app.world_mut().write_command(RecordingCommand::Finish);
        app.step(1);
        folder
    });
    &DEMO
}

/// An episode with this sentence, of two frames.
pub fn episode(task: &str) -> TrainingEpisode {
    static PICTURE: LazyLock<Arc<Image>> = LazyLock::new(|| {
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, 2, 2);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[7; 12]).unwrap();
        writer.finish().unwrap();
        Arc::new(Image {
            width: 2,
            height: 2,
            rgb: vec![7; 12],
            png,
        })
    });
    // Some formats do not keep the sentence, but every number.
    let number = task.bytes().fold(0_u16, |number, letter| {
        number.wrapping_mul(31).wrapping_add(u16::from(letter))
    });
    let signal = |name: &str, values: [f32; 2]| FrameVectors {
        names: vec![name.into()],
        values: values.into(),
    };
    TrainingEpisode {
        folder: "demo".into(),
        fps: 4,
        ticks: vec![SimTick(0), SimTick(15)],
        state: signal("x", [number.into(), 1.0]),
        environment: FrameVectors::default(),
        action: signal("right_hand.grip", [0.0, 1.0]),
        action_kind: ActionKind::Hands,
        objects: Vec::new(),
        cameras: vec![CameraTrack {
            name: "head".into(),
            images: vec![Arc::clone(&PICTURE); 2],
            depths: Vec::new(),
            video: None,
            ids: Vec::new(),
        }],
        task: task.into(),
        paraphrases: Vec::new(),
        subtasks: Vec::new(),
    }
}

/// A folder with a place for each kind of writing.
#[derive(Debug)]
pub struct Workplace(PathBuf);

impl Workplace {
    pub fn new(name: &str) -> Self {
        let path = memory().join(name);
        let _not_there = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("count"), "0").unwrap();
        Self(path)
    }

    pub fn at(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// The names in a folder that are not hidden.
    pub fn shown(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.at(folder)).into_iter().flatten();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| !name.starts_with('.'))
            .collect();
        names.sort();
        names
    }
}

impl Drop for Workplace {
    fn drop(&mut self) {
        let _stays = fs::remove_dir_all(&self.0);
    }
}
