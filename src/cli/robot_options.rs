//! Which robot stands at the table, and which script drives it.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use clap::Args;
use tabletop::{
    baxter::{BaxterPlugin, Description, Source},
    core::RobotMode,
    script::{ENGINE_VARIABLE, EngineChoice, EngineKind, ScriptSettings, Surroundings, Tell},
};

use super::Failure;

#[derive(Args, Clone)]
pub(super) struct RobotOptions {
    /// A robot description (URDF) in place of the Baxter that comes with the program: its arms must have the same joints
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
    /// Move the arms by motors with limited torque, instead of exactly as told
    #[arg(long)]
    dynamic: bool,
}

impl RobotOptions {
    /// The plugin of this robot.
    pub fn plugin(&self) -> Result<BaxterPlugin, Failure> {
        let description = match &self.robot {
            Some(path) => Some(describe(path)?),
            None => None,
        };
        Ok(BaxterPlugin {
            description,
            mode: match self.dynamic {
                true => RobotMode::Dynamic,
                false => RobotMode::Kinematic,
            },
        })
    }
}

fn describe(path: &Path) -> Result<Description, Failure> {
    let at = |error: &dyn std::fmt::Display| Failure::input(format!("{}: {error}", path.display()));
    let urdf = std::fs::read_to_string(path).map_err(|error| at(&error))?;
    let source = Source {
        path: path.to_owned(),
        urdf,
    };
    Description::read(source).map_err(|error| at(&error))
}

#[derive(Args, Clone)]
pub(super) struct EngineOptions {
    /// What runs the scripts: `matlab`, `octave`, `python`, `auto`, or the path of a program [default: auto, or TABLETOP_ENGINE]
    #[arg(long, value_name = "ENGINE")]
    engine: Option<String>,
    /// Ticks from one picture that a script gets to the next, 60 a second [default: 15]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    picture_every: Option<u64>,
    /// How long to wait for init, and for each call of the callback, before the engine is ended, in seconds [default: 120 and
    /// 30]
    #[arg(long, value_name = "S", value_parser = patience)]
    script_timeout: Option<Duration>,
    /// Let scripts sense with the head camera and the joints alone: no `sensor.objects`, `contacts` and `held`
    #[arg(long)]
    no_objects: bool,
}

impl EngineOptions {
    /// The settings of the script bridge. `script` is what `--script` says: `matlab`, `octave` or `python`, and after a colon
    /// the folder of the scripts or the Python file.
    pub fn settings(&self, script: Option<&str>) -> Result<ScriptSettings, Failure> {
        let mut settings = ScriptSettings::default();
        settings.engine = match script {
            Some(script) => {
                let (language, agent) = split(script);
                settings.agent = agent.map(PathBuf::from);
                self.engine_for(language, &settings.surroundings)?
            }
            None => parse(self.engine.as_deref().unwrap_or_default()),
        };
        if self.no_objects {
            settings.objects = Tell::Never;
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

    /// The engine that is named, if it runs scripts in this language; else any that does.
    fn engine_for(&self, language: &str, there: &Surroundings) -> Result<EngineChoice, Failure> {
        let Some((choice, by)) = self.named_engine(there) else {
            return Ok(match language {
                "matlab" => EngineChoice::Auto,
                language => parse(language),
            });
        };
        let kind = there.find(&choice).map_err(Failure::input)?.kind;
        let fits = match language {
            "python" => kind == EngineKind::Python,
            "octave" => kind == EngineKind::Octave,
            _ => kind != EngineKind::Python,
        };
        match fits {
            true => Ok(choice),
            false => Err(Failure::input(format!(
                "--script {language} cannot run in {kind}, which {by} names; leave it out, or say --engine {language}"
            ))),
        }
    }

    /// The engine that is named, and what names it.
    fn named_engine(&self, there: &Surroundings) -> Option<(EngineChoice, &'static str)> {
        let names = [
            (&self.engine, "--engine"),
            (&there.variable, ENGINE_VARIABLE),
        ];
        names
            .into_iter()
            .find_map(|(name, by)| match parse(name.as_deref()?) {
                EngineChoice::Auto => None,
                choice => Some((choice, by)),
            })
    }
}

fn parse(engine: &str) -> EngineChoice {
    let Ok(choice) = engine.parse();
    choice
}

/// Reads a time of a hundredth of a second to a day.
fn patience(text: &str) -> Result<Duration, String> {
    const DAY: f64 = 24.0 * 3600.0;
    text.parse()
        .ok()
        .filter(|seconds| (0.01..=DAY).contains(seconds))
        .map(Duration::from_secs_f64)
        .ok_or_else(|| format!("expected a number of seconds from 0.01 to {DAY}"))
}

/// The language, and the path after the colon.
fn split(script: &str) -> (&str, Option<&str>) {
    match script.split_once(':') {
        Some((language, path)) => (language, Some(path)),
        None => (script, None),
    }
}

/// Reads what `--script` says.
pub(super) fn script(text: &str) -> Result<String, String> {
    match split(text).0 {
        "matlab" | "octave" | "python" => Ok(text.to_owned()),
        _ => Err("expected matlab, octave or python, and after a colon the folder of the scripts or the Python file".into()),
    }
}
