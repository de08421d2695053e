//! The commands that write, each in a folder of its own in which something was before.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    thread,
};

use crate::{
    fault::{self, Fault},
    tree::{Tree, copy},
};

/// A command that writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A scenario that is recorded and does not finish its recording, where one was recorded before.
    Unfinished,
    Imitated,
    Multiplied,
    MultipliedByTwo,
    MultipliedFurther,
    Replayed,
    Saved,
    FinalState,
    Initialized,
    Required,
    Imported,
    Edited,
    Merged,
}

impl Subject {
    pub const ALL: [Self; 13] = [
        Self::Unfinished,
        Self::Imitated,
        Self::Multiplied,
        Self::MultipliedByTwo,
        Self::MultipliedFurther,
        Self::Replayed,
        Self::Saved,
        Self::FinalState,
        Self::Initialized,
        Self::Required,
        Self::Imported,
        Self::Edited,
        Self::Merged,
    ];

    fn arguments(self) -> &'static str {
        match self {
            Self::Unfinished => "run unfinished.ron --quiet --record demo",
            Self::Imitated => "imitate demo --record imitated",
            Self::Multiplied => "multiply demo --count 2 --jobs 1 --out many",
            Self::MultipliedByTwo => "multiply demo --count 3 --jobs 2 --out many",
            Self::MultipliedFurther => "multiply demo --count 3 --jobs 1 --out started",
            Self::Replayed => "replay demo --out replayed",
            Self::Saved => "run --seconds 0.1 --quiet --save saved.xml",
            Self::FinalState => "run --seconds 0.1 --quiet --final-state state.csv",
            Self::Initialized => "init work",
            Self::Required => "require demo --step 1 color",
            Self::Imported => "import original imported",
            Self::Edited => "edit demo edited --retime 1=2",
            Self::Merged => "dataset merge demo demo --out merged",
        }
    }

    /// The files that the command replaces.
    fn replaced(self) -> &'static [&'static str] {
        match self {
            Self::FinalState => &["state.csv"],
            Self::Required => &["demo/task.json"],
            Self::Unfinished
            | Self::Imitated
            | Self::Multiplied
            | Self::MultipliedByTwo
            | Self::MultipliedFurther
            | Self::Replayed
            | Self::Saved
            | Self::Initialized
            | Self::Imported
            | Self::Edited
            | Self::Merged => &[],
        }
    }
}

const SCENARIO: &str = r#"(setup: "shipped:tablesetup/blocks.xml", steps: [
  Start, Grasp("Red"), Glide(to: (3, -2.5, 4), seconds: 0.3), Glide(to: (3, -2.5, 1.5), seconds: 0.3), WaitUntilThere(1), Release,
  Wait(0.3), FINISH
])"#;

/// A recording of the original program.
const ORIGINAL: &str = "0,create,a,shape,block,xspan,1.0,zspan,1.0,yspan,1.0,color,#00ff00,mass,1.0\n0,move,a,0,0,0.5,0,0,0\n2,move,a,1,0,0.5,0,0,0\n";

/// The place of the commands, with a folder that each of them begins with.
pub struct Commands {
    place: PathBuf,
    beginning: PathBuf,
}

impl Commands {
    pub fn new(name: &str) -> Self {
        let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        drop(fs::remove_dir_all(&place));
        let beginning = place.join("beginning");
        fs::create_dir_all(&beginning).unwrap();
        let commands = Self { place, beginning };
        let write = |name: &str, text: &str| fs::write(commands.beginning.join(name), text);
        write("unfinished.ron", &SCENARIO.replace("FINISH", "")).unwrap();
        write("finished.ron", &SCENARIO.replace("FINISH", "Finish")).unwrap();
        write("state.csv", "id,x,y,z,rx,ry,rz\nmine\n").unwrap();
        fs::create_dir(commands.beginning.join("original")).unwrap();
        write("original/0.txt", ORIGINAL).unwrap();
        for arguments in [
            "run finished.ron --quiet --record demo",
            "require demo --step 1 shape",
            "multiply demo --count 1 --jobs 1 --out started",
        ] {
            let output = command(arguments)
                .current_dir(&commands.beginning)
                .output()
                .unwrap();
            assert!(output.status.success(), "{arguments}: {output:?}");
        }
        commands
    }

    /// A new folder for a command.
    fn folder(&self) -> PathBuf {
        let folder = self.place.join("folder");
        drop(fs::remove_dir_all(&folder));
        copy(&self.beginning, &folder);
        folder
    }

    /// The files after a command without a fault.
    pub fn expected(&self, subject: Subject) -> Tree {
        let folder = self.folder();
        let output = command(subject.arguments())
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(output.status.success(), "{subject:?}: {output:?}");
        Tree::of(&folder)
    }

    /// The number of calls of a kind that a command makes.
    pub fn calls(&self, subject: Subject, fault: Fault) -> usize {
        fault::count(fault, &command(subject.arguments()), &self.folder())
    }

    /// Runs a command with a fault, and checks its report and the files afterwards.
    pub fn survives(
        &self,
        subject: Subject,
        expected: &Tree,
        fault: Fault,
        call: usize,
    ) -> Result<(), String> {
        let folder = self.folder();
        let program = command(subject.arguments());
        let output = fault::run_with(fault, call, &program, &folder);
        let found = Tree::of(&folder);
        let said = String::from_utf8_lossy(&output.stderr);
        if said.contains("panicked") {
            return Err(format!("it panicked: {said}"));
        }
        if output.status.success() {
            return match found.first_difference(expected) {
                None => Ok(()),
                Some(file) => Err(format!("it was silent, and {file} differs")),
            };
        }
        self.is_kept(subject, &found, expected)?;
        is_whole(subject, &folder, &found, expected)
    }

    /// Everything that was there is there, perhaps moved aside or replaced as asked.
    fn is_kept(&self, subject: Subject, found: &Tree, expected: &Tree) -> Result<(), String> {
        for (name, text) in Tree::of(&self.beginning).0 {
            let aside = name.replacen("demo/", "demo-1/", 1);
            let is_there = |name: &String| found.0.get(name) == Some(&text);
            let is_replaced = subject.replaced().contains(&name.as_str())
                && found.0.get(&name) == expected.0.get(&name);
            if !is_there(&name) && !is_there(&aside) && !is_replaced {
                return Err(format!("{name} is gone"));
            }
        }
        Ok(())
    }

    /// Two programs make demonstrations in one folder at once: one does after the other.
    pub fn multiply_twice_at_once(&self) {
        let expected = self.expected(Subject::MultipliedByTwo);
        for _ in 0..5 {
            let folder = self.folder();
            let outputs = thread::scope(|scope| {
                let run = || {
                    let mut program = command(Subject::MultipliedByTwo.arguments());
                    program.current_dir(&folder).output().unwrap()
                };
                let running = [scope.spawn(run), scope.spawn(run)];
                running.map(|program| program.join().unwrap())
            });
            let all_done = outputs.iter().all(|output| output.status.success());
            assert!(all_done, "{outputs:?}");
            assert_eq!(Tree::of(&folder).first_difference(&expected), None);
        }
    }
}

/// Recordings that were made replay, and demonstrations that were kept are those of a command without a fault.
fn is_whole(subject: Subject, folder: &Path, found: &Tree, expected: &Tree) -> Result<(), String> {
    // What was imported has no commands to replay.
    let recordings = found.recordings().into_iter();
    for recording in recordings.filter(|name| name != "imported") {
        let output = command("replay --verify")
            .arg(&recording)
            .current_dir(folder)
            .output()
            .unwrap();
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{recording} does not replay: {said}"));
        }
    }
    for (name, text) in &found.0 {
        let is_new = [
            "many/",
            "started/",
            "work/",
            "saved.xml",
            "imported/",
            "merged/",
        ];
        let is_to_be_whole = is_new.iter().any(|prefix| name.starts_with(prefix));
        if is_to_be_whole && expected.0.get(name) != Some(text) {
            return Err(format!("{subject:?} has left another {name}"));
        }
    }
    for folder in ["many", "started"] {
        let made = found.recordings().into_iter();
        for made in made.filter(|made| made.starts_with(&format!("{folder}/"))) {
            let of = |tree: &Tree| {
                let files = tree.0.keys().filter(|name| name.starts_with(&made));
                files.count()
            };
            if of(found) != of(expected) {
                return Err(format!("{made} is not whole"));
            }
        }
    }
    Ok(())
}

fn command(arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tabletop"));
    command
        .args(arguments.split(' '))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY");
    command
}
