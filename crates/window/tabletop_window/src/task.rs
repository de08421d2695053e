//! The task of the recording, and its imitation by the robot.

mod imitator;
mod understood;

use bevy::prelude::*;
use tabletop_controller::RobotController;
use tabletop_core::{
    Actor, Agent, CommandWriter, Playback, PlaybackOrder, SceneCommand, ShownTask, Timeline,
    TimelineStage,
};
use tabletop_user::{Notices, TaskOrder, Tone};

use self::{imitator::RobotImitator, understood::Understood};

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Understood>()
        .init_resource::<PuttingBack>()
        .add_plugins(imitator::plugin)
        .add_systems(
            Update,
            (
                understood::read_recording,
                understood::take_read_task,
                obey,
                put_back.run_if(|putting: Res<PuttingBack>| putting.0.is_some()),
            )
                .chain(),
        );
}

/// The act that follows once everything is put back; `None` if nothing is to be put back.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
struct PuttingBack(Option<Afterwards>);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Afterwards {
    Nothing,
    Imitate,
}

/// Carries out the user's requests about the task.
fn obey(
    mut orders: MessageReader<TaskOrder>,
    mut understood: ResMut<Understood>,
    mut shown: ResMut<ShownTask>,
    mut imitator: ResMut<RobotImitator>,
    mut controller: ResMut<RobotController>,
    mut putting: ResMut<PuttingBack>,
    mut notices: ResMut<Notices>,
    agent: Res<Agent>,
    timeline: Res<Timeline>,
    playback: Res<Playback>,
) {
    for order in orders.read() {
        let result = match order {
            TaskOrder::Require {
                role,
                property,
                is_required,
            } => understood.require(role, property, *is_required),
            TaskOrder::Free { role, is_free } => understood.free(role, *is_free),
            TaskOrder::Stop => {
                imitator.stop(&mut controller);
                Ok(())
            }
            TaskOrder::PutBack => {
                imitator.stop(&mut controller);
                putting.0 = Some(Afterwards::Nothing);
                Ok(())
            }
            TaskOrder::Imitate if agent.is_on() => {
                Err("a script drives the robot; stop it first".into())
            }
            TaskOrder::Imitate if timeline.stage == TimelineStage::Open && !playback.is_over => {
                putting.0 = Some(Afterwards::Imitate);
                Ok(())
            }
            TaskOrder::Imitate => imitator.prepare(&understood, &mut controller),
        };
        if let Err(reason) = result {
            notices.append(Tone::Warning, &reason);
        }
    }
    if let Some(new) = understood.shown_if_changed() {
        *shown = new;
    }
}

/// Puts every object back where the recording began, after closing the recording if it is open.
fn put_back(
    mut putting: ResMut<PuttingBack>,
    mut commands: CommandWriter,
    mut orders: MessageWriter<PlaybackOrder>,
    mut imitator: ResMut<RobotImitator>,
    mut controller: ResMut<RobotController>,
    mut notices: ResMut<Notices>,
    understood: Res<Understood>,
    timeline: Res<Timeline>,
) {
    if timeline.stage == TimelineStage::Open {
        orders.write(PlaybackOrder::Close);
        return;
    }
    let afterwards = putting.0.take();
    let Some(scene) = understood.scene() else {
        notices.append(
            Tone::Warning,
            "the recording does not contain the scene at its beginning",
        );
        return;
    };
    commands.write(Actor::Panel, SceneCommand::Set(Box::new(scene.clone())));
    if afterwards == Some(Afterwards::Imitate)
        && let Err(reason) = imitator.prepare(&understood, &mut controller)
    {
        notices.append(Tone::Warning, &reason);
    }
}
