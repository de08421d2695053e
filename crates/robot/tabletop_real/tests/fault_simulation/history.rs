//! What happens in a trial.

use std::{fmt, time::Duration};

use tabletop_core::Random;

/// The length of a trial, in periods of the watchdog.
pub const TICKS: u64 = 200;

/// What happens in a trial.
#[derive(Clone, Debug)]
pub struct History {
    /// The share of the greatest speeds.
    pub share: f64,
    /// Noise of the measured angles, in rad.
    pub noise: f64,
    /// How long states and commands are on their way.
    pub state_delay: Duration,
    pub command_delay: Duration,
    /// Seconds of the robot's clock in one of the wall clock's.
    pub pace: f64,
    pub events: Vec<Event>,
}

/// Something that happens at a tick.
#[derive(Clone, Debug)]
pub struct Event {
    pub tick: u64,
    pub what: What,
}

#[derive(Clone, Debug)]
pub enum What {
    /// The program turns a limb's joints.
    Turn(usize, Vec<f64>),
    /// The program sends a limb to angles: these changes of what is measured.
    Go(usize, Vec<f64>),
    /// The program moves a gripper.
    Grip(usize, f64),
    /// The program lets all rest.
    Rest,
    /// The program sets no target any more.
    Silence,
    Fault(Fault),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    EmergencyStop,
    Disabled,
    Error,
    SilentStates,
    SilentHealth,
    SilentGripper,
    GripperError,
    /// The encoder of a joint begins anew, elsewhere.
    Restart(usize, usize),
    /// A second publisher says something else.
    SecondPublisher,
    /// A joint is stuck.
    Stuck(usize, usize),
    /// Commands do not reach it.
    Deaf,
    /// This computer stands still for so many ticks.
    Stall(u64),
    /// A signal ends the program.
    Signal,
    /// The connection ends.
    Lost,
}

impl History {
    /// The history of a seed.
    pub fn draw(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut events = Vec::new();
        let mut tick = 0;
        while tick < TICKS {
            let what = order(&mut random);
            events.push(Event { tick, what });
            tick += 5 + random.bits() % 60;
        }
        if !random.bits().is_multiple_of(4) {
            let tick = random.bits() % TICKS;
            let what = What::Fault(fault(&mut random));
            events.push(Event { tick, what });
            events.sort_by_key(|event| event.tick);
        }
        let ms = |number: u64| Duration::from_millis(number);
        Self {
            share: random.one_of([0.1, 0.3, 0.3, 1.0]),
            noise: random.one_of([0.0, 0.0, 5e-4, 2e-3]),
            state_delay: ms(random.one_of([0, 0, 2, 10, 20])),
            command_delay: ms(random.one_of([0, 0, 2, 10])),
            pace: random.one_of([1.0, 1.0, 1.0, 0.95]),
            events,
        }
    }
}

fn order(random: &mut Random) -> What {
    let limb = (random.bits() % 2) as usize;
    let size = random.one_of([0.05_f32, 0.3, 1.0, 9.0]);
    let mut each = |size: f32| -> Vec<f64> {
        let all = (0..7).map(|_| f64::from(random.between((-size, size))));
        all.collect()
    };
    let numbers = each(size);
    match random.bits() % 8 {
        0..4 => What::Turn(limb, numbers),
        4 | 5 => What::Go(limb, numbers),
        6 => What::Grip(limb, f64::from(random.between((0.0, 1.0)))),
        _ if random.one_of([true, false, false]) => What::Silence,
        _ => What::Rest,
    }
}

fn fault(random: &mut Random) -> Fault {
    let (limb, joint) = ((random.bits() % 2) as usize, (random.bits() % 7) as usize);
    random.one_of([
        Fault::EmergencyStop,
        Fault::Disabled,
        Fault::Error,
        Fault::SilentStates,
        Fault::SilentHealth,
        Fault::SilentGripper,
        Fault::GripperError,
        Fault::Restart(limb, joint),
        Fault::SecondPublisher,
        Fault::Stuck(limb, joint),
        Fault::Deaf,
        Fault::Stall(11 + joint as u64 * 3),
        Fault::Signal,
        Fault::Lost,
    ])
}

impl fmt::Display for History {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "share {}, noise {} rad, states after {:?}, commands after {:?}, pace {}",
            self.share, self.noise, self.state_delay, self.command_delay, self.pace
        )?;
        for Event { tick, what } in &self.events {
            writeln!(f, "  {tick:4}: {what:?}")?;
        }
        Ok(())
    }
}
