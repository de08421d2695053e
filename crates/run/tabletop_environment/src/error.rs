//! Errors of worlds and environments.

use std::path::PathBuf;

use tabletop_camera::StudioError;
use tabletop_replay::ReplayError;
use tabletop_scenario::ScenarioError;
use tabletop_sim::robots::RobotFileError;

/// The error of a world or an environment.
#[derive(Debug, thiserror::Error)]
pub enum EnvironmentError {
    /// A scenario or a step of one.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A task file that cannot be read.
    #[error("{0}")]
    Task(String),
    /// A robot that cannot be read.
    #[error(transparent)]
    Robot(#[from] RobotFileError),
    /// A recording that cannot be replayed.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A recording that has failed.
    #[error("{0}")]
    Recording(String),
    /// A camera that is not there.
    #[error(transparent)]
    Camera(#[from] StudioError),
    /// A scenario that does not begin with a task file.
    #[error("{path}: it has no setup; expected `setup: \"FILE.xml\"`, the table with which an episode begins", path = .0.display())]
    NoSetup(PathBuf),
    /// A scenario that says nothing of its end.
    #[error("{path}: it has no goal; expected an `Expect(..)` after its last act, which is what the robot is to bring about", path = .0.display())]
    NoGoal(PathBuf),
    /// There is no room for a random arrangement.
    #[error("{path}: there is no room to put everything at random places within reach of the robot", path = .0.display())]
    NoRoom(PathBuf),
    /// The value of an option.
    #[error("{0}")]
    Option(String),
    /// An action of the wrong length.
    #[error("an action of {found} numbers, expected {expected}")]
    Action {
        /// Its length.
        found: usize,
        /// The length of the action space.
        expected: usize,
    },
    /// A number of an action that is none.
    #[error("number {number} of the action, from 0, is NaN; expected numbers from -1 to 1")]
    NotANumber {
        /// Which one, from 0.
        number: usize,
    },
    /// A step outside an episode.
    #[error("{0}; reset it first")]
    NoEpisode(&'static str),
    /// An error of one of many environments.
    #[error("environment {number}: {error}")]
    OfMany {
        /// Which one, from 0.
        number: usize,
        /// Its error.
        error: Box<Self>,
    },
    /// A pose that an arm cannot reach.
    #[error("{0}")]
    Unreachable(String),
    /// The program was told to stop waiting.
    #[error("interrupted")]
    Interrupted,
    /// A world that is no simulator's.
    #[error("{0}")]
    World(String),
}
