//! Columns of Arrow tables.

use std::sync::Arc;

use arrow_array::{
    ArrayRef, BinaryArray, FixedSizeListArray, Float32Array, Float64Array, Int64Array, ListArray,
    StringArray, StructArray,
};
use arrow_buffer::OffsetBuffer;
use arrow_schema::{DataType, Field, Fields};

/// A column with its name.
pub(super) type Column = (Field, ArrayRef);

fn column(name: &str, array: ArrayRef) -> Column {
    (Field::new(name, array.data_type().clone(), true), array)
}

/// Whole numbers.
pub(super) fn int64(name: &str, values: impl IntoIterator<Item = usize>) -> Column {
    let values = values.into_iter().map(|value| value as i64);
    column(name, Arc::new(Int64Array::from_iter_values(values)))
}

/// Numbers.
pub(super) fn float32(name: &str, values: impl IntoIterator<Item = f32>) -> Column {
    column(name, Arc::new(Float32Array::from_iter_values(values)))
}

/// Numbers of 64 bits.
pub(super) fn float64(name: &str, values: impl IntoIterator<Item = f64>) -> Column {
    column(name, Arc::new(Float64Array::from_iter_values(values)))
}

/// Texts.
pub(super) fn strings<'t>(name: &str, values: impl IntoIterator<Item = &'t str>) -> Column {
    column(name, Arc::new(StringArray::from_iter_values(values)))
}

/// Vectors of a fixed number of numbers.
pub(super) fn vectors(name: &str, width: usize, values: &[f32]) -> Column {
    let item = Arc::new(Field::new("item", DataType::Float32, true));
    let values = Arc::new(Float32Array::from(values.to_vec()));
    let width = i32::try_from(width).unwrap_or(i32::MAX);
    column(
        name,
        Arc::new(FixedSizeListArray::new(item, width, values, None)),
    )
}

/// Pictures of numbers: of each row, so many rows and columns.
pub(super) fn pictures(name: &str, [rows, columns]: [usize; 2], values: ArrayRef) -> Column {
    let count = values.len() / columns.max(1);
    let lines = list(values, std::iter::repeat_n(columns, count));
    lists(name, lines, std::iter::repeat_n(rows, count / rows.max(1)))
}

/// Files, each with its name: the form in which `datasets` keeps pictures.
pub(super) fn files<'f>(
    name: &str,
    files: impl IntoIterator<Item = &'f [u8]>,
    names: impl IntoIterator<Item = String>,
) -> Column {
    let bytes: ArrayRef = Arc::new(BinaryArray::from_iter_values(files));
    let names: ArrayRef = Arc::new(StringArray::from_iter_values(names));
    let fields = Fields::from(vec![
        Field::new("bytes", DataType::Binary, true),
        Field::new("path", DataType::Utf8, true),
    ]);
    column(
        name,
        Arc::new(StructArray::new(fields, vec![bytes, names], None)),
    )
}

/// A list in each row: `lengths` of the items.
pub(super) fn lists(
    name: &str,
    items: ArrayRef,
    lengths: impl IntoIterator<Item = usize>,
) -> Column {
    column(name, list(items, lengths))
}

fn list(items: ArrayRef, lengths: impl IntoIterator<Item = usize>) -> ArrayRef {
    let item = Arc::new(Field::new("item", items.data_type().clone(), true));
    let offsets = OffsetBuffer::from_lengths(lengths);
    Arc::new(ListArray::new(item, offsets, items, None))
}

/// A list of texts in each row.
pub(super) fn string_lists(name: &str, rows: &[Vec<&str>]) -> Column {
    let items = StringArray::from_iter_values(rows.iter().flatten());
    lists(name, Arc::new(items), rows.iter().map(Vec::len))
}

/// A tensor in each row: numbers, each in this many lists of its own besides the outermost.
pub(super) fn tensors(name: &str, rows: &[&[f64]], inner_lists: usize) -> Column {
    let count = rows.iter().map(|row| row.len()).sum();
    let values = rows.iter().flat_map(|row| row.iter().copied());
    let mut items: ArrayRef = Arc::new(Float64Array::from_iter_values(values));
    for _ in 0..inner_lists {
        items = list(items, std::iter::repeat_n(1, count));
    }
    lists(name, items, rows.iter().map(|row| row.len()))
}
