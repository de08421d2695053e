//! `tabletop robot`: questions about a robot, and a first description of one.

mod calibrate;
mod describe;
mod kinematics;

use std::{path::PathBuf, process::ExitCode};

use clap::{Args, Subcommand};

use super::Failure;
use kinematics::Question;

#[derive(Args)]
pub(super) struct RobotArgs {
    #[command(subcommand)]
    task: RobotTask,
    /// A robot other than the Baxter inside the program: a robot.ron (docs/robot.md), or a URDF with the same joints
    #[arg(long, value_name = "FILE", global = true)]
    robot: Option<PathBuf>,
}

#[derive(Subcommand)]
enum RobotTask {
    /// Print the robot's frames, for joint angles from standard input
    Fk,
    /// Print the joint angles that bring a hand to a pose, for poses from standard input
    Ik,
    /// Say what a description holds, and what it lacks or has wrong, with file, line and remedy; exit code 2 if no robot can be made of it
    Check(describe::SurveyArgs),
    /// Write a first robot.ron for a URDF: limbs and grippers found in its tree, and questions where it says nothing
    New(describe::DraftArgs),
    /// Print where the head camera is, by the edges of the table in its picture
    Calibrate(calibrate::CalibrateArgs),
}

pub(super) fn robot(args: &RobotArgs) -> Result<ExitCode, Failure> {
    let robot = args.robot.as_deref();
    match &args.task {
        RobotTask::Fk => kinematics::answer(Question::Forward, robot),
        RobotTask::Ik => kinematics::answer(Question::Inverse, robot),
        RobotTask::Check(args) => describe::check(args.file.as_deref().or(robot)),
        RobotTask::New(_) if robot.is_some() => Err(Failure::input(
            "`robot new` takes a URDF and makes a robot of it; --robot names one that is there",
        )),
        RobotTask::New(new) => describe::write_first(new),
        RobotTask::Calibrate(args) => calibrate::calibrate(args),
    }
}
