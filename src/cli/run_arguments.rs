//! The arguments of `tabletop run`, and the simulator that they ask for.

use std::{
    ops::Range,
    path::{Path, PathBuf},
};

use bevy::{app::PluginGroupBuilder, prelude::*};
use clap::{ArgGroup, Args};
use serde_json::json;
use tabletop_scenario::{Program, Scenario, ScenarioError};

use super::{
    Failure, Output,
    allowed_paths::AllowedPaths,
    duration::{SECONDS, ticks},
    hand_cameras::HandCameraOption,
    jobs::JOBS,
    quiet::QuietOption,
    range::SEEDS,
    real::{self, RealOptions},
    robot_options::{EngineOptions, RobotOptions, script},
    script::headless_settings,
    seed_range::seed_range,
    shard::ShardOption,
    wait::WaitOption,
};
use crate::{
    TabletopSimPlugins,
    core::SceneSpec,
    real::RealRobotPlugin,
    recorder::{HandPictures, RecorderPlugin, UnrecordedPlugin},
    robot::RobotPlugin,
    script::ScriptPlugin,
    shipped::{read_faultless_task, read_scenario, true_path},
};

#[derive(Args)]
#[command(mut_group("EngineOptions", |options| options.requires("script")))]
#[command(mut_group("HandCameraOption", |options| options.requires("record").conflicts_with("real_robot")))]
#[command(mut_group("ShardOption", |options| options.requires("seeds")))]
#[command(mut_arg("no_wait", |option| option.requires("seeds")))]
#[command(group = ArgGroup::new("recordable").args(["scenario", "shadow", "real"]).multiple(true))]
pub(super) struct RunArgs {
    /// The scenario to perform (docs/scenarios.md); exit code 1 if one of its steps fails
    #[arg(value_name = "SCENARIO")]
    pub scenario: Option<PathBuf>,
    /// The task file to begin with [default: tablesetup/default.xml, or the one that the scenario names]
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    #[command(flatten)]
    pub allowed: AllowedPaths,
    /// Number of seconds to simulate, from 0 to 31622400 [default: 10]; a scenario fails if it takes longer [default: 600]
    #[arg(long, value_name = "S", value_parser = SECONDS, allow_negative_numbers = true)]
    pub seconds: Option<f64>,
    /// The seed of a scenario's random places, from 0 to 18446744073709551615 [default: 0]
    #[arg(
        long,
        value_name = "N",
        value_parser = SEEDS,
        allow_negative_numbers = true,
        default_value = "0",
        requires = "scenario",
        hide_default_value = true
    )]
    pub seed: u64,
    /// Perform it once with each seed from A to B - 1, on all cores
    #[arg(
        long,
        value_name = "A..B",
        value_parser = seed_range,
        requires = "scenario",
        conflicts_with_all = ["seed", "script", "final_state", "final_robot", "save", "real_robot"]
    )]
    pub seeds: Option<Range<u64>>,
    #[command(flatten)]
    pub shard: ShardOption,
    /// Number of seeds at a time, from 1 to 256 [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true, requires = "seeds")]
    pub jobs: Option<usize>,
    /// The folder for the scenario's recording, or with --seeds for a folder of each seed, of which those that are whole stay; without it, nothing is recorded
    #[arg(long, value_name = "DIR", requires = "recordable")]
    pub record: Option<PathBuf>,
    #[command(flatten)]
    pub hand_cameras: HandCameraOption,
    /// Write the final pose of every object as CSV (`id,x,y,z,rx,ry,rz`); `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub final_state: Option<Output>,
    /// Write the robot's final state as JSON; `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub final_robot: Option<Output>,
    /// Save the final state as a new task file
    #[arg(long, value_name = "FILE.xml")]
    pub save: Option<PathBuf>,
    /// The script that drives the robot: `matlab` (the scripts that matlab/agentBehavior.m names), `matlab:FOLDER`, `octave:FOLDER`,
    /// `matlab:FOLDER#reach` (reachInit.m and reachCallback.m), `python:FILE`, or `other:FILE` for the driver that `--engine` names.
    /// The run ends with the script if there is no scenario, or one that waits for nothing
    #[arg(long, value_name = "LANGUAGE[:PATH][#PAIR]", value_parser = script)]
    pub script: Option<String>,
    /// The recording whose task the script gets as `sensor.task`
    #[arg(long, value_name = "DIR", requires = "script")]
    pub task: Option<PathBuf>,
    #[command(flatten)]
    pub engine: EngineOptions,
    #[command(flatten)]
    pub robot: RobotOptions,
    #[command(flatten)]
    pub real: RealOptions,
    #[command(flatten)]
    pub quiet: QuietOption,
    #[command(flatten)]
    pub wait: WaitOption,
}

impl RunArgs {
    /// The scenario of this file with the task file that was asked for, and the robot, which can do all its steps.
    pub fn prepare(&self, scenario: &Path) -> Result<(Scenario, RobotPlugin), Failure> {
        let mut scenario = read_scenario(scenario).map_err(Failure::input)?;
        scenario.allowed.clone_from(&self.allowed.folders);
        if let Some(setup) = &self.setup {
            scenario.begin_with(&true_path(setup));
        }
        let robot = self.real.body(self.robot.plugin()?)?;
        let checked = scenario.check_for(robot.layout());
        checked.map_err(Failure::input)?;
        Ok((scenario, robot))
    }

    /// The scenario with the places of a seed, and the time limit that was asked for.
    pub fn program(&self, scenario: &Scenario, seed: u64) -> Result<Program, ScenarioError> {
        let mut program = Program::new(scenario, |file| self.read_faultless(file), seed)?;
        if let Some(seconds) = self.seconds {
            program.limit = ticks(seconds);
        }
        Ok(program)
    }

    /// The simulator with this robot, and the engine that was asked for.
    pub fn simulator(&self, robot: RobotPlugin) -> Result<PluginGroupBuilder, Failure> {
        let settings = headless_settings(&self.engine, self.script.as_deref())?;
        let plugins = TabletopSimPlugins
            .build()
            .set(robot)
            .set(ScriptPlugin { settings });
        Ok(match self.real.address() {
            Some(_) => plugins.add(RealRobotPlugin { is_paced: true }),
            None => plugins,
        })
    }

    /// The simulator with this robot and engine, and with a recorder if there is a folder for it.
    pub fn plugins(
        &self,
        robot: RobotPlugin,
        folder: Option<&Path>,
        seed: u64,
        hand_pictures: HandPictures,
    ) -> Result<PluginGroupBuilder, Failure> {
        let plugins = self.simulator(robot)?;
        let Some(folder) = folder else {
            return Ok(plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin));
        };
        let mut header = real::header(self.real.address());
        let scenario = self.scenario.as_deref().map(true_path);
        let text = |path: PathBuf| json!(path.to_string_lossy());
        header.insert("scenario".into(), json!(scenario.map(text)));
        if let Some(setup) = &self.setup {
            header.insert("setup".into(), text(true_path(setup)));
        }
        header.insert("seed".into(), json!(seed));
        Ok(plugins.set(RecorderPlugin {
            folder: folder.to_owned(),
            header,
            hand_pictures,
            ..default()
        }))
    }

    /// The scene of a task file, which may include files in the allowed folders, or all its faults.
    pub fn read_faultless(&self, file: &Path) -> Result<SceneSpec, String> {
        read_faultless_task(file, &self.allowed.folders)
    }
}
