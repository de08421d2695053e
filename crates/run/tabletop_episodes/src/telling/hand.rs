//! A step of a program, done by the hand.

use bevy::prelude::*;
use tabletop_core::{Hand, Hands, ObjectIndex, StepApp as _, WriteCommand as _};
use tabletop_planner::PlanFailure;
use tabletop_program::{
    ConcreteStep, HandFailure, HandProgress, HandStep, HandledObject, TableScene,
};

/// The hand that does it.
const HAND: Hand = Hand::Right;

/// Does a step.
pub(super) fn perform(
    app: &mut App,
    scene: &TableScene,
    step: &ConcreteStep,
) -> Result<(), PlanFailure> {
    let mut step = HandStep::begin(scene, step, HAND);
    loop {
        match step.tick(handled(app, step.object())) {
            HandProgress::Over(done) => return done.map_err(plan_failure),
            HandProgress::GoesOn(commands) => {
                for command in commands {
                    app.world_mut().write_command(command);
                }
                app.step(1);
            }
        }
    }
}

fn handled(app: &App, id: &str) -> HandledObject {
    let world = app.world();
    let object = world.resource::<ObjectIndex>().get(id);
    let place = object.and_then(|object| world.get::<Transform>(object));
    HandledObject {
        location: place.map(|place| place.translation),
        is_held: object.is_some() && world.resource::<Hands>().held_by(HAND) == object,
    }
}

fn plan_failure(failure: HandFailure) -> PlanFailure {
    match failure {
        HandFailure::Gone(object) => PlanFailure::Gone(object),
        HandFailure::NotHeld(object) => PlanFailure::NotHeld(object),
    }
}
