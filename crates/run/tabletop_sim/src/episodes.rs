//! Numbered episodes, on several threads, their results in order.

use std::{sync::mpsc, thread};

/// Runs the episode of each number, so many at a time, and hands over the results in the order of the numbers. No thread is more than two
/// episodes ahead, so results do not pile up. The first error, in this order, ends it. A single one at a time runs on this thread.
///
/// # Errors
/// The first error of an episode, or of `done`.
pub fn run_episodes<T: Send, E: Send>(
    numbers: impl IntoIterator<Item = u64, IntoIter: Clone + Send>,
    at_a_time: usize,
    episode: impl Fn(u64) -> Result<T, E> + Sync,
    mut done: impl FnMut(u64, T) -> Result<(), E>,
) -> Result<(), E> {
    let mut numbers = numbers.into_iter();
    if at_a_time <= 1 {
        return numbers.try_for_each(|number| done(number, episode(number)?));
    }
    thread::scope(|scope| {
        let workers = (0..at_a_time).map(|first| {
            let (sender, results) = mpsc::sync_channel(1);
            let (numbers, episode) = (numbers.clone(), &episode);
            scope.spawn(move || {
                for number in numbers.skip(first).step_by(at_a_time) {
                    let result = episode(number);
                    let is_last = result.is_err();
                    if sender.send((number, result)).is_err() || is_last {
                        break;
                    }
                }
            });
            results
        });
        let workers: Vec<_> = workers.collect();
        for results in workers.iter().cycle() {
            let Ok((number, result)) = results.recv() else {
                // There are no more numbers.
                break;
            };
            done(number, result?)?;
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
            Ok(())
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
            let result = run_episodes(0.., at_a_time, episode, |number, ()| {
                last = Some(number);
                Ok(())
            });
            assert_eq!(result, Err("five"));
            assert!(last.is_none_or(|last| last < 5), "{last:?}");
            assert!(at_a_time > 1 || begun.load(Ordering::Relaxed) == 6);
        }
    }

    #[test]
    fn without_numbers_nothing_happens() {
        let result = run_episodes(0..0, 3, |_| Err::<(), _>("an episode"), |_, ()| Ok(()));
        assert_eq!(result, Ok(()));
    }
}
