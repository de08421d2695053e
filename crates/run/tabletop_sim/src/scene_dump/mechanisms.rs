//! The objects of a scene that can be operated, and their bonds.

use serde::Serialize;
use tabletop_core::{BondEnd, BondPoint, Bonds, Control, ObjectSpec, PlacedPart, TightnessStep};

use super::pose::PoseDump;

#[derive(Serialize)]
pub(super) struct ControlDump<'a> {
    id: &'a str,
    #[serde(rename = "type")]
    kind: &'a str,
    #[serde(flatten)]
    pose: PoseDump,
    state: u32,
    #[serde(rename = "stateName")]
    state_name: String,
    states: u32,
    downstream: &'a [String],
}

#[derive(Serialize)]
pub(super) struct BondPointDump<'a> {
    id: &'a str,
    #[serde(rename = "type")]
    fit: &'a str,
    #[serde(flatten)]
    pose: PoseDump,
    #[serde(flatten)]
    end: EndDump<'a>,
}

#[derive(Serialize)]
#[serde(tag = "end", rename_all = "lowercase")]
enum EndDump<'a> {
    Guest,
    Host {
        downstream: Option<&'a str>,
        #[serde(rename = "downstreamOverride")]
        downstream_override: Option<&'a str>,
        #[serde(rename = "downstreamLock")]
        downstream_lock: Option<&'a str>,
        tightness: Vec<TightnessDump>,
    },
}

#[derive(Serialize)]
struct TightnessDump {
    #[serde(flatten)]
    pose: PoseDump,
    #[serde(rename = "downstreamState")]
    state: Option<u32>,
    #[serde(rename = "downstreamLock")]
    locks: bool,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BondDump {
    host_point: String,
    host: String,
    guest_point: String,
    guest: String,
    tightness: u32,
}

pub(super) fn controls(spec: &ObjectSpec) -> Vec<ControlDump<'_>> {
    let controls = spec.controls().into_iter();
    controls.map(ControlDump::from).collect()
}

pub(super) fn bond_points(spec: &ObjectSpec) -> Vec<BondPointDump<'_>> {
    let points = spec.bond_points().into_iter();
    points.map(BondPointDump::from).collect()
}

/// The bonds that objects have at first.
pub(super) fn bonds(objects: &[ObjectSpec]) -> Vec<BondDump> {
    let placed: Vec<_> = objects.iter().map(|spec| (spec, spec.pose)).collect();
    let mut bonds = Bonds::default();
    for (point, guest) in objects.iter().flat_map(ObjectSpec::guest_points) {
        if guest.tightness > 0
            && let Ok(bond) = bonds.first(&placed, point.id, &guest.host, guest.tightness)
        {
            bonds.0.push(bond);
        }
    }
    let bonds = bonds.0.into_iter().map(|bond| BondDump {
        host_point: bond.host_point,
        host: bond.host,
        guest_point: bond.guest_point,
        guest: bond.guest,
        tightness: bond.tightness,
    });
    bonds.collect()
}

impl<'a> From<PlacedPart<'a, Control>> for ControlDump<'a> {
    fn from(PlacedPart { id, pose, what }: PlacedPart<'a, Control>) -> Self {
        Self {
            id,
            kind: what.type_name(),
            pose: pose.into(),
            state: what.shown_state(),
            state_name: what.state_name(),
            states: what.states(),
            downstream: &what.downstream,
        }
    }
}

impl<'a> From<PlacedPart<'a, BondPoint>> for BondPointDump<'a> {
    fn from(PlacedPart { id, pose, what }: PlacedPart<'a, BondPoint>) -> Self {
        let id_of = |text: &'a String| (!text.is_empty()).then_some(&**text);
        let end = match &what.end {
            BondEnd::Guest(_) => EndDump::Guest,
            BondEnd::Host(host) => EndDump::Host {
                downstream: id_of(&host.downstream),
                downstream_override: id_of(&host.downstream_override),
                downstream_lock: id_of(&host.downstream_lock),
                tightness: host.steps.iter().map(TightnessDump::from).collect(),
            },
        };
        Self {
            id,
            fit: &what.fit,
            pose: pose.into(),
            end,
        }
    }
}

impl From<&TightnessStep> for TightnessDump {
    fn from(step: &TightnessStep) -> Self {
        Self {
            pose: step.pose.into(),
            state: step.state,
            locks: step.locks,
        }
    }
}
