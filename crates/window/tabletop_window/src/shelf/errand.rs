//! Work on recordings that the program does as a child process of its own.

use std::{
    env,
    ffi::OsString,
    io::{BufRead as _, BufReader, Read},
    process::{Child, Command, Stdio},
    sync::mpsc::{Receiver, Sender, channel},
    thread,
};

use bevy::{platform::cell::SyncCell, prelude::*};
use tabletop_user::{Errand, Notices, RunningErrand, Shelf, ShelfOrder, Tone};

use tabletop_sim::progress::{PROGRESS_VARIABLE, progress_in};

/// Number of lines of a failed child that are told.
const MOST_LINES: usize = 4;

/// The child that works.
#[derive(Resource, Default)]
pub(super) struct ErrandProcess(Option<WorkingChild>);

struct WorkingChild {
    errand: Errand,
    child: Child,
    lines: SyncCell<Receiver<String>>,
    /// The last lines that tell no progress.
    last: Vec<String>,
    is_cancelled: bool,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<ErrandProcess>()
        .add_systems(Update, follow);
}

impl ErrandProcess {
    /// Begins a piece of work, unless one is being done.
    pub fn begin(&mut self, errand: &Errand) -> Result<(), String> {
        if let Some(working) = &self.0 {
            let sentence = working.errand.sentence();
            return Err(format!("{sentence}: wait until it is done, or cancel it"));
        }
        let program = env::current_exe().map_err(|error| format!("cannot find itself: {error}"))?;
        self.0 = Some(WorkingChild::start(program.into(), errand)?);
        Ok(())
    }

    /// Ends the work. What it has not completed is not there, or hidden.
    pub fn cancel(&mut self) {
        if let Some(working) = &mut self.0 {
            working.is_cancelled = true;
            // It may just have ended.
            let _ = working.child.kill();
        }
    }
}

impl Drop for ErrandProcess {
    fn drop(&mut self) {
        self.cancel();
    }
}

impl WorkingChild {
    fn start(program: OsString, errand: &Errand) -> Result<Self, String> {
        let mut child = Command::new(program)
            .args(arguments(errand))
            .env(PROGRESS_VARIABLE, "1")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| format!("it cannot be done: {error}"))?;
        let (sender, lines) = channel();
        if let Some(output) = child.stdout.take() {
            listen(output, sender.clone());
        }
        if let Some(output) = child.stderr.take() {
            listen(output, sender);
        }
        Ok(Self {
            errand: errand.clone(),
            child,
            lines: SyncCell::new(lines),
            last: Vec::new(),
            is_cancelled: false,
        })
    }

    /// Takes in what the child has said, and returns its latest progress.
    fn hear(&mut self) -> Option<(u64, u64)> {
        let mut latest = None;
        while let Ok(line) = self.lines.get().try_recv() {
            match progress_in(&line) {
                Some(progress) => latest = Some(progress),
                None => self.last.push(line),
            }
        }
        let excess = self.last.len().saturating_sub(MOST_LINES);
        self.last.drain(..excess);
        latest
    }
}

/// Sends on what a child says, line by line.
fn listen(output: impl Read + Send + 'static, sender: Sender<String>) {
    let listening = move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    };
    // Without it, only the progress is not known.
    let _ = thread::Builder::new().spawn(listening);
}

/// The arguments of the command line that do it. Where another program writes, the window says so at once.
fn arguments(errand: &Errand) -> Vec<OsString> {
    match errand {
        Errand::Export {
            recordings,
            format,
            out,
        } => {
            let mut all: Vec<OsString> = vec!["export".into()];
            all.extend(recordings.iter().map(OsString::from));
            all.extend(["--to".into(), format.into(), out.into()]);
            all.push("--no-wait".into());
            all
        }
        Errand::Multiply {
            recording,
            count,
            out,
        } => vec![
            "multiply".into(),
            recording.into(),
            "--count".into(),
            count.to_string().into(),
            "--out".into(),
            out.into(),
            "--no-wait".into(),
        ],
        Errand::Imitate { recording, out } => vec![
            "imitate".into(),
            recording.into(),
            "--record".into(),
            out.into(),
        ],
    }
}

/// Shows the progress of the child, and says what has become of it when it has ended.
fn follow(
    mut process: ResMut<ErrandProcess>,
    mut shelf: ResMut<Shelf>,
    mut notices: ResMut<Notices>,
    mut orders: MessageWriter<ShelfOrder>,
) {
    let process = process.bypass_change_detection();
    let Some(working) = &mut process.0 else {
        if shelf.errand.is_some() {
            shelf.errand = None;
        }
        return;
    };
    let ended = working.child.try_wait();
    let heard = working.hear();
    let known = shelf.errand.as_ref().and_then(|running| running.progress);
    let running = RunningErrand {
        errand: working.errand.clone(),
        progress: heard.or(known),
    };
    if shelf.errand.as_ref() != Some(&running) {
        shelf.errand = Some(running);
    }
    let status = match ended {
        Ok(None) => return,
        Ok(Some(status)) => Ok(status.success()),
        Err(error) => Err(error.to_string()),
    };
    let sentence = working.errand.sentence();
    let out = working.errand.out().display();
    let last = working.last.join("\n");
    let (tone, end) = match status {
        Ok(true) => (Tone::Event, format!("done\n{last}")),
        Ok(false) | Err(_) if working.is_cancelled => {
            let end = format!("cancelled; what was complete by then is in {out}");
            (Tone::Warning, end)
        }
        Ok(false) => (Tone::Fault, last),
        Err(error) => (Tone::Fault, error),
    };
    notices.append(tone, &format!("{sentence}: {end}"));
    process.0 = None;
    shelf.errand = None;
    orders.write(ShelfOrder::Look(shelf.folder.clone()));
}

#[cfg(test)]
mod tests {
    #[cfg(unix)]
    use std::time::Duration;

    use super::*;
    #[cfg(unix)]
    use crate::test_folder::TestFolder;

    fn imitate() -> Errand {
        Errand::Imitate {
            recording: "a".into(),
            out: "a-robot".into(),
        }
    }

    #[test]
    fn the_arguments_are_those_of_the_command_line() {
        let export = Errand::Export {
            recordings: vec!["a".into(), "b c".into()],
            format: "mcap".into(),
            out: "a-mcap".into(),
        };
        let words = ["export", "a", "b c", "--to", "mcap", "a-mcap", "--no-wait"];
        assert_eq!(arguments(&export), words.map(OsString::from));
        let words = ["imitate", "a", "--record", "a-robot"];
        assert_eq!(arguments(&imitate()), words.map(OsString::from));
    }

    /// Begins a program in the place of the command line.
    #[cfg(unix)]
    fn child(name: &str, program: &str) -> (WorkingChild, TestFolder) {
        use std::os::unix::fs::PermissionsExt as _;

        let folder = TestFolder::new(&format!("errand-{name}"));
        folder.write("program", &format!("#!/bin/sh\n{program}\n"));
        let path = folder.join("program");
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        (
            WorkingChild::start(path.into(), &imitate()).unwrap(),
            folder,
        )
    }

    #[cfg(unix)]
    fn heard_until_end(child: &mut WorkingChild) -> Option<(u64, u64)> {
        let mut latest = None;
        while child.child.try_wait().unwrap().is_none() {
            latest = child.hear().or(latest);
            thread::sleep(Duration::from_millis(5));
        }
        // What it has said may come a little later.
        thread::sleep(Duration::from_millis(200));
        child.hear().or(latest)
    }

    #[cfg(unix)]
    #[test]
    fn a_child_is_heard() {
        let text = "echo progress 3 12 >&2; echo odd; echo the reason >&2; exit 1";
        let (mut child, _folder) = child("heard", text);
        assert_eq!(heard_until_end(&mut child), Some((3, 12)));
        child.last.sort();
        assert_eq!(child.last, ["odd", "the reason"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_child_can_be_cancelled() {
        let (child, _folder) = child("cancelled", "exec sleep 100");
        let mut process = ErrandProcess(Some(child));
        assert!(process.begin(&imitate()).is_err());
        process.cancel();
        let working = process.0.as_mut().unwrap();
        assert!(!working.child.wait().unwrap().success());
        assert!(working.is_cancelled);
    }
}
