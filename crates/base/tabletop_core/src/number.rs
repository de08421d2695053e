//! Numbers as recordings and tables show them.

use std::fmt;

/// A number displayed as in the original program's recordings: the shortest digits that read back to the same `f32`,
/// always with a decimal point, and with an exponent below 0.001 and from ten million.
///
/// ```
/// use tabletop_core::Decimal;
///
/// assert_eq!(Decimal(1.0).to_string(), "1.0");
/// assert_eq!(Decimal(-0.0).to_string(), "-0.0");
/// assert_eq!(Decimal(45.000004).to_string(), "45.000004");
/// assert_eq!(Decimal(0.0001).to_string(), "1.0E-4");
/// assert_eq!(Decimal(12345678.0).to_string(), "1.2345678E7");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decimal(pub f32);

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if !size.is_finite() || size == 0.0 || (1e-3..1e7).contains(&size) {
            return write!(f, "{:?}", self.0);
        }
        let scientific = format!("{:e}", self.0);
        let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
        let point = if digits.contains('.') { "" } else { ".0" };
        write!(f, "{digits}{point}E{exponent}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_size_reads_back() {
        for number in [
            0.001,
            0.000_999_9,
            9_999_999.0,
            1e7,
            1.5e-30,
            -3.25e20,
            f32::MIN_POSITIVE,
            f32::MAX,
            0.1,
            -180.0,
        ] {
            assert_eq!(Decimal(number).to_string().parse(), Ok(number));
        }
        assert_eq!(Decimal(0.001).to_string(), "0.001");
        assert_eq!(Decimal(9_999_999.0).to_string(), "9999999.0");
        assert_eq!(Decimal(1e10).to_string(), "1.0E10");
    }
}
