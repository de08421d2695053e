//! Messages of named numbers.

use std::collections::BTreeSet;

use tabletop_training::FrameVectors;

use crate::protobuf::{
    FieldValue as _,
    schema::{FieldSchema, MessageSchema, ProtoKind, SchemaSet},
};

/// A message with a field for each number of a frame, in their order: so a reader plots `/state.left_s0`.
pub(crate) struct SignalMessage(MessageSchema);

impl SignalMessage {
    /// The message of this name, with its package.
    pub fn new(name: &str, signal: &FrameVectors) -> Self {
        let mut taken = BTreeSet::new();
        let fields = (1..).zip(&signal.names).map(|(number, name)| FieldSchema {
            name: field_name(name, number, &mut taken),
            number,
            kind: ProtoKind::Float,
            is_repeated: false,
        });
        Self(MessageSchema {
            name: name.to_owned(),
            fields: fields.collect(),
            enums: &[],
        })
    }

    pub fn schemas(&self) -> SchemaSet {
        let mut schemas = SchemaSet::default();
        schemas.add(self.0.clone());
        schemas
    }

    /// The message with these numbers.
    pub fn of(&self, numbers: &[f32]) -> Vec<u8> {
        let mut message = Vec::new();
        for (field, number) in self.0.fields.iter().zip(numbers) {
            number.write(field.number, &mut message);
        }
        message
    }
}

/// A name as fields may have it: letters, digits and underscores, and no other field's. `Red.x` is `Red_x`.
fn field_name(name: &str, number: u32, taken: &mut BTreeSet<String>) -> String {
    let plain = name.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_");
    let mut name = match plain.starts_with(|first: char| first.is_ascii_alphabetic()) {
        true => plain,
        false => format!("n{plain}"),
    };
    while !taken.insert(name.to_lowercase()) {
        name = format!("{name}_{number}");
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_names_of_fields_each_once() {
        let names = ["Red.x", "Red_x", "2 blocks.x", "öse", "left_s0"];
        let signal = FrameVectors::new(names.map(str::to_owned).to_vec());
        let SignalMessage(message) = SignalMessage::new("tabletop.State", &signal);
        let fields: Vec<_> = message.fields.iter().map(|it| it.name.as_str()).collect();
        assert_eq!(
            fields,
            ["Red_x", "Red_x_2", "n2_blocks_x", "n_se", "left_s0"]
        );
    }
}
