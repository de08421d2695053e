//! The hands that a command empties before it does anything else.

use tabletop_core::{CommandId, Hand, HandFact, SimFact};

/// The hands that a command has emptied by now.
pub(crate) fn released_by(command: CommandId, facts: &[SimFact]) -> Vec<Hand> {
    let released = facts.iter().filter_map(|fact| {
        if let SimFact::Hand(HandFact::Released {
            cause: Some(cause),
            hand,
            ..
        }) = fact
        {
            (*cause == command).then_some(*hand)
        } else {
            None
        }
    });
    released.collect()
}
