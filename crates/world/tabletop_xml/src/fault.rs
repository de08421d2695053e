//! Faults of task files, with their places.

mod position;

pub use position::Position;
pub(crate) use position::PositionCursor;

use std::{fmt, path::PathBuf};

use crate::origin::{Origin, Sources};

/// Largest number of faults of a file that are reported; one more fault then mentions that there are others.
pub const MAX_FAULTS: usize = 200;

/// A fault of a task file.
///
/// ```
/// use tabletop_xml::Fault;
///
/// let fault = Fault {
///     file: "task.xml".into(),
///     line: 3,
///     column: 10,
///     element: Some("block".into()),
///     attribute: Some("color".into()),
///     problem: "`reed` is not a colour".into(),
///     expected: "#rrggbb".into(),
///     instances: Vec::new(),
///     repeats: 0,
/// };
/// assert_eq!(
///     fault.to_string(),
///     "task.xml:3:10: block, color: `reed` is not a colour, expected #rrggbb"
/// );
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// Name of the faulty element; absent if the fault is in none.
    pub element: Option<String>,
    /// Name of the faulty attribute; absent if the fault is in none.
    pub attribute: Option<String>,
    /// The problem.
    pub problem: String,
    /// The expectation.
    pub expected: String,
    /// The instances of templates that brought the element, the innermost first.
    pub instances: Vec<Position>,
    /// Number of other instances with the same fault at the same place.
    pub repeats: usize,
}

impl fmt::Display for Fault {
    /// Writes `file:line:column: element, attribute: problem, expected expectation` on one line; then
    /// ` (in the instance at file:line:column)` if it is in one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            line,
            column,
            element,
            attribute,
            problem,
            expected,
            instances,
            repeats,
        } = self;
        write!(f, "{}:{line}:{column}: ", file.display())?;
        match (element, attribute) {
            (Some(element), Some(attribute)) => write!(f, "{element}, {attribute}: ")?,
            (Some(element), None) => write!(f, "{element}: ")?,
            (None, Some(attribute)) => write!(f, "{attribute}: ")?,
            (None, None) => {}
        }
        write!(f, "{problem}, expected {expected}")?;
        write_instances(f, instances, *repeats)
    }
}

fn write_instances(
    f: &mut fmt::Formatter<'_>,
    instances: &[Position],
    repeats: usize,
) -> fmt::Result {
    const MOST_SHOWN: usize = 4;
    let [innermost, outer @ ..] = instances else {
        return Ok(());
    };
    write!(f, " (in the instance at {innermost}")?;
    if instances.len() > MOST_SHOWN {
        f.write_str(", …")?;
    }
    for instance in &outer[outer.len().saturating_sub(MOST_SHOWN - 1)..] {
        write!(f, ", in that at {instance}")?;
    }
    if repeats > 0 {
        write!(f, ", and in {repeats} more")?;
    }
    f.write_str(")")
}

impl std::error::Error for Fault {}

/// A place in the text of a task file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a> {
    pub origin: Origin,
    pub element: Option<&'a str>,
    pub attribute: Option<&'a str>,
}

impl Place<'_> {
    /// A place in no element.
    pub const fn outside(source: usize, offset: usize) -> Self {
        Self {
            origin: Origin {
                source,
                offset,
                instance: None,
            },
            element: None,
            attribute: None,
        }
    }
}

/// The faults found so far, in any order.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    found: Vec<UnplacedFault>,
    first_left_out: Option<Origin>,
}

#[derive(Debug)]
struct UnplacedFault {
    origin: Origin,
    element: Option<String>,
    attribute: Option<String>,
    problem: String,
    expected: String,
    repeats: usize,
}

impl UnplacedFault {
    /// True if it is the same fault, from another instance.
    fn is_repeated_by(&self, other: &Self) -> bool {
        let (mine, others) = (self.origin, other.origin);
        mine.instance.is_some()
            && others.instance.is_some()
            && (mine.source, mine.offset) == (others.source, others.offset)
            && self.attribute == other.attribute
            && self.problem == other.problem
    }
}

impl Faults {
    /// True if no more faults are kept.
    pub fn is_full(&self) -> bool {
        self.found.len() >= MAX_FAULTS
    }

    /// Notes a fault.
    pub fn report(
        &mut self,
        place: Place,
        problem: impl fmt::Display,
        expected: impl fmt::Display,
    ) {
        if self.is_full() {
            self.first_left_out.get_or_insert(place.origin);
            return;
        }
        let name = |name: &str| Excerpt(name).to_string();
        let fault = UnplacedFault {
            origin: place.origin,
            element: place.element.map(name),
            attribute: place.attribute.map(name),
            problem: problem.to_string(),
            expected: expected.to_string(),
            repeats: 0,
        };
        match self
            .found
            .iter_mut()
            .find(|found| found.is_repeated_by(&fault))
        {
            Some(found) => found.repeats += 1,
            None => self.found.push(fault),
        }
    }

    /// The faults in the order of the files and their texts.
    pub fn locate(mut self, sources: &Sources) -> Vec<Fault> {
        self.found
            .sort_by_key(|found| (found.origin.source, found.origin.offset));
        if let Some(origin) = self.first_left_out {
            let last = self.found.last().map_or(origin, |found| found.origin);
            self.found.push(UnplacedFault {
                origin: Origin {
                    instance: None,
                    ..origin.max(last)
                },
                element: None,
                attribute: None,
                problem: "more faults follow".into(),
                expected: format!("at most {MAX_FAULTS}"),
                repeats: 0,
            });
        }
        let origins = self.found.iter().flat_map(|found| {
            std::iter::once(found.origin).chain(sources.instances_of(found.origin))
        });
        let positions = sources.positions(origins);
        let position = |origin: Origin| {
            let position = positions.get(&(origin.source, origin.offset));
            position.cloned().unwrap_or_default()
        };
        let located = |found: UnplacedFault| {
            let Position { file, line, column } = position(found.origin);
            Fault {
                file,
                line,
                column,
                element: found.element,
                attribute: found.attribute,
                problem: found.problem,
                expected: found.expected,
                instances: sources.instances_of(found.origin).map(position).collect(),
                repeats: found.repeats,
            }
        };
        self.found.into_iter().map(located).collect()
    }
}

/// Displays the beginning of a text that may be of any length, on one line.
pub(crate) struct Excerpt<'a>(pub &'a str);

impl fmt::Display for Excerpt<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const LONGEST: usize = 40;
        let mut characters = self.0.chars();
        for character in characters.by_ref().take(LONGEST) {
            match character.is_control() {
                true => write!(f, "{}", character.escape_default())?,
                false => write!(f, "{character}")?,
            }
        }
        match characters.next() {
            Some(_) => f.write_str("…"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn lines(faults: Faults, sources: &Sources) -> Vec<String> {
        let faults = faults.locate(sources);
        faults.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn faults_are_sorted_and_located() {
        let mut sources = Sources::default();
        sources.add(Path::new("f.xml"), "a\nbc");
        sources.add(Path::new("g.xml"), "a");
        let mut faults = Faults::default();
        faults.report(Place::outside(1, 0), "last", "z");
        faults.report(Place::outside(0, 3), "late", "x");
        faults.report(
            Place {
                element: Some("box"),
                ..Place::outside(0, 1)
            },
            "early",
            "y",
        );
        assert_eq!(
            lines(faults, &sources),
            [
                "f.xml:1:2: box: early, expected y",
                "f.xml:2:2: late, expected x",
                "g.xml:1:1: last, expected z",
            ]
        );
    }

    #[test]
    fn a_fault_names_the_instances_that_brought_it() {
        let text = "x".repeat(20);
        let mut sources = Sources::default();
        sources.add(Path::new("f"), &text);
        let at = |offset, instance| Origin {
            source: 0,
            offset,
            instance,
        };
        let mut faults = Faults::default();
        for column in [10, 12] {
            let outer = sources.add_instance(at(column, None));
            let inner = sources.add_instance(at(5, Some(outer)));
            let place = Place {
                origin: at(0, Some(inner)),
                ..Place::outside(0, 0)
            };
            faults.report(place, "p", "e");
        }
        assert_eq!(
            lines(faults, &sources),
            ["f:1:1: p, expected e (in the instance at f:1:6, in that at f:1:11, and in 1 more)"]
        );
        let deep = Fault {
            instances: vec![Position::default(); 100],
            ..bare_fault()
        };
        assert!(deep.to_string().len() < 200, "{deep}");
    }

    fn bare_fault() -> Fault {
        let mut faults = Faults::default();
        faults.report(Place::outside(0, 0), "p", "e");
        faults.locate(&Sources::default()).remove(0)
    }

    #[test]
    fn faults_beyond_the_limit_are_counted_as_one() {
        let text = "x".repeat(1000);
        let mut sources = Sources::default();
        sources.add(Path::new("f"), &text);
        let mut faults = Faults::default();
        for offset in (0..1000).rev() {
            faults.report(Place::outside(0, offset), "p", "e");
        }
        let faults = faults.locate(&sources);
        assert_eq!(faults.len(), MAX_FAULTS + 1);
        assert_eq!(faults[MAX_FAULTS].problem, "more faults follow");
        assert!(faults.is_sorted_by_key(|fault| fault.column));
    }

    #[test]
    fn an_excerpt_is_short_and_on_one_line() {
        assert_eq!(Excerpt("a\nb").to_string(), "a\\nb");
        assert_eq!(Excerpt(&"ä".repeat(41)).to_string().chars().count(), 41);
        assert_eq!(Excerpt(&"ä".repeat(40)).to_string(), "ä".repeat(40));
    }
}
