//! Code for one platform has its other side for the rest: each `#[cfg(unix)]` and its like has its `#[cfg(not(unix))]` in the same file,
//! which says what is missing there.

use crate::source::{Source, program};

/// Conditions on the platform.
const PLATFORMS: [&str; 4] = ["unix", "windows", "target_os", "target_family"];

#[test]
fn no_platform_is_left_out() {
    for (file, source) in program() {
        for condition in &source.conditions {
            let other = match condition.strip_prefix("not(") {
                Some(positive) => positive.trim_end_matches(')').to_owned(),
                None => format!("not({condition})"),
            };
            let is_of_platform = PLATFORMS.iter().any(|name| condition.contains(name));
            assert!(
                !is_of_platform || source.conditions.contains(&other),
                "{}: cfg({condition}) without cfg({other})",
                file.display()
            );
        }
    }
}

#[test]
fn conditions_are_found_outside_tests() {
    let text = "#[cfg(unix)] fn f() {} mod m { #[cfg(not(unix))] fn f() {} } #[cfg(test)] mod tests { #[cfg(windows)] fn f() {} }";
    let conditions = Source::parse(text).conditions;
    assert_eq!(conditions, ["not(unix)", "unix"].map(String::from).into());
}
