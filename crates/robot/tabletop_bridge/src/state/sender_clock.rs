//! The sender's clock beside ours.
//!
//! The two differ by an unknown time, and a simulator's goes slower. So what is known of a message is how much longer it was on its way than the quickest
//! ones: the line below all of them, of arrival over stamp, is the sender's clock.

use std::{collections::VecDeque, time::Duration};

use crate::tolerances::{CLOCK_SPAN, CLOCK_SPANS, SHORTEST_CLOCK};

/// See the module. Times are in s.
#[derive(Debug, Default)]
pub(super) struct SenderClock {
    /// The quickest message of each span, the oldest first.
    quickest: VecDeque<Sent>,
    /// Seconds of ours for one of the sender's.
    rate: Option<f64>,
}

/// A message: when it was sent by the sender's clock, and when it arrived by ours, in s.
#[derive(Clone, Copy, Debug)]
struct Sent {
    sent: f64,
    at: f64,
}

impl Sent {
    /// The slope of the line to a later one.
    fn slope(self, later: Self) -> f64 {
        (later.at - self.at) / (later.sent - self.sent)
    }
}

impl SenderClock {
    /// How much longer a message was on its way than the quickest one.
    pub fn excess(&mut self, sent: Duration, at: Duration) -> Duration {
        let now = Sent {
            sent: sent.as_secs_f64(),
            at: at.as_secs_f64(),
        };
        // The sender has begun anew, as a simulator does.
        if self
            .quickest
            .back()
            .is_some_and(|last| now.sent < last.sent - 1.0)
        {
            *self = Self::default();
        }
        self.note(now);
        let rate = self.rate();
        let least = self.quickest.iter().map(|it| it.at - rate * it.sent);
        let least = least.fold(now.at - rate * now.sent, f64::min);
        Duration::try_from_secs_f64(now.at - rate * now.sent - least).unwrap_or_default()
    }

    /// Seconds of the sender's time in one of ours.
    pub fn pace(&self) -> f64 {
        1.0 / self.rate()
    }

    fn rate(&self) -> f64 {
        self.rate.unwrap_or(1.0)
    }

    /// Keeps a message if it is the quickest of its span.
    fn note(&mut self, now: Sent) {
        let rate = self.rate();
        match self.quickest.back_mut() {
            Some(last) if now.at - span_start(last.at) < CLOCK_SPAN.as_secs_f64() => {
                if now.at - rate * now.sent < last.at - rate * last.sent {
                    *last = now;
                }
            }
            Some(_) | None => {
                self.quickest.push_back(now);
                if self.quickest.len() > CLOCK_SPANS {
                    self.quickest.pop_front();
                }
                self.rate = self.lower_edge();
            }
        }
    }

    /// The slope of the edge of the lower convex hull that is below the middle: messages at the ends may be late.
    fn lower_edge(&self) -> Option<f64> {
        let mut hull: Vec<Sent> = Vec::new();
        for &point in &self.quickest {
            if hull.last().is_some_and(|last| point.sent <= last.sent) {
                continue;
            }
            while let [.., a, b] = hull[..]
                && a.slope(point) <= a.slope(b)
            {
                hull.pop();
            }
            hull.push(point);
        }
        let (first, last) = (hull.first()?, hull.last()?);
        if last.at - first.at < SHORTEST_CLOCK.as_secs_f64() {
            return None;
        }
        let middle = f64::midpoint(first.sent, last.sent);
        let edge = hull.windows(2).find(|edge| edge[1].sent >= middle)?;
        let slope = edge[0].slope(edge[1]);
        (slope.is_finite() && slope > 0.0).then_some(slope)
    }
}

/// The beginning of the span in which a moment is.
fn span_start(at: f64) -> f64 {
    let span = CLOCK_SPAN.as_secs_f64();
    (at / span).floor() * span
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The greatest excess, in s, after the first second, of messages 100 times a second of a clock with this rate that are delayed by some time.
    fn greatest(pace: f64, delay: impl Fn(usize) -> f64) -> f64 {
        let mut clock = SenderClock::default();
        let excess = (0..3000).map(|number| {
            let at = 50.0 + number as f64 / 100.0;
            let sent = Duration::from_secs_f64(1000.0 + pace * (at - 50.0));
            let at = Duration::from_secs_f64(at + delay(number));
            (number, clock.excess(sent, at).as_secs_f64())
        });
        let late = excess.filter(|(number, _)| *number > 120);
        late.map(|(_, excess)| excess).fold(0.0, f64::max)
    }

    /// Up to 8 ms, which look random.
    fn jitter(number: usize) -> f64 {
        0.008 * (number as f64 * 0.618_034).fract()
    }

    #[test]
    fn a_slow_or_drifting_clock_makes_no_message_old() {
        for pace in [0.3, 0.95, 0.999, 1.0, 1.001, 1.3] {
            let excess = greatest(pace, jitter);
            assert!(excess < 0.02, "{pace}: {excess}");
        }
    }

    #[test]
    fn messages_that_begin_to_be_late_are_known_by_it() {
        for pace in [0.95, 1.0] {
            let excess = greatest(pace, |number| {
                jitter(number) + f64::from(u8::from(number == 1500)) * 0.3
            });
            assert!((0.28..0.32).contains(&excess), "{pace}: {excess}");
            let growing = greatest(pace, |number| {
                jitter(number) + (number.max(1500) - 1500) as f64 * 0.005
            });
            assert!(growing > 0.2, "{pace}: {growing}");
        }
    }

    #[test]
    fn a_backlog_at_the_start_is_soon_forgotten() {
        let mut clock = SenderClock::default();
        for number in 0..300 {
            let sent = 1000.0 + f64::from(number) / 100.0;
            // What was sent before 0.8 s arrives at once then.
            let at = 50.0 + (f64::from(number) / 100.0).max(0.8);
            let excess = clock.excess(Duration::from_secs_f64(sent), Duration::from_secs_f64(at));
            assert!(
                number < 80 || excess.as_secs_f64() < 0.02,
                "{number}: {excess:?}"
            );
        }
    }

    #[test]
    fn a_clock_that_begins_anew_is_another_one() {
        let mut clock = SenderClock::default();
        let second = Duration::from_secs;
        for moment in 0..20 {
            clock.excess(second(1000 + moment), second(moment));
        }
        assert_eq!(clock.excess(second(3), second(20)), Duration::ZERO);
    }
}
