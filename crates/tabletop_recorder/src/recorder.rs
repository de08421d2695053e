//! The recorder in the simulation.

use std::path::PathBuf;

use bevy::{ecs::system::SystemParam, prelude::*};
use serde_json::{Map, Value};
use tabletop_core::{
    HeadCamera, Joint, JointSpec, ObjectIndex, ObjectSpec, Paused, PictureDemand, Pose, Recording,
    SensorImage, SimCommand, SimFact, SimTick, TICKS_PER_SECOND, Table,
};

use crate::{
    RecorderError, SessionHeader, SessionObject, SessionScene, SessionTask, TICKS_PER_FRAME,
    episode::Episode, session::FORMAT,
};

/// Makes the recordings.
#[derive(Resource, Debug)]
pub(crate) struct Recorder {
    folder: PathBuf,
    settings: Map<String, Value>,
    episode: Option<Episode>,
    is_finishing: bool,
    task: Option<SessionTask>,
}

impl Recorder {
    pub(crate) fn new(folder: PathBuf, settings: Map<String, Value>) -> Self {
        Self {
            folder,
            settings,
            episode: None,
            is_finishing: false,
            task: None,
        }
    }

    fn start(&mut self, tick: SimTick, stage: &Stage) -> Result<SimFact, RecorderError> {
        let header = SessionHeader {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            ticks_per_second: TICKS_PER_SECOND,
            ticks_per_frame: TICKS_PER_FRAME,
            start_tick: tick.0,
            camera: stage.camera.as_deref().copied(),
            settings: self.settings.clone(),
        };
        let scene = SessionScene {
            task: self.task.clone(),
            ..stage.scene()
        };
        self.episode = Some(Episode::begin(&self.folder, &header, &scene)?);
        self.is_finishing = false;
        let folder = self.folder.clone();
        Ok(SimFact::RecordingStarted { folder })
    }
}

/// The world as recordings see it.
#[derive(SystemParam)]
pub(crate) struct Stage<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
    tables: Query<'w, 's, &'static Table>,
    joints: Query<'w, 's, (Entity, &'static Joint)>,
    camera: Option<Res<'w, HeadCamera>>,
}

impl Stage<'_, '_> {
    fn scene(&self) -> SessionScene {
        let mut joints: Vec<_> = self.joints.iter().collect();
        joints.sort_by_key(|(entity, _)| *entity);
        let objects = self.index.iter().filter_map(|object| {
            let (spec, transform) = self.objects.get(object).ok()?;
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
                .filter_map(|(_, joint)| self.joint(joint))
                .collect(),
            task: None,
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
        self.objects.get(object).ok().map(|(spec, _)| spec)
    }

    fn pose(&self, id: &str) -> Option<Pose> {
        let (_, transform) = self.objects.get(self.index.get(id)?).ok()?;
        Some(transform.into())
    }
}

/// Starts recordings, and logs the commands of this tick before they are carried out.
pub(crate) fn take_commands(
    mut recorder: ResMut<Recorder>,
    mut recording: ResMut<Recording>,
    mut commands: MessageReader<SimCommand>,
    mut facts: MessageWriter<SimFact>,
    tick: Res<SimTick>,
    stage: Stage,
) {
    let commands: Vec<_> = commands.read().cloned().collect();
    for command in &commands {
        match command {
            SimCommand::StartRecording if recorder.episode.is_some() => {
                facts.write(refused(format!(
                    "a recording into {} is running; finish it first",
                    recorder.folder.display()
                )));
            }
            SimCommand::StartRecording => match recorder.start(*tick, &stage) {
                Ok(started) => {
                    recording.0 = true;
                    facts.write(started);
                }
                Err(error) => {
                    error!("{error}");
                    facts.write(refused(format!("no recording was started: {error}")));
                }
            },
            SimCommand::FinishRecording if recorder.episode.is_none() => {
                facts.write(refused("no recording is running; start one first".into()));
            }
            SimCommand::FinishRecording => recorder.is_finishing = true,
            _ => {}
        }
    }
    for command in &commands {
        match command {
            SimCommand::SetScene(scene) => {
                recorder.task = Some(SessionTask {
                    tick: tick.0,
                    scene: (**scene).clone(),
                });
            }
            SimCommand::ClearTable => recorder.task = None,
            _ => {}
        }
    }
    if let Some(episode) = &mut recorder.episode {
        let result = episode.log_commands(*tick, &commands);
        recorder.stop_on_error(result, &mut recording, &mut facts);
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
    let mut result = episode.write_facts(*tick, &told, |object| stage.spec(object));
    if result.is_ok() && !paused.0 {
        let picture = image
            .as_deref()
            .filter(|image| image.tick == *tick && image.picture.width > 0)
            .map(|image| &image.picture);
        result = episode.write_tick(*tick, |id| stage.pose(id), picture);
    }
    let mut facts = facts.p1();
    recorder.stop_on_error(result, &mut recording, &mut facts);
    if recorder.is_finishing {
        recorder.finish(&mut recording, &mut facts);
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
            error!("the recording has ended: {error}");
            facts.write(refused(format!("the recording has ended: {error}")));
            self.end(recording, facts);
        }
    }

    fn finish(&mut self, recording: &mut Recording, facts: &mut MessageWriter<SimFact>) {
        if let Some(episode) = &self.episode
            && let Err(error) = episode.drop_undone()
        {
            warn!("what was undone is still there: {error}");
        }
        self.end(recording, facts);
    }

    fn end(&mut self, recording: &mut Recording, facts: &mut MessageWriter<SimFact>) {
        self.is_finishing = false;
        if let Some(episode) = self.episode.take() {
            let folder = episode.folder().to_owned();
            recording.0 = false;
            facts.write(SimFact::RecordingFinished { folder });
        }
    }
}

fn refused(reason: String) -> SimFact {
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
