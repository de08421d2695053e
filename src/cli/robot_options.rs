//! Options for the robot and its script.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use crate::{
    core::{RobotCommand, RobotMode, WriteCommand as _},
    robot::{Description, RobotPlugin},
    robots::read_robot,
    script::{
        ENGINE_VARIABLE, EngineChoice, EngineKind, EngineLocator, FieldPolicy, ScriptSettings,
    },
    shipped::shipped_files,
};
use bevy::prelude::*;
use clap::{Args, builder::TypedValueParser as _};
#[cfg(feature = "window")]
use tabletop_user::Keymap;

use super::{Failure, range::NumberRange};

/// The choice of the robot and its mode.
#[derive(Args, Clone)]
pub(super) struct RobotChoice {
    /// A robot other than the Baxter inside the program: a robot.ron (docs/robot.md), or a URDF with the same joints
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
    /// Move the arms by motors with limited torque instead of exactly as commanded
    #[arg(long)]
    dynamic: bool,
}

#[derive(Args, Clone)]
pub(super) struct RobotOptions {
    #[command(flatten)]
    choice: RobotChoice,
    /// Put the robot at the table from the start
    #[arg(long)]
    pub show_robot: bool,
}

impl RobotChoice {
    /// The plugin of this robot.
    pub fn plugin(&self) -> Result<RobotPlugin, Failure> {
        let mode = match self.dynamic {
            true => RobotMode::Dynamic,
            false => RobotMode::Kinematic,
        };
        Ok(RobotPlugin {
            mode,
            ..robot_of(self.robot.as_deref())?
        })
    }
}

/// The robot of a file, or the Baxter inside the program.
pub(super) fn robot_of(file: Option<&Path>) -> Result<RobotPlugin, Failure> {
    Ok(RobotPlugin {
        description: file.map(describe).transpose()?,
        ..default()
    })
}

impl RobotOptions {
    /// The plugin of this robot.
    pub fn plugin(&self) -> Result<RobotPlugin, Failure> {
        self.choice.plugin()
    }

    /// All that was said of the robot, but whether it is shown.
    pub fn name(&self) -> (Option<&Path>, bool) {
        (self.choice.robot.as_deref(), self.choice.dynamic)
    }

    /// Puts the robot at the table, if it is to be there from the start.
    pub fn show(&self, app: &mut App) {
        if self.show_robot {
            app.world_mut().write_command(RobotCommand::Show(true));
        }
    }
}

/// Reads a `robot.ron` and the URDF beside it, or a URDF of a robot with Baxter's limbs and joints.
pub(super) fn describe(path: &Path) -> Result<Description, Failure> {
    let description = read_robot(path).map_err(Failure::input)?;
    #[cfg(feature = "window")]
    if let Some(fault) = Keymap::of(&description.layout).1.first() {
        return Err(Failure::input(format!("{}: {fault}", path.display())));
    }
    Ok(description)
}

/// The language of scripts that a user's own driver runs.
const OTHER: &str = "other";

/// Periods from one picture for a script to the next.
const PERIODS: NumberRange<u64> = NumberRange::whole(1, 1_000_000_000).of("ticks");

/// Times for a call of a script, up to a day.
const PATIENCE: NumberRange<f64> = NumberRange::decimal(0.01, 24.0 * 3600.0).of("seconds");

#[derive(Args, Clone)]
pub(super) struct EngineOptions {
    /// The engine of the script: `matlab`, `octave`, `python`, `auto`, or the path of a program; with `--script other`, of its driver
    /// [default: TABLETOP_ENGINE, or auto]
    #[arg(long, value_name = "ENGINE")]
    engine: Option<String>,
    /// Number of ticks, 60 a second, from one picture for the script to the next, from 1 to 1000000000 [default: 15]
    #[arg(long, value_name = "N", value_parser = PERIODS, allow_negative_numbers = true)]
    picture_every: Option<u64>,
    /// Number of seconds, from 0.01 to 86400, that init and each call of the callback may take before the engine is ended
    /// [default: 120 and 30]
    #[arg(long, value_name = "S", value_parser = PATIENCE.map(Duration::from_secs_f64), allow_negative_numbers = true)]
    script_timeout: Option<Duration>,
    /// Give the script only the head camera and the joints, without `sensor.objects`, `contacts` and `held`
    #[arg(long)]
    no_objects: bool,
}

impl EngineOptions {
    /// The settings of the script bridge. `script` is the value of `--script`: a language, and after a colon the place of the scripts.
    ///
    /// # Errors
    /// The engine does not exist, or does not run this language; or the scripts do not exist.
    pub fn settings(&self, script: Option<&str>) -> Result<ScriptSettings, Failure> {
        let mut settings = ScriptSettings {
            shipped: shipped_files().clone(),
            ..ScriptSettings::default()
        };
        if self.engine.as_deref().map(parse) == Some(EngineChoice::Auto) {
            settings.locator.variable = None;
        }
        if let Some(script) = script {
            let ScriptName {
                language,
                agent,
                pair,
            } = ScriptName::parse(script);
            settings.agent = agent.map(PathBuf::from);
            settings.pair =
                pair.map(|pair| ["Init", "Callback"].map(|part| format!("{pair}{part}")));
            settings.engine = self.engine_for(language, &settings.locator)?;
            if language == OTHER {
                settings.objects = FieldPolicy::Always;
                settings.trackers = FieldPolicy::Always;
            }
        } else if let Some(engine) = &self.engine {
            settings.engine = parse(engine);
        }
        if script.is_some() {
            check_scripts(&settings)?;
        } else if self.engine.is_some() {
            settings.engine_config().map_err(Failure::input)?;
        }
        if self.no_objects {
            settings.objects = FieldPolicy::Never;
        }
        if let Some(patience) = self.script_timeout {
            settings.timeouts.init = patience;
            settings.timeouts.step = patience;
        }
        if let Some(ticks) = self.picture_every {
            settings.ticks_per_picture = ticks;
        }
        Ok(settings)
    }

    /// The named engine, if it runs scripts in this language; otherwise any that does.
    fn engine_for(&self, language: &str, there: &EngineLocator) -> Result<EngineChoice, Failure> {
        if language == OTHER {
            return match self.engine.as_deref() {
                Some(driver) if matches!(parse(driver), EngineChoice::Program(_)) => {
                    Ok(EngineChoice::Driver(driver.into()))
                }
                _ => Err(Failure::input(
                    "--script other needs --engine and the driver, a program that runs such scripts (docs/script-protocol.md)",
                )),
            };
        }
        let Some((choice, by)) = self.named_engine(there) else {
            return Ok(match language {
                "matlab" => EngineChoice::Auto,
                language => parse(language),
            });
        };
        let misfit = |kind| {
            let advice = match language {
                "matlab" => "matlab or --engine octave",
                language => language,
            };
            Failure::input(format!(
                "--script {language} cannot run in {kind}, which {by} names; say --engine {advice}"
            ))
        };
        // A missing engine of the wrong kind: installing it would not help.
        if let EngineChoice::Kind(kind) = choice
            && !runs(kind, language)
        {
            return Err(misfit(kind));
        }
        let found = there.find(&choice);
        let kind = found
            .map_err(|error| Failure::input(format!("{by}: {error}")))?
            .kind;
        match runs(kind, language) {
            true => Ok(choice),
            false => Err(misfit(kind)),
        }
    }

    /// The named engine, and the option or variable that names it.
    fn named_engine(&self, there: &EngineLocator) -> Option<(EngineChoice, &'static str)> {
        let names = [
            (&self.engine, "--engine"),
            (&there.variable, ENGINE_VARIABLE),
        ];
        names
            .into_iter()
            .find_map(|(name, by)| match parse(name.as_deref()?) {
                EngineChoice::Auto => None,
                choice @ (EngineChoice::Kind(_)
                | EngineChoice::Program(_)
                | EngineChoice::Driver(_)) => Some((choice, by)),
            })
    }
}

/// True if scripts in this language run in this kind of engine.
fn runs(kind: EngineKind, language: &str) -> bool {
    match language {
        "python" => kind == EngineKind::Python,
        "octave" => kind == EngineKind::Octave,
        _ => matches!(kind, EngineKind::Matlab | EngineKind::Octave),
    }
}

/// Checks that there are scripts in the place of these settings, as far as that is known before the engine starts.
fn check_scripts(settings: &ScriptSettings) -> Result<(), Failure> {
    let config = settings.engine_config().map_err(Failure::input)?;
    match config.fault() {
        None => Ok(()),
        Some(fault) => Err(Failure::input(fault)),
    }
}

fn parse(engine: &str) -> EngineChoice {
    let Ok(choice) = engine.parse();
    choice
}

/// The value of `--script`.
struct ScriptName<'a> {
    language: &'a str,
    /// The folder of the scripts, or the file.
    agent: Option<&'a str>,
    /// Prefix of the names of a pair of Matlab scripts.
    pair: Option<&'a str>,
}

impl<'a> ScriptName<'a> {
    fn parse(text: &'a str) -> Self {
        let (name, pair) = match text.rsplit_once('#') {
            Some((name, pair)) if !pair.contains('/') => (name, Some(pair)),
            Some(_) | None => (text, None),
        };
        let (language, agent) = match name.split_once(':') {
            Some((language, agent)) => (language, Some(agent)),
            None => (name, None),
        };
        Self {
            language,
            agent,
            pair,
        }
    }
}

/// Checks the value of `--script`.
pub(super) fn script(text: &str) -> Result<String, String> {
    let name = ScriptName::parse(text);
    match (name.language, name.agent, name.pair) {
        ("matlab" | "octave", _, Some("")) => {
            Err("expected the name of a pair of scripts after #, as in #reach".into())
        }
        ("matlab" | "octave", _, _) | ("python", _, None) | (OTHER, Some(_), None) => Ok(text.to_owned()),
        ("python" | OTHER, _, Some(_)) => {
            Err("# names a pair of Matlab scripts; a Python file or a driver has no pairs".into())
        }
        (OTHER, None, None) => Err("expected a colon and the path of the script after other".into()),
        _ => Err("expected matlab, octave, python or other, and after a colon the folder of the scripts or the file".into()),
    }
}
