//! The deeds that undo takes back and redo brings back, in words.

use bevy::prelude::*;
use tabletop_core::{Act, CommandId, History, HistoryFact, SceneFact, SimFact};

use crate::files::short_name;

/// The deeds that the [`History`] keeps.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(super) struct PastDeeds {
    /// Those that can be undone, the last one last.
    done: Vec<PastDeed>,
    /// Those that can be redone, the last one that was undone last.
    undone: Vec<PastDeed>,
    /// The task file that was read last, and the command that names it.
    read: Option<(CommandId, String)>,
}

/// What a command has done.
#[derive(Clone, Debug, Default, PartialEq)]
struct PastDeed {
    cause: CommandId,
    /// The sentence of a hand's act.
    act: Option<String>,
    /// The task file that was loaded.
    task: Option<String>,
    made: Several,
    removed: Several,
}

/// Some objects.
#[derive(Clone, Debug, Default, PartialEq)]
struct Several {
    first: Option<String>,
    count: usize,
}

impl PastDeeds {
    /// Follows a fact.
    pub fn follow(&mut self, fact: &SimFact) {
        match fact {
            SimFact::History(HistoryFact::SegmentBegun { cause }) => self.begin(*cause),
            SimFact::History(HistoryFact::Kept { cause }) => {
                // That of a hand has begun already.
                if self.done.last() != Some(&self.deed_of(*cause)) {
                    self.begin(*cause);
                }
            }
            SimFact::History(HistoryFact::Undone { .. }) => {
                self.undone.push(self.done.pop().unwrap_or_default());
            }
            SimFact::History(HistoryFact::Redone { .. }) => {
                self.done.push(self.undone.pop().unwrap_or_default());
            }
            SimFact::Scene(SceneFact::TaskLoaded { cause, path, .. }) => {
                self.read = Some((*cause, short_name(path)));
            }
            SimFact::Scene(SceneFact::ObjectCreated { cause, id, .. }) => {
                self.note(*cause, |deed| deed.made.add(id));
            }
            SimFact::Scene(SceneFact::ObjectDeleted { cause, id }) => {
                self.note(*cause, |deed| deed.removed.add(id));
            }
            SimFact::Hand(_) | SimFact::Mechanism(_) => {
                if let (Some(act), Some(last)) = (Act::of(fact), self.done.last_mut()) {
                    last.act.get_or_insert_with(|| act.to_string());
                }
            }
            SimFact::Recording(_) | SimFact::Robot(_) | SimFact::Refused { .. } => {}
        }
    }

    /// Forgets what the history has forgotten.
    pub fn forget(&mut self, history: &History) {
        for (deeds, kept) in [
            (&mut self.done, history.undoable),
            (&mut self.undone, history.redoable),
        ] {
            deeds.drain(..deeds.len().saturating_sub(kept));
        }
    }

    /// The sentence of the deed that was undone last.
    pub fn undone(&self) -> Option<String> {
        self.undone.last()?.sentence()
    }

    /// The sentence of the deed that was done, or brought back, last.
    pub fn done(&self) -> Option<String> {
        self.done.last()?.sentence()
    }

    fn begin(&mut self, cause: CommandId) {
        self.undone.clear();
        self.done.push(self.deed_of(cause));
    }

    fn deed_of(&self, cause: CommandId) -> PastDeed {
        let read = self.read.as_ref().filter(|(reading, _)| *reading == cause);
        PastDeed {
            cause,
            task: read.map(|(_, name)| name.clone()),
            ..default()
        }
    }

    fn note(&mut self, cause: Option<CommandId>, note: impl FnOnce(&mut PastDeed)) {
        if let Some(last) = self
            .done
            .last_mut()
            .filter(|deed| Some(deed.cause) == cause)
        {
            note(last);
        }
    }
}

impl PastDeed {
    fn sentence(&self) -> Option<String> {
        let Self {
            act,
            task,
            made,
            removed,
            ..
        } = self;
        let act = act.clone();
        let act = act.or_else(|| task.as_ref().map(|task| format!("{task} is loaded")));
        act.or_else(|| match (made.count, removed.count) {
            (0, _) => removed.sentence("removed"),
            (_, 0) => made.sentence("made"),
            _ => removed.sentence("changed"),
        })
    }
}

impl Several {
    fn add(&mut self, id: &str) {
        self.first.get_or_insert_with(|| id.to_owned());
        self.count += 1;
    }

    fn sentence(&self, done: &str) -> Option<String> {
        let first = self.first.as_ref()?;
        Some(match self.count {
            1 => format!("{first} is {done}"),
            count => format!("{count} objects are {done}"),
        })
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Hand, HandFact};

    use super::*;

    const CAUSE: CommandId = CommandId(7);

    fn kept() -> SimFact {
        SimFact::History(HistoryFact::Kept { cause: CAUSE })
    }

    fn made(id: &str) -> SimFact {
        SimFact::Scene(SceneFact::ObjectCreated {
            cause: Some(CAUSE),
            id: id.into(),
            object: Entity::PLACEHOLDER,
        })
    }

    fn removed(id: &str) -> SimFact {
        SimFact::Scene(SceneFact::ObjectDeleted {
            cause: Some(CAUSE),
            id: id.into(),
        })
    }

    fn after(facts: &[SimFact]) -> PastDeeds {
        let mut deeds = PastDeeds::default();
        facts.iter().for_each(|fact| deeds.follow(fact));
        deeds
    }

    #[test]
    fn a_deed_is_a_sentence() {
        let read = SimFact::Scene(SceneFact::TaskLoaded {
            cause: CAUSE,
            path: "tablesetup/tower.xml".into(),
            faults: Vec::new(),
        });
        let facts = [
            (vec![kept(), made("red")], Some("red is made")),
            (vec![kept(), removed("red")], Some("red is removed")),
            (
                vec![kept(), removed("red"), made("blue")],
                Some("red is changed"),
            ),
            (
                vec![kept(), made("red"), made("blue")],
                Some("2 objects are made"),
            ),
            (
                vec![read, kept(), removed("red"), made("blue")],
                Some("tower.xml is loaded"),
            ),
            (vec![kept()], None),
        ];
        for (facts, sentence) in facts {
            assert_eq!(after(&facts).done().as_deref(), sentence);
        }
    }

    fn grasp(id: &str) -> [SimFact; 2] {
        let grasped = HandFact::Grasped {
            cause: CAUSE,
            hand: Hand::Left,
            id: id.into(),
        };
        let begun = HistoryFact::SegmentBegun { cause: CAUSE };
        [SimFact::History(begun), SimFact::Hand(grasped)]
    }

    #[test]
    fn what_is_undone_comes_back_until_something_else_is_done() {
        let cause = CommandId(8);
        let undone = SimFact::History(HistoryFact::Undone { cause });
        let redone = SimFact::History(HistoryFact::Redone { cause });
        let mut deeds = after(&[grasp("red"), grasp("blue")].concat());
        deeds.follow(&undone);
        assert_eq!(deeds.undone().as_deref(), Some("LeftHand grasps blue"));
        deeds.follow(&undone);
        assert_eq!(deeds.undone().as_deref(), Some("LeftHand grasps red"));
        assert_eq!(deeds.done(), None);
        deeds.follow(&redone);
        assert_eq!(deeds.done().as_deref(), Some("LeftHand grasps red"));
        deeds.follow(&kept());
        assert_eq!(deeds.undone(), None);
    }

    #[test]
    fn an_act_outside_a_recording_is_one_deed() {
        let [begun, grasped] = grasp("red");
        let deeds = after(&[begun, kept(), grasped]);
        assert_eq!(deeds.done.len(), 1);
        assert_eq!(deeds.done().as_deref(), Some("LeftHand grasps red"));
    }

    #[test]
    fn what_the_history_forgets_is_forgotten() {
        let mut deeds = after(&[grasp("red"), grasp("blue")].concat());
        deeds.forget(&History {
            undoable: 1,
            ..default()
        });
        assert_eq!(deeds.done.len(), 1);
        assert_eq!(deeds.done().as_deref(), Some("LeftHand grasps blue"));
    }
}
