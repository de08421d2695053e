//! The task of the recording, the program that it means, and the robot that does them.

mod assignment;
mod imitator;
mod teaching;
mod understood;

use bevy::prelude::*;
use tabletop_controller::RobotController;
use tabletop_core::{
    Actor, Agent, CommandWriter, Playback, PlaybackOrder, SceneCommand, SceneSpec, ShownTask,
    Timeline, TimelineStage,
};
use tabletop_user::{Notices, TaskOrder, Tone};

use self::{
    assignment::Assignment, imitator::RobotImitator, teaching::Teaching, understood::Understood,
};

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Understood>()
        .init_resource::<Teaching>()
        .init_resource::<NextTable>()
        .add_plugins(imitator::plugin)
        .add_systems(
            Update,
            (
                understood::read_recording,
                understood::take_read_task,
                obey,
                teaching::take_meaning,
                put_up.run_if(|next: Res<NextTable>| next.0.is_some()),
            )
                .chain(),
        );
}

/// The table that is put up once the recording is closed, and what the robot then does; `None` if none is to be put up.
#[derive(Resource, Default)]
struct NextTable(Option<(SceneSpec, Option<Assignment>)>);

/// Carries out the user's requests about the task.
fn obey(
    mut orders: MessageReader<TaskOrder>,
    mut understood: ResMut<Understood>,
    mut teaching: ResMut<Teaching>,
    mut shown: ResMut<ShownTask>,
    mut imitator: ResMut<RobotImitator>,
    mut controller: ResMut<RobotController>,
    mut next: ResMut<NextTable>,
    mut notices: ResMut<Notices>,
    agent: Res<Agent>,
    timeline: Res<Timeline>,
    playback: Res<Playback>,
) {
    let begins = timeline.stage == TimelineStage::Open && !playback.is_over;
    for order in orders.read() {
        let mut act = |assignment: Result<Assignment, String>, understood: &Understood| {
            let assignment = assignment?;
            if agent.is_on() {
                return Err("a script drives the robot; stop it first".into());
            }
            match begins {
                true => next.0 = Some((understood.beginning()?, Some(assignment))),
                false => imitator.prepare(assignment, &mut controller),
            }
            Ok(())
        };
        let result = match order {
            TaskOrder::Require {
                role,
                property,
                is_required,
            } => understood.require(role, property, *is_required),
            TaskOrder::Free { role, is_free } => understood.free(role, *is_free),
            TaskOrder::Imitate => act(Assignment::of_lesson(&understood), &understood),
            TaskOrder::Perform => act(Assignment::of_program(&teaching), &understood),
            TaskOrder::Stop => {
                imitator.stop(&mut controller);
                Ok(())
            }
            TaskOrder::PutBack => {
                imitator.stop(&mut controller);
                let scene = understood.beginning();
                scene.map(|scene| next.0 = Some((scene, None)))
            }
            TaskOrder::ShowAgain => {
                teaching.await_another();
                Ok(())
            }
            TaskOrder::Ask(number) => {
                imitator.stop(&mut controller);
                let question = teaching.question(*number);
                question
                    .ok_or("there is no such program".to_owned())
                    .map(|scene| {
                        teaching.await_another();
                        next.0 = Some((scene, None));
                    })
            }
            TaskOrder::Answer(number) => teaching.answer(*number),
        };
        if let Err(reason) = result {
            notices.append(Tone::Warning, &reason);
        }
    }
    if let Some(new) = understood.shown_if_changed() {
        *shown = new;
    }
}

/// Puts up the next table, after closing the recording if it is open.
fn put_up(
    mut next: ResMut<NextTable>,
    mut commands: CommandWriter,
    mut orders: MessageWriter<PlaybackOrder>,
    mut imitator: ResMut<RobotImitator>,
    mut controller: ResMut<RobotController>,
    timeline: Res<Timeline>,
) {
    if timeline.stage == TimelineStage::Open {
        orders.write(PlaybackOrder::Close);
        return;
    }
    let Some((scene, assignment)) = next.0.take() else {
        return;
    };
    commands.write(Actor::Panel, SceneCommand::Set(Box::new(scene)));
    if let Some(assignment) = assignment {
        imitator.prepare(assignment, &mut controller);
    }
}

#[cfg(test)]
mod tests;
