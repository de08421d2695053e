//! Drafts: the recordings that edits have made of the one that was opened, until they are saved.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_storage::TemporaryFolder;

/// The edits of a recording that can be undone and redone.
#[derive(Resource, Debug, Default)]
pub(super) struct Drafts {
    /// The recording before all edits.
    original: PathBuf,
    /// What the edits have made of it, one of the other.
    drafts: Vec<Draft>,
}

/// A recording that an edit has made.
#[derive(Debug)]
pub(super) struct Draft {
    /// Its folder, named like the original one.
    pub folder: PathBuf,
    pub is_saved: bool,
    /// The place of the folder, which disappears with the draft.
    pub _place: TemporaryFolder,
}

impl Drafts {
    /// The recording before all edits of the one in a folder.
    pub fn original<'f>(&'f self, folder: &'f Path) -> &'f Path {
        match self.edits(folder) {
            Some(_) => &self.original,
            None => folder,
        }
    }

    /// Number of edits that have led from the original to the recording in a folder; `None` if none can have.
    fn edits(&self, folder: &Path) -> Option<usize> {
        if self.original == folder {
            return Some(0);
        }
        let place = self.drafts.iter().position(|draft| draft.folder == folder);
        place.map(|place| place + 1)
    }

    /// Numbers of edits that can be undone and redone while the recording in a folder is open.
    pub fn undoable_and_redoable(&self, folder: &Path) -> (usize, usize) {
        let edits = self.edits(folder);
        edits.map_or((0, 0), |edits| (edits, self.drafts.len() - edits))
    }

    /// The recording before the last edit of the one in a folder.
    pub fn before(&self, folder: &Path) -> Option<&Path> {
        let edits = self.edits(folder)?.checked_sub(1)?;
        match edits.checked_sub(1) {
            None => Some(&self.original),
            Some(place) => Some(&self.drafts.get(place)?.folder),
        }
    }

    /// The recording after the edit of the one in a folder that was undone last.
    pub fn after(&self, folder: &Path) -> Option<&Path> {
        let next = self.drafts.get(self.edits(folder)?)?;
        Some(&next.folder)
    }

    /// Adds what an edit has made of the recording in a folder. Undone edits, and those of another recording, are forgotten.
    pub fn add(&mut self, edited: &Path, draft: Draft) {
        match self.edits(edited) {
            Some(edits) => self.drafts.truncate(edits),
            None => {
                self.original = edited.to_owned();
                self.drafts.clear();
            }
        }
        self.drafts.push(draft);
    }

    /// Notes that the recording in a folder is saved.
    pub fn note_saved(&mut self, folder: &Path) {
        let draft = self.drafts.iter_mut().find(|draft| draft.folder == folder);
        if let Some(draft) = draft {
            draft.is_saved = true;
        }
    }

    /// True if the recording in a folder is a draft that is saved nowhere.
    pub fn is_unsaved(&self, folder: &Path) -> bool {
        let draft = self.drafts.iter().find(|draft| draft.folder == folder);
        draft.is_some_and(|draft| !draft.is_saved)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draft() -> Draft {
        let place = TemporaryFolder::new("tabletop-test").unwrap();
        Draft {
            folder: place.path().join("demo"),
            is_saved: false,
            _place: place,
        }
    }

    #[test]
    fn edits_are_undone_and_redone_until_another_one_is_made() {
        let demo = Path::new("demo");
        let mut drafts = Drafts::default();
        assert_eq!(drafts.undoable_and_redoable(demo), (0, 0));
        let (first, second, third) = (draft(), draft(), draft());
        let [one, two, three] = [&first, &second, &third].map(|draft| draft.folder.clone());
        drafts.add(demo, first);
        drafts.add(&one, second);
        assert_eq!(drafts.undoable_and_redoable(&two), (2, 0));
        assert_eq!(drafts.before(&two), Some(&*one));
        assert_eq!(drafts.before(&one), Some(demo));
        assert_eq!(drafts.before(demo), None);
        assert_eq!(drafts.after(demo), Some(&*one));
        assert_eq!(drafts.after(&two), None);
        assert_eq!(drafts.original(&two), demo);
        let place = two.parent().unwrap();
        assert!(place.exists());
        drafts.add(&one, third);
        assert!(!place.exists(), "an undone edit is forgotten");
        assert_eq!(drafts.after(&one), Some(&*three));
        assert_eq!(drafts.undoable_and_redoable(demo), (0, 2));
        assert_eq!(drafts.undoable_and_redoable(&two), (0, 0));
    }

    #[test]
    fn a_draft_is_unsaved_until_it_is_saved() {
        let demo = Path::new("demo");
        let mut drafts = Drafts::default();
        let draft = draft();
        let folder = draft.folder.clone();
        drafts.add(demo, draft);
        assert!(drafts.is_unsaved(&folder) && !drafts.is_unsaved(demo));
        drafts.note_saved(&folder);
        assert!(!drafts.is_unsaved(&folder));
    }

    #[test]
    fn an_edit_of_another_recording_begins_anew() {
        let mut drafts = Drafts::default();
        let (first, second) = (draft(), draft());
        let [one, two] = [&first, &second].map(|draft| draft.folder.clone());
        drafts.add(Path::new("demo"), first);
        drafts.add(Path::new("other"), second);
        assert_eq!(drafts.original(&two), Path::new("other"));
        assert_eq!(drafts.undoable_and_redoable(&one), (0, 0));
        assert!(!one.parent().unwrap().exists());
    }
}
