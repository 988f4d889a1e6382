//! Parquet form of a table: one row group, with columns compressed by Snappy and the dictionary encoding that the crate uses by
//! default.

use super::{ColumnValues, Columns};
use ::parquet::basic::Compression;
use ::parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type};
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::parser::parse_message_type;
use std::io::{self, Write};
use std::sync::Arc;

impl Columns {
    /// Writes the table as Apache Parquet, with `notes` as its key-value metadata.
    ///
    /// # Errors
    ///
    /// Returns the errors of `out`, and of the encoder if the names of the columns do not form a schema.
    pub fn write_parquet(
        &self,
        notes: Vec<(String, String)>,
        out: impl Write + Send,
    ) -> io::Result<()> {
        let field = |(name, values): &(_, ColumnValues)| match values {
            ColumnValues::Text(_) => format!("required binary {name} (STRING);"),
            ColumnValues::Whole(_) => format!("required int32 {name};"),
            ColumnValues::Number(_) => format!("optional double {name};"),
        };
        let fields: String = self.0.iter().map(field).collect();
        let schema = parse_message_type(&format!("message study {{ {fields} }}"))?;
        let notes = notes
            .into_iter()
            .map(|(key, value)| KeyValue::new(key, value))
            .collect();
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_max_row_group_row_count(None)
            .set_key_value_metadata(Some(notes))
            .build();
        let mut file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
        let mut group = file.next_row_group()?;
        for (_, values) in &self.0 {
            let Some(mut column) = group.next_column()? else {
                break;
            };
            match values {
                ColumnValues::Text(values) => {
                    let values: Vec<ByteArray> = values
                        .iter()
                        .map(|value| ByteArray::from(&**value))
                        .collect();
                    column
                        .typed::<ByteArrayType>()
                        .write_batch(&values, None, None)?;
                }
                ColumnValues::Whole(values) => {
                    column
                        .typed::<Int32Type>()
                        .write_batch(values, None, None)?;
                }
                ColumnValues::Number(values) => {
                    let there: Vec<i16> = values
                        .iter()
                        .map(|value| i16::from(value.is_finite()))
                        .collect();
                    let finite: Vec<f64> = values
                        .iter()
                        .copied()
                        .filter(|value| value.is_finite())
                        .collect();
                    column
                        .typed::<DoubleType>()
                        .write_batch(&finite, Some(&there), None)?;
                }
            }
            column.close()?;
        }
        group.close()?;
        file.close()?;
        Ok(())
    }
}
