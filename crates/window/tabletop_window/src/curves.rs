//! The curves of the recording that the Timeline shows, read beside the frames.

use std::{collections::BTreeMap, path::Path};

use bevy::prelude::*;
use tabletop_core::{SimTick, TICKS_PER_SECOND, Timeline, TimelineStage};
use tabletop_gui::{Panel, Panels};
use tabletop_recorder::RecordingReader;
use tabletop_user::{Curves, Quantity, RecordedCurves};

use crate::background::BackgroundWork;

/// The most points of a curve: more than a screen has columns.
const MOST_POINTS: usize = 4000;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<CurveReading>()
        .add_systems(Update, (begin, take).chain());
}

/// The reading of curves, while it goes on.
#[derive(Resource, Default)]
struct CurveReading(Option<BackgroundWork<Curves>>);

fn begin(
    mut reading: ResMut<CurveReading>,
    mut recorded: ResMut<RecordedCurves>,
    timeline: Res<Timeline>,
    panels: Res<Panels>,
) {
    let is_whole = match timeline.stage {
        TimelineStage::Finished | TimelineStage::Open => true,
        TimelineStage::Absent | TimelineStage::Running => false,
    };
    if !is_whole {
        if *recorded != RecordedCurves::default() {
            // The next recording may have the same folder.
            *recorded = RecordedCurves::default();
            reading.0 = None;
        }
        return;
    }
    if !panels.is_open(Panel::Plots) || recorded.folder == timeline.folder {
        return;
    }
    let folder = timeline.folder.clone();
    *recorded = RecordedCurves {
        folder: folder.clone(),
        curves: None,
    };
    reading.0 = Some(BackgroundWork::begin(move || read(&folder)));
}

fn take(mut reading: ResMut<CurveReading>, mut recorded: ResMut<RecordedCurves>) {
    let reading = reading.bypass_change_detection();
    if let Some(read) = reading.0.as_mut().and_then(BackgroundWork::result) {
        recorded.curves = Some(read);
        reading.0 = None;
    }
}

/// Reads the curves of a recording.
fn read(folder: &Path) -> Result<Curves, String> {
    let said = |error: &dyn std::fmt::Display| error.to_string();
    let recording = RecordingReader::open(folder).map_err(|error| said(&error))?;
    let first = recording.first_tick();
    let mut curves = Curves::default();
    let seconds = |tick: u64| tick.saturating_sub(first.0) as f64 / f64::from(TICKS_PER_SECOND);
    let mut add = |quantity, name: &str, tick: SimTick, value: f64| {
        let hold = seconds(tick.0.saturating_sub(1));
        curves.add(quantity, name, hold, [seconds(tick.0), value]);
    };
    let mut names: BTreeMap<String, [String; 3]> = BTreeMap::new();
    for row in recording.states().map_err(|error| said(&error))? {
        let names = names
            .entry(row.id.clone())
            .or_insert_with(|| ["X", "Y", "Z"].map(|axis| format!("{} {axis}", row.id)));
        let values = [
            (Quantity::Places, row.pose.location),
            (Quantity::Angles, row.pose.degrees()),
        ];
        for (quantity, vector) in values {
            for (name, value) in names.iter().zip(vector.to_array()) {
                add(quantity, name, row.tick, value.into());
            }
        }
        let speed = row.twist.linear.length();
        add(Quantity::Speeds, &row.id, row.tick, speed.into());
    }
    for row in recording.joints().map_err(|error| said(&error))? {
        let name = row.joint.to_string();
        // The openings of grippers are the joints whose names say so.
        if name.contains("gripper") {
            add(Quantity::Grippers, &name, row.tick, row.state.position);
            continue;
        }
        add(Quantity::Joints, &name, row.tick, row.state.position);
        add(
            Quantity::JointVelocities,
            &name,
            row.tick,
            row.state.velocity,
        );
        add(Quantity::Torques, &name, row.tick, row.state.torque);
    }
    curves.extend_to(seconds(recording.last_tick().0));
    curves.thin(MOST_POINTS);
    Ok(curves)
}
