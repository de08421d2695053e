//! The recorder in the simulation.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_core::{
    CommandId, CommandKind as _, Hand, HandImages, Hands, IssuedCommand, Paused, PictureDemand,
    Recording, RecordingCommand, RecordingFact, SensorImage, SimFact, SimTick, TICKS_PER_SECOND,
    Timeline, TimelineStage,
};

use crate::{
    error::RecorderError,
    files::{
        destination::Destination,
        format::FORMAT,
        frame::TICKS_PER_FRAME,
        new_recording::NewRecording,
        session::{SessionCommand, SessionHeader},
    },
    recording::{
        earlier_commands::EarlierCommands,
        episode::Episode,
        report::{MovedAside, RecordingReport},
        stage::RecordedWorld,
    },
};

/// Why a recording cannot be started.
pub(crate) const IS_RUNNING: &str = "a recording is running; finish it first";

/// The reason why no recording can be finished.
pub(crate) const NONE_IS_RUNNING: &str = "no recording is running; start one first";

/// Makes the recordings.
#[derive(Resource, Debug)]
pub(crate) struct Recorder {
    destination: Destination,
    episode: Option<Episode>,
    /// The command that ends the recording in this tick.
    finish: Option<IssuedCommand>,
    earlier: EarlierCommands,
    report: RecordingReport,
}

impl Recorder {
    pub(crate) fn new(destination: Destination) -> Self {
        Self {
            destination,
            episode: None,
            finish: None,
            earlier: EarlierCommands::default(),
            report: RecordingReport::default(),
        }
    }

    pub(crate) const fn report(&self) -> &RecordingReport {
        &self.report
    }

    fn start(
        &mut self,
        cause: CommandId,
        tick: SimTick,
        stage: &RecordedWorld,
        timeline: &mut Timeline,
    ) -> Result<SimFact, RecorderError> {
        self.earlier.begin_recording(tick);
        let header = SessionHeader {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            ticks_per_second: TICKS_PER_SECOND,
            ticks_per_frame: TICKS_PER_FRAME,
            begin_tick: self.earlier.begin().map(|tick| tick.0),
            start_tick: tick.0,
            earlier_commands: self.earlier.count(),
            camera: stage.camera.as_deref().copied(),
            hand_cameras: stage.hand_cameras(&self.destination.hand_pictures),
            settings: stage.settings.0.clone(),
        };
        let scene = stage.scene();
        let NewRecording {
            opened: mut episode,
            moved_aside,
        } = Episode::begin(&self.destination, &header, &scene, &self.earlier)?;
        episode.note_pause(*stage.paused)?;
        *timeline = episode.timeline();
        self.episode = Some(episode);
        self.finish = None;
        let folder = self.destination.folder.clone();
        self.report.started += 1;
        let moved = moved_aside.iter().map(|to| MovedAside {
            from: folder.clone(),
            to: to.clone(),
        });
        self.report.moved_aside.extend(moved);
        Ok(SimFact::Recording(RecordingFact::Started {
            cause,
            folder,
            moved_aside,
        }))
    }
}

/// Tells the recorder, if there is one, that the world is what these commands have made of an empty one since this tick: a player has
/// put it back there. The next recording begins with them.
pub fn set_earlier_commands(world: &mut World, begin: SimTick, commands: &[SessionCommand]) {
    if let Some(mut recorder) = world.get_resource_mut::<Recorder>() {
        recorder.earlier = EarlierCommands::since(begin, commands);
    }
}

/// The commands since a world was last empty, with which its next recording begins. Whoever takes the world back to an earlier moment takes
/// them back, too.
#[derive(Clone, Debug)]
pub struct GivenCommands(Option<EarlierCommands>);

impl GivenCommands {
    /// Those of a world.
    pub fn of(world: &World) -> Self {
        let recorder = world.get_resource::<Recorder>();
        Self(recorder.map(|recorder| recorder.earlier.clone()))
    }

    /// Makes them those of a world again.
    pub fn restore(&self, world: &mut World) {
        if let (Some(earlier), Some(mut recorder)) = (&self.0, world.get_resource_mut::<Recorder>())
        {
            recorder.earlier.clone_from(earlier);
        }
    }
}

/// Chooses the folder of the next recording.
///
/// # Errors
/// A recording runs, or the world has no recorder.
pub fn record_into(world: &mut World, folder: &Path) -> Result<(), String> {
    if world.resource::<Recording>().0 {
        return Err(IS_RUNNING.into());
    }
    let Some(mut recorder) = world.get_resource_mut::<Recorder>() else {
        return Err("nothing of this world can be recorded".into());
    };
    folder.clone_into(&mut recorder.destination.folder);
    Ok(())
}

/// Follows undo and redo.
pub(crate) fn follow_history(
    mut recorder: ResMut<Recorder>,
    mut recording: ResMut<Recording>,
    mut facts: ParamSet<(MessageReader<SimFact>, MessageWriter<SimFact>)>,
    mut timeline: ResMut<Timeline>,
    tick: Res<SimTick>,
    paused: Res<Paused>,
) {
    let mut history = Vec::new();
    for fact in facts.p0().read() {
        if let SimFact::History(fact) = fact {
            history.push(fact.clone());
        }
    }
    if let Some(episode) = &mut recorder.episode {
        let result = episode.follow(&history, *tick, *paused, &mut timeline);
        recorder.stop_on_error(result, &mut recording, &mut facts.p1());
        recorder.earlier.note_pause(*paused);
    } else {
        recorder.earlier.follow(&history, *tick, *paused);
    }
}

/// Starts recordings, and logs the commands of this tick before they are carried out.
pub(crate) fn take_commands(
    mut recorder: ResMut<Recorder>,
    mut recording: ResMut<Recording>,
    mut commands: MessageReader<IssuedCommand>,
    mut facts: MessageWriter<SimFact>,
    mut timeline: ResMut<Timeline>,
    tick: Res<SimTick>,
    hands: Res<Hands>,
    stage: RecordedWorld,
) {
    let mut commands: Vec<_> = commands.read().cloned().collect();
    commands.sort_by_key(|issued| issued.command.phase());
    for issued in &commands {
        let cause = issued.id;
        match RecordingCommand::of(&issued.command) {
            Some(RecordingCommand::Start) if recorder.episode.is_some() => {
                facts.write(refused(cause, IS_RUNNING));
            }
            Some(RecordingCommand::Start) => {
                match recorder.start(cause, *tick, &stage, &mut timeline) {
                    Ok(started) => {
                        recording.0 = true;
                        facts.write(started);
                    }
                    Err(error) => {
                        let folder = recorder.destination.folder.clone();
                        let reason = format!("no recording was started: {error}");
                        facts.write(recorder.fail(Some(cause), folder, reason));
                    }
                }
            }
            Some(RecordingCommand::Finish) if recorder.episode.is_none() => {
                facts.write(refused(cause, NONE_IS_RUNNING));
            }
            Some(RecordingCommand::Finish) => recorder.finish = Some(issued.clone()),
            None => {}
        }
    }
    let Recorder {
        episode, earlier, ..
    } = &mut *recorder;
    if let Some(episode) = episode {
        commands
            .iter()
            .for_each(|issued| earlier.note_lasting(&issued.command));
        let result = episode.log_commands(&commands);
        recorder.stop_on_error(result, &mut recording, &mut facts);
    } else {
        let hands_are_empty = Hand::ALL.iter().all(|&hand| hands.held_by(hand).is_none());
        earlier.note(*tick, &commands, hands_are_empty);
    }
}

/// Number of ticks before the next frame, if something is recorded: in a world at rest, the other ticks leave nothing in a recording.
pub(crate) fn ticks_to_frame(recorder: Res<Recorder>, tick: Res<SimTick>) -> Option<u64> {
    let episode = recorder.episode.as_ref()?;
    Some(match recorder.finish {
        Some(_) => 0,
        None => episode.ticks_to_frame(*tick),
    })
}

/// Lets so many ticks go by that leave nothing in a recording.
pub(crate) fn pass_over(world: &mut World, ticks: u64) -> Result {
    let is_recording = (world.get_resource::<Recorder>()).is_some_and(|it| it.episode.is_some());
    if is_recording {
        let next = world.resource::<SimTick>().0 + ticks;
        world.resource_mut::<Timeline>().end = SimTick(next - 1);
    }
    Ok(())
}

/// Asks for the pictures of a tick that is a frame.
pub(crate) fn ask_for_picture(
    recorder: Res<Recorder>,
    tick: Res<SimTick>,
    paused: Res<Paused>,
    demand: Option<Res<PictureDemand>>,
    mut hand_images: ResMut<HandImages>,
) {
    let (Some(episode), Some(demand)) = (&recorder.episode, demand) else {
        return;
    };
    if recorder.finish.is_some() {
        demand.insist();
    } else if !paused.0 && episode.is_frame(*tick) {
        demand.ask();
    } else {
        return;
    }
    if !episode.hand_cameras().is_empty() {
        hand_images.ask(episode.hand_cameras());
    }
}

/// Writes this tick, and ends the recording if a command does.
pub(crate) fn record(
    mut recorder: ResMut<Recorder>,
    mut recording: ResMut<Recording>,
    mut facts: ParamSet<(MessageReader<SimFact>, MessageWriter<SimFact>)>,
    mut timeline: ResMut<Timeline>,
    tick: Res<SimTick>,
    paused: Res<Paused>,
    stage: RecordedWorld,
    image: Option<Res<SensorImage>>,
) {
    let finish = recorder.finish.clone();
    let happened: Vec<_> = facts.p0().read().cloned().collect();
    let Some(episode) = &mut recorder.episode else {
        recorder.earlier.end_tick(*tick, &happened);
        end_running(&mut timeline);
        return;
    };
    let mut result = episode.write_events(&happened, &stage, &mut timeline);
    let image = image
        .as_deref()
        .filter(|image| image.tick == *tick && image.picture.width > 0);
    if result.is_ok() && !paused.0 {
        result = episode.write_tick(*tick, &stage, image, &mut timeline);
    }
    let ending = match (result, &finish) {
        (Ok(()), Some(finish)) => episode
            .finish(*tick, finish, &stage, image, &mut timeline)
            .map(|commands| Some((finish.id, commands))),
        (result, _) => result.map(|()| None),
    };
    recorder.end_if_over(ending, &mut recording, &mut facts.p1());
    if recorder.episode.is_none() {
        end_running(&mut timeline);
    }
}

fn end_running(timeline: &mut ResMut<Timeline>) {
    if timeline.stage == TimelineStage::Running {
        timeline.stage = TimelineStage::Finished;
    }
}

impl Recorder {
    /// Ends a recording that cannot go on; its files are kept.
    fn stop_on_error(
        &mut self,
        result: Result<(), RecorderError>,
        recording: &mut Recording,
        facts: &mut MessageWriter<SimFact>,
    ) {
        if let Err(error) = result {
            let reason = format!("the recording has ended: {error}");
            let cause = self.finish.as_ref().map(|finish| finish.id);
            if let Some(episode) = self.end(None, recording) {
                facts.write(self.fail(cause, episode.abandon(), reason));
            }
        }
    }

    /// Ends a recording of which these are the commands, if a command ends it, or one that cannot go on.
    fn end_if_over(
        &mut self,
        ending: Result<Option<(CommandId, Vec<u8>)>, RecorderError>,
        recording: &mut Recording,
        facts: &mut MessageWriter<SimFact>,
    ) {
        match ending {
            Ok(None) => {}
            Ok(Some((cause, commands))) => {
                if let Some(episode) = self.end(Some(&commands), recording) {
                    let folder = episode.folder().to_owned();
                    facts.write(SimFact::Recording(RecordingFact::Finished {
                        cause,
                        folder,
                    }));
                }
            }
            Err(error) => self.stop_on_error(Err(error), recording, facts),
        }
    }

    /// Nobody may miss that a demonstration is not recorded: it is logged, too.
    fn fail(&mut self, cause: Option<CommandId>, folder: PathBuf, reason: String) -> SimFact {
        error!("{reason}");
        self.report.failure = Some(reason.clone());
        SimFact::Recording(RecordingFact::Failed {
            cause,
            folder,
            reason,
        })
    }

    /// Ends the recording, of which these are the lines of its commands, and returns it.
    fn end(&mut self, commands: Option<&[u8]>, recording: &mut Recording) -> Option<Episode> {
        self.finish = None;
        self.earlier.append_recorded(commands);
        recording.0 = false;
        self.episode.take()
    }
}

pub(crate) fn refused(cause: CommandId, reason: &str) -> SimFact {
    SimFact::Refused {
        cause: Some(cause),
        reason: reason.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use bevy::ecs::schedule::{LogLevel, ScheduleBuildSettings};
    use tabletop_core::{CorePlugin, HeadCamera, SimSystems, StepApp as _};

    use crate::recording::recorder_plugin::RecorderPlugin;

    use super::*;

    #[test]
    fn it_can_run_in_one_order_only() {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            RecorderPlugin::default(),
        ))
        .init_resource::<HeadCamera>()
        .init_resource::<PictureDemand>()
        .init_resource::<SensorImage>()
        .edit_schedule(FixedUpdate, |schedule| {
            schedule.set_build_settings(ScheduleBuildSettings {
                ambiguity_detection: LogLevel::Error,
                ..default()
            });
        });
        for phase in [SimSystems::Ingest, SimSystems::Sense, SimSystems::Record] {
            app.add_systems(FixedUpdate, (|_: &mut World| {}).in_set(phase));
        }
        app.start().step(1);
        assert_eq!(app.world().resource::<SimTick>().0, 1);
    }
}
