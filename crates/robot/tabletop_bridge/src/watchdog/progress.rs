//! Whether a joint turns as it is ordered to, at any speed.

use std::collections::VecDeque;

use crate::tolerances::{LEAST_SHARE, LEAST_WAY, LONGEST_ANSWER, MOST_SHARE};

/// The way that a joint was ordered to turn, and a moment since which it is compared with the one that was measured.
#[derive(Clone, Debug, Default)]
pub(super) struct JointProgress {
    /// The time of the orders, in s, and their whole way, in rad; and what it was at each time of late.
    seconds: f64,
    ordered: f64,
    lately: VecDeque<(f64, f64)>,
    begun: Baseline,
}

/// The moment since which ways are compared.
#[derive(Clone, Copy, Debug, Default)]
struct Baseline {
    seconds: f64,
    angle: f64,
    /// The whole way that had been ordered by then, and the part of it that must have shown.
    ordered: f64,
    shown: f64,
}

impl JointProgress {
    /// A joint at this angle that has not been ordered to turn.
    pub fn at(angle: f64) -> Self {
        Self {
            begun: Baseline {
                angle,
                ..Baseline::default()
            },
            ..Self::default()
        }
    }

    /// A joint that is at an angle is ordered to turn at a speed, in rad/s, for some seconds. False if what it was ordered some time ago does not show.
    pub fn is_followed(&mut self, angle: f64, speed: f64, seconds: f64) -> bool {
        // Ways are compared in one direction.
        if speed * (self.ordered - self.begun.ordered) < 0.0 {
            self.begin(angle);
        }
        self.seconds += seconds;
        self.ordered += speed * seconds;
        self.lately.push_back((self.seconds, self.ordered));
        if self.seconds < self.begun.seconds + LONGEST_ANSWER {
            return true;
        }
        let must_show = self.shown() - self.begun.ordered;
        let ordered = self.ordered - self.begun.ordered;
        if must_show.abs() < LEAST_WAY {
            return true;
        }
        // What had been ordered before may show only now.
        let direction = ordered.signum();
        let owed = (self.begun.ordered - self.begun.shown) * direction;
        let way = (angle - self.begun.angle) * direction;
        let least = LEAST_SHARE * must_show.abs() + owed.min(0.0);
        let most = MOST_SHARE * ordered.abs() + owed.max(0.0);
        self.begin(angle);
        (least..=most).contains(&way)
    }

    /// The way that was ordered so long ago that it must have shown.
    fn shown(&mut self) -> f64 {
        let until = self.seconds - LONGEST_ANSWER;
        while self.lately.get(1).is_some_and(|(at, _)| *at <= until) {
            self.lately.pop_front();
        }
        match self.lately.front() {
            Some((at, ordered)) if *at <= until => *ordered,
            Some(_) | None => 0.0,
        }
    }

    fn begin(&mut self, angle: f64) {
        self.begun = Baseline {
            seconds: self.seconds,
            angle,
            ordered: self.ordered,
            shown: self.shown(),
        };
    }
}
