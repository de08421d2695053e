//! Steps of keys that stay down, and of what a gamepad pushes.

use std::time::Duration;

use tabletop_user::{Action, Keys};

/// The time after which a key that stays down repeats its step.
const DELAY: Duration = Duration::from_millis(300);

/// The most steps in a frame, so that a slow one does not throw things.
const MOST_STEPS: u32 = 6;

/// The repeats of keys that stay down, and of what a gamepad pushes.
#[derive(Default)]
pub(super) struct Repeats {
    /// The time of the next one.
    next: Duration,
    /// The time of the last frame.
    last: Duration,
    /// The parts of steps that a gamepad has pushed.
    pushed: [f32; 3],
}

/// The keys in a frame, by which things go in steps along three axes.
pub(super) struct StepKeys<'a> {
    pub keys: &'a Keys<'a>,
    /// The actions along each axis, forth and back.
    pub actions: &'a [[Action; 2]; 3],
    /// The time between two steps of a key that stays down.
    pub every: Duration,
    pub now: Duration,
}

impl Repeats {
    /// The steps in this frame along each axis.
    pub(super) fn steps(&mut self, frame: &StepKeys) -> [i32; 3] {
        let pushed = self.pushed_steps(frame);
        let struck = self.struck_steps(frame);
        std::array::from_fn(|axis| pushed[axis] + struck[axis])
    }

    /// The steps of sticks and triggers, which move the faster the farther they are pushed.
    fn pushed_steps(&mut self, frame: &StepKeys) -> [i32; 3] {
        let passed = frame
            .now
            .saturating_sub(self.last)
            .div_duration_f32(frame.every);
        let passed = passed.min(MOST_STEPS as f32);
        self.last = frame.now;
        std::array::from_fn(|axis| {
            let [plus, minus] = frame.actions[axis];
            let pushed = match frame.keys.push(plus, minus) {
                0.0 => 0.0,
                push => self.pushed[axis] + push * passed,
            };
            self.pushed[axis] = pushed.fract();
            pushed.trunc() as i32
        })
    }

    fn struck_steps(&mut self, frame: &StepKeys) -> [i32; 3] {
        let struck = frame.actions.map(|[plus, minus]| {
            i32::from(frame.keys.was_struck(plus)) - i32::from(frame.keys.was_struck(minus))
        });
        if struck != [0; 3] {
            self.next = frame.now + DELAY;
            return struck;
        }
        let held = frame
            .actions
            .map(|[plus, minus]| frame.keys.axis(plus, minus) as i32);
        let mut steps = 0;
        while held != [0; 3] && self.next <= frame.now && steps < MOST_STEPS {
            self.next += frame.every;
            steps += 1;
        }
        if self.next <= frame.now {
            self.next = frame.now + frame.every;
        }
        held.map(|way| way * steps as i32)
    }
}
