//! The elements of the points at which objects are fastened to each other.

use tabletop_core::{BondEnd, BondPoint, GuestPoint, HostPoint, Shape, TightnessStep};

use crate::{
    document::tree::Element,
    elements::{
        ElementReader,
        attributes::AttributeReader,
        names::{DOWNSTREAM, TIGHTNESS},
        value::{self, STATES},
    },
};

impl ElementReader<'_, '_> {
    /// Reads the steps in a host point, and says whether none is faulty. A guest point has none.
    pub(super) fn tightness_steps(&mut self, element: &Element) -> (Vec<TightnessStep>, bool) {
        let allowed: &[&str] = match element.name {
            "hostBondPoint" => &[TIGHTNESS],
            _ => &[DOWNSTREAM],
        };
        let mut steps = Vec::new();
        let mut is_sound = true;
        for child in &element.children {
            if !self.is_allowed(child, element.name, allowed) {
                continue;
            }
            self.forbid_children(child);
            if child.name == DOWNSTREAM {
                continue; // The later program allows it, and does nothing with it.
            }
            let mut attributes = AttributeReader::of(child, self.faults);
            let step = TightnessStep {
                pose: attributes.pose_or_origin(),
                state: attributes.read("downstreamState", None, |text| {
                    value::count(text, &STATES).map(Some)
                }),
                locks: attributes.read("downstreamLock", false, value::boolean),
            };
            let step = attributes.finish(Some(step));
            is_sound &= step.is_some();
            steps.extend(step);
        }
        if element.name == "hostBondPoint" && steps.is_empty() && is_sound && !element.is_broken {
            let expected = "at least one <tightness>";
            self.faults
                .report(element.place(), "it has no steps", expected);
            is_sound = false;
        }
        (steps, is_sound)
    }
}

/// The point of an element that is one of [`BOND_POINTS`](super::names::BOND_POINTS).
pub(super) fn bond_point(
    element: &Element,
    steps: Vec<TightnessStep>,
    attributes: &mut AttributeReader,
) -> Shape {
    let fit = attributes.require("type", String::new(), "type", |text| {
        match value::trim(text) {
            "" => Err(value::ValueError::new(text, "is empty", "a type")),
            fit => Ok(fit.to_owned()),
        }
    });
    let end = match element.name {
        "hostBondPoint" => BondEnd::Host(HostPoint {
            downstream: attributes.read("downstream", String::new(), value::id),
            downstream_override: attributes.read("downstreamOverride", String::new(), value::id),
            downstream_lock: attributes.read("downstreamLock", String::new(), value::id),
            steps,
        }),
        _ => {
            for name in ["downstream", "downstreamOverride", "downstreamLock"] {
                attributes.ignore(name, String::new(), value::id);
            }
            BondEnd::Guest(GuestPoint {
                host: attributes.read("initBondHostId", String::new(), value::id),
                tightness: attributes
                    .read("initBondTightness", 0, |text| value::count(text, &STATES)),
            })
        }
    };
    Shape::BondPoint(BondPoint { fit, end })
}
