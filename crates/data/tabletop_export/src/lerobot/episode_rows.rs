//! The rows of a table of frames, episode by episode, however they are grouped: this program writes a row group an episode, LeRobot one for a whole file.

use std::{collections::VecDeque, ops::Range, sync::Arc};

use arrow_array::RecordBatch;
use arrow_schema::Schema;
use arrow_select::concat::concat_batches;

use super::table_file::TableFile;
use crate::error::ExportError;

/// Bytes of an episode whose rows are in several groups.
const MOST_BYTES: usize = 1 << 32;

/// Rows of a group.
type Part = (usize, Range<usize>);

/// The rows of each episode of a table, one after the other.
pub(super) struct EpisodeRows<'t> {
    table: &'t TableFile,
    episodes: VecDeque<Vec<Part>>,
    /// The group that was read last.
    group: Option<(usize, RecordBatch)>,
}

impl<'t> EpisodeRows<'t> {
    /// Those of a table.
    ///
    /// # Errors
    /// It has no numbers of episodes.
    pub fn of(table: &'t TableFile) -> Result<Self, ExportError> {
        let mut episodes = VecDeque::<Vec<Part>>::new();
        let mut last = None;
        for (group, numbers) in table.whole_numbers("episode_index")?.iter().enumerate() {
            let mut first = 0;
            for rows in numbers.chunk_by(|one, next| one == next) {
                let part = (group, first..first + rows.len());
                first += rows.len();
                match episodes.back_mut() {
                    Some(begun) if last == rows.first().copied() => begun.push(part),
                    Some(_) | None => episodes.push_back(vec![part]),
                }
                last = rows.first().copied();
            }
        }
        Ok(Self {
            table,
            episodes,
            group: None,
        })
    }

    fn part(&mut self, (group, rows): Part) -> Result<RecordBatch, ExportError> {
        let known = self.group.take().filter(|(known, _)| *known == group);
        let batch = match known {
            Some((_, batch)) => batch,
            None => self.table.group(group)?,
        };
        let part = batch.slice(rows.start, rows.len());
        self.group = Some((group, batch));
        Ok(part)
    }

    fn rows(&mut self, parts: Vec<Part>) -> Result<RecordBatch, ExportError> {
        let mut batches = Vec::with_capacity(parts.len());
        let mut bytes = 0_usize;
        for part in parts {
            let batch = self.part(part)?;
            bytes = bytes.saturating_add(batch.get_array_memory_size());
            if bytes > MOST_BYTES {
                let problem = format!("an episode has more than {MOST_BYTES} bytes");
                return Err(ExportError::dataset(self.table.path(), problem));
            }
            batches.push(batch);
        }
        match &batches[..] {
            [whole] => Ok(whole.clone()),
            parts => {
                let schema = parts
                    .first()
                    .map_or_else(|| Arc::new(Schema::empty()), RecordBatch::schema);
                concat_batches(&schema, parts)
                    .map_err(|error| ExportError::dataset(self.table.path(), error))
            }
        }
    }
}

impl Iterator for EpisodeRows<'_> {
    type Item = Result<RecordBatch, ExportError>;

    fn next(&mut self) -> Option<Self::Item> {
        let parts = self.episodes.pop_front()?;
        Some(self.rows(parts))
    }
}
