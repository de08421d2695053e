//! The lines of a segment's text file, read.

use std::{path::Path, str::FromStr};

use bevy::math::Vec3;
use tabletop_core::{Bond, Hand, LimbName, Operator, OperatorError, SimTick};

use crate::{error::RecorderError, reading::fault::damaged};

/// A line of a segment's text file.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedEvent {
    /// The first frame that shows it.
    pub frame: u64,
    /// The event.
    pub what: Occurrence,
}

/// The event in a line of a segment's text file.
#[derive(Clone, Debug, PartialEq)]
pub enum Occurrence {
    /// An object is there for the first time.
    Create {
        /// Its id.
        id: String,
        /// Its properties, as key and value.
        properties: Vec<(String, String)>,
    },
    /// An object has gone.
    Delete {
        /// Its id.
        id: String,
    },
    /// An object is somewhere else, or turned.
    Move {
        /// Its id.
        id: String,
        /// Its present location, in units.
        location: Vec3,
        /// Its angles in degrees about the fixed X, then Y, then Z axis.
        degrees: Vec3,
    },
    /// A hand has taken an object.
    Grasp {
        /// The hand.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A hand has let go of what it held.
    Release {
        /// The hand.
        hand: Hand,
    },
    /// A hand has removed what it held.
    Destroy {
        /// The hand.
        hand: Hand,
    },
    /// A gripper of the robot has closed on an object and holds it.
    Grip {
        /// The gripper's limb.
        limb: LimbName,
        /// Id of the object.
        id: String,
        /// The tick in which it did.
        tick: SimTick,
    },
    /// A gripper of the robot no longer holds an object.
    LetGo {
        /// The gripper's limb.
        limb: LimbName,
        /// Id of the object.
        id: String,
        /// The tick from which on it does not.
        tick: SimTick,
    },
    /// A control as it was when it appeared.
    InitializeControl {
        /// Its id.
        control: String,
        /// The kind of control.
        kind: String,
        /// Id of the object.
        object: String,
        /// The name of its state.
        state: String,
    },
    /// A control has another state.
    ChangeControlState {
        /// Its id.
        control: String,
        /// The name of its state.
        state: String,
    },
    /// Somebody has operated a control.
    Trigger {
        /// The operator.
        by: Operator,
        /// Id of the control.
        control: String,
    },
    /// A hand has pointed to something.
    PointTo {
        /// The hand.
        hand: Hand,
        /// Id of the part, or of the whole object.
        part: String,
        /// Id of the object.
        object: String,
    },
    /// A bond was made, or is tighter.
    Fasten {
        /// The operator.
        by: Operator,
        /// The bond.
        bond: Bond,
    },
    /// A bond is looser, or no more.
    Loosen {
        /// The operator.
        by: Operator,
        /// The bond.
        bond: Bond,
    },
    /// A link of a chain was cut.
    Cut {
        /// Who has closed the scissors.
        by: Operator,
        /// Id of the first blade.
        blade: String,
        /// Id of the link.
        link: String,
    },
}

/// The writing of a comma in a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CommaStyle {
    /// The value is quoted.
    Quoted,
    /// A backslash is before the comma, as in recordings of the original program, which knows no quotes.
    Escaped,
}

/// Reads the text of a file of events.
pub(super) fn read(
    path: &Path,
    text: &str,
    commas: CommaStyle,
) -> Result<Vec<RecordedEvent>, RecorderError> {
    let lines = read_lines(text, commas).into_iter();
    let events = lines.map(|(line, event)| event.map_err(|problem| damaged(path, line, problem)));
    events.collect()
}

/// The events in the lines of a text, each with its line's number, from 1; or what is wrong with the line.
pub(super) fn read_lines(
    text: &str,
    commas: CommaStyle,
) -> Vec<(u64, Result<RecordedEvent, String>)> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .quoting(commas == CommaStyle::Quoted)
        .from_reader(text.as_bytes());
    let records = reader.records().map(|record| match record {
        Ok(record) => {
            let line = record.position().map_or(0, csv::Position::line);
            (line, event_of(&record, commas))
        }
        Err(error) => {
            let line = error.position().map_or(0, csv::Position::line);
            (line, Err(error.to_string()))
        }
    });
    records.collect()
}

fn event_of(record: &csv::StringRecord, commas: CommaStyle) -> Result<RecordedEvent, String> {
    let fields: Vec<_> = record.iter().map(str::to_owned).collect();
    let fields = match commas {
        CommaStyle::Quoted => fields,
        // Files that were edited by hand may have spaces between the values.
        CommaStyle::Escaped => {
            let fields = joined(fields).into_iter();
            fields.map(|field| field.trim().to_owned()).collect()
        }
    };
    let fields: Vec<_> = fields.iter().map(String::as_str).collect();
    parse(&fields)
}

/// The values of fields that were split at commas with a backslash before them.
fn joined(fields: Vec<String>) -> Vec<String> {
    let mut values = Vec::<String>::new();
    let mut goes_on = false;
    for field in fields {
        let (text, is_cut) = match field.strip_suffix('\\') {
            Some(text) => (format!("{text},"), true),
            None => (field, false),
        };
        match values.last_mut() {
            Some(value) if goes_on => value.push_str(&text),
            Some(_) | None => values.push(text),
        }
        goes_on = is_cut;
    }
    values
}

fn parse(fields: &[&str]) -> Result<RecordedEvent, String> {
    let [frame, ref event @ ..] = *fields else {
        return Err("the line is empty".into());
    };
    let frame = number("a frame", frame)?;
    let what = match *event {
        ["create", id, ref pairs @ ..] if pairs.len().is_multiple_of(2) => Occurrence::Create {
            id: id.into(),
            properties: pairs
                .chunks_exact(2)
                .map(|pair| (pair[0].into(), pair[1].into()))
                .collect(),
        },
        ["delete", id] => Occurrence::Delete { id: id.into() },
        ["move", id, x, y, z, rx, ry, rz] => Occurrence::Move {
            id: id.into(),
            location: vector([x, y, z])?,
            degrees: vector([rx, ry, rz])?,
        },
        ["grasp", by, id] => Occurrence::Grasp {
            hand: hand(by)?,
            id: id.into(),
        },
        ["release", by] => Occurrence::Release { hand: hand(by)? },
        ["destroy", by] => Occurrence::Destroy { hand: hand(by)? },
        ["grip", by, id, tick] => Occurrence::Grip {
            limb: limb(by)?,
            id: id.into(),
            tick: SimTick(number("a tick", tick)?),
        },
        ["letGo", by, id, tick] => Occurrence::LetGo {
            limb: limb(by)?,
            id: id.into(),
            tick: SimTick(number("a tick", tick)?),
        },
        ["initializeControl", control, kind, object, state] => Occurrence::InitializeControl {
            control: control.into(),
            kind: kind.into(),
            object: object.into(),
            state: state.into(),
        },
        ["changeControlState", control, state] => Occurrence::ChangeControlState {
            control: control.into(),
            state: state.into(),
        },
        ["trigger", by, control] => Occurrence::Trigger {
            by: operator(by)?,
            control: control.into(),
        },
        ["pointTo", by, part, object] => Occurrence::PointTo {
            hand: hand(by)?,
            part: part.into(),
            object: object.into(),
        },
        ["fasten", by, ref bonded @ ..] if bonded.len() == 5 => Occurrence::Fasten {
            by: operator(by)?,
            bond: bond(bonded)?,
        },
        ["cut", by, blade, link] => Occurrence::Cut {
            by: operator(by)?,
            blade: blade.into(),
            link: link.into(),
        },
        ["loosen", by, ref bonded @ ..] if bonded.len() == 5 => Occurrence::Loosen {
            by: operator(by)?,
            bond: bond(bonded)?,
        },
        _ => {
            return Err(format!(
                "expected an event of a recording, found `{}`",
                event.join(",")
            ));
        }
    };
    Ok(RecordedEvent { frame, what })
}

fn vector(texts: [&str; 3]) -> Result<Vec3, String> {
    let [x, y, z] = texts.map(|text| number("a number", text));
    Ok(Vec3::new(x?, y?, z?))
}

pub(super) fn number<T: FromStr>(expected: &str, text: &str) -> Result<T, String> {
    let parsed = text.parse();
    parsed.map_err(|_| format!("expected {expected}, found `{text}`"))
}

fn operator(name: &str) -> Result<Operator, String> {
    name.parse()
        .map_err(|error: OperatorError| error.to_string())
}

fn bond(fields: &[&str]) -> Result<Bond, String> {
    let [host_point, host, guest_point, guest, tightness] = *fields else {
        return Err(format!(
            "expected the five fields of a bond, found {}",
            fields.join(",")
        ));
    };
    Ok(Bond {
        host_point: host_point.into(),
        host: host.into(),
        guest_point: guest_point.into(),
        guest: guest.into(),
        tightness: number("a tightness", tightness)?,
    })
}

fn hand(name: &str) -> Result<Hand, String> {
    let hand = Hand::ALL.into_iter().find(|hand| hand.name() == name);
    hand.ok_or_else(|| format!("expected a hand, such as LeftHand, found `{name}`"))
}

fn limb(name: &str) -> Result<LimbName, String> {
    LimbName::new(name).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use tabletop_core::{ObjectSpec, Shape};
    use tabletop_geometry::{Pose, Rgb};

    use super::*;
    use crate::files::event::Event;

    fn read_back(event: Event) -> Occurrence {
        let mut lines = csv::WriterBuilder::new()
            .flexible(true)
            .from_writer(Vec::new());
        lines.write_record(event.fields(7)).unwrap();
        let text = String::from_utf8(lines.into_inner().unwrap()).unwrap();
        let [event] = &read(Path::new("1.txt"), &text, CommaStyle::Quoted).unwrap()[..] else {
            panic!("{text} is not one event");
        };
        assert_eq!(event.frame, 7);
        event.what.clone()
    }

    #[test]
    fn written_text_reads_back() {
        let id = "a, \"b\"";
        let shape = Shape::Sphere {
            radius: 0.5,
            color: Rgb::WHITE,
        };
        let spec = ObjectSpec::new(id, Pose::IDENTITY, 1.0, shape);
        let pairs = [
            ("shape", "sphere"),
            ("radius", "0.5"),
            ("color", "#ffffff"),
            ("mass", "1.0"),
        ];
        let pose = Pose::from_degrees(Vec3::new(-2.0, 1e-5, 12_345_678.0), Vec3::Z * 45.0);
        let hand = Hand::Both;
        let (limb, tick) = (LimbName::from_static("left"), SimTick(97));
        let own = |id: &str| id.to_owned();
        for (event, expected) in [
            (
                Event::Create(&spec),
                Occurrence::Create {
                    id: own(id),
                    properties: pairs.map(|(key, value)| (own(key), own(value))).into(),
                },
            ),
            (Event::Delete { id }, Occurrence::Delete { id: own(id) }),
            (
                Event::Move { id, pose },
                Occurrence::Move {
                    id: own(id),
                    location: pose.location,
                    degrees: pose.degrees(),
                },
            ),
            (
                Event::Grasp { hand, id },
                Occurrence::Grasp { hand, id: own(id) },
            ),
            (Event::Release { hand }, Occurrence::Release { hand }),
            (Event::Destroy { hand }, Occurrence::Destroy { hand }),
            (
                Event::Grip { limb, id, tick },
                Occurrence::Grip {
                    limb,
                    id: own(id),
                    tick,
                },
            ),
            (
                Event::LetGo { limb, id, tick },
                Occurrence::LetGo {
                    limb,
                    id: own(id),
                    tick,
                },
            ),
        ] {
            assert_eq!(read_back(event), expected);
        }
    }

    #[test]
    fn a_comma_of_the_original_program_has_a_backslash_before_it() {
        let text = "0,create,a,shape,block,said,\"one\\, two\\, three\n";
        let events = read(Path::new("0.txt"), text, CommaStyle::Escaped).unwrap();
        let [
            RecordedEvent {
                what: Occurrence::Create { properties, .. },
                ..
            },
        ] = &events[..]
        else {
            panic!("{events:?}");
        };
        assert_eq!(properties[1].1, "\"one, two, three");
    }

    #[test]
    fn an_invalid_line_is_named() {
        for (line, problem) in [
            ("x,delete,a", "expected a frame, found `x`"),
            ("1,fly,a", "expected an event of a recording, found `fly,a`"),
            ("1,create,a,shape", "expected an event"),
            ("1,move,a,1,2,3,4,5,six", "expected a number, found `six`"),
            (
                "1,grasp,Foot,a",
                "expected a hand, such as LeftHand, found `Foot`",
            ),
            ("1,grip,left,a,soon", "expected a tick, found `soon`"),
        ] {
            let text = format!("0,delete,\"two\nlines\"\n{line}\n");
            let error = read(Path::new("1.txt"), &text, CommaStyle::Quoted)
                .unwrap_err()
                .to_string();
            assert!(error.starts_with("1.txt:3: "), "{error}");
            assert!(error.contains(problem), "{error}");
        }
    }
}
