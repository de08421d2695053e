//! The robot of a recording, as its joints were: what the head camera saw of it.

use std::{collections::BTreeMap, iter::Peekable, vec};

use tabletop_camera::DrawnFigure;
use tabletop_core::{RobotCommand, SimCommand, SimTick};
use tabletop_geometry::Pose;
use tabletop_recorder::{JointRow, RecorderError};
use tabletop_replay::Replay;
use tabletop_robot::{Articulation, Description, TreePosition};

/// The number of the robot's pixels in pictures.
const NUMBER: u32 = 2;

/// A recorded robot, tick by tick.
pub struct RecordedRobot {
    description: Description,
    articulation: Articulation,
    base: Pose,
    positions: Vec<f64>,
    rows: Peekable<vec::IntoIter<JointRow>>,
    /// From when on the robot is shown, and from when on it is not.
    shown: BTreeMap<SimTick, bool>,
}

impl RecordedRobot {
    /// The robot of a recording; `None` if the recording does not tell its joints, or not which robot it is.
    ///
    /// # Errors
    /// The joints cannot be read.
    pub fn of(replay: &Replay) -> Result<Option<Self>, RecorderError> {
        let rows = replay.recording().joints()?;
        let description = match &replay.robot().description {
            Some(description) => Ok(description.clone()),
            None => Description::baxter(),
        };
        let Ok(description) = description else {
            return Ok(None);
        };
        let layout = description.layout.clone();
        let articulation = Articulation::new(description.model.clone(), layout.clone());
        let (Ok(articulation), false) = (articulation, rows.is_empty()) else {
            return Ok(None);
        };
        let session = replay.session();
        let commands = session.earlier.iter().chain(&session.commands);
        let shown = commands.filter_map(|given| {
            let SimCommand::Robot(RobotCommand::Show(is_shown)) = given.command else {
                return None;
            };
            Some((SimTick(given.tick), is_shown))
        });
        Ok(Some(Self {
            base: layout.base.pose(&session.scene.table.unwrap_or_default()),
            positions: vec![0.0; layout.joints.len()],
            shown: shown.collect(),
            rows: rows.into_iter().peekable(),
            articulation,
            description,
        }))
    }

    /// What the head camera sees of it at the end of a tick. Ticks must ascend.
    pub fn figures(&mut self, tick: SimTick) -> Vec<DrawnFigure> {
        while let Some(row) = self.rows.next_if(|row| row.tick <= tick) {
            if let Some(joint) = self.description.layout.find_joint(row.joint) {
                self.positions[joint.index()] = row.state.position;
            }
        }
        let is_shown = self.shown.range(..=tick).next_back();
        if is_shown.is_none_or(|(_, is_shown)| !is_shown) {
            return Vec::new();
        }
        let posture = self.articulation.posture(&self.positions, self.base);
        let figures = self.description.figures_of(&self.articulation);
        let bodies = self.articulation.bodies.iter().zip(posture.bodies());
        let seen = bodies.zip(figures).filter_map(|((body, &pose), figure)| {
            let is_head = body.place == TreePosition::Head;
            Some(DrawnFigure::of(
                pose,
                figure.as_ref().filter(|_| !is_head)?,
                NUMBER,
            ))
        });
        seen.collect()
    }
}
