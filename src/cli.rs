//! The command line and its exit codes: 0 done, 1 the run failed, 2 wrong usage or input.

mod acting_policy;
mod allowed_paths;
mod arguments;
mod benchmark;
mod cameras;
mod check;
mod compare;
mod completions;
mod counted;
mod cut_off;
mod dataset;
mod demonstration;
#[cfg(feature = "window")]
mod display;
mod docs;
mod duration;
mod edit;
mod explain;
mod export;
mod failure;
mod hand_cameras;
mod head_camera;
mod imitate;
mod import;
mod init;
mod jobs;
mod judge;
#[cfg(feature = "window")]
mod keys;
mod learn;
mod list;
mod man;
mod meaning;
mod multiply;
mod number_run;
mod output;
mod picture_size;
mod progress;
mod quiet;
mod range;
mod real;
mod recorded;
mod recordings;
mod replay;
mod report;
mod require;
mod result_file;
mod robot;
mod robot_options;
mod run;
mod run_arguments;
mod script;
mod seed_range;
mod seeds;
mod sentinel;
mod serve_policy;
mod shard;
mod shipped;
mod soak;
mod teach;
mod tell;
mod terminal;
mod validate;
mod variation_options;
mod video;
mod wait;
mod watch;
mod window;

use std::{ffi::OsString, process::ExitCode};

use clap::{CommandFactory as _, Parser, Subcommand};

pub use cameras::camera as read_camera;

use failure::{Failure, WRONG_INPUT};
use output::Output;
use terminal::say;

/// A virtual demonstrator environment for robot imitation learning.
///
/// Without a command, opens a window in which you show a task by moving objects on a table with the mouse, and drive a robot by hand
/// or by scripts. The commands do the same without a window, many times faster than real time and with the same result.
#[derive(Parser)]
#[command(version, after_long_help = MANUAL, bin_name = "tabletop")]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    window: window::WindowArgs,
}

#[derive(Subcommand)]
enum Command {
    /// Simulate a task file or a scenario without a window, as fast as possible
    Run(Box<run_arguments::RunArgs>),
    /// Run a recording again: watch it, verify it, or make its pictures anew
    Replay(replay::ReplayArgs),
    /// Print the task that a recording shows, step by step
    Explain(explain::ExplainArgs),
    /// Compare two recordings: what they show, how long they are, and where the objects go
    Compare(compare::CompareArgs),
    /// List the recordings of folders: how long each is, and what it shows
    List(list::ListArgs),
    /// Print the task that pictures show
    ///
    /// Shapes and colours of the objects are known; their places, the motions and the acts are seen in the pictures of the head camera alone. If the recording tells
    /// the truth, the errors follow.
    Watch(watch::WatchArgs),
    /// Set requirements on the objects of a recording's task, so that others can take their places
    Require(require::RequireArgs),
    /// Let the robot imitate the task that a recording shows
    Imitate(imitate::ImitateArgs),
    /// Do what sentences say, such as "Put every red block into the blue box.", by the hand or by the robot
    Tell(Box<tell::TellArgs>),
    /// Say what a few demonstrations mean, as a program such as "Put every red block into the blue box.", and what else they may mean
    Teach(teach::TeachArgs),
    /// Make many demonstrations from one, with everything elsewhere: for training networks
    Multiply(multiply::MultiplyArgs),
    /// Learn a policy from one demonstration: from the head camera's picture to what is to be put where
    Learn(learn::LearnArgs),
    /// Serve a policy to other programs, by openpi's protocol, until this one is ended
    ServePolicy(serve_policy::ServePolicyArgs),
    /// Write recordings as a dataset that other tools read
    Export(export::ExportArgs),
    /// Make a video, an animation or a contact sheet of a recording
    Video(video::VideoArgs),
    /// Make a page of one recording, or a table of many, that any browser shows
    Report(report::ReportArgs),
    /// Describe, check, repair, merge, split and trim folders of recordings and LeRobot datasets
    Dataset(dataset::DatasetArgs),
    /// Make a recording of another's segments: left out, in another order, faster or slower
    Edit(edit::EditArgs),
    /// Turn a recording of the original program into one of this program, for all commands but those that simulate it again
    Import(import::ImportArgs),
    /// Check task files and report every fault with its place
    Check(check::CheckArgs),
    /// Answer questions about the robot's joints and frames for other programs
    Robot(robot::RobotArgs),
    /// List the keys of the window and what they do
    #[cfg(feature = "window")]
    Keys(keys::KeysArgs),
    /// Write the task files, scenarios and scripts that ship with the program to a folder, for you to change
    ///
    /// Existing files that differ are never overwritten: then nothing is written, and they are named.
    Init(init::InitArgs),
    /// List the task files, scenarios, scripts and robots inside the program, which every command finds by their paths
    Shipped(shipped::ShippedArgs),
    /// Open the documentation in a browser, with contents and search
    Docs(docs::DocsArgs),
    /// Act at random, for hours, as a user could, and check the world after every tick
    Soak(soak::SoakArgs),
    /// Measure the physics beside closed-form results of mechanics; exit code 1 if one is missed by more than its limit
    ///
    /// Its table, its units and its experiments are explained in docs/validation.md.
    Validate(validate::ValidateArgs),
    /// Teach task programs by demonstrations, and count how many are understood; or judge a policy: how often it does tasks with fixed beginnings
    ///
    /// Families of programs are explained in docs/task-programs.md; policies, tasks and results in docs/policies.md.
    Benchmark(benchmark::BenchmarkArgs),
    /// Bring a real robot to rest if the program that drives it is killed; started by that program
    #[command(hide = true)]
    Sentinel(sentinel::SentinelArgs),
    /// Print a script with which your shell completes commands and options
    ///
    /// For bash: tabletop completions bash > ~/.local/share/bash-completion/completions/tabletop
    Completions(completions::CompletionsArgs),
    /// Print the manual page
    ///
    /// For `man tabletop`: tabletop man > ~/.local/share/man/man1/tabletop.1
    Man,
}

/// The end of the long help.
const MANUAL: &str = "\
Examples:
  tabletop                                      open the window
  tabletop --setup tablesetup/chains.xml        open it with another scene
  tabletop run scenarios/robot_stack.ron        let the robot build a tower, without a window
  tabletop run scenarios/stack_two_blocks.ron --record demo
                                                perform a demonstration and record it
  tabletop replay demo --window                 watch the recording
  tabletop explain demo                         say what it shows
  tabletop tell 'Put all blocks in a row.'       do what a sentence says
  tabletop multiply demo --count 100 --out many make a hundred of it, with everything elsewhere
  tabletop export many --to lerobot dataset     make a dataset of them that LeRobot reads
  tabletop video demo demo.mp4 --captions       make a video of the recording
  tabletop run --script python --seconds 20     let a script drive the robot
  tabletop docs                                 read the documentation in a browser
  tabletop init work                            write all shipped files to a folder, to change them

Files:
  Task files, scenarios, scripts and the robot come with the program. Where there is no file at a path such as
  tablesetup/default.xml, the one that comes with the program is taken; shipped:tablesetup/default.xml always means that one.

Exit codes:
  0  done
  1  the run failed: a step or check of a scenario, a script, a replay that differs, a file that cannot be written
  2  wrong usage or input: an unknown option, a file that is missing or wrong";

/// Reads a command line, of which the program's name is the first argument, and carries it out.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli: Cli = match arguments::read(arguments) {
        Ok(cli) => cli,
        Err(code) => return code,
    };
    let result = match cli.command {
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::Explain(args)) => explain::explain(&args),
        Some(Command::Compare(args)) => compare::run(&args),
        Some(Command::List(args)) => list::list(&args),
        Some(Command::Watch(args)) => watch::watch(&args),
        Some(Command::Require(args)) => require::require(&args),
        Some(Command::Imitate(args)) => imitate::run(&args),
        Some(Command::Tell(args)) => tell::tell(&args),
        Some(Command::Teach(args)) => teach::teach(&args),
        Some(Command::Multiply(args)) => multiply::run(&args),
        Some(Command::Learn(args)) => learn::run(&args),
        Some(Command::ServePolicy(args)) => serve_policy::run(&args),
        Some(Command::Export(args)) => export::run(&args),
        Some(Command::Video(args)) => video::run(&args),
        Some(Command::Report(args)) => report::run(&args),
        Some(Command::Dataset(args)) => dataset::run(&args),
        Some(Command::Edit(args)) => edit::run(&args),
        Some(Command::Import(args)) => import::run(&args),
        Some(Command::Check(args)) => check::check(&args),
        Some(Command::Robot(args)) => robot::robot(&args),
        #[cfg(feature = "window")]
        Some(Command::Keys(args)) => keys::list(&args),
        Some(Command::Init(args)) => init::init(&args),
        Some(Command::Shipped(args)) => shipped::list(&args),
        Some(Command::Docs(args)) => docs::docs(&args),
        Some(Command::Soak(args)) => soak::soak(&args),
        Some(Command::Validate(args)) => validate::validate(&args),
        Some(Command::Benchmark(args)) => benchmark::benchmark(&args),
        Some(Command::Sentinel(args)) => sentinel::run(&args),
        Some(Command::Completions(args)) => completions::completions(&args, &mut Cli::command()),
        Some(Command::Man) => man::man(Cli::command()),
        None => window::open(cli.window),
    };
    result.unwrap_or_else(|failure| {
        if let Some(message) = failure.message {
            say(format_args!("tabletop: {message}"));
        }
        ExitCode::from(failure.code)
    })
}
