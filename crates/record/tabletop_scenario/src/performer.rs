//! A scenario whose steps come one after the other, while a program decides on them.

use bevy::prelude::*;
use tabletop_core::step_world;

use crate::{Outcome, Program, ScenarioError, ScenarioRun, due::take_due_steps_of};

/// Performs programs one after the other in a world, in the ticks that they would take in one scenario. A check of a placement need not last.
///
/// ```
/// use bevy::prelude::*;
/// use tabletop_core::prelude::*;
/// use tabletop_scenario::{Performer, Program, Scenario};
///
/// let program = |steps| {
///     let scenario = Scenario::parse("steps", &format!("(steps: [{steps}])"))?;
///     Program::new(&scenario, |_| Ok(SceneSpec::default()), 0)
/// };
/// let mut app = App::new();
/// app.add_plugins((MinimalPlugins, CorePlugin::default())).start();
/// let mut performer = Performer::new(0);
/// performer.perform(app.world_mut(), program("Wait(0.5)")?)?;
/// assert_eq!(app.world().resource::<SimTick>().0, 30);
/// let failure = performer.perform(app.world_mut(), program("Expect(Exists(\"RedBlock\"))")?);
/// assert!(failure.is_err());
/// # Ok::<_, tabletop_scenario::ScenarioError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Performer(ScenarioRun);

impl Performer {
    /// A performer whose random numbers have this seed.
    pub fn new(seed: u64) -> Self {
        Self(ScenarioRun::without_end(seed))
    }

    /// Performs a program until it is done.
    ///
    /// # Errors
    /// The step that failed. The steps before it were done.
    pub fn perform(&mut self, world: &mut World, program: Program) -> Result<(), ScenarioError> {
        self.0.go_on_with(program);
        loop {
            if let Err(error) = world.run_system_cached_with(take_due_steps_of, &mut self.0) {
                self.0.give_up(error.to_string());
            }
            match self.0.outcome() {
                Outcome::Running => step_world(world, 1),
                Outcome::Done => return Ok(()),
                Outcome::Failed(error) => return Err(error.clone()),
            }
        }
    }
}
