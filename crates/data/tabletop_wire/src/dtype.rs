//! Types of the numbers in arrays.

use half::f16;

/// The type of the numbers in an array. Objects, records, texts, times and complex numbers are refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dtype {
    /// True or false, a byte each.
    Bool,
    /// 8 bits with sign.
    I8,
    /// 16 bits with sign.
    I16,
    /// 32 bits with sign.
    I32,
    /// 64 bits with sign.
    I64,
    /// 8 bits.
    U8,
    /// 16 bits.
    U16,
    /// 32 bits.
    U32,
    /// 64 bits.
    U64,
    /// Half precision.
    F16,
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

impl Dtype {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Bool,
        Self::I8,
        Self::I16,
        Self::I32,
        Self::I64,
        Self::U8,
        Self::U16,
        Self::U32,
        Self::U64,
        Self::F16,
        Self::F32,
        Self::F64,
    ];

    /// Its name in NumPy, little-endian: `<f4`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bool => "|b1",
            Self::I8 => "|i1",
            Self::I16 => "<i2",
            Self::I32 => "<i4",
            Self::I64 => "<i8",
            Self::U8 => "|u1",
            Self::U16 => "<u2",
            Self::U32 => "<u4",
            Self::U64 => "<u8",
            Self::F16 => "<f2",
            Self::F32 => "<f4",
            Self::F64 => "<f8",
        }
    }

    /// Bytes of a number.
    pub const fn bytes(self) -> usize {
        match self {
            Self::Bool | Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 | Self::F16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The type of a name in NumPy, and whether the bytes of its numbers are in the other order.
    pub(crate) fn named(name: &str) -> Option<(Self, bool)> {
        let mut letters = name.chars();
        let order = letters.next()?;
        let kind = letters.as_str();
        let dtype = Self::ALL.into_iter().find(|it| &it.name()[1..] == kind)?;
        match (order, dtype.bytes()) {
            ('|' | '<' | '>' | '=', 1) | ('<', _) => Some((dtype, false)),
            ('>', _) => Some((dtype, true)),
            _ => None,
        }
    }

    /// The number that these bytes are, little-endian; 0 if they are too few. Whole numbers beyond 2^53 are rounded.
    pub(crate) fn number(self, bytes: &[u8]) -> f64 {
        fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
            bytes.first_chunk().copied().unwrap_or([0; N])
        }
        match self {
            Self::Bool => f64::from(u8::from(bytes.first().is_some_and(|byte| *byte != 0))),
            Self::I8 => f64::from(i8::from_le_bytes(first(bytes))),
            Self::I16 => f64::from(i16::from_le_bytes(first(bytes))),
            Self::I32 => f64::from(i32::from_le_bytes(first(bytes))),
            Self::I64 => i64::from_le_bytes(first(bytes)) as f64,
            Self::U8 => f64::from(u8::from_le_bytes(first(bytes))),
            Self::U16 => f64::from(u16::from_le_bytes(first(bytes))),
            Self::U32 => f64::from(u32::from_le_bytes(first(bytes))),
            Self::U64 => u64::from_le_bytes(first(bytes)) as f64,
            Self::F16 => f16::from_le_bytes(first(bytes)).to_f64(),
            Self::F32 => f64::from(f32::from_le_bytes(first(bytes))),
            Self::F64 => f64::from_le_bytes(first(bytes)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_numpys() {
        for dtype in Dtype::ALL {
            assert_eq!(Dtype::named(dtype.name()), Some((dtype, false)));
        }
        assert_eq!(Dtype::named(">f4"), Some((Dtype::F32, true)));
        assert_eq!(Dtype::named(">u1"), Some((Dtype::U8, false)));
        for strange in ["", "|O", "<c8", "|V3", "<U5", "<M8[ns]", "f4", "|f4", "é"] {
            assert_eq!(Dtype::named(strange), None, "{strange}");
        }
    }

    #[test]
    fn numbers_are_those_of_their_bytes() {
        assert_eq!(Dtype::F16.number(&[0x00, 0x3e]), 1.5);
        assert_eq!(Dtype::F32.number(&1.5_f32.to_le_bytes()), 1.5);
        assert_eq!(Dtype::I16.number(&[0xfe, 0xff]), -2.0);
        assert_eq!(Dtype::U16.number(&[0xfe, 0xff]), 65534.0);
        assert_eq!(Dtype::Bool.number(&[7]), 1.0);
        assert_eq!(Dtype::F64.number(&[]), 0.0);
    }
}
