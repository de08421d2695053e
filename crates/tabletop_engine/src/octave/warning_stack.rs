//! The places that Octave adds to a warning, without those in the driver.

use crate::octave::stubs;

/// Looks through the lines of the standard error.
#[derive(Debug, Default)]
pub(crate) struct WarningStack {
    /// The line before the places, while there has been none of the script's.
    title: Option<Vec<u8>>,
    listing: bool,
}

impl WarningStack {
    /// Takes a line and calls `each` with the rest of it.
    pub(crate) fn feed(&mut self, line: &[u8], mut each: impl FnMut(&[u8])) {
        if line.ends_with(b": called from") {
            self.title = Some(line.to_owned());
            self.listing = true;
            return;
        }
        let function = function(line).filter(|_| self.listing);
        if function.is_some_and(is_of_driver) {
            return;
        }
        if function.is_some()
            && let Some(title) = self.title.take()
        {
            each(&title);
        }
        let after = self.listing && line.is_empty();
        self.listing &= function.is_some();
        if !after {
            each(line);
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
}
