//! The recorder in the simulation.

use std::path::PathBuf;

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    Hand, Hands, HeadCamera, Joint, JointSpec, ObjectIndex, ObjectSpec, Paused, PictureDemand,
    Recording, Robot, SensorImage, SimCommand, SimFact, SimTick, TICKS_PER_SECOND, Table, Twist,
};

use crate::{
    Channels, RecorderError, SessionHeader, SessionObject, SessionScene, SessionSettings,
    TICKS_PER_FRAME,
    episode::{Episode, Shown},
    prelude::Prelude,
    session::FORMAT,
    states::State,
};

/// Why a recording cannot be started.
pub(crate) const IS_RUNNING: &str = "a recording is running; finish it first";

/// Why no recording can be finished.
pub(crate) const NONE_IS_RUNNING: &str = "no recording is running; start one first";

/// Makes the recordings.
#[derive(Resource, Debug)]
pub(crate) struct Recorder {
    folder: PathBuf,
    channels: Channels,
    episode: Option<Episode>,
    is_finishing: bool,
    prelude: Prelude,
}

impl Recorder {
    pub(crate) fn new(folder: PathBuf, channels: Channels) -> Self {
        Self {
            folder,
            channels,
            episode: None,
            is_finishing: false,
            prelude: Prelude::default(),
        }
    }

    fn start(&mut self, tick: SimTick, stage: &Stage) -> Result<SimFact, RecorderError> {
        let header = SessionHeader {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            ticks_per_second: TICKS_PER_SECOND,
            ticks_per_frame: TICKS_PER_FRAME,
            begin_tick: self.prelude.begin().map(|tick| tick.0),
            start_tick: tick.0,
            earlier_commands: self.prelude.count(),
            camera: stage.camera.as_deref().copied(),
            settings: stage.settings.0.clone(),
        };
        self.episode = Some(Episode::begin(
            &self.folder,
            &header,
            &stage.scene(),
            &self.prelude,
            self.channels,
        )?);
        self.is_finishing = false;
        let folder = self.folder.clone();
        Ok(SimFact::RecordingStarted { folder })
    }
}

/// The world as recordings see it.
#[derive(SystemParam)]
pub(crate) struct Stage<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<
        'w,
        's,
        (
            &'static ObjectSpec,
            &'static Transform,
            Option<&'static Twist>,
        ),
    >,
    tables: Query<'w, 's, &'static Table>,
    joints: Query<'w, 's, &'static Joint>,
    camera: Option<Res<'w, HeadCamera>>,
    settings: Res<'w, SessionSettings>,
    robot: Res<'w, Robot>,
}

impl Stage<'_, '_> {
    fn scene(&self) -> SessionScene {
        let place = |object| self.index.iter().position(|other| other == object);
        let mut joints: Vec<_> = self.joints.iter().collect();
        joints.sort_by_key(|joint| joint.objects.map(place));
        let objects = self.index.iter().filter_map(|object| {
            let (spec, transform, _) = self.objects.get(object).ok()?;
            Some(SessionObject {
                pose: transform.into(),
                spec: spec.clone(),
            })
        });
        SessionScene {
            table: self.tables.iter().next().copied(),
            objects: objects.collect(),
            joints: joints
                .into_iter()
                .filter_map(|joint| self.joint(joint))
                .collect(),
        }
    }

    fn joint(&self, joint: &Joint) -> Option<JointSpec> {
        let id = |object| self.spec(object).map(|spec| spec.id.clone());
        let [first, second] = joint.objects;
        Some(JointSpec {
            objects: [id(first)?, id(second)?],
            frames: joint.frames,
            kind: joint.kind,
        })
    }

    fn spec(&self, object: Entity) -> Option<&ObjectSpec> {
        self.objects.get(object).ok().map(|(spec, ..)| spec)
    }

    fn shown(&self, entity: Entity) -> Shown<'_> {
        match self.spec(entity) {
            Some(spec) => Shown::Object(spec),
            None if self.tables.contains(entity) => Shown::Table,
            None => Shown::Other,
        }
    }

    fn state(&self, id: &str) -> Option<State> {
        let (_, transform, twist) = self.objects.get(self.index.get(id)?).ok()?;
        Some(State {
            pose: transform.into(),
            twist: twist.copied().unwrap_or_default(),
        })
    }
}

/// Starts recordings, and logs the commands of this tick before they are carried out.
pub(crate) fn take_commands(
    mut recorder: ResMut<Recorder>,
    mut recording: ResMut<Recording>,
    mut commands: MessageReader<SimCommand>,
    mut facts: MessageWriter<SimFact>,
    tick: Res<SimTick>,
    hands: Res<Hands>,
    stage: Stage,
) {
    let commands: Vec<_> = commands.read().cloned().collect();
    for command in &commands {
        match command {
            SimCommand::StartRecording if recorder.episode.is_some() => {
                facts.write(refused(IS_RUNNING.into()));
            }
            SimCommand::StartRecording => match recorder.start(*tick, &stage) {
                Ok(started) => {
                    recording.0 = true;
                    facts.write(started);
                }
                Err(error) => {
                    facts.write(failed(
                        recorder.folder.clone(),
                        format!("no recording was started: {error}"),
                    ));
                }
            },
            SimCommand::FinishRecording if recorder.episode.is_none() => {
                facts.write(refused(NONE_IS_RUNNING.into()));
            }
            SimCommand::FinishRecording => recorder.is_finishing = true,
            _ => {}
        }
    }
    let Recorder {
        episode, prelude, ..
    } = &mut *recorder;
    if let Some(episode) = episode {
        commands
            .iter()
            .for_each(|command| prelude.note_lasting(command));
        let result = episode.log_commands(*tick, &commands);
        recorder.stop_on_error(result, &mut recording, &mut facts);
    } else {
        let hands_are_empty = Hand::ALL.iter().all(|&hand| hands.held_by(hand).is_none());
        prelude.note(*tick, &commands, hands_are_empty);
    }
}

/// Asks for a picture of a tick that is a frame.
pub(crate) fn ask_for_picture(
    recorder: Res<Recorder>,
    tick: Res<SimTick>,
    demand: Option<Res<PictureDemand>>,
) {
    if let (Some(episode), Some(demand)) = (&recorder.episode, demand)
        && episode.is_frame(*tick)
    {
        demand.ask();
    }
}

/// Writes what this tick has brought, and ends the recording if it was told to.
pub(crate) fn record(
    mut recorder: ResMut<Recorder>,
    mut recording: ResMut<Recording>,
    mut facts: ParamSet<(MessageReader<SimFact>, MessageWriter<SimFact>)>,
    tick: Res<SimTick>,
    paused: Res<Paused>,
    stage: Stage,
    image: Option<Res<SensorImage>>,
) {
    let Some(episode) = &mut recorder.episode else {
        facts.p0().clear();
        return;
    };
    let told: Vec<_> = facts.p0().read().cloned().collect();
    let mut result = episode.write_facts(*tick, &told, *paused, |object| stage.spec(object));
    if result.is_ok() && !paused.0 {
        let image = image
            .as_deref()
            .filter(|image| image.tick == *tick && image.picture.width > 0);
        let state = |id: &str| stage.state(id);
        let joints = &stage.robot.joints;
        result = episode.write_tick(*tick, state, joints, image, |entity| stage.shown(entity));
    }
    let mut facts = facts.p1();
    recorder.stop_on_error(result, &mut recording, &mut facts);
    if recorder.is_finishing {
        recorder.finish(*tick, &mut recording, &mut facts);
    }
}

impl Recorder {
    /// Ends a recording that cannot go on; what it has is kept.
    fn stop_on_error(
        &mut self,
        result: Result<(), RecorderError>,
        recording: &mut Recording,
        facts: &mut MessageWriter<SimFact>,
    ) {
        if let Err(error) = result {
            let reason = format!("the recording has ended: {error}");
            if let Some(folder) = self.end(None, recording) {
                facts.write(failed(folder, reason));
            }
        }
    }

    fn finish(
        &mut self,
        tick: SimTick,
        recording: &mut Recording,
        facts: &mut MessageWriter<SimFact>,
    ) {
        let Some(episode) = &mut self.episode else {
            self.is_finishing = false;
            return;
        };
        let commands = episode.commands();
        let result = episode.finish(tick).and(commands);
        match result {
            Ok(commands) => {
                if let Some(folder) = self.end(Some(&commands), recording) {
                    facts.write(SimFact::RecordingFinished { folder });
                }
            }
            Err(error) => self.stop_on_error(Err(error), recording, facts),
        }
    }

    /// Ends the recording, of which these are the lines of its commands. Returns its folder.
    fn end(&mut self, commands: Option<&[u8]>, recording: &mut Recording) -> Option<PathBuf> {
        self.is_finishing = false;
        self.prelude.append_recorded(commands);
        let episode = self.episode.take()?;
        recording.0 = false;
        Some(episode.folder().to_owned())
    }
}

/// Nobody may miss that a demonstration is not recorded: it is logged, too.
fn failed(folder: PathBuf, reason: String) -> SimFact {
    error!("{reason}");
    SimFact::RecordingFailed { folder, reason }
}

pub(crate) fn refused(reason: String) -> SimFact {
    SimFact::Refused { reason }
}

#[cfg(test)]
mod tests {
    use bevy::ecs::schedule::{LogLevel, ScheduleBuildSettings};
    use tabletop_core::{CorePlugin, HeadCamera, SimSystems, StepApp as _};

    use crate::RecorderPlugin;

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
