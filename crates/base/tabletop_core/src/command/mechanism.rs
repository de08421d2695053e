//! Commands to mechanisms: operate a control, fasten and loosen bonds, point to something.

use serde::{Deserialize, Serialize};

use crate::Hand;

/// A command to something that can be operated, fastened or pointed to. The hand can be empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum MechanismCommand {
    /// Press a switch, or the part of a control that leads to another state.
    Trigger {
        /// The hand.
        hand: Hand,
        /// Id of the control.
        control: String,
        /// The touched one of the control's [simple parts](crate::Shape::simple_parts), from 0; for `None`, the first one that leads
        /// to another state.
        #[serde(default)]
        part: Option<u32>,
    },
    /// Point to an object or to a part of one.
    PointTo {
        /// The hand.
        hand: Hand,
        /// Id of the object or part.
        target: String,
    },
    /// Fasten a guest to the nearest host, or tighten it by a step.
    Fasten {
        /// The hand.
        hand: Hand,
        /// Id of a guest point, or of an object; for an object, the point nearest to a host counts.
        guest: String,
    },
    /// Loosen a guest by a step.
    Loosen {
        /// The hand.
        hand: Hand,
        /// Id of a guest point, or of an object; for an object, its bonded point counts.
        guest: String,
    },
    /// Close scissors: links of chains that both blades come to touch are cut.
    Cut {
        /// The hand.
        hand: Hand,
        /// Id of a blade.
        blade: String,
    },
}
