//! Ranges of the numbers of options. Help texts state them, and refusals repeat them.

use std::{ffi::OsStr, fmt, str::FromStr};

use clap::{Arg, Command, builder::TypedValueParser};

/// The seeds of everything random.
pub(super) const SEEDS: NumberRange<u64> = NumberRange::whole(0, u64::MAX);

/// The numbers that an option takes.
#[derive(Clone, Copy)]
pub(super) struct NumberRange<T> {
    kind: &'static str,
    least: T,
    most: T,
    unit: &'static str,
}

impl<T> NumberRange<T> {
    /// Whole numbers, the last one included.
    pub const fn whole(least: T, most: T) -> Self {
        Self {
            kind: "a whole number",
            least,
            most,
            unit: "",
        }
    }

    /// Numbers with decimals, the last one included.
    pub const fn decimal(least: T, most: T) -> Self {
        Self {
            kind: "a number",
            least,
            most,
            unit: "",
        }
    }

    /// The same, of this unit.
    #[must_use]
    pub const fn of(self, unit: &'static str) -> Self
    where
        T: Copy,
    {
        Self { unit, ..self }
    }
}

impl<T: FromStr + PartialOrd + fmt::Display> NumberRange<T> {
    /// Reads a number of the range.
    pub fn read(&self, text: &str) -> Result<T, String> {
        let number = text.parse().ok();
        number
            .filter(|number| (&self.least..=&self.most).contains(&number))
            .ok_or_else(|| format!("expected {} {self}", self.kind))
    }
}

impl<T: fmt::Display> fmt::Display for NumberRange<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "from {} to {}", self.least, self.most)?;
        match self.unit {
            "" => Ok(()),
            unit => write!(f, " {unit}"),
        }
    }
}

impl<T> TypedValueParser for NumberRange<T>
where
    T: FromStr + PartialOrd + fmt::Display + Copy + Send + Sync + 'static,
{
    type Value = T;

    fn parse_ref(
        &self,
        command: &Command,
        option: Option<&Arg>,
        value: &OsStr,
    ) -> Result<T, clap::Error> {
        let range = *self;
        (move |text: &str| range.read(text)).parse_ref(command, option, value)
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::{super::Cli, *};

    #[test]
    fn numbers_of_the_range_are_read_and_all_others_refused_with_it() {
        let jobs = NumberRange::<u8>::whole(1, 200);
        assert_eq!(jobs.read("1"), Ok(1));
        assert_eq!(jobs.read("200"), Ok(200));
        for text in ["0", "201", "1000", "-1", "1.5", "", "many"] {
            let expected = "expected a whole number from 1 to 200";
            assert_eq!(jobs.read(text), Err(expected.to_owned()), "{text:?}");
        }
        let length = NumberRange::<f32>::decimal(0.0, 0.5).of("units");
        assert_eq!(length.read("0.5"), Ok(0.5));
        for text in ["0.51", "-0.1", "NaN", "inf", "1e99"] {
            let expected = "expected a number from 0 to 0.5 units";
            assert_eq!(length.read(text), Err(expected.to_owned()), "{text:?}");
        }
    }

    /// The message that refuses a value of an option.
    fn refusal(option: &Arg, value: &str) -> Option<String> {
        let alone = Arg::new("alone")
            .allow_hyphen_values(true)
            .value_parser(option.get_value_parser().clone());
        let command = Command::new("alone").arg(alone);
        let read = command.try_get_matches_from(["alone", value]);
        read.err().map(|error| error.to_string())
    }

    fn takes(option: &Arg, value: &str) -> bool {
        refusal(option, value).is_none()
    }

    fn takes_numbers(option: &Arg) -> bool {
        let numbers = ["0.2", "2", "50", "320x200", "1,2,3"];
        numbers.iter().any(|number| takes(option, number)) && !takes(option, "none")
    }

    /// The options of all commands that take numbers, by command and name.
    fn options() -> Vec<(String, Arg)> {
        let mut options = Vec::new();
        let mut commands = vec![Cli::command()];
        while let Some(command) = commands.pop() {
            for option in command.get_arguments().filter(|it| takes_numbers(it)) {
                let name = format!("{} {}", command.get_name(), option.get_id());
                options.push((name, option.clone()));
            }
            commands.extend(command.get_subcommands().cloned());
        }
        options
    }

    /// The range in a refusal, such as `from 1 to 8`, or the list of values.
    fn range(refusal: &str) -> Option<String> {
        let (_, expected) = refusal.split_once("expected ")?;
        let expected = expected.lines().next()?;
        let Some(from) = expected.find("from ") else {
            return Some(expected.to_owned());
        };
        let words: Vec<_> = expected[from..].split([' ', ',']).take(4).collect();
        Some(words.join(" "))
    }

    #[test]
    fn every_number_states_its_range_in_help_and_refusal() {
        let options = options();
        assert!(options.len() >= 20, "{}", options.len());
        for (name, option) in options {
            let refusal = refusal(&option, "none").unwrap();
            let Some(range) = range(&refusal) else {
                panic!("{name} refuses without a range: {refusal}");
            };
            let help = option.get_help().map(ToString::to_string);
            let help = help.unwrap_or_default();
            assert!(help.contains(&range), "{name}: {range}: {help}");
        }
    }

    #[test]
    fn a_number_below_zero_is_refused_as_a_number() {
        for (name, option) in options() {
            let is_one_number = takes(&option, "0.2") || takes(&option, "2");
            let is_range = refusal(&option, "none").unwrap().contains("from ");
            if is_one_number && is_range {
                assert!(option.is_allow_negative_numbers_set(), "{name}");
            }
        }
    }
}
