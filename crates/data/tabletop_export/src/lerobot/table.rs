//! Tables of columns, and their files.

use std::sync::Arc;

use arrow_array::RecordBatch;
use arrow_schema::{ArrowError, Field, Schema};
use parquet::{
    basic::Compression,
    file::properties::{WriterProperties, WriterPropertiesBuilder},
};

use super::columns::Column;

/// The usual properties of files.
pub(super) fn properties() -> WriterPropertiesBuilder {
    WriterProperties::builder().set_compression(Compression::SNAPPY)
}

/// A table of these columns.
pub(super) fn batch(columns: Vec<Column>) -> Result<RecordBatch, ArrowError> {
    let schema = schema_of(&columns);
    RecordBatch::try_new(
        schema,
        columns.into_iter().map(|(_, array)| array).collect(),
    )
}

pub(super) fn schema_of(columns: &[Column]) -> Arc<Schema> {
    let fields: Vec<Field> = columns.iter().map(|(field, _)| field.clone()).collect();
    Arc::new(Schema::new(fields))
}
