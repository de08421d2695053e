//! Operations: the objects that were operated, pointed to, fastened, loosened and cut.

use serde::{Deserialize, Serialize};
use tabletop_core::{Bond, SimTick};

/// An act of a demonstration that moves no object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Operation {
    /// The tick in which it was done.
    pub tick: SimTick,
    /// The kind of act.
    pub deed: OperationDeed,
    /// The controls whose states it changed, with the names of the new states.
    pub states: Vec<(String, String)>,
}

/// An act on a control, an object or a bond.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum OperationDeed {
    /// A control was triggered.
    Trigger {
        /// Its id.
        control: String,
    },
    /// An object or a part of one was pointed to.
    PointTo {
        /// Its id.
        part: String,
    },
    /// A bond was made or tightened.
    Fasten(Bond),
    /// A bond was loosened or undone.
    Loosen(Bond),
    /// A chain link was cut.
    Cut {
        /// Id of the first blade.
        #[serde(default)]
        blade: String,
        /// Its id.
        link: String,
    },
}

impl Operation {
    /// The operation in one sentence.
    pub fn sentence(&self) -> String {
        let what = match &self.deed {
            OperationDeed::Trigger { control } => format!("Trigger {control}"),
            OperationDeed::PointTo { part } => format!("Point to {part}"),
            OperationDeed::Cut { link, .. } => format!("Cut {link}"),
            OperationDeed::Fasten(bond) => {
                format!(
                    "Fasten {} to {}, step {}",
                    bond.guest, bond.host, bond.tightness
                )
            }
            OperationDeed::Loosen(bond) if bond.tightness == 0 => {
                format!("Loosen {} from {} until it is free", bond.guest, bond.host)
            }
            OperationDeed::Loosen(bond) => {
                format!(
                    "Loosen {} from {}, step {}",
                    bond.guest, bond.host, bond.tightness
                )
            }
        };
        let is_itself = |control: &str| matches!(&self.deed, OperationDeed::Trigger { control: own } if own == control);
        let states = self
            .states
            .iter()
            .filter(|(control, _)| !is_itself(control));
        let states: Vec<_> = states
            .map(|(control, state)| format!("{control} shows {state}"))
            .collect();
        match states.is_empty() {
            true => format!("{what}."),
            false => format!("{what}: {}.", states.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_have_sentences() {
        let bond = |tightness| Bond {
            host_point: "hole".into(),
            host: "panel".into(),
            guest_point: "tip".into(),
            guest: "screw".into(),
            tightness,
        };
        let power = || "power".to_owned();
        for (deed, sentence) in [
            (
                OperationDeed::Trigger { control: power() },
                "Trigger power: lights shows off.",
            ),
            (
                OperationDeed::Fasten(bond(2)),
                "Fasten screw to panel, step 2: power shows 1, lights shows off.",
            ),
            (
                OperationDeed::Loosen(bond(0)),
                "Loosen screw from panel until it is free: power shows 1, lights shows off.",
            ),
        ] {
            let states = vec![(power(), "1".into()), ("lights".into(), "off".into())];
            let tick = SimTick(0);
            let operation = Operation { tick, deed, states };
            assert_eq!(operation.sentence(), sentence);
        }
    }
}
