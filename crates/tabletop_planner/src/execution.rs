//! Execution of a task beside the simulation, tick by tick.

use std::{
    io,
    sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    thread,
    time::Duration,
};

use bevy::platform::cell::SyncCell;
use tabletop_task::{Binding, Task};

use crate::{
    body::RobotBody,
    failure::PlanFailure,
    imitation::{Doing, Imitation, imitate},
    sight::Sight,
    stage::{LimbOrder, PlanningStage, Stopped},
};

/// The execution of a task, for callers that advance time themselves: it asks for a tick and continues when it is given the result. It plans in
/// its own thread, and stops when it is dropped.
pub struct Execution {
    sights: Sender<Sight>,
    events: SyncCell<Receiver<ExecutionEvent>>,
    doing: Option<Doing>,
    over: Option<Imitation>,
}

/// The next move of an execution.
#[derive(Clone, Debug, PartialEq)]
pub enum ExecutionTurn {
    /// It is planning.
    Planning,
    /// It waits for a tick with these orders, one for each limb; then call [`Execution::see`].
    Orders(Vec<LimbOrder>),
    /// It has ended.
    Over(Imitation),
}

/// An event of the planning thread.
enum ExecutionEvent {
    Doing(Doing),
    Orders(Vec<LimbOrder>),
    Over(Imitation),
}

/// The world as the planning thread knows it.
struct Correspondence {
    sight: Sight,
    sights: Receiver<Sight>,
    events: Sender<ExecutionEvent>,
}

impl PlanningStage for Correspondence {
    fn sight(&self) -> &Sight {
        &self.sight
    }

    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped> {
        let orders = ExecutionEvent::Orders(orders.to_vec());
        self.events.send(orders).map_err(|_| Stopped)?;
        self.sight = self.sights.recv().map_err(|_| Stopped)?;
        Ok(())
    }
}

impl Execution {
    /// Begins a task in a world that looks like this. `seed` decides all random choices.
    ///
    /// # Errors
    /// The system has no thread for it.
    pub fn begin(
        body: RobotBody,
        task: Task,
        binding: Binding,
        sight: Sight,
        seed: u64,
    ) -> io::Result<Self> {
        let (sights, seen) = channel();
        let (events, received) = channel();
        let plan = move || {
            let sender = events.clone();
            let mut stage = Correspondence {
                sight,
                sights: seen,
                events,
            };
            // Nobody listens any more if it is dropped.
            let report = |doing| drop(sender.send(ExecutionEvent::Doing(doing)));
            let imitation = imitate(&mut stage, &body, &task, &binding, seed, report);
            drop(sender.send(ExecutionEvent::Over(imitation)));
        };
        thread::Builder::new().name("planner".into()).spawn(plan)?;
        Ok(Self {
            sights,
            events: SyncCell::new(received),
            doing: None,
            over: None,
        })
    }

    /// The next move, as soon as it is known; after `within`, [`ExecutionTurn::Planning`].
    pub fn turn(&mut self, within: Duration) -> ExecutionTurn {
        if let Some(imitation) = &self.over {
            return ExecutionTurn::Over(imitation.clone());
        }
        loop {
            match self.events.get().recv_timeout(within) {
                Ok(ExecutionEvent::Doing(doing)) => self.doing = Some(doing),
                Ok(ExecutionEvent::Orders(orders)) => return ExecutionTurn::Orders(orders),
                Ok(ExecutionEvent::Over(imitation)) => return self.end(imitation),
                Err(RecvTimeoutError::Timeout) => return ExecutionTurn::Planning,
                Err(RecvTimeoutError::Disconnected) => {
                    let step = self.doing.map_or(1, |doing| doing.step);
                    return self.end(Imitation {
                        failure: Some((step, PlanFailure::Stopped)),
                        ..Imitation::default()
                    });
                }
            }
        }
    }

    fn end(&mut self, imitation: Imitation) -> ExecutionTurn {
        self.over = Some(imitation.clone());
        ExecutionTurn::Over(imitation)
    }

    /// Passes on what is seen after the tick that it asked for.
    pub fn see(&self, sight: Sight) {
        // After the end, nobody looks.
        drop(self.sights.send(sight));
    }

    /// The step that is being done; `None` before the first one.
    pub fn doing(&self) -> Option<Doing> {
        self.doing
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use tabletop_core::{RobotLayout, TICK_SECONDS, Table};
    use tabletop_kinematics::baxter;

    use super::*;
    use crate::{body::angles, sight::LimbSight};

    fn body() -> RobotBody {
        RobotBody::new(RobotLayout::baxter(), baxter().unwrap(), &Table::default()).unwrap()
    }

    fn at_home(body: &RobotBody) -> Sight {
        let limbs = body.limbs.iter().map(|limb| LimbSight {
            angles: limb.home,
            ..LimbSight::default()
        });
        Sight {
            limbs: limbs.collect(),
            ..Sight::default()
        }
    }

    /// The expected sight after a tick with these orders, if nothing is in the way.
    fn passed(mut sight: Sight, orders: &[LimbOrder]) -> Sight {
        for (limb, order) in sight.limbs.iter_mut().zip(orders) {
            let turns = limb.angles.into_iter().zip(order.joints);
            limb.angles =
                angles(turns.map(|(angle, speed)| angle + speed * f64::from(TICK_SECONDS)));
        }
        sight
    }

    struct Alone(Sight, Vec<Vec<LimbOrder>>);

    impl PlanningStage for Alone {
        fn sight(&self) -> &Sight {
            &self.0
        }

        fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped> {
            self.1.push(orders.to_vec());
            self.0 = passed(self.0.clone(), orders);
            Ok(())
        }
    }

    fn nothing() -> Task {
        Task {
            table: Table::default(),
            roles: Vec::new(),
            joints: Vec::new(),
            steps: Vec::new(),
            detours: Vec::new(),
            operations: Vec::new(),
            vocabulary: BTreeMap::new(),
        }
    }

    fn begun() -> (Execution, Sight) {
        let body = body();
        let sight = at_home(&body);
        let begun = Execution::begin(body, nothing(), Binding::default(), sight.clone(), 7);
        (begun.unwrap(), sight)
    }

    #[test]
    fn tick_by_tick_it_does_the_same_as_at_a_stretch() {
        let (mut execution, mut sight) = begun();
        let mut orders = Vec::new();
        let step_by_step = loop {
            match execution.turn(Duration::MAX) {
                ExecutionTurn::Planning => {}
                ExecutionTurn::Orders(next) => {
                    sight = passed(sight, &next);
                    orders.push(next);
                    execution.see(sight.clone());
                }
                ExecutionTurn::Over(imitation) => break imitation,
            }
        };
        let body = body();
        let mut alone = Alone(at_home(&body), Vec::new());
        let at_a_stretch = imitate(
            &mut alone,
            &body,
            &nothing(),
            &Binding::default(),
            7,
            |_| {},
        );
        assert_eq!(step_by_step, at_a_stretch);
        assert!(orders.len() > 30);
        assert_eq!(orders, alone.1);
        assert_eq!(
            execution.turn(Duration::ZERO),
            ExecutionTurn::Over(at_a_stretch)
        );
    }

    #[test]
    fn it_waits_for_the_tick_that_it_has_asked_for() {
        let (mut execution, sight) = begun();
        let ExecutionTurn::Orders(_) = execution.turn(Duration::MAX) else {
            panic!("arms are to be parked");
        };
        assert_eq!(
            execution.turn(Duration::from_millis(20)),
            ExecutionTurn::Planning
        );
        execution.see(sight);
        assert!(matches!(
            execution.turn(Duration::MAX),
            ExecutionTurn::Orders(_)
        ));
    }
}
