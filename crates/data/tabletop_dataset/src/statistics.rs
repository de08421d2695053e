//! The distribution of a dataset's numbers.

use std::collections::BTreeMap;

use tabletop_core::{Manipulator, TICKS_PER_SECOND};
use tabletop_recorder::RecordingReader;
use tabletop_task::{Demonstration, Task};

use crate::{
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder},
};

/// The distribution of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberStatistics {
    /// How many values there are.
    pub count: usize,
    /// The least.
    pub min: f64,
    /// The largest.
    pub max: f64,
    sum: f64,
    squares: f64,
}

impl Default for NumberStatistics {
    fn default() -> Self {
        Self {
            count: 0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            sum: 0.0,
            squares: 0.0,
        }
    }
}

impl NumberStatistics {
    fn add(&mut self, value: f64) {
        self.count += 1;
        self.min = self.min.min(value);
        self.max = self.max.max(value);
        self.sum += value;
        self.squares += value * value;
    }

    /// The mean.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// The standard deviation.
    pub fn deviation(&self) -> f64 {
        let count = self.count.max(1) as f64;
        (self.squares / count - self.mean() * self.mean())
            .max(0.0)
            .sqrt()
    }
}

/// The numbers of a dataset, by name and unit: of its episodes, and of the states and actions of a LeRobot dataset, or of the places of a
/// recording's objects.
///
/// # Errors
/// A file of it cannot be read.
pub fn statistics(
    dataset: &DatasetFolder,
) -> Result<BTreeMap<String, NumberStatistics>, DatasetError> {
    let mut all = BTreeMap::<String, NumberStatistics>::new();
    let mut add = |name: &str, value: f64| {
        if !all.contains_key(name) {
            all.insert(name.to_owned(), NumberStatistics::default());
        }
        if let Some(known) = all.get_mut(name) {
            known.add(value);
        }
    };
    match &dataset.content {
        DatasetContent::Recordings(recordings) => {
            for folder in recordings {
                let recording = RecordingReader::open(folder)?;
                let shown = Demonstration::of(&recording)?;
                let ticks = recording.last_tick().0 - recording.first_tick().0;
                add("episode [s]", ticks as f64 / f64::from(TICKS_PER_SECOND));
                add("steps", Task::of(&shown).steps.len() as f64);
                let of_hands = shown.acts.iter();
                let of_hands = of_hands.filter(|act| matches!(act.by, Manipulator::Hand(_)));
                let of_hands = of_hands.count();
                add("acts of hands", of_hands as f64);
                add("acts of grippers", (shown.acts.len() - of_hands) as f64);
                for row in recording.states()? {
                    let place = row.pose.location.to_array();
                    for (axis, value) in ["x", "y", "z"].into_iter().zip(place) {
                        add(&format!("{}.{axis}", row.id), f64::from(value));
                    }
                }
            }
        }
        DatasetContent::LeRobot(reader) => reader.visit_tables(|_, episode| {
            add("episode [s]", episode.len() as f64 / f64::from(episode.fps));
            for (kind, signal) in [
                ("state", &episode.whole_state()),
                ("action", &episode.action),
            ] {
                for frame in signal.frames() {
                    for (name, value) in signal.names.iter().zip(frame) {
                        add(&format!("{kind} {name}"), f64::from(*value));
                    }
                }
            }
            Ok::<_, DatasetError>(())
        })?,
    }
    Ok(all)
}
