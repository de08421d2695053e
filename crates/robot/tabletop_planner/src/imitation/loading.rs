//! Steps with a load: objects that go along with the moved one, on it or in it.

use super::Imitator;
use crate::{
    failure::PlanFailure,
    goals::{bound, is_placed},
    sight::Arranged as _,
    stage::PlanningStage,
};

impl Imitator<'_> {
    /// Does a step. Its load goes along with the object; if that is impossible, the object goes alone. What is then not where it belongs is put there.
    pub(super) fn do_step(
        &mut self,
        stage: &mut dyn PlanningStage,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let task = self.task;
        let step = &task.steps[i];
        if step.load.is_empty() {
            return self.do_alone(stage, step, i);
        }
        let is_there = is_placed(step, self.binding, stage.sight(), &self.before)?;
        if !(is_there && step.goal.is_some()) {
            let loaded = self.do_loaded(stage, i);
            let is_possible = !loaded.as_ref().is_err_and(PlanFailure::is_of_planning);
            match loaded {
                Err(_) if !is_possible => self.do_alone(stage, step, i)?,
                done => done?,
            }
        }
        for loading in step.loading() {
            if !is_placed(&loading, self.binding, stage.sight(), &self.before)? {
                self.do_alone(stage, &loading, i)?;
            }
        }
        Ok(())
    }

    /// Moves the object of a step with as much of its load as is on it or in it.
    fn do_loaded(&mut self, stage: &mut dyn PlanningStage, i: usize) -> Result<(), PlanFailure> {
        let (task, binding) = (self.task, self.binding);
        let step = &task.steps[i];
        let id = bound(binding, &step.object)?;
        let arrangement = stage.sight().arrangement();
        let carried = arrangement.load(id);
        let load = step
            .load
            .iter()
            .filter_map(|load| binding.object(&load.object));
        let load = load
            .filter(|load| carried.contains(load))
            .map(str::to_owned);
        self.loaded = Some((id.to_owned(), load.collect()));
        let outcome = self.do_alone(stage, step, i);
        self.loaded = None;
        outcome
    }

    /// What goes along with an object that is moved now.
    pub(super) fn load_of(&self, id: &str) -> &[String] {
        match &self.loaded {
            Some((loaded, load)) if loaded == id => load,
            Some(_) | None => &[],
        }
    }
}
