//! Schemas of messages, as files hold them for readers that do not know them: a `FileDescriptorSet` (descriptor.proto).

use super::wire::{field, whole};

/// The schema of a message.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MessageSchema {
    /// Its name, with the package.
    pub name: String,
    pub fields: Vec<FieldSchema>,
    pub enums: &'static [EnumSchema],
}

/// The schema of a field.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FieldSchema {
    pub name: String,
    pub number: u32,
    pub kind: ProtoKind,
    pub is_repeated: bool,
}

/// The type of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ProtoKind {
    Double,
    Float,
    Int64,
    Int32,
    Fixed32,
    Bool,
    Text,
    Bytes,
    /// A message, or an enumeration within one, by its name with the package.
    Message(&'static str),
    Enum(&'static str),
}

/// An enumeration within a message: its name, and its values with their numbers.
pub(crate) type EnumSchema = (&'static str, &'static [(&'static str, u64)]);

impl ProtoKind {
    /// Its number in a `FieldDescriptorProto`.
    const fn number(self) -> u64 {
        match self {
            Self::Double => 1,
            Self::Float => 2,
            Self::Int64 => 3,
            Self::Int32 => 5,
            Self::Fixed32 => 7,
            Self::Bool => 8,
            Self::Text => 9,
            Self::Message(_) => 11,
            Self::Bytes => 12,
            Self::Enum(_) => 14,
        }
    }

    const fn type_name(self) -> Option<&'static str> {
        match self {
            Self::Message(name) | Self::Enum(name) => Some(name),
            Self::Double
            | Self::Float
            | Self::Int64
            | Self::Int32
            | Self::Fixed32
            | Self::Bool
            | Self::Text
            | Self::Bytes => None,
        }
    }
}

/// The schemas of a message and of all that it consists of, the innermost first.
#[derive(Clone, Debug, Default)]
pub(crate) struct SchemaSet(Vec<MessageSchema>);

impl SchemaSet {
    pub fn knows(&self, name: &str) -> bool {
        self.0.iter().any(|known| known.name == name)
    }

    /// Adds a message, the parts of which are there.
    pub fn add(&mut self, message: MessageSchema) {
        self.0.push(message);
    }

    /// The `FileDescriptorSet`: a file a message.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut set = Vec::new();
        for message in &self.0 {
            field(&mut set, 1, &file(message));
        }
        set
    }
}

/// The name of the file of a message. Google's are written small.
fn file_name(message: &str) -> String {
    let path = message.replace('.', "/");
    match path.starts_with("google/") {
        true => format!("{}.proto", path.to_lowercase()),
        false => format!("{path}.proto"),
    }
}

fn file(message: &MessageSchema) -> Vec<u8> {
    let (package, name) = message.name.rsplit_once('.').unwrap_or(("", &message.name));
    let mut file = Vec::new();
    field(&mut file, 1, file_name(&message.name).as_bytes());
    field(&mut file, 2, package.as_bytes());
    let mut needed: Vec<_> = message.fields.iter().filter_map(needed_file).collect();
    needed.sort();
    needed.dedup();
    for name in needed {
        field(&mut file, 3, name.as_bytes());
    }
    let mut content = Vec::new();
    field(&mut content, 1, name.as_bytes());
    for own in &message.fields {
        field(&mut content, 2, &field_descriptor(own));
    }
    for own in message.enums {
        field(&mut content, 4, &enum_descriptor(own));
    }
    field(&mut file, 4, &content);
    field(&mut file, 12, b"proto3");
    file
}

/// The file of another message that a field is.
fn needed_file(field: &FieldSchema) -> Option<String> {
    match field.kind {
        ProtoKind::Message(name) => Some(file_name(name)),
        ProtoKind::Double
        | ProtoKind::Float
        | ProtoKind::Int64
        | ProtoKind::Int32
        | ProtoKind::Fixed32
        | ProtoKind::Bool
        | ProtoKind::Text
        | ProtoKind::Bytes
        | ProtoKind::Enum(_) => None,
    }
}

fn field_descriptor(schema: &FieldSchema) -> Vec<u8> {
    const OPTIONAL: u64 = 1;
    const REPEATED: u64 = 3;
    let mut descriptor = Vec::new();
    field(&mut descriptor, 1, schema.name.as_bytes());
    whole(&mut descriptor, 3, u64::from(schema.number));
    let label = match schema.is_repeated {
        true => REPEATED,
        false => OPTIONAL,
    };
    whole(&mut descriptor, 4, label);
    whole(&mut descriptor, 5, schema.kind.number());
    if let Some(name) = schema.kind.type_name() {
        field(&mut descriptor, 6, format!(".{name}").as_bytes());
    }
    descriptor
}

fn enum_descriptor((name, values): &EnumSchema) -> Vec<u8> {
    let mut descriptor = Vec::new();
    field(&mut descriptor, 1, name.as_bytes());
    for (name, number) in *values {
        let mut value = Vec::new();
        field(&mut value, 1, name.as_bytes());
        whole(&mut value, 2, *number);
        field(&mut descriptor, 2, &value);
    }
    descriptor
}
