//! Columns of Arrow tables, read back.

use arrow_array::{
    Array as _, ArrayRef, RecordBatch,
    cast::AsArray as _,
    types::{ArrowPrimitiveType, Int64Type},
};

/// A column of this name.
pub(super) fn column<'b>(batch: &'b RecordBatch, name: &str) -> Result<&'b ArrayRef, String> {
    let column = batch.column_by_name(name);
    column.ok_or_else(|| format!("there is no column {name}"))
}

/// The whole numbers of a column.
pub(super) fn whole_numbers<'b>(batch: &'b RecordBatch, name: &str) -> Result<&'b [i64], String> {
    let numbers = column(batch, name)?.as_primitive_opt::<Int64Type>();
    let numbers = numbers.ok_or_else(|| format!("{name} has other than whole numbers"))?;
    Ok(numbers.values())
}

/// The numbers in each row of a column, whatever lists they are in; none if there is no such column.
pub(super) fn rows_of<N: ArrowPrimitiveType>(
    batch: &RecordBatch,
    name: &str,
) -> Result<Vec<Vec<N::Native>>, String> {
    let Some(column) = batch.column_by_name(name) else {
        return Ok(Vec::new());
    };
    let rows = (0..column.len()).map(|row| {
        let mut values = column.slice(row, 1);
        loop {
            let inner = match (values.as_fixed_size_list_opt(), values.as_list_opt::<i32>()) {
                (Some(list), _) => {
                    let width = list.value_length() as usize;
                    let first = list.value_offset_at(0);
                    list.values().slice(first, list.len() * width)
                }
                (None, Some(list)) => {
                    let offsets = list.value_offsets();
                    let (first, last) = (offsets[0] as usize, offsets[list.len()] as usize);
                    list.values().slice(first, last - first)
                }
                (None, None) => break,
            };
            values = inner;
        }
        let numbers = values.as_primitive_opt::<N>();
        let numbers = numbers.ok_or_else(|| format!("{name} has other numbers"))?;
        Ok(numbers.values().to_vec())
    });
    rows.collect()
}
