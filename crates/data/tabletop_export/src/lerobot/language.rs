//! The language columns: the parts of the task as they become current, and other words for it.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float32Array, ListArray, StringArray, StructArray, new_null_array};
use arrow_buffer::OffsetBuffer;
use arrow_schema::{DataType, Field, Fields};
use tabletop_training::TrainingEpisode;

use super::columns::Column;

/// `language_persistent`: every frame has all rows of the episode, each with the time from which it holds.
pub(super) fn persistent(episode: &TrainingEpisode) -> Column {
    let seconds = |frame: usize| frame as f32 / episode.fps as f32;
    let paraphrases = episode.paraphrases.iter();
    let paraphrases = paraphrases.map(|text| ("user", text.as_str(), "task_aug", 0.0));
    let subtasks = episode.subtasks.iter();
    let subtasks = subtasks.map(|part| {
        let since = seconds(part.frame);
        ("assistant", part.sentence.as_str(), "subtask", since)
    });
    let rows: Vec<_> = paraphrases.chain(subtasks).collect();
    let repeated: Vec<_> = std::iter::repeat_n(&rows, episode.len())
        .flatten()
        .collect();
    let texts = |of: fn(&&(&'static str, &str, &'static str, f32)) -> String| -> ArrayRef {
        Arc::new(StringArray::from_iter_values(repeated.iter().map(of)))
    };
    let times = Float32Array::from_iter_values(repeated.iter().map(|row| row.3));
    let columns = vec![
        texts(|row| row.0.to_owned()),
        texts(|row| row.1.to_owned()),
        texts(|row| row.2.to_owned()),
        Arc::new(times) as ArrayRef,
        new_null_array(&DataType::Utf8, repeated.len()),
        new_null_array(&tool_calls(), repeated.len()),
    ];
    let fields = fields(Some(Field::new("timestamp", DataType::Float32, false)));
    rows_of_frames(
        "language_persistent",
        StructArray::new(fields, columns, None),
        std::iter::repeat_n(rows.len(), episode.len()),
    )
}

/// `language_events`: none.
pub(super) fn events(episode: &TrainingEpisode) -> Column {
    let fields = fields(None);
    rows_of_frames(
        "language_events",
        StructArray::new_null(fields, 0),
        std::iter::repeat_n(0, episode.len()),
    )
}

fn rows_of_frames(
    name: &str,
    rows: StructArray,
    lengths: impl IntoIterator<Item = usize>,
) -> Column {
    let item = Field::new("item", DataType::Struct(rows.fields().clone()), true);
    let item = Arc::new(item);
    let offsets = OffsetBuffer::from_lengths(lengths);
    let field = Field::new(name, DataType::List(item.clone()), true);
    let list = ListArray::new(item, offsets, Arc::new(rows), None);
    (field, Arc::new(list))
}

/// Calls of tools, as texts of JSON.
fn tool_calls() -> DataType {
    DataType::List(Arc::new(Field::new("item", DataType::Utf8, true)))
}

fn fields(timestamp: Option<Field>) -> Fields {
    let texts = [
        Field::new("role", DataType::Utf8, false),
        Field::new("content", DataType::Utf8, true),
        Field::new("style", DataType::Utf8, true),
    ];
    let rest = [
        Field::new("camera", DataType::Utf8, true),
        Field::new("tool_calls", tool_calls(), true),
    ];
    texts.into_iter().chain(timestamp).chain(rest).collect()
}
