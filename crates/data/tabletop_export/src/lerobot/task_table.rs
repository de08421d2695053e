//! `meta/tasks.parquet`: the sentences of the tasks, which are the index of a pandas table.

use std::{collections::HashMap, path::Path, sync::Arc};

use arrow_array::{cast::AsArray as _, types::Int64Type};
use parquet::{arrow::ArrowWriter, file::metadata::KeyValue};
use serde_json::json;
use tabletop_storage::{InnerFile, InnerPath};

use super::{
    columns,
    table::{batch, properties},
    table_file::TableFile,
};
use crate::error::ExportError;

const PATH: &str = "meta/tasks.parquet";
/// The column of an index to which pandas knows no name: LeRobot's recorder gives it none.
const NAMELESS_INDEX: &str = "__index_level_0__";

/// The table of these sentences. Without pandas' own description, readers take numbers for the index and the sentences are lost.
pub(super) fn write(tasks: &[String]) -> Result<Vec<u8>, ExportError> {
    let pandas = json!({
        "index_columns": ["task"],
        "column_indexes": [{
            "name": null,
            "field_name": null,
            "pandas_type": "unicode",
            "numpy_type": "object",
            "metadata": { "encoding": "UTF-8" },
        }],
        "columns": [
            { "name": "task_index", "field_name": "task_index", "pandas_type": "int64", "numpy_type": "int64", "metadata": null },
            { "name": "task", "field_name": "task", "pandas_type": "unicode", "numpy_type": "object", "metadata": null },
        ],
        "creator": { "library": "tabletop", "version": env!("CARGO_PKG_VERSION") },
        "pandas_version": "2.2.3",
    });
    let bytes = (|| {
        let batch = batch(vec![
            columns::int64("task_index", 0..tasks.len()),
            columns::strings("task", tasks.iter().map(String::as_str)),
        ])?;
        // In the Arrow schema, where pyarrow looks, and in the file itself.
        let schema = batch.schema().as_ref().clone();
        let described = HashMap::from([("pandas".to_owned(), pandas.to_string())]);
        let batch = batch.with_schema(Arc::new(schema.with_metadata(described)))?;
        let entry = KeyValue::new("pandas".to_owned(), pandas.to_string());
        let properties = properties()
            .set_key_value_metadata(Some(vec![entry]))
            .build();
        let mut bytes = Vec::new();
        let mut writer = ArrowWriter::try_new(&mut bytes, batch.schema(), Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok::<_, parquet::errors::ParquetError>(bytes)
    })();
    bytes.map_err(|error| ExportError::dataset(PATH, error))
}

/// The sentences of a dataset.
pub(super) fn read(folder: &Path) -> Result<Vec<String>, ExportError> {
    let file = InnerFile::new(folder, InnerPath::fixed(PATH));
    let table = TableFile::open(&file)?;
    let fault = |problem: &str| ExportError::dataset(table.path(), problem);
    let mut tasks = Vec::new();
    for batch in table.all_groups() {
        let batch = batch?;
        let numbers = batch.column_by_name("task_index");
        let numbers = numbers.and_then(|column| column.as_primitive_opt::<Int64Type>());
        let sentences = batch.column_by_name("task");
        let sentences = sentences.or_else(|| batch.column_by_name(NAMELESS_INDEX));
        let sentences = sentences.and_then(|column| column.as_string_opt::<i32>());
        let (Some(numbers), Some(sentences)) = (numbers, sentences) else {
            return Err(fault("expected the columns task_index and task"));
        };
        for row in 0..numbers.len() {
            if numbers.value(row) != tasks.len() as i64 {
                return Err(fault("expected tasks numbered from 0 on"));
            }
            tasks.push(sentences.value(row).to_owned());
        }
    }
    Ok(tasks)
}
