//! Attributes of an element, read by name and type.

use std::{fmt, ops::RangeInclusive};

use bevy::math::{DVec3, Vec3};
use tabletop_core::{Dynamics, nearest_name};
use tabletop_geometry::{Pose, Rgb};

use crate::{
    document::tree::{Attribute, Element},
    elements::value::{
        self, FRICTIONS, LOCATIONS, MASSES, PROPORTIONS, ROTATIONS, SIDES, SPANS, VELOCITIES,
        ValueError,
    },
    fault::Faults,
};

/// Reads the attributes of one element. A read that fails notes a fault and gives the default;
/// [`finish`](Self::finish) then withholds the element.
pub(crate) struct AttributeReader<'e, 'a, 'f> {
    element: &'e Element<'a>,
    faults: &'f mut Faults,
    known: Vec<&'static str>,
    is_faulty: bool,
}

impl<'e, 'a, 'f> AttributeReader<'e, 'a, 'f> {
    pub fn of(element: &'e Element<'a>, faults: &'f mut Faults) -> Self {
        Self {
            element,
            faults,
            known: Vec::new(),
            is_faulty: element.is_broken,
        }
    }

    /// The value of an attribute, or `default` where it is absent or faulty.
    pub fn read<T>(
        &mut self,
        name: &'static str,
        default: T,
        parse: impl FnOnce(&str) -> Result<T, ValueError>,
    ) -> T {
        self.known.push(name);
        let Some(text) = self.find(name).and_then(|found| found.value.as_deref()) else {
            return default;
        };
        match parse(text) {
            Ok(value) => value,
            Err(error) => {
                self.fault(name, error.problem, error.expected);
                default
            }
        }
    }

    /// The value of an attribute that must be there; `stand_in` where it is absent or faulty.
    pub fn require<T>(
        &mut self,
        name: &'static str,
        stand_in: T,
        form: &str,
        parse: impl FnOnce(&str) -> Result<T, ValueError>,
    ) -> T {
        if self.find(name).is_none() && !self.element.is_broken {
            self.fault(name, "it is missing", format_args!("{name}=\"{form}\""));
        }
        self.read(name, stand_in, parse)
    }

    pub fn id(&mut self) -> String {
        self.read("id", String::new(), value::id)
    }

    pub fn number(&mut self, name: &'static str, default: f32, range: &RangeInclusive<f32>) -> f32 {
        self.read(name, default, |text| value::number(text, range))
    }

    pub fn span(&mut self, name: &'static str, default: f32) -> f32 {
        self.number(name, default, &SPANS)
    }

    pub fn spans(&mut self, names: [&'static str; 3], default: Vec3) -> Vec3 {
        Vec3::new(
            self.span(names[0], default.x),
            self.span(names[1], default.y),
            self.span(names[2], default.z),
        )
    }

    pub fn mass(&mut self, name: &'static str, default: f32) -> f32 {
        self.number(name, default, &MASSES)
    }

    /// Friction, restitution and initial velocity of an object.
    pub fn dynamics(&mut self) -> Dynamics {
        let some = |range| move |text: &str| value::number(text, range).map(Some);
        Dynamics {
            friction: self.read("friction", None, some(&FRICTIONS)),
            restitution: self.read("restitution", None, some(&PROPORTIONS)),
            velocity: self.read("linearVelocity", Vec3::ZERO, |text| {
                value::vector(text, &VELOCITIES)
            }),
        }
    }

    /// Number of sides.
    pub fn sides(&mut self, default: u32) -> u32 {
        self.read("sides", default, |text| value::count(text, &SIDES))
    }

    pub fn color(&mut self, name: &'static str) -> Rgb {
        self.read(name, Rgb::GRAY, value::color)
    }

    pub fn location(&mut self, name: &'static str) -> Vec3 {
        self.require(name, Vec3::ZERO, "(x,y,z)", |text| {
            value::vector(text, &LOCATIONS)
        })
    }

    pub fn pose(&mut self) -> Pose {
        let location = self.location("location");
        let rotation = self.read("rotation", DVec3::ZERO, |text| {
            value::angles(text, &ROTATIONS)
        });
        Pose::from_degrees(location, rotation)
    }

    /// A pose, at the origin by default.
    pub fn pose_or_origin(&mut self) -> Pose {
        match self.has("location") {
            true => self.pose(),
            false => {
                let rotation = self.read("rotation", DVec3::ZERO, |text| {
                    value::angles(text, &ROTATIONS)
                });
                self.known.push("location");
                Pose::from_degrees(Vec3::ZERO, rotation)
            }
        }
    }

    /// Checks an attribute that has no effect here.
    pub fn ignore<T>(
        &mut self,
        name: &'static str,
        default: T,
        parse: impl FnOnce(&str) -> Result<T, ValueError>,
    ) {
        self.read(name, default, parse);
    }

    /// Notes a fault if an attribute exists.
    pub fn forbid(&mut self, name: &'static str, problem: &str, expected: &str) {
        if self.find(name).is_some() {
            self.fault(name, problem, expected);
            self.known.push(name);
        }
    }

    /// True if the attribute exists.
    pub fn has(&self, name: &str) -> bool {
        self.find(name).is_some()
    }

    /// True if there is no fault so far, so that values can be checked against each other.
    pub fn is_sound(&self) -> bool {
        !self.is_faulty
    }

    /// Notes a fault of an attribute, at the attribute or, where it is absent, at the element.
    pub fn fault(&mut self, name: &str, problem: impl fmt::Display, expected: impl fmt::Display) {
        self.is_faulty = true;
        let place = self.element.place_of(name);
        self.faults.report(place, problem, expected);
    }

    /// Notes a fault of an attribute of an element in this one, which is left out for it.
    pub fn fault_of(
        &mut self,
        inner: &Element,
        name: &str,
        problem: impl fmt::Display,
        expected: impl fmt::Display,
    ) {
        self.is_faulty = true;
        self.faults.report(inner.place_of(name), problem, expected);
    }

    /// Notes the attributes that were not read, and gives the value if the element has no fault at all.
    pub fn finish<T>(mut self, value: Option<T>) -> Option<T> {
        self.report_unknown();
        value.filter(|_| self.is_sound())
    }

    /// Notes the attributes that were not read.
    pub fn report_unknown(&mut self) {
        let element = self.element;
        for attribute in &element.attributes {
            let name = attribute.name;
            if self.known.contains(&name) || self.faults.is_full() {
                continue;
            }
            let problem = "it is not known";
            match nearest_name(name, &self.known) {
                Some(known) => self.fault(name, problem, known),
                None if self.known.is_empty() => self.fault(name, problem, "no attributes"),
                None => {
                    let known = format!("one of {}", self.known.join(", "));
                    self.fault(name, problem, known);
                }
            }
        }
    }

    fn find(&self, name: &str) -> Option<&'e Attribute<'a>> {
        let element = self.element;
        element.attribute(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{document::build, document::decode::decode, test_support::located};

    fn read<T>(
        text: &str,
        read: impl FnOnce(&mut AttributeReader) -> T,
    ) -> (Option<T>, Vec<String>) {
        let decoded = decode(text.as_bytes());
        let mut faults = Faults::default();
        let element = build::read(&decoded, 0, &mut faults).unwrap();
        let mut reader = AttributeReader::of(&element, &mut faults);
        let value = read(&mut reader);
        let value = reader.finish(Some(value));
        let faults = located(faults, decoded.text);
        (value, faults.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn absent_attributes_have_defaults() {
        let (span, faults) = read("<a y='3'/>", |reader| {
            reader.spans(["x", "y", "z"], Vec3::ONE)
        });
        assert_eq!((span, faults), (Some(Vec3::new(1.0, 3.0, 1.0)), vec![]));
    }

    #[test]
    fn a_missing_attribute_is_a_fault_of_the_element() {
        let (pose, faults) = read("<a/>", |reader| reader.pose());
        assert_eq!(pose, None);
        assert_eq!(
            faults,
            ["f:1:1: a, location: it is missing, expected location=\"(x,y,z)\""]
        );
    }

    #[test]
    fn every_faulty_attribute_is_reported() {
        let (value, faults) = read("<a x='-1'\n y='b' colour='red' q='1'/>", |reader| {
            (
                reader.span("x", 1.0),
                reader.span("y", 1.0),
                reader.color("color"),
            )
        });
        assert_eq!(value, None);
        assert_eq!(
            faults,
            [
                "f:1:4: a, x: `-1` is out of range, expected a number from 0.001 to 1000",
                "f:2:2: a, y: `b` is not a number, expected a number from 0.001 to 1000",
                "f:2:8: a, colour: it is not known, expected color",
                "f:2:21: a, q: it is not known, expected one of x, y, color",
            ]
        );
    }

    #[test]
    fn an_unreadable_attribute_has_one_fault() {
        for text in ["<a location='(0,0,&x;)'/>", "<a location=(0,0,0)/>"] {
            let (pose, faults) = read(text, |reader| reader.pose());
            assert_eq!((pose, faults.len()), (None, 1), "{faults:?}");
        }
    }
}
