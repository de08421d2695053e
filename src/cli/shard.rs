//! Shares of the work of a command, for several machines.

use clap::Args;

/// A share of the work.
#[derive(Args, Clone)]
pub(super) struct ShardOption {
    /// Do only share I, from 0, of N equal shares of the work, each of them by another machine
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<Shard>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Shard {
    number: u64,
    count: u64,
}

impl ShardOption {
    /// The numbers that are in this share.
    pub fn share_of(
        &self,
        numbers: impl Iterator<Item = u64> + Clone + Send,
    ) -> impl Iterator<Item = u64> + Clone + Send {
        let shard = self.shard.unwrap_or(Shard {
            number: 0,
            count: 1,
        });
        numbers.filter(move |number| number % shard.count == shard.number)
    }
}

fn shard(text: &str) -> Result<Shard, String> {
    let expected = || format!("expected I/N, such as 0/4, with I from 0 to N - 1, not {text:?}");
    let (number, count) = text.split_once('/').ok_or_else(expected)?;
    let read = |text: &str| text.parse::<u64>().map_err(|_| expected());
    let shard = Shard {
        number: read(number)?,
        count: read(count)?,
    };
    match shard.number < shard.count {
        true => Ok(shard),
        false => Err(expected()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_all_of_the_work_and_do_not_overlap() {
        let share = |number| {
            let shard = Some(Shard { number, count: 3 });
            ShardOption { shard }.share_of(0..10).collect::<Vec<_>>()
        };
        assert_eq!([share(0), share(1), share(2)].concat().len(), 10);
        assert_eq!(share(1), [1, 4, 7]);
        let all = ShardOption { shard: None };
        assert_eq!(all.share_of(0..10).count(), 10);
    }

    #[test]
    fn a_share_is_one_of_its_number() {
        assert_eq!(
            shard("2/3"),
            Ok(Shard {
                number: 2,
                count: 3
            })
        );
        for text in ["3/3", "0/0", "1", "-1/3", "a/b", "", "1/2/3"] {
            assert!(shard(text).is_err(), "{text}");
        }
    }
}
