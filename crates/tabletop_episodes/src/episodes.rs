//! Numbered episodes, each in a world of its own, on several threads.

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError, mpsc},
    thread,
};

/// Runs the episode of each number, so many at a time, and hands over the results in the order of the numbers. The first error ends it: no
/// further episode begins. A single one at a time runs on this thread.
///
/// # Errors
/// The first error of an episode.
pub fn run_episodes<T: Send, E: Send>(
    numbers: impl IntoIterator<Item = u64, IntoIter: Send>,
    at_a_time: usize,
    episode: impl Fn(u64) -> Result<T, E> + Sync,
    mut done: impl FnMut(u64, T),
) -> Result<(), E> {
    let mut numbers = numbers.into_iter();
    if at_a_time <= 1 {
        return numbers.try_for_each(|number| {
            done(number, episode(number)?);
            Ok(())
        });
    }
    let numbers = Mutex::new(numbers.enumerate());
    let next = || {
        let mut numbers = numbers.lock().unwrap_or_else(PoisonError::into_inner);
        numbers.next()
    };
    let (sender, results) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..at_a_time {
            let sender = sender.clone();
            let (next, episode) = (&next, &episode);
            scope.spawn(move || {
                while let Some((turn, number)) = next() {
                    let result = episode(number);
                    let is_last = result.is_err();
                    if sender.send((turn, number, result)).is_err() || is_last {
                        break;
                    }
                }
            });
        }
        drop(sender);
        // Results that have come before their turn.
        let mut early = BTreeMap::new();
        let mut due = 0;
        for (turn, number, result) in results {
            early.insert(turn, (number, result?));
            while let Some((number, result)) = early.remove(&due) {
                done(number, result);
                due += 1;
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use std::{
        sync::atomic::{AtomicU64, Ordering},
        time::Duration,
    };

    use super::*;

    #[test]
    fn results_come_in_the_order_of_their_numbers() {
        let mut found = Vec::new();
        let later_ones_are_faster = |number: u64| {
            thread::sleep(Duration::from_millis(20 - number));
            Ok::<_, ()>(number * number)
        };
        let result = run_episodes(3..20, 4, later_ones_are_faster, |number, square| {
            found.push((number, square));
        });
        assert_eq!(result, Ok(()));
        let expected: Vec<_> = (3..20).map(|number| (number, number * number)).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn the_first_error_ends_it() {
        for at_a_time in [1, 4] {
            let begun = AtomicU64::new(0);
            let episode = |number| {
                begun.fetch_add(1, Ordering::Relaxed);
                match number {
                    5 => Err("five"),
                    _ => Ok(()),
                }
            };
            let mut last = None;
            let result = run_episodes(0.., at_a_time, episode, |number, ()| last = Some(number));
            assert_eq!(result, Err("five"));
            assert!(last.is_none_or(|last| last < 5), "{last:?}");
            assert!(at_a_time > 1 || begun.load(Ordering::Relaxed) == 6);
        }
    }

    #[test]
    fn without_numbers_nothing_happens() {
        let result = run_episodes(0..0, 3, |_| Err::<(), _>("an episode"), |_, ()| {});
        assert_eq!(result, Ok(()));
    }
}
