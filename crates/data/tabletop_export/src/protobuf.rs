//! Protocol Buffers: messages that know their schemas, so that what is written and what a file says of it cannot differ.

pub(crate) mod schema;
pub(crate) mod wire;

use self::{
    schema::{EnumSchema, FieldSchema, MessageSchema, ProtoKind, SchemaSet},
    wire::{eight_bytes, field, four_bytes, whole},
};

/// A message.
pub(crate) trait Message {
    /// Its name, with the package.
    const NAME: &'static str;
    const ENUMS: &'static [EnumSchema] = &[];

    fn fields() -> Vec<FieldSchema>;

    /// Adds the schemas of the messages that it consists of.
    fn add_parts(to: &mut SchemaSet);

    fn write(&self, to: &mut Vec<u8>);

    /// Adds its schema and those of its parts.
    fn add_schema(to: &mut SchemaSet) {
        if to.knows(Self::NAME) {
            return;
        }
        Self::add_parts(to);
        to.add(MessageSchema {
            name: Self::NAME.to_owned(),
            fields: Self::fields(),
            enums: Self::ENUMS,
        });
    }

    fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.write(&mut bytes);
        bytes
    }
}

/// What a field can hold.
pub(crate) trait FieldValue {
    const KIND: ProtoKind;
    const IS_REPEATED: bool = false;

    fn add_schema(_to: &mut SchemaSet) {}

    fn write(&self, number: u32, to: &mut Vec<u8>);
}

/// A message: its name, its fields as the language of Protocol Buffers has them, and its enumerations.
macro_rules! message {
    ($type:ident = $name:literal { $($number:literal $field:ident: $kind:ty,)* } $($enums:expr)?) => {
        #[derive(Clone, Debug, Default)]
        pub(crate) struct $type {
            $(pub $field: $kind,)*
        }

        impl Message for $type {
            const NAME: &'static str = $name;
            $(const ENUMS: &'static [EnumSchema] = $enums;)?

            fn fields() -> Vec<FieldSchema> {
                vec![$(FieldSchema {
                    name: stringify!($field).trim_start_matches("r#").to_owned(),
                    number: $number,
                    kind: <$kind as FieldValue>::KIND,
                    is_repeated: <$kind as FieldValue>::IS_REPEATED,
                },)*]
            }

            fn add_parts(to: &mut SchemaSet) {
                $(<$kind as FieldValue>::add_schema(to);)*
            }

            fn write(&self, to: &mut Vec<u8>) {
                $(FieldValue::write(&self.$field, $number, to);)*
            }
        }
    };
}
pub(crate) use message;

/// A whole number of 32 bits that takes as many bytes as it needs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Int32(pub u32);

/// Bytes that are no text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bytes(pub Vec<u8>);

impl FieldValue for f64 {
    const KIND: ProtoKind = ProtoKind::Double;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        eight_bytes(to, number, self.to_le_bytes());
    }
}

impl FieldValue for f32 {
    const KIND: ProtoKind = ProtoKind::Float;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        four_bytes(to, number, self.to_le_bytes());
    }
}

impl FieldValue for u64 {
    const KIND: ProtoKind = ProtoKind::Int64;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        whole(to, number, *self);
    }
}

impl FieldValue for Int32 {
    const KIND: ProtoKind = ProtoKind::Int32;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        whole(to, number, u64::from(self.0));
    }
}

impl FieldValue for u32 {
    const KIND: ProtoKind = ProtoKind::Fixed32;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        four_bytes(to, number, self.to_le_bytes());
    }
}

impl FieldValue for Vec<u32> {
    const KIND: ProtoKind = ProtoKind::Fixed32;
    const IS_REPEATED: bool = true;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        let packed: Vec<u8> = self.iter().flat_map(|value| value.to_le_bytes()).collect();
        field(to, number, &packed);
    }
}

impl FieldValue for bool {
    const KIND: ProtoKind = ProtoKind::Bool;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        whole(to, number, u64::from(*self));
    }
}

impl FieldValue for String {
    const KIND: ProtoKind = ProtoKind::Text;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        field(to, number, self.as_bytes());
    }
}

impl FieldValue for Bytes {
    const KIND: ProtoKind = ProtoKind::Bytes;

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        field(to, number, &self.0);
    }
}

impl<M: Message> FieldValue for M {
    const KIND: ProtoKind = ProtoKind::Message(M::NAME);

    fn add_schema(to: &mut SchemaSet) {
        <M as Message>::add_schema(to);
    }

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        field(to, number, &self.to_bytes());
    }
}

impl<M: Message> FieldValue for Vec<M> {
    const KIND: ProtoKind = ProtoKind::Message(M::NAME);
    const IS_REPEATED: bool = true;

    fn add_schema(to: &mut SchemaSet) {
        <M as Message>::add_schema(to);
    }

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        for message in self {
            field(to, number, &message.to_bytes());
        }
    }
}
