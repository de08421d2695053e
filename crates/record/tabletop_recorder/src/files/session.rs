//! The session log: the content that a replay needs besides the states.

use std::path::{Path, PathBuf};

use bevy::prelude::Resource;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Map, Value};
use tabletop_core::{
    Actor, ClockCommand, HandCamera, HeadCamera, IssuedCommand, JointSpec, ObjectSpec,
    RecordingCommand, SimCommand, SimTick, TICKS_PER_SECOND, Table,
};
use tabletop_geometry::Pose;

use crate::{
    error::RecorderError,
    files::{
        bounds::{
            check_begin, check_cameras, check_command, check_joint, check_present, check_table,
            check_ticks,
        },
        format::FORMAT,
        frame::TICKS_PER_FRAME,
        json::{from_json, reads_back, to_json_line},
        limits::MOST_SESSION_BYTES,
        log_file::read_whole_lines,
        segment_mark::SegmentMark,
    },
};

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
    /// The tick from which on the log holds every command. The world was empty before it. `None` if the log does not go back
    /// that far.
    pub begin_tick: Option<u64>,
    /// The first recorded tick.
    pub start_tick: u64,
    /// The number of commands of the log that were carried out before the recording started.
    pub earlier_commands: usize,
    /// The head camera, if there is one.
    pub camera: Option<HeadCamera>,
    /// The hand cameras whose pictures it holds, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hand_cameras: Vec<HandCamera>,
    /// The [settings](SessionSettings) when the recording started.
    pub settings: Map<String, Value>,
}

/// The name of the setting that says of a recording that it was imported, and not simulated.
pub const IMPORTED: &str = "imported";

impl SessionHeader {
    /// The header of a recording that this program writes, from this tick on.
    pub fn new(start_tick: u64) -> Self {
        Self {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").into(),
            ticks_per_second: TICKS_PER_SECOND,
            ticks_per_frame: TICKS_PER_FRAME,
            begin_tick: None,
            start_tick,
            earlier_commands: 0,
            camera: None,
            hand_cameras: Vec::new(),
            settings: Map::new(),
        }
    }

    /// True if the recording was imported: its states were not simulated, and its commands are not known.
    pub fn is_imported(&self) -> bool {
        self.settings.contains_key(IMPORTED)
    }

    /// Where it was imported from, such as `pictures`; `None` if it was simulated.
    pub fn imported_from(&self) -> Option<&str> {
        let imported = self.settings.get(IMPORTED)?;
        imported
            .get("from")
            .map_or(Some("another program"), Value::as_str)
    }
}

/// Further content of the next recording's header that a replay must know.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct SessionSettings(pub Map<String, Value>);

/// Second line of a session log: the world as it was before the first recorded tick.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SessionScene {
    /// The table, if there was one.
    pub table: Option<Table>,
    /// The objects, in the order of their creation.
    pub objects: Vec<SessionObject>,
    /// The joints between them.
    pub joints: Vec<JointSpec>,
}

/// An object as it was before the first recorded tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SessionObject {
    /// Its pose.
    pub pose: Pose,
    /// Its description, with the pose at which it was first put.
    pub spec: ObjectSpec,
}

/// Every further line of a session log: a command that was carried out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SessionCommand {
    /// The tick in which it was.
    pub tick: u64,
    /// The actor who gave it.
    pub actor: Actor,
    /// The command.
    pub command: SimCommand,
    /// Of a scene that is set in a pause: it was in the same moment as the scene before it, or as the start of the recording. Of the end of a pause: it
    /// was in the same moment as the start of the recording.
    #[serde(default, skip_serializing_if = "is_false")]
    pub at_once: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde wants it")]
const fn is_false(value: &bool) -> bool {
    !*value
}

/// The content of a session log.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// Its header: the program that wrote it, and the settings.
    pub header: SessionHeader,
    /// The world before the first recorded tick.
    pub scene: SessionScene,
    /// The commands that were carried out before the recording, from [`SessionHeader::begin_tick`] on, in their order.
    pub earlier: Vec<SessionCommand>,
    /// The commands of the recording, in their order.
    pub commands: Vec<SessionCommand>,
    /// The first ticks of its segments, without that of the first one, which is the recording's.
    pub segments: Vec<SimTick>,
}

impl SessionCommand {
    /// A command as it is logged.
    pub(crate) fn of(tick: SimTick, issued: &IssuedCommand) -> Self {
        Self {
            tick: tick.0,
            actor: issued.actor,
            command: issued.command.clone(),
            at_once: false,
        }
    }

    /// A command of the program itself in a tick.
    pub(crate) fn of_app(tick: SimTick, command: impl Into<SimCommand>) -> Self {
        Self {
            tick: tick.0,
            actor: Actor::App,
            command: command.into(),
            at_once: false,
        }
    }
}

/// True if a session log holds a command. It holds none that is about recordings; the one that ends them is added at the end.
pub(crate) fn is_logged(command: &SimCommand) -> bool {
    match command {
        SimCommand::Recording(_) | SimCommand::History(_) => false,
        SimCommand::Clock(_)
        | SimCommand::Scene(_)
        | SimCommand::Hand(_)
        | SimCommand::Mechanism(_)
        | SimCommand::Robot(_) => true,
    }
}

impl Session {
    /// Reads a session log. A last line without its line end, as a program that was killed may leave it, does not count.
    ///
    /// # Errors
    /// The file cannot be read, a line is not what it should be, or no simulation can have come to a command's tick.
    pub fn read(path: impl Into<PathBuf>) -> Result<Self, RecorderError> {
        let path = path.into();
        let text = read_whole_lines(&path, MOST_SESSION_BYTES)?;
        Self::parse(path, &text)
    }

    /// Reads the text of a session log, which faults call by this name.
    ///
    /// # Errors
    /// A line is not what it should be, or no simulation can have come to a command's tick.
    pub fn parse(path: impl Into<PathBuf>, text: &str) -> Result<Self, RecorderError> {
        let path = path.into();
        let mut lines = (1..).zip(text.lines());
        let mut line = |number| lines.next().unwrap_or((number, ""));
        let fault = |line: usize| {
            let path = path.clone();
            move |problem| RecorderError::Course {
                path,
                line,
                problem,
            }
        };
        let header: SessionHeader = parse_header(&path, line(1))?;
        check_begin(header.begin_tick, header.start_tick)
            .and_then(|()| check_cameras(header.camera.as_ref(), &header.hand_cameras))
            .map_err(fault(1))?;
        let scene: SessionScene = parse(&path, line(2))?;
        scene.check().map_err(fault(2))?;
        let mut earlier = Vec::new();
        let mut segments = Vec::new();
        let mut course = Course::of(&header);
        for line in lines {
            if SegmentMark::is_in(line.1) {
                let mark = parse(&path, line)?;
                course.pass(&mark, segments.len()).map_err(fault(line.0))?;
                segments.push(SimTick(mark.tick));
                continue;
            }
            let entry: SessionCommand = parse(&path, line)?;
            course
                .follow(&entry)
                .and_then(|()| check_command(&entry.command))
                .map_err(fault(line.0))?;
            earlier.push(entry);
        }
        let commands = earlier.split_off(earlier.len().min(header.earlier_commands));
        Ok(Self {
            header,
            scene,
            earlier,
            commands,
            segments,
        })
    }
}

/// Of a command that cannot be written, not more letters are shown.
const LONGEST_SHOWN: usize = 200;

impl SessionScene {
    /// Returns the first invalid value in it as a fault.
    pub(crate) fn check(&self) -> Result<(), String> {
        self.table.iter().try_for_each(check_table)?;
        let mut parts = 0;
        for object in &self.objects {
            check_present(object.pose, &object.spec, &mut parts)?;
        }
        self.joints.iter().try_for_each(check_joint)
    }
}

/// The progress of a simulation through the commands of a session log.
struct Course {
    /// The tick of the first command.
    begin: u64,
    tick: u64,
    is_paused: bool,
    is_finished: bool,
}

impl Course {
    fn of(header: &SessionHeader) -> Self {
        Self {
            begin: header.begin_tick.unwrap_or(header.start_tick),
            tick: header.begin_tick.unwrap_or(0),
            is_paused: false,
            is_finished: false,
        }
    }

    /// Goes on to the mark of a segment after so many others, or says why no recording comes to it.
    fn pass(&mut self, mark: &SegmentMark, others: usize) -> Result<(), String> {
        let SegmentMark { segment, tick } = *mark;
        if segment as usize != others + 1 {
            return Err(format!("segment {segment} follows segment {others}"));
        }
        self.come_to(tick)
    }

    /// Goes on to the next command, or says why no simulation comes to it.
    fn follow(&mut self, next: &SessionCommand) -> Result<(), String> {
        self.come_to(next.tick)?;
        self.is_finished = next.command == RecordingCommand::Finish.into();
        if let SimCommand::Clock(ClockCommand::SetPaused(paused)) = next.command {
            self.is_paused = paused;
        }
        Ok(())
    }

    fn come_to(&mut self, next_tick: u64) -> Result<(), String> {
        let tick = self.tick;
        if next_tick < tick {
            return Err(format!("tick {next_tick} comes after tick {tick}"));
        }
        if self.is_paused && next_tick > tick {
            return Err(format!(
                "tick {next_tick} never comes: the simulation is paused in tick {tick}, and no command ends the pause"
            ));
        }
        if self.is_finished {
            return Err("something comes after the end of the recording".into());
        }
        check_ticks(self.begin, next_tick)?;
        self.tick = next_tick;
        Ok(())
    }
}

/// Every header has a format.
fn parse_header(path: &Path, line: (usize, &str)) -> Result<SessionHeader, RecorderError> {
    #[derive(Deserialize)]
    struct Format {
        format: u32,
    }
    let Format { format: found } = parse(path, line)?;
    match found {
        FORMAT => parse(path, line),
        found => Err(RecorderError::Format {
            path: path.to_owned(),
            found,
        }),
    }
}

fn parse<T: DeserializeOwned>(
    path: &Path,
    (line, text): (usize, &str),
) -> Result<T, RecorderError> {
    from_json(text.as_bytes()).map_err(|source| RecorderError::Session {
        path: path.to_owned(),
        line,
        source,
    })
}

/// The line of a command.
///
/// # Errors
/// It would not read back, because it holds numbers that are none.
pub(crate) fn command_line(command: &SessionCommand) -> Result<Vec<u8>, RecorderError> {
    let line = to_json_line(command).and_then(|line| {
        if !reads_back(&line) {
            // It may have a value that is absent.
            from_json::<SessionCommand>(&line)?;
        }
        Ok(line)
    });
    line.map_err(|source| RecorderError::Command {
        tick: command.tick,
        command: format!("{:?}", command.command)
            .chars()
            .take(LONGEST_SHOWN)
            .collect(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use bevy::math::Vec3;
    use tabletop_core::{Drive, Hand, HandCommand, RobotCommand, RobotJoint, SceneCommand};

    use super::*;

    fn given(tick: u64, command: impl Into<SimCommand>) -> SessionCommand {
        SessionCommand {
            tick,
            actor: Actor::Mouse,
            command: command.into(),
            at_once: false,
        }
    }

    #[test]
    fn commands_read_back_to_the_bit() {
        let location = Vec3::new(0.1, -1.234_567_9e-7, 16_777_217.0);
        let hand = Hand::Left;
        let command = given(12, HandCommand::MoveTo { hand, location });
        let line = command_line(&command).unwrap();
        assert_eq!(
            serde_json::from_slice::<SessionCommand>(&line).unwrap(),
            command
        );
        assert_eq!(line.last(), Some(&b'\n'));
    }

    #[test]
    fn orders_to_joints_read_back_to_the_bit() {
        let mut bits = 0x3fcd_e5c8_0f3e_0d9b_u64;
        for _ in 0..10_000 {
            bits = bits.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            // Between 1/16 and 16, as in commands to joints.
            let value = f64::from_bits(0x3fb0_0000_0000_0000 + bits % 0x0080_0000_0000_0000);
            let drive = (RobotJoint::LeftS0, Drive::Velocity(value));
            let command = given(1, RobotCommand::drive([drive]));
            let line = command_line(&command).unwrap();
            let read = serde_json::from_slice::<SessionCommand>(&line).unwrap();
            assert_eq!(read, command);
        }
    }

    #[test]
    fn a_command_that_would_not_read_back_is_an_error() {
        let location = Vec3::new(f32::NAN, 0.0, 0.0);
        let hand = Hand::Left;
        let command = given(12, HandCommand::MoveTo { hand, location });
        let error = command_line(&command).unwrap_err().to_string();
        assert!(
            error.starts_with("a command in tick 12 cannot be written: Hand(MoveTo"),
            "{error}"
        );
    }

    #[test]
    fn a_torn_last_line_does_not_count_and_a_wrong_one_is_located() {
        let header = SessionHeader {
            format: FORMAT,
            program: "0".into(),
            ticks_per_second: 60,
            ticks_per_frame: 15,
            begin_tick: Some(2),
            start_tick: 3,
            earlier_commands: 1,
            camera: None,
            hand_cameras: Vec::new(),
            settings: Map::new(),
        };
        let mut log = to_json_line(&header).unwrap();
        log.extend(to_json_line(&SessionScene::default()).unwrap());
        for tick in [2, 4] {
            log.extend(command_line(&given(tick, SceneCommand::Clear)).unwrap());
        }
        log.extend(b"{\"tick\":5,\"comm");
        let path = std::env::temp_dir().join(format!("tabletop_session_{}", std::process::id()));
        fs::write(&path, &log).unwrap();
        let session = Session::read(&path).unwrap();
        assert_eq!(session.header, header);
        let ticks =
            |commands: &[SessionCommand]| commands.iter().map(|c| c.tick).collect::<Vec<_>>();
        assert_eq!(ticks(&session.earlier), [2]);
        assert_eq!(ticks(&session.commands), [4]);

        for (tick, command, problem) in [
            (
                1,
                SimCommand::Scene(SceneCommand::Clear),
                ":5: tick 1 comes after tick 4",
            ),
            (
                5,
                SimCommand::Clock(ClockCommand::SetPaused(true)),
                ":6: tick 7 never comes",
            ),
        ] {
            let mut log = log[..log.len() - 15].to_vec();
            log.extend(command_line(&given(tick, command)).unwrap());
            log.extend(command_line(&given(7, SceneCommand::Clear)).unwrap());
            fs::write(&path, &log).unwrap();
            let error = Session::read(&path).unwrap_err().to_string();
            assert!(error.contains(problem), "{error}");
        }

        log.push(b'\n');
        fs::write(&path, &log).unwrap();
        let error = Session::read(&path).unwrap_err().to_string();
        assert!(
            error.starts_with(&format!("{}:5: ", path.display())),
            "{error}"
        );
        for (text, line) in [(&[][..], 1), (&to_json_line(&header).unwrap(), 2)] {
            fs::write(&path, text).unwrap();
            let error = Session::read(&path).unwrap_err().to_string();
            let place = format!("{}:{line}: ", path.display());
            assert!(error.starts_with(&place), "{error}");
        }

        let header = SessionHeader {
            format: FORMAT + 1,
            ..header
        };
        fs::write(&path, to_json_line(&header).unwrap()).unwrap();
        let error = Session::read(&path).unwrap_err().to_string();
        assert!(error.contains(&format!("format {}", FORMAT + 1)), "{error}");
        fs::remove_file(path).unwrap();
    }
}
