//! The roads that lead from recordings.

use std::{fs, path::Path};

use tabletop_export::{ExportError, LeRobotReader, read_robomimic};
use tabletop_training::TrainingEpisode;

use super::{
    kind::copy,
    playback,
    program::{Ended, run},
    shown::{Sentences, check_printed, check_told, seen, with_one_hand},
};

/// Commands that read no recording.
pub const WITHOUT_RECORDING: [&str; 16] = [
    "run",
    "serve-policy",
    "tell",
    "import",
    "check",
    "robot",
    "keys",
    "init",
    "docs",
    "shipped",
    "soak",
    "validate",
    "benchmark",
    "completions",
    "man",
    "help",
];

/// A road: a command, with the options that make it another way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Road {
    Explain,
    List,
    Compare,
    Teach,
    Require,
    Watch,
    Imitate,
    ImitateSeeing,
    Multiply,
    MultiplyByRobot,
    Learn,
    Verify,
    LeRobot,
    Robomimic,
    Rlds,
    Mcap,
    Mat,
    Report,
    Sheet,
    Video,
    Edit,
    Splice,
    Info,
    Stats,
    Check,
    Merge,
    Split,
    Drop,
    Trim,
    Card,
    Repair,
    Window,
}

/// Where a road has led.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cell {
    Right,
    /// With this sentence.
    Refused(String),
}

/// Says why a result is wrong.
type Wrong = String;

impl Road {
    pub const ALL: [Self; 32] = [
        Self::Explain,
        Self::List,
        Self::Compare,
        Self::Teach,
        Self::Require,
        Self::Watch,
        Self::Imitate,
        Self::ImitateSeeing,
        Self::Multiply,
        Self::MultiplyByRobot,
        Self::Learn,
        Self::Verify,
        Self::LeRobot,
        Self::Robomimic,
        Self::Rlds,
        Self::Mcap,
        Self::Mat,
        Self::Report,
        Self::Sheet,
        Self::Video,
        Self::Edit,
        Self::Splice,
        Self::Info,
        Self::Stats,
        Self::Check,
        Self::Merge,
        Self::Split,
        Self::Drop,
        Self::Trim,
        Self::Card,
        Self::Repair,
        Self::Window,
    ];

    /// The command that it takes. The window is none.
    pub const fn command(self) -> &'static str {
        match self {
            Self::Window => "",
            Self::Explain => "explain",
            Self::List => "list",
            Self::Compare => "compare",
            Self::Teach => "teach",
            Self::Require => "require",
            Self::Watch => "watch",
            Self::Imitate | Self::ImitateSeeing => "imitate",
            Self::Multiply | Self::MultiplyByRobot => "multiply",
            Self::Learn => "learn",
            Self::Verify => "replay",
            Self::LeRobot | Self::Robomimic | Self::Rlds | Self::Mcap | Self::Mat => "export",
            Self::Report => "report",
            Self::Sheet | Self::Video => "video",
            Self::Edit | Self::Splice => "edit",
            Self::Info
            | Self::Stats
            | Self::Check
            | Self::Merge
            | Self::Split
            | Self::Drop
            | Self::Trim
            | Self::Card
            | Self::Repair => "dataset",
        }
    }

    /// The command and its options, with the recording as `DIR`, and `OUT`.
    const fn line(self) -> &'static str {
        match self {
            Self::Explain => "explain DIR",
            Self::List => "list DIR",
            Self::Compare => "compare DIR DIR",
            Self::Teach => "teach DIR",
            Self::Require => "require DIR --step 1 color",
            Self::Watch => "watch DIR",
            Self::Imitate => "imitate DIR",
            Self::ImitateSeeing => "imitate DIR --eyes",
            Self::Multiply => "multiply DIR --count 1 --out OUT",
            Self::MultiplyByRobot => "multiply DIR --count 1 --out OUT --robot",
            Self::Learn => "learn DIR --out OUT.safetensors --count 4 --samples 16 --trials 1",
            Self::Verify => "replay DIR --verify",
            Self::LeRobot => "export DIR --to lerobot OUT",
            Self::Robomimic => "export DIR --to robomimic OUT.hdf5",
            Self::Rlds => "export DIR --to rlds OUT",
            Self::Mcap => "export DIR --to mcap OUT",
            Self::Mat => "export DIR --to mat OUT",
            Self::Report => "report DIR OUT.html",
            Self::Sheet => "video DIR OUT.png",
            Self::Video => "video DIR OUT.mp4 --size 64x48 --fps 2",
            Self::Edit => "edit DIR OUT --retime 1=2",
            Self::Splice => "edit DIR OUT --splice DIR",
            Self::Info => "dataset info DIR",
            Self::Stats => "dataset stats DIR",
            Self::Check => "dataset check DIR",
            Self::Merge => "dataset merge DIR --out OUT",
            Self::Split => "dataset split DIR OUT --into train=1",
            Self::Drop => "dataset drop DIR OUT --episodes 0",
            Self::Trim => "dataset trim DIR OUT",
            Self::Card => "dataset card DIR",
            Self::Repair => "dataset repair DIR",
            Self::Window => "opened in the window",
        }
    }

    /// What is written above its column.
    pub fn name(self) -> String {
        let line = self.line();
        let end = line.find(" --out").unwrap_or(line.len());
        let words = line[..end]
            .split(' ')
            .filter(|word| !word.starts_with("DIR"));
        let words = words.filter(|word| !word.starts_with("OUT"));
        let mut name = words.collect::<Vec<_>>().join(" ");
        if self == Self::MultiplyByRobot {
            name += " --robot";
        }
        name
    }

    /// Goes it with a recording that is known to show this. `place` is an empty folder.
    pub fn go(self, recording: &Path, shown: Sentences, place: &Path) -> Result<Cell, Wrong> {
        // Some commands write into the recording.
        let copied = place.join("recording");
        copy(recording, &copied);
        if self == Self::Window {
            return playback::open(&copied);
        }
        let out = place.join("out");
        let (dir, out_name) = (copied.to_str().unwrap(), out.to_str().unwrap());
        let words: Vec<_> = self
            .line()
            .split(' ')
            .map(|word| word.replace("DIR", dir).replace("OUT", out_name))
            .collect();
        let words: Vec<_> = words.iter().map(String::as_str).collect();
        let ended = run(&words, place);
        if ended.is_success() {
            self.check(&ended, &copied, &out, shown)?;
            return Ok(Cell::Right);
        }
        let sentence = refusal(&ended)?;
        let sentence = without_times(&sentence)
            .replace(dir, "DIR")
            .replace(out_name, "OUT");
        Ok(Cell::Refused(sentence))
    }

    /// Compares what was made with what is to be shown.
    fn check(self, ended: &Ended, dir: &Path, out: &Path, shown: Sentences) -> Result<(), Wrong> {
        let explain = |folder: &Path| {
            run(
                &["explain", folder.to_str().unwrap()],
                out.parent().unwrap(),
            )
        };
        let with = |ending: &str| out.with_extension(ending);
        match self {
            Self::Explain => check_printed(ended, shown),
            Self::List | Self::Compare => check_told(&ended.stdout, shown),
            // What is printed is a program.
            Self::Teach => {
                let lines = ended.stdout.lines();
                let is_said =
                    |line: &&str| !line.starts_with("Or ") && !line.starts_with("Not moved");
                let program: Vec<_> = lines.take_while(is_said).collect();
                let checked = ["tell", "--check", &program.join("\n")];
                let checked = run(&checked, out.parent().unwrap());
                begins_with(&checked.stdout, &program.join("\n"))
            }
            // No picture shows who triggers or points.
            Self::Watch => check_printed(ended, &seen(shown)),
            Self::Require => {
                let ended = run(&["require", dir.to_str().unwrap()], out.parent().unwrap());
                match ended.stdout.contains("color") {
                    true => Ok(()),
                    false => Err(format!("the requirement is not there: {ended:?}")),
                }
            }
            Self::Imitate | Self::ImitateSeeing => begins_with(&ended.stdout, "Done: "),
            Self::Multiply => check_printed(&explain(&out.join("0000")), shown),
            Self::MultiplyByRobot => {
                check_printed(&explain(&out.join("0000")), &with_one_hand(shown))
            }
            Self::Learn => is_file(&with("safetensors"), &[]),
            Self::Verify | Self::Repair | Self::Window => Ok(()),
            Self::LeRobot => {
                let reader = LeRobotReader::open(out).map_err(|error| error.to_string())?;
                let mut episodes = Vec::new();
                let visited = reader.visit(|episode| {
                    episodes.push(episode);
                    Ok::<_, ExportError>(())
                });
                visited.map_err(|error| error.to_string())?;
                check_episode(&episodes, shown)
            }
            Self::Robomimic => {
                let episodes = read_robomimic(&with("hdf5")).map_err(|error| error.to_string())?;
                check_episode(&episodes, shown)
            }
            Self::Rlds => is_file(&out.join("dataset_info.json"), b"{"),
            Self::Mcap => is_file(&out.join("episode-000000.mcap"), b"\x89MCAP0\r\n"),
            Self::Mat => is_file(&out.join("episode-000000.mat"), b"MATLAB 7.3"),
            Self::Report => {
                let page = fs::read_to_string(with("html")).map_err(|error| error.to_string())?;
                check_told(&page, shown)
            }
            Self::Sheet => is_file(&with("png"), b"\x89PNG"),
            Self::Video => is_file(&with("mp4"), b""),
            Self::Edit => check_printed(&explain(out), shown),
            Self::Splice | Self::Merge | Self::Split | Self::Drop | Self::Trim => is_folder(out),
            Self::Info => check_told(&ended.stdout, shown),
            Self::Stats | Self::Check => Ok(()),
            Self::Card => {
                let page = fs::read_to_string(dir.join("README.md"));
                check_told(&page.map_err(|error| error.to_string())?, shown)
            }
        }
    }
}

/// The sentence without how long it took, which no two runs have alike.
fn without_times(sentence: &str) -> &str {
    let times = sentence.find(" s simulated in ");
    let end = times.and_then(|times| sentence[..times].rfind("; "));
    &sentence[..end.unwrap_or(sentence.len())]
}

/// The sentence of a refusal; `Err` if it is none.
fn refusal(ended: &Ended) -> Result<String, Wrong> {
    let lines = ended.stderr.lines().chain(ended.stdout.lines());
    let mut said = lines.map(|line| line.strip_prefix("tabletop: ").unwrap_or(line));
    let sentence = said.rfind(|line| !line.trim().is_empty());
    let is_sentence = |line: &&str| {
        let unfit = ["os error", "panicked", "Error {", "try '--help'"];
        line.contains(' ') && !unfit.iter().any(|unfit| line.contains(unfit))
    };
    match sentence.filter(is_sentence) {
        Some(sentence) if ended.is_refusal() => Ok(sentence.to_owned()),
        _ => Err(format!("it fails without a sentence: {ended:?}")),
    }
}

fn check_episode(episodes: &[TrainingEpisode], shown: Sentences) -> Result<(), Wrong> {
    match episodes {
        [episode] if !episode.is_empty() => check_told(&episode.task, shown),
        _ => Err(format!("expected an episode, not {}", episodes.len())),
    }
}

fn begins_with(text: &str, beginning: &str) -> Result<(), Wrong> {
    match text.starts_with(beginning) {
        true => Ok(()),
        false => Err(format!("expected {beginning}, not {text}")),
    }
}

fn is_file(path: &Path, magic: &[u8]) -> Result<(), Wrong> {
    let bytes = fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    match bytes.len() > magic.len() && bytes.starts_with(magic) {
        true => Ok(()),
        false => Err(format!("{} is no such file", path.display())),
    }
}

fn is_folder(path: &Path) -> Result<(), Wrong> {
    match path.is_dir() {
        true => Ok(()),
        false => Err(format!("{} is not there", path.display())),
    }
}
