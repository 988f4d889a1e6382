//! The Parquet form: one row group, columns compressed by Snappy, text and the axes by dictionary.

use super::{ColumnValues, Columns};
use ::parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical};
use ::parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::Type;
use std::io::{self, Write};
use std::sync::Arc;

pub(super) fn write(columns: &Columns, notes: &[(String, String)], out: impl Write + Send) -> io::Result<()> {
    write_file(columns, notes, out).map_err(io::Error::other)
}

fn write_file(columns: &Columns, notes: &[(String, String)], out: impl Write + Send) -> Result<(), ParquetError> {
    let fields = columns.columns().iter().map(|(name, values)| field(name, values)).collect::<Result<_, _>>()?;
    let schema = Arc::new(Type::group_type_builder("study").with_fields(fields).build()?);
    let notes = notes.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone())).collect();
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_max_row_group_row_count(None)
        .set_key_value_metadata(Some(notes))
        .build();
    let mut file = SerializedFileWriter::new(out, schema, Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for (_, values) in columns.columns() {
        let Some(mut column) = group.next_column()? else { break };
        match values {
            ColumnValues::Text(values) => {
                let values: Vec<ByteArray> = values.iter().map(|value| ByteArray::from(&**value)).collect();
                column.typed::<ByteArrayType>().write_batch(&values, None, None)?;
            }
            ColumnValues::Whole(values) => {
                column.typed::<Int32Type>().write_batch(values, None, None)?;
            }
            ColumnValues::Number(values) => {
                let there: Vec<i16> = values.iter().map(|value| i16::from(value.is_finite())).collect();
                let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
                column.typed::<DoubleType>().write_batch(&finite, Some(&there), None)?;
            }
        }
        column.close()?;
    }
    group.close()?;
    file.close()?;
    Ok(())
}

fn field(name: &str, values: &ColumnValues) -> Result<Arc<Type>, ParquetError> {
    let (physical, repetition) = match values {
        ColumnValues::Text(_) => (Physical::BYTE_ARRAY, Repetition::REQUIRED),
        ColumnValues::Whole(_) => (Physical::INT32, Repetition::REQUIRED),
        ColumnValues::Number(_) => (Physical::DOUBLE, Repetition::OPTIONAL),
    };
    let mut builder = Type::primitive_type_builder(name, physical).with_repetition(repetition);
    if matches!(values, ColumnValues::Text(_)) {
        builder = builder.with_logical_type(Some(LogicalType::String)).with_converted_type(ConvertedType::UTF8);
    }
    Ok(Arc::new(builder.build()?))
}
