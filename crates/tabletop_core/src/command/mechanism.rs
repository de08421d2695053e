//! Commands to mechanisms: what the demonstrator does to controls and bonds, and what is pointed to.

use serde::{Deserialize, Serialize};

use crate::Hand;

/// A command to what can be operated, fastened or pointed to. A hand needs to hold nothing for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum MechanismCommand {
    /// Press a switch, or what leads to another state of a control.
    Trigger {
        /// The hand.
        hand: Hand,
        /// Id of the control.
        control: String,
        /// Which of the control's [simple parts](crate::Shape::simple_parts) is touched, from 0; for none, the first one that leads
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
    /// Fasten a guest to the nearest host, or one step tighter.
    Fasten {
        /// The hand.
        hand: Hand,
        /// Id of a guest point, or of an object, whose point next to a host it is then.
        guest: String,
    },
    /// Loosen a guest by a step.
    Loosen {
        /// The hand.
        hand: Hand,
        /// Id of a guest point, or of an object, whose bonded point it is then.
        guest: String,
    },
}
