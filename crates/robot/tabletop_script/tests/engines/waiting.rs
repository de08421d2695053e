//! With a window, frames go by while the simulation waits for a script, and nothing else changes.

use std::time::Duration;

use bevy::{prelude::*, time::TimeUpdateStrategy};
use tabletop_core::{
    Agent, ClockCommand, Drive, Face, RobotCommand, RobotJoint, ScriptCommand, SimBlocked,
    TICK_SECONDS,
};
use tabletop_harness::test_with;
use tabletop_script::{ScriptSettings, Waiting};

use crate::kit::{Folder, Stage};

/// A script that goes on when the file that it waits for is there.
const GATED: &str = "calls = calls + 1;\nwhile ~exist([aux.path 'go' num2str(calls)], 'file'), pause(0.01); end\nmotor.jointVelocities(:) = 0.1;\n";

/// A script that takes its time.
const SLOW: &str = "calls = calls + 1;\npause(0.3);\nmotor.jointVelocities = 0.1 * calls - sensor.jointAngles / 10;\n";

fn framewise(folder: &Folder) -> ScriptSettings {
    ScriptSettings {
        waiting: Waiting::Frame(Duration::from_millis(2)),
        ..folder.settings()
    }
}

fn waits(stage: &Stage) -> bool {
    matches!(stage.agent(), Agent::Waiting { .. })
}

fn waited(stage: &Stage) -> Duration {
    let agent = stage.agent();
    let Agent::Waiting { since } = agent else {
        panic!("{agent:?}");
    };
    *since
}

#[test_with(Octave)]
fn a_slow_script_moves_the_robot_as_if_nobody_had_waited() {
    let folder = Folder::pair("calls = 0;", SLOW);
    let mut blocking = Stage::start(folder.settings());
    blocking.ticks(6);
    assert_eq!(blocking.track().len(), 6);

    let mut stage = Stage::start(framewise(&folder));
    stage.frames_until(|stage| stage.track().len() >= 6);
    assert_eq!(&stage.track()[..6], blocking.track());
}

#[test_with(Octave)]
fn the_waiting_is_reported_and_no_tick_passes() {
    let folder = Folder::pair("calls = 0;", GATED);
    let mut stage = Stage::start(framewise(&folder));
    stage.frames_until(Stage::is_online);
    let mut tick = stage.tick();
    for call in 1..4 {
        stage.frames_until(waits);
        let mut since = waited(&stage);
        for _ in 0..5 {
            stage.frame();
            assert!(waited(&stage) > since);
            since = waited(&stage);
        }
        assert_eq!(stage.tick(), tick);
        folder.write(&format!("go{call}"), "");
        stage.frames_until(|stage| stage.tick() > tick);
        tick += 1;
        assert_eq!(stage.tick(), tick);
    }
}

/// Number of tries to begin a tick.
#[derive(Resource, Default)]
struct Tries(u32);

impl Tries {
    fn count(mut tries: ResMut<Self>) {
        tries.0 += 1;
    }

    fn of(stage: &Stage) -> u32 {
        stage.app.world().resource::<Self>().0
    }
}

#[test_with(Octave)]
fn each_frame_looks_for_the_answer_once_and_no_waiting_is_made_up_for() {
    let folder = Folder::pair("calls = 0;", GATED);
    let mut stage = Stage::start(framewise(&folder));
    stage
        .app
        .init_resource::<Tries>()
        .add_systems(FixedFirst, Tries::count);
    stage.frames_until(Stage::is_online);
    for (call, ticks_a_frame) in [(1, 0.3), (2, 1.0), (3, 3.5)] {
        let frame = Duration::from_secs_f32(ticks_a_frame * TICK_SECONDS);
        stage
            .app
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
        stage.frames_until(waits);
        let tick = stage.tick();
        let (tries, virtual_time) = (Tries::of(&stage), time_in_window(&stage));
        for frames in 1..=20 {
            stage.frame();
            assert_eq!(Tries::of(&stage), tries + frames, "{ticks_a_frame}");
            assert_eq!(time_in_window(&stage), virtual_time + frame * frames);
        }
        assert_eq!(stage.tick(), tick);

        folder.write(&format!("go{call}"), "");
        stage.frames_until(|stage| !waits(stage));
        assert_eq!(stage.tick(), tick + 1, "{ticks_a_frame}");
        let overstep = stage.app.world().resource::<Time<Fixed>>().overstep();
        assert_eq!(overstep, Duration::ZERO);
    }
}

/// The time by which things move in the window by themselves, like its camera.
fn time_in_window(stage: &Stage) -> Duration {
    stage.app.world().resource::<Time<Virtual>>().elapsed()
}

#[test_with(Octave)]
fn nothing_that_is_reported_meanwhile_gets_lost() {
    let folder = Folder::pair("calls = 0;", GATED);
    let mut stage = Stage::start(framewise(&folder));
    stage.frames_until(Stage::is_online);
    for call in 1..3 {
        stage.frames_until(waits);
        let tick = stage.tick();
        let goal = 0.3 + f64::from(call) / 10.0;
        let face = if call == 1 { Face::Happy } else { Face::Asleep };
        let drive = (RobotJoint::HeadPan, Drive::Position(goal));
        stage.command(RobotCommand::drive([drive]));
        stage.command(RobotCommand::ShowFace(face));
        for _ in 0..10 {
            stage.frame();
        }
        assert_eq!(stage.tick(), tick);
        assert!(stage.app.world().resource::<SimBlocked>().0);
        folder.write(&format!("go{call}"), "");
        stage.frames_until(|stage| stage.tick() > tick);
        assert_eq!(stage.robot().joint(RobotJoint::HeadPan).position, goal);
        assert_eq!(stage.robot().face, face);
    }
}

#[test_with(Octave)]
fn the_simulation_goes_on_while_the_engine_comes_up_and_can_be_stopped_then() {
    let folder = Folder::pair("aux.drawMarkers = [1 2 3];", "");
    let mut stage = Stage::start(framewise(&folder));
    stage.frame();
    stage.frame();
    assert_eq!(stage.agent(), &Agent::Starting);
    let tick = stage.tick();
    stage.frame();
    assert_eq!(stage.tick(), tick + 1);
    stage.script(ScriptCommand::Stop);
    stage.frame();
    assert!(stage.has_stopped());
    assert_eq!(stage.agent(), &Agent::Off);
    stage.script(ScriptCommand::Start);
    stage.frames_until(Stage::is_online);
    assert_eq!(stage.failure(), None);
    assert_eq!(stage.markers(), 1);
}

#[test_with(Octave)]
fn an_endless_loop_is_ended_by_a_stop() {
    let folder = Folder::pair("aux.drawMarkers = [1 2 3];", "while true, end");
    let mut stage = Stage::start(framewise(&folder));
    stage.frames_until(|stage| waits(stage) && waited(stage) > Duration::from_millis(100));
    let tick = stage.tick();
    stage.script(ScriptCommand::Stop);
    stage.frames_until(Stage::has_stopped);
    assert_eq!(stage.agent(), &Agent::Off);
    stage.frames_until(|stage| stage.tick() > tick + 10);
    assert_eq!(stage.markers(), 0);
}

#[test_with(Octave)]
fn an_endless_loop_is_ended_by_the_time_limit() {
    let folder = Folder::pair("aux.drawMarkers = [1 2 3];", "while true, end");
    let mut settings = framewise(&folder);
    settings.timeouts.step = Duration::from_millis(300);
    let mut stage = Stage::start(settings);
    stage.frames_until(|stage| stage.failure().is_some());
    let reason = stage.failure().unwrap();
    assert!(
        reason.contains("no answer from the callback script within 0.3 s"),
        "{reason}"
    );
    let tick = stage.tick();
    stage.frames_until(|stage| stage.tick() > tick + 10);
    assert_eq!((stage.agent(), stage.markers()), (&Agent::Failed, 0));
}

#[test_with(Octave)]
fn an_endless_init_is_ended_by_a_stop() {
    let folder = Folder::pair("while true, end", "");
    let mut stage = Stage::start(framewise(&folder));
    stage.frames_until(|stage| waits(stage) && waited(stage) > Duration::from_millis(50));
    stage.script(ScriptCommand::Stop);
    stage.frames_until(Stage::has_stopped);
}

#[test_with(Octave)]
fn a_pause_can_be_made_while_a_script_is_waited_for() {
    let folder = Folder::pair("calls = 0;", SLOW);
    let mut stage = Stage::start(framewise(&folder));
    stage.frames_until(|stage| waits(stage) && stage.track().len() >= 2);
    stage.command(ClockCommand::SetPaused(true));
    stage.frames_until(Stage::is_online);
    for _ in 0..5 {
        stage.frame();
    }
    let tick = stage.tick();
    for _ in 0..20 {
        stage.frame();
        assert!(stage.is_online());
    }
    assert_eq!(stage.tick(), tick);
    stage.command(ClockCommand::SetPaused(false));
    stage.frames_until(|stage| stage.track().len() >= 6);

    let mut blocking = Stage::start(folder.settings());
    blocking.ticks(6);
    assert_eq!(&stage.track()[..6], blocking.track());
}

#[test_with(Octave)]
fn in_a_pause_nothing_waits_for_a_script() {
    let folder = Folder::pair("calls = 0;", GATED);
    let mut stage = Stage::start(framewise(&folder));
    stage.frames_until(waits);
    stage.command(ClockCommand::SetPaused(true));
    stage.command(RobotCommand::ShowFace(Face::Asleep));
    stage.frame();
    assert_eq!(stage.robot().face, Face::Asleep);
    assert!(waits(&stage) && !stage.app.world().resource::<SimBlocked>().0);
    stage.script(ScriptCommand::Stop);
    stage.frames_until(Stage::has_stopped);
}
