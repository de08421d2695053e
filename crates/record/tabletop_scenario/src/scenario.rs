//! Scenario files.

use std::path::{Path, PathBuf};

use ron::{Options, error::SpannedError, extensions::Extensions, value::RawValue};
use serde::Deserialize;
use tabletop_core::{RobotLayout, is_shipped, ron_fault};
use tabletop_storage::{Symlinks, read_regular_text};

use crate::{ScenarioError, SourceLocation, Step, source::Places};

/// The largest file that is read.
const MOST_BYTES: u64 = 16 << 20;

/// Most steps of a scenario.
const MOST_STEPS: usize = 100_000;

/// The content of a scenario file.
///
/// ```
/// use tabletop_scenario::{Scenario, Step};
///
/// let text = r#"(steps: [Grasp("RedBlock"), MoveBy((0, 0, 2)), Release])"#;
/// let scenario = Scenario::parse("lift.ron", text)?;
/// assert_eq!(scenario.steps[2].step, Step::Release);
///
/// let error = Scenario::parse("lift.ron", "(steps: [\n  Drop,\n])").unwrap_err();
/// assert!(error.to_string().starts_with("lift.ron:2:3: "), "{error}");
/// # Ok::<_, tabletop_scenario::ScenarioError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Its file.
    pub path: PathBuf,
    /// The step that loads its first task file.
    pub setup: Option<LocatedStep>,
    /// The steps after that.
    pub steps: Vec<LocatedStep>,
    /// Folders in which, including their subfolders, it may name task files, besides those around it.
    pub allowed: Vec<PathBuf>,
}

/// A step and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct LocatedStep {
    /// The place where it begins.
    pub at: SourceLocation,
    /// Its text, on one line.
    pub text: String,
    /// The step.
    pub step: Step,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Scenario")]
struct ScenarioFile<'a> {
    #[serde(default, borrow)]
    setup: Option<&'a RawValue>,
    #[serde(borrow)]
    steps: Vec<&'a RawValue>,
}

impl Scenario {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// It cannot be read, or its [text](Self::parse) has a fault.
    pub fn read(path: impl Into<PathBuf>) -> Result<Self, ScenarioError> {
        let path = path.into();
        match read_regular_text(&path, MOST_BYTES, Symlinks::Followed) {
            Ok(text) => Self::parse(path, &text),
            Err(error) => Err(ScenarioError::Unreadable {
                path,
                reason: error.to_string(),
            }),
        }
    }

    /// Reads the text of a file of this name.
    ///
    /// # Errors
    ///
    /// What is no scenario, or all its faulty steps, with their places.
    pub fn parse(path: impl Into<PathBuf>, text: &str) -> Result<Self, ScenarioError> {
        let path = path.into();
        if text
            .trim_start_matches('\u{feff}')
            .trim_start()
            .starts_with('<')
        {
            return Err(ScenarioError::Syntax {
                at: SourceLocation::start_of(&path),
                what: format!(
                    "it is a task file and no scenario; `tabletop run --setup {}` puts it on the table",
                    path.display()
                ),
            });
        }
        let file: ScenarioFile = from_ron(text, &SourceLocation::start_of(&path))?;
        if file.steps.len() > MOST_STEPS {
            return Err(ScenarioError::Syntax {
                at: SourceLocation::start_of(&path),
                what: format!("there are more than {MOST_STEPS} steps"),
            });
        }
        let mut places = Places::of(&path, text);
        let setup = file.setup.map(|raw| {
            let (at, text) = located(&mut places, text, raw);
            let task: PathBuf = from_ron(text, &at)?;
            Ok(LocatedStep::setup(at, task))
        });
        let setup = setup.transpose()?;
        let steps = file.steps.into_iter().zip(1..).map(|(raw, number)| {
            let (at, text) = located(&mut places, text, raw);
            LocatedStep::parse(at, text).map_err(|fault| numbered(number, fault))
        });
        Ok(Self {
            setup,
            steps: ScenarioError::of_all(steps)?,
            path,
            allowed: Vec::new(),
        })
    }

    /// Checks that this robot has the joints and limbs that the steps name, and can reach the positions that they ask for.
    ///
    /// # Errors
    ///
    /// The steps that this robot cannot do, with their places.
    pub fn check_for(&self, layout: &RobotLayout) -> Result<(), ScenarioError> {
        let checked = self.steps.iter().map(|LocatedStep { at, text, step }| {
            let Step::Robot(step) = step else {
                return Ok(());
            };
            let command = step.command(layout).map(drop);
            command.map_err(|what| ScenarioError::Step {
                at: at.clone(),
                step: text.clone(),
                what,
            })
        });
        ScenarioError::of_all(checked).map(drop)
    }

    /// Replaces its first task file by this one, which is relative to the working directory.
    pub fn begin_with(&mut self, task: &Path) {
        let at = SourceLocation::start_of(&self.path);
        let task = match is_shipped(task) {
            true => task.to_owned(),
            false => std::path::absolute(task).unwrap_or(task.to_owned()),
        };
        self.allowed.extend(task.parent().map(Path::to_owned));
        self.setup = Some(LocatedStep::setup(at, task));
    }
}

impl LocatedStep {
    fn setup(at: SourceLocation, task: PathBuf) -> Self {
        Self {
            at,
            text: "setup".to_owned(),
            step: Step::Load {
                file: task,
                place: Vec::new(),
            },
        }
    }

    fn parse(at: SourceLocation, text: &str) -> Result<Self, ScenarioError> {
        let step: Step = from_ron(text, &at)?;
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        match step.fault() {
            None => Ok(Self { at, text, step }),
            Some(what) => Err(ScenarioError::Step {
                at,
                step: text,
                what,
            }),
        }
    }
}

/// A fault in the text of a step, with the step's number.
fn numbered(number: usize, fault: ScenarioError) -> ScenarioError {
    match fault {
        ScenarioError::Syntax { at, what } => ScenarioError::Syntax {
            at,
            what: format!("step {number}: {what}"),
        },
        fault @ (ScenarioError::Unreadable { .. }
        | ScenarioError::Step { .. }
        | ScenarioError::Setup { .. }
        | ScenarioError::Failed { .. }
        | ScenarioError::Several(_)) => fault,
    }
}

/// The place of a part of the text, and the part without blanks and comments around it.
fn located<'a>(places: &mut Places, text: &str, part: &'a RawValue) -> (SourceLocation, &'a str) {
    let part = part.trim().get_ron();
    let offset = part.as_ptr() as usize - text.as_ptr() as usize;
    (places.find(offset), part)
}

fn from_ron<'a, T: Deserialize<'a>>(
    text: &'a str,
    at: &SourceLocation,
) -> Result<T, ScenarioError> {
    Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .from_str(text)
        .map_err(|SpannedError { code, span }| ScenarioError::Syntax {
            at: at.followed_by(span.start),
            what: ron_fault(&code),
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_faulty_steps_are_told() {
        let text = "(steps: [\n  Jump,\n  Wait(1),\n  Grasp(3),\n])";
        let lines: Vec<_> = error(text).lines().map(str::to_owned).collect();
        assert_eq!(lines.len(), 2, "{lines:?}");
        assert!(lines[0].starts_with("s.ron:2:3: "), "{lines:?}");
        assert!(lines[1].starts_with("s.ron:4:"), "{lines:?}");
        let many = error(&format!("(steps: [{}])", "Jump,".repeat(1000)));
        assert_eq!(many.lines().count(), 200);
    }

    fn error(text: &str) -> String {
        match Scenario::parse("s.ron", text) {
            Ok(scenario) => format!("{scenario:?}"),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn every_step_can_be_written() -> Result<(), ScenarioError> {
        let text = r#"
            // A comment.
            (
                setup: "a.xml", // another
                steps: [
                    Load(file: "b.xml"),
                    Load(file: "b.xml", place: [(object: "x", x: (0, 1), y: (-1, 1), turn: (0, 360))]),
                    Clear, Make(Stack(5)), Make(BigBlock), Make(BoxContainer), Select(Left), With(Right, Grasp("x")), Grasp("y"),
                    MoveTo((1, 2.5, -3)), MoveBy((0, 0, 1e-1)), Glide(to: (1, 2, 3), seconds: 2),
                    Turn(axis: Z, degrees: -45), Release, Destroy,
                    Do("Put every red block into the box."), Wait(0.5), WaitUntilRest(5), WaitUntilThere(5),
                    Start, Finish, Undo, Redo, Pause(true),
                    Expect(Location(object: "x", at: (1, 2, 3), within: 0.1)),
                    Expect(Rotation(object: "x", degrees: (0, 0, 45))),
                    Expect(OnTopOf(object: "x", of: "y")), Expect(OnTable(object: "x")),
                    Expect(Inside(object: "x", of: "y")),
                    Expect(AtRest("x")), Expect(AllAtRest), Expect(Exists("x")), Expect(Gone("x")),
                    Expect(HeldBy(object: "x", hand: Any)), Expect(Free("x")),
                ],
            )"#;
        let scenario = Scenario::parse("s.ron", text)?;
        assert_eq!(scenario.steps.len(), 35);
        let setup = scenario.setup.map(|setup| setup.at.to_string());
        assert_eq!(setup.as_deref(), Some("s.ron:4:24"));
        assert_eq!(scenario.steps[3].at.to_string(), "s.ron:8:28");
        assert_eq!(scenario.steps[3].text, "Make(Stack(5))");
        Ok(())
    }

    #[test]
    fn mistakes_are_reported_with_their_place() {
        for (text, at, words) in [
            ("(steps: [\n  Grasp(\"x\"),\n  Drop,\n])", "3:3: ", "Drop"),
            (
                "(steps: [\n  Turn(axis: Z, angle: 3),\n])",
                "2:17: ",
                "angle",
            ),
            (
                "(steps: [\n  Turn(\n    axis: W, degrees: 3),\n])",
                "3:11: step 1: ",
                "no W",
            ),
            ("(steps: [\n  Wait(2]\n])", "2:9: ", "expected"),
            ("(steps: [Wait(1)], stop: 3)", "1:20: ", "stop"),
            ("(setup: 3, steps: [])", "1:9: ", "text in quotes"),
            ("()", "1:2: ", "steps"),
            ("", "1:1: ", ""),
            ("(steps: [\n  Wait(-1),\n])", "2:3: Wait(-1): ", "seconds"),
            ("(steps: [MoveTo((0, NaN, 0))])", "1:10: MoveTo", "finite"),
            ("(steps: [Make(Stack(0))])", "1:10: Make", "1 to 50 blocks"),
            (
                "(steps: [\n  Do(\"Put every red blokc into the box.\")])",
                "2:3: Do(",
                "1:15: `blokc` does not fit here",
            ),
            (
                "(steps: [With(Left, Wait(1))])",
                "1:10: With",
                "a hand does",
            ),
            (
                "(steps: [Load(file: \"a.xml\", place: [(object: \"x\", x: (1, 0), y: (0, 1))])])",
                "1:10: Load",
                "`x` as (least, greatest)",
            ),
        ] {
            let error = error(text);
            assert!(error.starts_with(&format!("s.ron:{at}")), "{error}");
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn deep_nesting_is_a_fault() {
        let error = error(&format!("(steps: [{}", "[".repeat(1_000_000)));
        assert!(error.ends_with("it is nested too deeply"), "{error}");
    }

    #[test]
    fn many_steps_in_a_line_are_found_at_once() {
        let text = format!("(steps: [{}])", "Wait(1),".repeat(MOST_STEPS));
        let scenario = Scenario::parse("s.ron", &text).unwrap();
        let last = &scenario.steps[MOST_STEPS - 1];
        assert_eq!(last.at.column, 10 + 8 * (MOST_STEPS - 1));
        let text = text.replace("])", "Wait(1)])");
        assert!(error(&text).contains("more than 100000 steps"));
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = Scenario::read("no such.ron").map_err(|error| error.to_string());
        assert!(error.is_err_and(|error| error.starts_with("no such.ron: it cannot be read: ")));
    }
}
