//! The session log: what a recording needs besides the states to be run again.

use std::{
    fs,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Map, Value};
use tabletop_core::{HeadCamera, JointSpec, ObjectSpec, Pose, SceneSpec, SimCommand, Table};

use crate::RecorderError;

/// Version of the format that is written here.
pub(crate) const FORMAT: u32 = 1;

/// First line of a session log: who wrote it, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SessionHeader {
    /// Version of the format.
    pub format: u32,
    /// Version of the program.
    pub program: String,
    /// Ticks per second of simulated time.
    pub ticks_per_second: u32,
    /// Ticks from one frame to the next.
    pub ticks_per_frame: u64,
    /// The first recorded tick.
    pub start_tick: u64,
    /// The head camera, if there is one.
    pub camera: Option<HeadCamera>,
    /// What [`RecorderPlugin::header`](crate::RecorderPlugin::header) adds.
    pub settings: Map<String, Value>,
}

/// Second line of a session log: the world as it was before the first recorded tick.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SessionScene {
    /// The table, if there was one.
    pub table: Option<Table>,
    /// The objects, in the order of their creation.
    pub objects: Vec<SessionObject>,
    /// The joints between them.
    pub joints: Vec<JointSpec>,
    /// The last scene, if the table was not cleared since.
    pub task: Option<SessionTask>,
}

/// An object as it was before the first recorded tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SessionObject {
    /// Where it was.
    pub pose: Pose,
    /// What it is, and where it was first put.
    pub spec: ObjectSpec,
}

/// A scene that was put on the table before the recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SessionTask {
    /// The tick in which it was.
    pub tick: u64,
    /// The scene.
    pub scene: SceneSpec,
}

/// Every further line of a session log: a command that was carried out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SessionCommand {
    /// The tick in which it was.
    pub tick: u64,
    /// The command.
    pub command: SimCommand,
}

/// The content of a session log.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// Who wrote it, and how.
    pub header: SessionHeader,
    /// The world before the first recorded tick.
    pub scene: SessionScene,
    /// The commands, in their order.
    pub commands: Vec<SessionCommand>,
}

impl Session {
    /// Reads a session log. A last line without its line end, as a program that was killed may leave it, does not count.
    pub fn read(path: impl Into<PathBuf>) -> Result<Self, RecorderError> {
        let path = path.into();
        let text = fs::read_to_string(&path).map_err(RecorderError::read(&path))?;
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut lines = (1..).zip(whole.split('\n'));
        let mut next = || lines.next().unwrap_or_default();
        let header: SessionHeader = parse(&path, next())?;
        if header.format != FORMAT {
            let found = header.format;
            return Err(RecorderError::Format { path, found });
        }
        let scene = parse(&path, next())?;
        let commands = lines
            .map(|line| parse(&path, line))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            header,
            scene,
            commands,
        })
    }
}

fn parse<T: DeserializeOwned>(
    path: &Path,
    (line, text): (usize, &str),
) -> Result<T, RecorderError> {
    serde_json::from_str(text).map_err(|source| RecorderError::Session {
        path: path.to_owned(),
        line,
        source,
    })
}

/// A line of a session log, with its line end.
pub(crate) fn session_line(content: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    let mut line = serde_json::to_vec(content)?;
    line.push(b'\n');
    Ok(line)
}

/// The line of a command; none if it would not read back, because it holds numbers that are none.
pub(crate) fn command_line(tick: u64, command: &SimCommand) -> Option<Vec<u8>> {
    let command = command.clone();
    let line = session_line(&SessionCommand { tick, command }).ok()?;
    serde_json::from_slice::<SessionCommand>(&line)
        .is_ok()
        .then_some(line)
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::Hand;

    use super::*;

    #[test]
    fn commands_read_back_to_the_bit() {
        let location = Vec3::new(0.1, -1.234_567_9e-7, 16_777_217.0);
        let command = SimCommand::MoveTo {
            hand: Hand::Left,
            location,
        };
        let line = command_line(12, &command).unwrap();
        assert_eq!(
            serde_json::from_slice::<SessionCommand>(&line).unwrap(),
            SessionCommand { tick: 12, command }
        );
        assert_eq!(line.last(), Some(&b'\n'));
    }

    #[test]
    fn a_command_that_would_not_read_back_is_left_out() {
        let location = Vec3::new(f32::NAN, 0.0, 0.0);
        let command = SimCommand::MoveTo {
            hand: Hand::Left,
            location,
        };
        assert_eq!(command_line(12, &command), None);
    }

    #[test]
    fn a_torn_last_line_does_not_count_and_a_wrong_one_is_located() {
        let header = SessionHeader {
            format: FORMAT,
            program: "0".into(),
            ticks_per_second: 60,
            ticks_per_frame: 15,
            start_tick: 3,
            camera: None,
            settings: Map::new(),
        };
        let mut log = session_line(&header).unwrap();
        log.extend(session_line(&SessionScene::default()).unwrap());
        log.extend(command_line(4, &SimCommand::ClearTable).unwrap());
        log.extend(b"{\"tick\":5,\"comm");
        let path = std::env::temp_dir().join(format!("tabletop_session_{}", std::process::id()));
        fs::write(&path, &log).unwrap();
        let session = Session::read(&path).unwrap();
        assert_eq!(session.header, header);
        assert_eq!(session.commands.len(), 1);

        log.push(b'\n');
        fs::write(&path, &log).unwrap();
        let error = Session::read(&path).unwrap_err().to_string();
        assert!(
            error.starts_with(&format!("{}:4: ", path.display())),
            "{error}"
        );
        fs::write(&path, "").unwrap();
        assert!(Session::read(&path).is_err());

        let header = SessionHeader {
            format: 2,
            ..header
        };
        fs::write(&path, session_line(&header).unwrap()).unwrap();
        let error = Session::read(&path).unwrap_err().to_string();
        assert!(error.contains("format 2"), "{error}");
        fs::remove_file(path).unwrap();
    }
}
