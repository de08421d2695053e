//! The question before the program ends in the middle of something.

use bevy::prelude::*;
use tabletop_core::Recording;

use crate::Editing;

/// Whether the user is asked.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuitQuestion {
    is_open: bool,
}

impl QuitQuestion {
    /// Asks, if there is something to lose. True if it does.
    pub fn asks(&mut self, recording: &Recording, editing: &Editing) -> bool {
        self.is_open = loss(recording, editing).is_some();
        self.is_open
    }

    /// What is lost or cut off if the program ends, as long as the question is open.
    pub fn loss(&self, recording: &Recording, editing: &Editing) -> Option<&'static str> {
        loss(recording, editing).filter(|_| self.is_open)
    }

    /// Takes the question back.
    pub const fn close(&mut self) {
        self.is_open = false;
    }
}

fn loss(recording: &Recording, editing: &Editing) -> Option<&'static str> {
    if recording.0 {
        Some("A recording runs. It ends here if the program does.")
    } else if editing.is_unsaved {
        Some("The open recording has edits that are not saved. They are lost if the program ends.")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_asked_unless_something_is_lost() {
        let mut question = QuitQuestion::default();
        let edited = Editing {
            is_unsaved: true,
            ..default()
        };
        assert!(!question.asks(&Recording(false), &default()));
        assert!(question.asks(&Recording(false), &edited));
        assert!(question.asks(&Recording(true), &default()));
        let loss = question.loss(&Recording(true), &default());
        assert!(loss.is_some_and(|loss| loss.contains("recording")));
    }
}
