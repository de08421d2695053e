//! The run of a test binary.

use std::{
    collections::BTreeSet,
    env,
    process::ExitCode,
    sync::{PoisonError, RwLock},
};

use libtest_mimic::{Arguments, Completion, Failed, Trial};

use crate::prerequisite::Prerequisite;

/// The variable that makes a missing tool an error if it is 1, so that no test is ignored.
pub const REQUIRE_ALL: &str = "TABLETOP_REQUIRE_ALL";

/// A test that `test_with` has registered.
#[derive(Debug)]
pub struct RegisteredTest {
    /// Its path, from the crate on.
    pub name: &'static str,
    /// Its prerequisites.
    pub prerequisites: &'static [Prerequisite],
    /// The test itself, which panics if it fails.
    pub run: fn(),
}

inventory::collect!(RegisteredTest);

/// What tests share that run beside each other, and a test in real time has alone.
static MACHINE: RwLock<()> = RwLock::new(());

/// The treatment of a test without its prerequisites.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LackPolicy {
    Ignore,
    Fail,
}

/// Runs the tests of this binary, with the options of `cargo test`.
///
/// # Panics
/// The binary has no tests.
#[expect(clippy::print_stdout, reason = "it is a test harness")]
pub fn run() -> ExitCode {
    let arguments = Arguments::from_args();
    let tests = registered_tests();
    let missing = missing(&tests);
    let policy = LackPolicy::of_environment();
    let trials = tests.iter().map(|test| test.trial(&missing, policy));
    let conclusion = libtest_mimic::run(&arguments, trials.collect());
    if conclusion.num_ignored > 0 {
        let ignored = conclusion.num_ignored;
        println!("{ignored} ignored: this machine lacks {}\n", list(&missing));
    }
    conclusion.exit_code()
}

/// The tests of this binary, in the order of their names.
fn registered_tests() -> Vec<&'static RegisteredTest> {
    let mut tests: Vec<_> = inventory::iter::<RegisteredTest>.into_iter().collect();
    assert!(!tests.is_empty(), "no test is registered");
    tests.sort_by_key(|test| test.name);
    tests
}

fn missing(tests: &[&RegisteredTest]) -> BTreeSet<Prerequisite> {
    let all: BTreeSet<_> = tests.iter().flat_map(|test| test.prerequisites).collect();
    all.into_iter().copied().filter(|it| !it.is_met()).collect()
}

fn list<'a>(prerequisites: impl IntoIterator<Item = &'a Prerequisite>) -> String {
    let names: Vec<_> = prerequisites
        .into_iter()
        .map(Prerequisite::to_string)
        .collect();
    names.join(", ")
}

impl LackPolicy {
    fn of_environment() -> Self {
        match env::var(REQUIRE_ALL).as_deref() {
            Ok("1") => Self::Fail,
            _ => Self::Ignore,
        }
    }
}

impl RegisteredTest {
    fn trial(&'static self, missing: &BTreeSet<Prerequisite>, policy: LackPolicy) -> Trial {
        let lacks = self.lacks(missing);
        let (_, name) = self.name.split_once("::").unwrap_or(("", self.name));
        Trial::ignorable_test(name, move || self.outcome(&lacks, policy))
    }

    fn lacks(&self, missing: &BTreeSet<Prerequisite>) -> String {
        list(self.prerequisites.iter().filter(|it| missing.contains(it)))
    }

    /// Runs it beside others, or, if the other side does not wait for it, when no other one runs.
    fn run_in_turn(&self) {
        let is_in_real_time = self.prerequisites.iter().any(|it| it.is_in_real_time());
        let alone = is_in_real_time.then(|| MACHINE.write());
        let beside = (!is_in_real_time).then(|| MACHINE.read());
        // A test that has failed leaves nothing behind that others could see.
        let _alone = alone.map(|turn| turn.unwrap_or_else(PoisonError::into_inner));
        let _beside = beside.map(|turn| turn.unwrap_or_else(PoisonError::into_inner));
        (self.run)();
    }

    fn outcome(&self, lacks: &str, policy: LackPolicy) -> Result<Completion, Failed> {
        if lacks.is_empty() {
            self.run_in_turn();
            return Ok(Completion::Completed);
        }
        match policy {
            LackPolicy::Ignore => Ok(Completion::ignored_with(format!("needs {lacks}"))),
            LackPolicy::Fail => Err(format!("it needs {lacks}, and {REQUIRE_ALL} is 1").into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEST: RegisteredTest = RegisteredTest {
        name: "binary::a_test",
        prerequisites: &[Prerequisite::Octave, Prerequisite::Python],
        run: || panic!("it ran"),
    };

    fn outcome(missing: &[Prerequisite], policy: LackPolicy) -> Result<Completion, Failed> {
        TEST.outcome(&TEST.lacks(&missing.iter().copied().collect()), policy)
    }

    #[test]
    fn a_test_that_lacks_something_is_ignored_with_the_reason() {
        let missing = [Prerequisite::Python, Prerequisite::Perl];
        let Ok(Completion::Ignored { reason }) = outcome(&missing, LackPolicy::Ignore) else {
            panic!("it is not ignored");
        };
        assert_eq!(reason.unwrap(), "needs Python 3 (python3)");
    }

    #[test]
    fn a_test_that_lacks_something_fails_where_all_is_required() {
        let missing = [Prerequisite::Octave, Prerequisite::Python];
        let failed = outcome(&missing, LackPolicy::Fail).err().unwrap();
        let message = failed.message().unwrap();
        let lacks = "GNU Octave (octave-cli), Python 3 (python3)";
        assert!(message.contains(lacks), "{message}");
    }

    #[test]
    #[should_panic = "it ran"]
    fn a_test_that_lacks_nothing_runs() {
        drop(outcome(&[Prerequisite::Xmllint], LackPolicy::Ignore));
    }
}
