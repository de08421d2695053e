//! The objects of a recording.

use std::{collections::BTreeMap, sync::Arc};

use tabletop_core::{ObjectSpec, SimTick};
use tabletop_geometry::Rgb;

use crate::{
    files::{event::Event, states},
    recording::{
        stage::{PixelSubject, RecordedWorld},
        tracked::Tracked,
    },
};

/// The objects that are on the table, as far as the recording tells.
#[derive(Clone, Debug, Default)]
pub(crate) struct RecordedObjects {
    tracked: Vec<Tracked>,
    /// The number of `create` lines that were written.
    created: usize,
    /// The objects of the first tick, until their `create` lines are written.
    opening: Option<Vec<ObjectSpec>>,
    /// The colours of all objects that there were.
    colors: Arc<BTreeMap<String, Rgb>>,
}

impl RecordedObjects {
    /// The objects of the first tick.
    pub(crate) fn opening(specs: impl Iterator<Item = ObjectSpec>) -> Self {
        Self {
            opening: Some(specs.collect()),
            ..Self::default()
        }
    }

    /// The `create` lines of the objects that are there at the beginning.
    pub(crate) fn open(&mut self, frame: u64) -> Vec<Vec<String>> {
        let objects = self.opening.take().unwrap_or_default();
        objects.iter().for_each(|spec| self.track(spec));
        let create = |spec| Event::Create(spec).fields(frame);
        let controls = objects
            .iter()
            .flat_map(|spec| initialized_controls(spec, frame));
        objects.iter().map(create).chain(controls).collect()
    }

    /// Takes in an object that has appeared. Says whether it needs a line now.
    pub(crate) fn create(&mut self, spec: &ObjectSpec) -> bool {
        if let Some(opening) = &mut self.opening {
            if opening.iter().all(|known| known.id != spec.id) {
                opening.push(spec.clone());
            }
            return false;
        }
        let is_new = !self.has(&spec.id);
        if is_new {
            self.track(spec);
        }
        is_new
    }

    /// Takes out an object that has gone. Says whether it needs a line now.
    pub(crate) fn delete(&mut self, id: &str) -> bool {
        if let Some(opening) = &mut self.opening {
            opening.retain(|known| known.id != id);
            return false;
        }
        let was_there = self.has(id);
        self.tracked.retain(|object| object.id != id);
        was_there
    }

    fn track(&mut self, spec: &ObjectSpec) {
        self.created += 1;
        self.tracked.push(Tracked::new(&spec.id, self.created));
        if let Some(solid) = spec.shape.drawn().first() {
            Arc::make_mut(&mut self.colors).insert(spec.id.clone(), solid.color);
        }
    }

    pub(crate) fn has(&self, id: &str) -> bool {
        self.tracked.iter().any(|object| object.id == id)
    }

    pub(crate) fn color(&self, id: &str) -> Option<Rgb> {
        self.colors.get(id).copied()
    }

    pub(crate) fn tracked(&self) -> &[Tracked] {
        &self.tracked
    }

    pub(crate) fn tracked_mut(&mut self) -> &mut [Tracked] {
        &mut self.tracked
    }

    /// A row of states for each object that has moved.
    pub(crate) fn moved_rows(&mut self, tick: SimTick, stage: &RecordedWorld) -> Vec<Vec<String>> {
        let moved = self.tracked.iter_mut().filter_map(|object| {
            let state = stage.state(&object.id)?;
            object
                .note(state)
                .then(|| states::row(tick, &object.id, state))
        });
        moved.collect()
    }

    /// The number of a subject in an image of ids.
    pub(crate) fn number_of(&self, shown: PixelSubject) -> u16 {
        let number = match shown {
            PixelSubject::Table => Some(1),
            PixelSubject::Object(spec) => {
                let object = self.tracked.iter().find(|object| object.id == spec.id);
                object.and_then(|object| u16::try_from(object.number + 1).ok())
            }
            PixelSubject::Other => None,
        };
        number.unwrap_or(u16::MAX)
    }
}

/// The lines of an object's controls.
pub(crate) fn initialized_controls(spec: &ObjectSpec, frame: u64) -> Vec<Vec<String>> {
    let controls = spec.controls().into_iter();
    controls
        .map(|control| {
            let initialize = Event::InitializeControl {
                control: control.id,
                kind: control.what.type_name(),
                object: &spec.id,
                state: &control.what.state_name(),
            };
            initialize.fields(frame)
        })
        .collect()
}
