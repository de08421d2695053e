//! The lesson of a recording.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_core::{SceneSpec, ShownTask, Timeline, TimelineStage};
use tabletop_program::Example;
use tabletop_recorder::RecordingReader;
use tabletop_storage::Storage;
use tabletop_task::{Demonstration, RequirementError, Requirements, Role, Task};

use tabletop_episodes::{
    scene_at_beginning,
    shown_task::{shown_task, value},
};

use super::teaching::Teaching;
use crate::background::BackgroundWork;

/// The task of the recording that was made or opened last, if it shows one.
#[derive(Resource, Default)]
pub(super) struct Understood {
    lesson: Option<Lesson>,
    /// The reading of a recording, while it goes on.
    reading: Option<BackgroundWork<Lesson>>,
    /// The recording that was read last, and its stage then.
    last: (PathBuf, TimelineStage),
    has_changed: bool,
    fault: Option<String>,
}

/// The lesson of a recording.
#[derive(Clone, Debug)]
pub(super) struct Lesson {
    pub folder: PathBuf,
    pub task: Task,
    pub requirements: Requirements,
    pub scene: Option<SceneSpec>,
    /// It as an example of a program; `None` if no program says what it shows.
    pub example: Option<Example>,
}

impl Lesson {
    fn read(folder: &Path) -> Result<Self, String> {
        let said = |error: &dyn std::fmt::Display| error.to_string();
        let recording = RecordingReader::open(folder).map_err(|error| said(&error))?;
        let shown = Demonstration::of(&recording).map_err(|error| said(&error))?;
        let task = Task::of(&shown);
        let requirements = Requirements::read_for(&task, folder).map_err(|error| said(&error))?;
        let example = Example::of(&shown, &task).filter(|_| !task.steps.is_empty());
        Ok(Self {
            folder: folder.to_owned(),
            task,
            requirements,
            scene: scene_at_beginning(recording.session()),
            example,
        })
    }

    fn role(&self, id: &str) -> Result<&Role, String> {
        let role = self.task.role(id);
        role.ok_or_else(|| format!("the task is not about {id}"))
    }
}

/// Begins to read a recording when it is finished or opened, beside the frames: a long one takes time.
pub(super) fn read_recording(timeline: Res<Timeline>, mut understood: ResMut<Understood>) {
    let is_there = match timeline.stage {
        TimelineStage::Finished | TimelineStage::Open => true,
        TimelineStage::Absent | TimelineStage::Running => false,
    };
    let now = (timeline.folder.clone(), timeline.stage);
    if understood.last == now {
        return;
    }
    // A recording that was just made is the same when it is opened.
    let is_known = understood.last.0 == now.0 && now.1 == TimelineStage::Open;
    understood.last = now;
    if !is_there || (is_known && understood.lesson.is_some()) {
        return;
    }
    let folder = timeline.folder.clone();
    understood.reading = Some(BackgroundWork::begin(move || Lesson::read(&folder)));
}

/// Takes over the result of reading. A recording in which no hand acts does not replace the earlier task.
pub(super) fn take_read_task(mut understood: ResMut<Understood>, mut teaching: ResMut<Teaching>) {
    let reading = understood.bypass_change_detection().reading.as_mut();
    let Some(read) = reading.and_then(BackgroundWork::result) else {
        return;
    };
    understood.reading = None;
    match read {
        Ok(lesson) if lesson.task.steps.is_empty() && understood.lesson.is_some() => {}
        Ok(lesson) => {
            teaching.show(lesson.example.clone());
            understood.lesson = Some(lesson);
            understood.fault = None;
        }
        Err(reason) => {
            understood.lesson = None;
            understood.fault = Some(reason);
        }
    }
    understood.has_changed = true;
}

impl Understood {
    /// The lesson of the recording, if it shows a task.
    pub fn lesson(&self) -> Option<&Lesson> {
        let lesson = self.lesson.as_ref();
        lesson.filter(|lesson| !lesson.task.steps.is_empty())
    }

    /// The scene at the beginning of the recording.
    pub fn beginning(&self) -> Result<SceneSpec, String> {
        let scene = self.lesson.as_ref().and_then(|lesson| lesson.scene.clone());
        scene.ok_or("the recording does not contain the scene at its beginning".into())
    }

    /// Requires a property of a role's object, or no longer, and keeps this with the recording.
    pub fn require(&mut self, role: &str, property: &str, is_required: bool) -> Result<(), String> {
        self.change(|lesson| {
            let role = lesson.role(role)?.clone();
            if !is_required {
                lesson.requirements.remove(&role, Some(property));
                return Ok(());
            }
            let value = value(&role, property);
            let required = lesson
                .requirements
                .require(&lesson.task, &role, property, &value);
            required.map_err(|error| error.to_string())
        })
    }

    /// Lets any object take a role, or again only the one most like the demonstrated object.
    pub fn free(&mut self, role: &str, is_free: bool) -> Result<(), String> {
        self.change(|lesson| {
            let role = lesson.role(role)?.clone();
            lesson.requirements.remove(&role, None);
            match is_free {
                true => {
                    let added = lesson.requirements.add(&lesson.task, &role, "any");
                    added.map_err(|error| error.to_string())
                }
                false => Ok(()),
            }
        })
    }

    fn change(
        &mut self,
        change: impl FnOnce(&mut Lesson) -> Result<(), String>,
    ) -> Result<(), String> {
        let lesson = self.lesson.as_mut();
        let lesson = lesson.ok_or("no recording shows a task yet")?;
        let said = |error: RequirementError| error.to_string();
        let mut edit = Requirements::edit(&lesson.folder, &Storage::default()).map_err(said)?;
        // Others may have changed them since.
        lesson.requirements = edit.requirements;
        change(lesson)?;
        self.has_changed = true;
        edit.requirements = lesson.requirements.clone();
        edit.finish().map(drop).map_err(said)
    }

    /// The task in words, if they have changed.
    pub fn shown_if_changed(&mut self) -> Option<ShownTask> {
        std::mem::take(&mut self.has_changed).then(|| self.shown())
    }

    fn shown(&self) -> ShownTask {
        let shown = self.lesson.as_ref().map(|lesson| {
            let Lesson {
                folder,
                task,
                requirements,
                ..
            } = lesson;
            shown_task(folder, task, requirements, None)
        });
        ShownTask {
            fault: self.fault.clone(),
            ..shown.unwrap_or_default()
        }
    }
}
