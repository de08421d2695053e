//! Values of the wire.

use std::collections::BTreeMap;

use crate::array::NumpyArray;

/// A map of values by their keys, which are sent in alphabetical order: the same map is the same bytes.
pub type WireMap = BTreeMap<String, WireValue>;

/// A value of a frame: what MessagePack has, and NumPy's arrays.
#[derive(Clone, Debug, PartialEq)]
pub enum WireValue {
    /// Nothing.
    Nil,
    /// True or false.
    Boolean(bool),
    /// A whole number.
    Integer(i64),
    /// Any other number, and those that are wholly beyond an [`Integer`](Self::Integer).
    Number(f64),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// Values in their order.
    List(Vec<WireValue>),
    /// Values by their keys.
    Map(WireMap),
    /// An array of NumPy's.
    Array(NumpyArray),
}

impl WireValue {
    /// The kind of the value, as faults name it.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Nil => "nothing",
            Self::Boolean(_) => "true or false",
            Self::Integer(_) => "a whole number",
            Self::Number(_) => "a number",
            Self::Text(_) => "a text",
            Self::Bytes(_) => "bytes",
            Self::List(_) => "a list",
            Self::Map(_) => "a map",
            Self::Array(_) => "an array",
        }
    }

    /// The array, if it is one.
    pub const fn array(&self) -> Option<&NumpyArray> {
        match self {
            Self::Array(array) => Some(array),
            Self::Nil
            | Self::Boolean(_)
            | Self::Integer(_)
            | Self::Number(_)
            | Self::Text(_)
            | Self::Bytes(_)
            | Self::List(_)
            | Self::Map(_) => None,
        }
    }

    /// The map, if it is one.
    pub const fn map(&self) -> Option<&WireMap> {
        match self {
            Self::Map(map) => Some(map),
            Self::Nil
            | Self::Boolean(_)
            | Self::Integer(_)
            | Self::Number(_)
            | Self::Text(_)
            | Self::Bytes(_)
            | Self::List(_)
            | Self::Array(_) => None,
        }
    }
}

impl From<&str> for WireValue {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for WireValue {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for WireValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<NumpyArray> for WireValue {
    fn from(array: NumpyArray) -> Self {
        Self::Array(array)
    }
}

impl From<WireMap> for WireValue {
    fn from(map: WireMap) -> Self {
        Self::Map(map)
    }
}
