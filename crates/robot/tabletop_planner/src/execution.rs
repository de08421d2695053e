//! Execution of a task beside the simulation, tick by tick.

use std::{
    io,
    sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    thread,
    time::Duration,
};

use bevy::platform::cell::SyncCell;
use tabletop_controller::{Controller, Drives, Sight};
use tabletop_core::RobotLayout;
use tabletop_task::{Binding, Task};

use crate::{
    body::RobotBody,
    failure::PlanFailure,
    imitation::{Doing, Imitation, imitate},
    stage::{Following, LimbOrder, PlanningStage, Stopped},
};

/// The execution of a task as a controller. It plans in a thread of its own while ticks pass, and stops when it is dropped.
pub struct Execution {
    layout: RobotLayout,
    pace: ExecutionPace,
    sights: Sender<Sight>,
    events: SyncCell<Receiver<ExecutionEvent>>,
    /// True if the plan waits for the result of its last orders.
    expects_sight: bool,
    is_planning: bool,
    doing: Option<Doing>,
    result: Option<Imitation>,
}

/// The pace of an execution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExecutionPace {
    /// Time for which a tick waits for its orders; then it passes without any. With [`Duration::MAX`], the same sights lead to the same drives.
    pub patience: Duration,
    /// How the robot follows its orders.
    pub following: Following,
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
    following: Following,
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

    fn following(&self) -> Following {
        self.following
    }
}

impl Execution {
    /// Begins a task in a world that looks like this. `seed` decides all random choices.
    ///
    /// # Errors
    /// The system has no thread for it.
    pub fn begin(
        layout: RobotLayout,
        body: RobotBody,
        task: Task,
        binding: Binding,
        sight: Sight,
        seed: u64,
        pace: ExecutionPace,
    ) -> io::Result<Self> {
        let (sights, seen) = channel();
        let (events, received) = channel();
        let plan = move || {
            let sender = events.clone();
            let mut stage = Correspondence {
                sight,
                following: pace.following,
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
            layout,
            pace,
            sights,
            events: SyncCell::new(received),
            expects_sight: false,
            is_planning: true,
            doing: None,
            result: None,
        })
    }

    /// The step that is being done; `None` before the first one.
    pub const fn doing(&self) -> Option<Doing> {
        self.doing
    }

    /// True while the next motion is being planned.
    pub const fn is_planning(&self) -> bool {
        self.is_planning
    }

    /// The result, once it has ended.
    pub const fn result(&self) -> Option<&Imitation> {
        self.result.as_ref()
    }

    /// The orders for the next tick, as soon as they are known. `None` if it is still planning, or over.
    fn orders(&mut self) -> Option<Vec<LimbOrder>> {
        loop {
            match self.events.get().recv_timeout(self.pace.patience) {
                Ok(ExecutionEvent::Doing(doing)) => self.doing = Some(doing),
                Ok(ExecutionEvent::Orders(orders)) => return Some(orders),
                Ok(ExecutionEvent::Over(imitation)) => self.result = Some(imitation),
                Err(RecvTimeoutError::Timeout) => return None,
                Err(RecvTimeoutError::Disconnected) => {
                    let step = self.doing.map_or(1, |doing| doing.step);
                    self.result.get_or_insert_with(|| Imitation {
                        failure: Some((step, PlanFailure::Stopped)),
                        ..Imitation::default()
                    });
                    return None;
                }
            }
        }
    }
}

impl Controller for Execution {
    fn act(&mut self, sight: &Sight) -> Drives {
        if self.result.is_some() {
            return Drives::new();
        }
        if self.expects_sight {
            // Nobody looks any more if it is over.
            drop(self.sights.send(sight.clone()));
        }
        let orders = self.orders();
        self.expects_sight = orders.is_some();
        self.is_planning = orders.is_none() && self.result.is_none();
        orders.map_or(Drives::new(), |orders| {
            self.pace.following.drives(&self.layout, sight, &orders)
        })
    }
}

#[cfg(test)]
mod tests {
    use tabletop_controller::{LimbSight, angles};
    use tabletop_core::{TICK_SECONDS, Table};
    use tabletop_kinematics::baxter;

    use super::*;
    use crate::stage::drives;

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
        Task::without_steps(Table::default())
    }

    fn begun(patience: Duration) -> (Execution, Sight) {
        let body = body();
        let sight = at_home(&body);
        let begun = Execution::begin(
            RobotLayout::baxter().clone(),
            body,
            nothing(),
            Binding::default(),
            sight.clone(),
            7,
            ExecutionPace {
                patience,
                following: Following::EXACT,
            },
        );
        (begun.unwrap(), sight)
    }

    #[test]
    fn tick_by_tick_it_does_the_same_as_at_a_stretch() {
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
        assert!(alone.1.len() > 30);

        let (mut execution, mut sight) = begun(Duration::MAX);
        for orders in &alone.1 {
            let expected = drives(RobotLayout::baxter(), orders);
            assert_eq!(execution.act(&sight), expected);
            sight = passed(sight, orders);
        }
        assert_eq!(execution.act(&sight), []);
        assert_eq!(execution.result(), Some(&at_a_stretch));
        assert!(!execution.is_planning());
    }

    #[test]
    fn a_tick_passes_without_drives_while_it_is_planning() {
        let (mut execution, sight) = begun(Duration::ZERO);
        let mut idle = 0;
        while execution.act(&sight).is_empty() {
            assert!(execution.is_planning());
            idle += 1;
            thread::sleep(Duration::from_millis(1));
        }
        assert!(!execution.is_planning());
        assert!(idle < 10_000);
    }
}
