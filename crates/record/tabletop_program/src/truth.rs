//! Whether conditions hold on the table.

use crate::{
    condition::Condition,
    noun::{HowMany, Noun},
    scene::SceneView,
    selection::{NounSelection, is_tower},
};

impl NounSelection<'_> {
    /// True if a condition holds.
    ///
    /// # Errors
    /// An object that it names is not there, or is not unique.
    pub fn holds(&self, condition: &Condition) -> Result<bool, String> {
        match condition {
            Condition::Is { what, not, spot } => {
                self.is_so(what, |id| Ok(self.is_at(id, spot)? != *not))
            }
            Condition::IsOpen { what } => self.is_so(what, |id| self.is_open(id)),
            Condition::IsClosed { what } => self.is_so(what, |id| Ok(!self.is_open(id)?)),
            Condition::IsHigh { what, count } => {
                if is_tower(what) && self.candidates(what).is_err() {
                    return Ok(false);
                }
                self.is_so(what, |id| Ok(self.view.levels(id) >= *count as usize))
            }
            Condition::ThereIsNo { of } => Ok(self.members(of)?.is_empty()),
            Condition::ThereAre { count, of } => Ok(self.members(of)?.len() >= *count as usize),
            Condition::ThereAreMore { of, than } => {
                Ok(self.members(of)?.len() > self.members(than)?.len())
            }
        }
    }

    /// True if something is so of as many objects as a noun says.
    fn is_so(
        &self,
        noun: &Noun,
        is_so_of: impl Fn(&str) -> Result<bool, String>,
    ) -> Result<bool, String> {
        let candidates = self.candidates(noun)?;
        let mut count = 0;
        for id in &candidates {
            count += usize::from(is_so_of(id)?);
        }
        Ok(match noun {
            Noun::Named { .. } => count == candidates.len(),
            Noun::Described { quantity, .. } => match quantity {
                HowMany::The | HowMany::Every | HowMany::Most { .. } => count == candidates.len(),
                HowMany::Any => count > 0,
                HowMany::Count(least) => count >= *least as usize,
            },
        })
    }

    fn is_open(&self, id: &str) -> Result<bool, String> {
        let part = self.view.sliding_part(id);
        let part = part.ok_or_else(|| format!("{id} has neither lid nor drawer"))?;
        Ok(part.is_open())
    }
}

impl SceneView<'_> {
    /// The number of objects on each other from this one upwards, itself included.
    pub fn levels(&self, id: &str) -> usize {
        let above = self.stack_above(id);
        let mut levels = vec![id];
        let mut count = 1;
        loop {
            let is_next = |other: &&String| {
                levels
                    .iter()
                    .any(|below| self.standing.rests_on(other, below))
            };
            let next: Vec<_> = above.iter().filter(is_next).map(String::as_str).collect();
            // Things that lean on each other have no end.
            if next.is_empty() || count > above.len() {
                return count;
            }
            count += 1;
            levels = next;
        }
    }
}
