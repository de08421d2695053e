//! The program that the last demonstrations mean.

use bevy::prelude::*;
use tabletop_core::SceneSpec;
use tabletop_program::{Example, Meaning, TaskProgram, Untouched};
use tabletop_user::{OtherProgram, TaughtProgram};

use crate::background::BackgroundWork;

/// The demonstrations of a program, and what they mean.
#[derive(Resource, Default)]
pub(super) struct Teaching {
    examples: Vec<Example>,
    meaning: Option<Meaning>,
    /// The search for what they mean, while it goes on.
    search: Option<BackgroundWork<Meaning>>,
    /// True if the next recording is one more demonstration of the program.
    is_awaiting: bool,
}

/// Takes over what was found, and publishes it for panels.
pub(super) fn take_meaning(mut teaching: ResMut<Teaching>, mut taught: ResMut<TaughtProgram>) {
    let search = teaching.bypass_change_detection().search.as_mut();
    if let Some(found) = search.and_then(BackgroundWork::result) {
        teaching.search = None;
        teaching.meaning = found.ok();
    }
    if teaching.is_changed() {
        taught.set_if_neq(teaching.published());
    }
}

impl Teaching {
    /// Takes in a demonstration: one more of the program if that was awaited, or the first one of another. `None` shows what no program says.
    pub fn show(&mut self, example: Option<Example>) {
        if !std::mem::take(&mut self.is_awaiting) {
            self.examples.clear();
        }
        self.meaning = None;
        self.examples.extend(example);
        let examples = self.examples.clone();
        let search = move || Ok(Meaning::of(&examples));
        self.search = (!self.examples.is_empty()).then(|| BackgroundWork::begin(search));
    }

    /// Takes the next recording as one more demonstration.
    pub fn await_another(&mut self) {
        self.is_awaiting = true;
    }

    /// The table on which another program acts differently, from 1.
    pub fn question(&self, number: usize) -> Option<SceneSpec> {
        let others = &self.meaning.as_ref()?.alternatives;
        let other = others.get(number.checked_sub(1)?)?;
        Some(other.decided_by.scene.items())
    }

    /// Another program is the one that is meant, from 1.
    pub fn answer(&mut self, number: usize) -> Result<(), String> {
        let meaning = self.meaning.as_ref();
        let answered = meaning.and_then(|meaning| meaning.answered(number));
        self.meaning = Some(answered.ok_or("there is no such program")?);
        self.is_awaiting = false;
        Ok(())
    }

    /// The program that is meant.
    pub fn program(&self) -> Option<&TaskProgram> {
        self.meaning.as_ref()?.program.as_ref()
    }

    fn published(&self) -> TaughtProgram {
        let demonstrations = self.examples.len();
        let Some(meaning) = &self.meaning else {
            return TaughtProgram::default();
        };
        let others = meaning.alternatives.iter().map(|other| OtherProgram {
            sentences: other.program.in_a_line(),
            differs: other.decided_by.sentence.clone(),
        });
        let fault = match (&meaning.program, demonstrations) {
            (Some(_), _) => None,
            (None, 1) => Some("no program explains this demonstration".to_owned()),
            (None, number) => Some(format!("no program explains all {number} demonstrations")),
        };
        TaughtProgram {
            sentences: meaning
                .program
                .as_ref()
                .map_or_else(String::new, TaskProgram::in_a_line),
            demonstrations,
            others: others.collect(),
            untouched: meaning.untouched.iter().map(Untouched::to_string).collect(),
            is_awaiting: self.is_awaiting,
            fault,
        }
    }
}
