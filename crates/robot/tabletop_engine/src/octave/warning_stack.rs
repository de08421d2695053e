//! The places that Octave adds to a warning, without those in the driver.

use crate::octave::stubs;

/// Looks through the lines of the standard error.
#[derive(Debug, Default)]
pub(crate) enum WarningStack {
    /// There is no list of places.
    #[default]
    Absent,
    /// This line may begin a list.
    Begun(Vec<u8>),
    /// The list that this line has begun has had places in the driver only.
    OfDriver(Vec<u8>),
    /// The list has had places in the script.
    OfScript,
}

impl WarningStack {
    /// Takes a line and calls `each` with every line that is to be shown.
    pub(crate) fn feed(&mut self, line: &[u8], mut each: impl FnMut(&[u8])) {
        let before = std::mem::take(self);
        if line.ends_with(b": called from") {
            before.finish(each);
            *self = Self::Begun(line.to_owned());
            return;
        }
        match (before, function(line)) {
            (Self::Begun(title) | Self::OfDriver(title), Some(function)) => {
                if is_of_driver(function) {
                    *self = Self::OfDriver(title);
                } else {
                    each(&title);
                    each(line);
                    *self = Self::OfScript;
                }
            }
            (Self::OfScript, Some(function)) => {
                if !is_of_driver(function) {
                    each(line);
                }
                *self = Self::OfScript;
            }
            // An empty line ends a list.
            (Self::OfDriver(_) | Self::OfScript, None) if line.is_empty() => {}
            (before @ (Self::Absent | Self::Begun(_) | Self::OfDriver(_) | Self::OfScript), _) => {
                before.finish(&mut each);
                each(line);
            }
        }
    }

    /// Calls `each` with the line that was kept because it might have begun a list.
    pub(crate) fn finish(self, mut each: impl FnMut(&[u8])) {
        match self {
            Self::Begun(title) => each(&title),
            Self::Absent | Self::OfDriver(_) | Self::OfScript => {}
        }
    }
}

/// The function of "    name at line 3 column 1".
fn function(line: &[u8]) -> Option<&str> {
    let (function, _) = str::from_utf8(line).ok()?.split_once(" at line ")?;
    function.strip_prefix("    ")
}

/// True if a function is one of the driver's, by its name.
fn is_of_driver(function: &str) -> bool {
    let file = function.split('>').next().unwrap_or_default();
    file.starts_with("tabletop_") || file == "savepath" || stubs::warns(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left(lines: &[&str]) -> Vec<String> {
        let mut frames = WarningStack::default();
        let mut all = Vec::new();
        for line in lines {
            frames.feed(line.as_bytes(), |line| {
                all.push(String::from_utf8_lossy(line).into_owned());
            });
        }
        frames.finish(|line| all.push(String::from_utf8_lossy(line).into_owned()));
        all
    }

    #[test]
    fn the_driver_is_not_shown() {
        let own = "    tabletop_init>tabletop_pair at line 24 column 1";
        assert_eq!(
            left(&["warning: x", "warning: called from", own, "", "", "more"]),
            ["warning: x", "", "more"]
        );
        let theirs = "    helper at line 2 column 1";
        assert_eq!(
            left(&["warning: called from", theirs, own, "", "more"]),
            ["warning: called from", theirs, "more"]
        );
        assert_eq!(left(&[own, theirs]), [own, theirs]);
    }

    #[test]
    fn a_line_that_begins_no_list_is_shown() {
        for lines in [
            &["he was: called from", "", "more"][..],
            &["a: called from", "b: called from", "    c"],
            &["a: called from"],
        ] {
            assert_eq!(left(lines), lines);
        }
    }
}
