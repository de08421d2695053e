//! Checks of the world.

use bevy::prelude::*;
use serde::Deserialize;
use tabletop_core::Hand;
use tabletop_geometry::quat_from_degrees;

use crate::{
    RobotCheck,
    fault::fault_of_vector,
    rest::Stillness,
    seen::{ScenarioObject, Seen},
};

/// A condition that is to hold. Lengths are in units of 10 cm, angles in degrees.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Check {
    /// An object's origin is at a location.
    Location {
        /// Its id.
        object: String,
        /// The location.
        at: Vec3,
        /// The tolerance.
        #[serde(default = "close")]
        within: f32,
    },
    /// An object is turned as a task file's `rotation` says.
    Rotation {
        /// Its id.
        object: String,
        /// The rotation about the fixed X, then Y, then Z axis.
        degrees: Vec3,
        /// The tolerance.
        #[serde(default = "nearly_parallel")]
        within: f32,
    },
    /// An object is at rest, its lowest point level with the highest point of another, and its origin above it.
    OnTopOf {
        /// The upper object's id.
        object: String,
        /// The lower object's id.
        of: String,
        /// The tolerance in height.
        #[serde(default = "close")]
        within: f32,
    },
    /// An object is at rest, its lowest point level with the table's top, and its origin above it.
    OnTable {
        /// Its id.
        object: String,
        /// The tolerance in height.
        #[serde(default = "close")]
        within: f32,
    },
    /// An object is at rest, and nowhere outside the upright cuboid around another.
    Inside {
        /// The inner object's id.
        object: String,
        /// The outer object's id.
        of: String,
        /// Largest length by which it may stand out.
        #[serde(default = "close")]
        within: f32,
    },
    /// The object of this id has not moved for half a second.
    AtRest(String),
    /// No object has moved for half a second.
    AllAtRest,
    /// There is an object of this id.
    Exists(String),
    /// There is no object of this id.
    Gone(String),
    /// A hand holds an object.
    HeldBy {
        /// The object's id.
        object: String,
        /// The hand.
        hand: Hand,
    },
    /// No hand holds the object of this id.
    Free(String),
    /// A control is in a state.
    State {
        /// The control's id.
        control: String,
        /// The state's name in recordings: its own, or its number; 0 or 1 for a switch whose left or right side is down.
        is: String,
    },
    /// An object is fastened.
    Fastened {
        /// Id of the object, or of its guest point.
        guest: String,
        /// The tightness; 0 if it is not fastened.
        tightness: u32,
    },
    /// A check of the robot.
    Robot(RobotCheck),
}

const fn close() -> f32 {
    0.05
}

const fn nearly_parallel() -> f32 {
    2.0
}

impl Check {
    /// Its fault, if it makes no sense.
    pub(crate) fn fault(&self) -> Option<String> {
        match self {
            Self::Location {
                at: vector, within, ..
            }
            | Self::Rotation {
                degrees: vector,
                within,
                ..
            } => fault_of_vector(*vector).or_else(|| fault_of_tolerance(*within)),
            Self::OnTopOf { within, .. }
            | Self::OnTable { within, .. }
            | Self::Inside { within, .. } => fault_of_tolerance(*within),
            Self::AtRest(_)
            | Self::AllAtRest
            | Self::Exists(_)
            | Self::Gone(_)
            | Self::HeldBy { .. }
            | Self::Free(_)
            | Self::State { .. }
            | Self::Fastened { .. }
            | Self::Robot(_) => None,
        }
    }

    /// Id of the object that has to be moved for it to hold, if it is about one.
    pub fn moved(&self) -> Option<&str> {
        match self {
            Self::Location { object, .. }
            | Self::Rotation { object, .. }
            | Self::OnTopOf { object, .. }
            | Self::OnTable { object, .. }
            | Self::Inside { object, .. }
            | Self::HeldBy { object, .. }
            | Self::Robot(RobotCheck::Holds { object, .. }) => Some(object),
            Self::Free(object)
            | Self::State {
                control: object, ..
            }
            | Self::Fastened { guest: object, .. } => Some(object),
            Self::AtRest(_)
            | Self::AllAtRest
            | Self::Exists(_)
            | Self::Gone(_)
            | Self::Robot(
                RobotCheck::Joint { .. }
                | RobotCheck::EndEffector { .. }
                | RobotCheck::HoldsNothing(_)
                | RobotCheck::BlockedBy { .. },
            ) => None,
        }
    }

    /// Whether it is about where an object has come to rest, which must last.
    pub(crate) const fn is_of_placement(&self) -> bool {
        match self {
            Self::OnTopOf { .. } | Self::OnTable { .. } | Self::Inside { .. } => true,
            Self::Location { .. }
            | Self::Rotation { .. }
            | Self::AtRest(_)
            | Self::AllAtRest
            | Self::Exists(_)
            | Self::Gone(_)
            | Self::HeldBy { .. }
            | Self::Free(_)
            | Self::State { .. }
            | Self::Fastened { .. }
            | Self::Robot(_) => false,
        }
    }

    /// Compares with the world; an error names the expectation and the finding.
    pub(crate) fn judge(&self, seen: &Seen, stillness: &Stillness) -> Result<(), String> {
        match self {
            Self::Location { object, at, within } => is_at(seen.object(object)?, *at, *within),
            Self::Rotation {
                object,
                degrees,
                within,
            } => is_turned(seen.object(object)?, *degrees, *within),
            Self::OnTopOf { object, of, within } => {
                let object = seen.object(object)?;
                is_on_top(object, seen.object(of)?, *within)?;
                is_at_rest(object, stillness)
            }
            Self::OnTable { object, within } => {
                let object = seen.object(object)?;
                is_on_table(object, seen, *within)?;
                is_at_rest(object, stillness)
            }
            Self::Inside { object, of, within } => {
                let object = seen.object(object)?;
                is_inside(object, seen.object(of)?, *within)?;
                is_at_rest(object, stillness)
            }
            Self::Robot(check) => check.judge(seen),
            Self::AtRest(object) => is_at_rest(seen.object(object)?, stillness),
            Self::AllAtRest => match stillness.moving(seen) {
                None => Ok(()),
                Some(moving) => Err(format!("expected all at rest, found `{moving}` moving")),
            },
            Self::Exists(object) => seen.object(object).map(|_| ()),
            Self::Gone(object) => match seen.object(object) {
                Err(_) => Ok(()),
                Ok(_) => Err(format!("expected no `{object}`, found it")),
            },
            Self::HeldBy { object, hand } => is_held_by(seen.object(object)?, Some(*hand)),
            Self::Free(object) => is_held_by(seen.object(object)?, None),
            Self::State { control, is } => is_in_state(seen, control, is),
            Self::Fastened { guest, tightness } => is_fastened(seen, guest, *tightness),
        }
    }
}

fn fault_of_tolerance(within: f32) -> Option<String> {
    let makes_sense = within.is_finite() && within >= 0.0;
    (!makes_sense).then(|| format!("expected a tolerance from 0, found {within}"))
}

fn is_at_rest(object: &ScenarioObject, stillness: &Stillness) -> Result<(), String> {
    stillness
        .is_at_rest(object)
        .then_some(())
        .ok_or_else(|| format!("expected `{}` at rest, found it moving", object.spec.id))
}

fn is_at(object: &ScenarioObject, at: Vec3, within: f32) -> Result<(), String> {
    let found = object.pose.location;
    let distance = found.distance(at);
    (distance <= within).then_some(()).ok_or_else(|| {
        format!(
            "expected `{}` within {within} of {}, found it at {}, {distance:.3} away",
            object.spec.id,
            in_words(at),
            in_words(found)
        )
    })
}

fn is_turned(object: &ScenarioObject, degrees: Vec3, within: f32) -> Result<(), String> {
    let expected = quat_from_degrees(degrees);
    let angle = object.pose.rotation.angle_between(expected).to_degrees();
    (angle <= within).then_some(()).ok_or_else(|| {
        format!(
            "expected `{}` within {within} degrees of {}, found it at {}, {angle:.1} degrees away",
            object.spec.id,
            in_words(degrees),
            in_words(object.pose.degrees())
        )
    })
}

fn is_on_top(upper: &ScenarioObject, lower: &ScenarioObject, within: f32) -> Result<(), String> {
    let support = lower.bounds();
    let gap = upper.bounds().low.z - support.high.z;
    let is_over = support.is_below(upper.pose.location);
    lies_on(gap, within, is_over).map_err(|found| {
        format!(
            "expected `{}` on top of `{}`, found it {found}",
            upper.spec.id, lower.spec.id
        )
    })
}

fn is_on_table(object: &ScenarioObject, seen: &Seen, within: f32) -> Result<(), String> {
    let table = seen.table.ok_or("expected a table, found none")?;
    let gap = object.bounds().low.z;
    let found = object.pose.location;
    let is_over = found.x.abs() <= table.xspan / 2.0 && found.y.abs() <= table.yspan / 2.0;
    lies_on(gap, within, is_over).map_err(|found| {
        format!(
            "expected `{}` on the table, found it {found}",
            object.spec.id
        )
    })
}

/// Checks that an object lies on its support; `gap` is the distance of its lowest point from the support's top.
fn lies_on(gap: f32, within: f32, is_over: bool) -> Result<(), String> {
    match (gap.abs() <= within, is_over) {
        (true, true) => Ok(()),
        (true, false) => Err("beside it".to_owned()),
        (false, _) if gap > 0.0 => Err(format!("{gap:.3} above")),
        (false, _) => Err(format!("{:.3} too low", -gap)),
    }
}

fn is_inside(inner: &ScenarioObject, outer: &ScenarioObject, within: f32) -> Result<(), String> {
    let outside = outer.bounds().distance_out(inner.bounds());
    (outside <= within).then_some(()).ok_or_else(|| {
        format!(
            "expected `{}` inside `{}`, found it {outside:.3} outside, at {}",
            inner.spec.id,
            outer.spec.id,
            in_words(inner.pose.location)
        )
    })
}

fn is_held_by(object: &ScenarioObject, hand: Option<Hand>) -> Result<(), String> {
    let name = |hand: Option<Hand>| hand.map_or("no hand", Hand::name);
    (object.holder == hand).then_some(()).ok_or_else(|| {
        format!(
            "expected `{}` in {}, found it in {}",
            object.spec.id,
            name(hand),
            name(object.holder)
        )
    })
}

fn is_in_state(seen: &Seen, id: &str, expected: &str) -> Result<(), String> {
    let mut specs = seen.objects.iter().map(|object| object.spec);
    let control = specs
        .find_map(|spec| spec.control(id))
        .ok_or_else(|| format!("expected a control `{id}`, found none of that id"))?;
    let found = control.state_name();
    (found == expected)
        .then_some(())
        .ok_or_else(|| format!("expected `{id}` in state {expected}, found it in {found}"))
}

fn is_fastened(seen: &Seen, guest: &str, expected: u32) -> Result<(), String> {
    let mut bonds = seen.bonds.0.iter();
    let found = bonds
        .find(|bond| bond.guest_point == guest || bond.guest == guest)
        .map_or(0, |bond| bond.tightness);
    (found == expected).then_some(()).ok_or_else(|| {
        format!("expected `{guest}` fastened to tightness {expected}, found it at {found}")
    })
}

fn in_words(vector: Vec3) -> String {
    let [x, y, z] = vector.to_array();
    format!("({x:.3}, {y:.3}, {z:.3})")
}

#[cfg(test)]
mod tests {
    use tabletop_core::Hand;

    use crate::test_stage::Stage;

    #[test]
    fn true_checks_pass() {
        let all = "WaitUntilRest(1), Expect(Location(object: \"low\", at: (0, 0, 0.5))), \
            Expect(Rotation(object: \"low\", degrees: (0, 0, 1))), \
            Expect(OnTopOf(object: \"high\", of: \"low\")), Expect(OnTable(object: \"low\")), \
            Expect(Inside(object: \"low\", of: \"low\")), Expect(AllAtRest), Expect(AtRest(\"low\")), \
            Expect(Exists(\"low\")), Expect(Gone(\"x\")), Expect(Free(\"low\")), \
            Expect(HeldBy(object: \"high\", hand: Both))";
        let mut stage = Stage::new(all);
        stage.holders[1] = Some(Hand::Both);
        assert_eq!(stage.failure(), "Done");
    }

    #[test]
    fn failed_checks_state_the_expected_and_the_found() {
        for (check, words) in [
            (
                "Location(object: \"low\", at: (1, 0, 0.5))",
                "expected `low` within 0.05 of (1.000, 0.000, 0.500), found it at (0.000, 0.000, 0.500), 1.000 away",
            ),
            (
                "Rotation(object: \"low\", degrees: (0, 0, 3))",
                "3.0 degrees away",
            ),
            ("OnTopOf(object: \"low\", of: \"high\")", "2.000 too low"),
            ("OnTable(object: \"high\")", "1.000 above"),
            ("Inside(object: \"high\", of: \"low\")", "1.000 outside"),
            (
                "OnTable(object: \"low\")",
                "expected `low` at rest, found it moving",
            ),
            (
                "OnTopOf(object: \"high\", of: \"low\")",
                "expected `high` at rest, found it moving",
            ),
            (
                "Inside(object: \"low\", of: \"low\")",
                "expected `low` at rest, found it moving",
            ),
            ("AllAtRest", "expected all at rest, found `low` moving"),
            ("AtRest(\"high\")", "found it moving"),
            ("Exists(\"x\")", "expected an object `x`, found none"),
            ("Gone(\"low\")", "expected no `low`, found it"),
            (
                "Free(\"high\")",
                "expected `high` in no hand, found it in LeftHand",
            ),
            (
                "HeldBy(object: \"low\", hand: Right)",
                "expected `low` in RightHand, found it in no hand",
            ),
        ] {
            let mut stage = Stage::new(&format!("Expect({check})"));
            stage.holders[1] = Some(Hand::Left);
            let failure = stage.failure();
            let text = format!("s.ron:1:10: Expect({check}): ");
            assert!(failure.starts_with(&text), "{failure}");
            assert!(failure.contains(words), "{failure}");
        }
    }
}
