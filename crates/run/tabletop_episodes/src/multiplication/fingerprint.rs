//! Fingerprints of files: whether they are still the same.

/// The FNV-1a hash of bytes, of 64 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Fingerprint {
    /// That of no bytes.
    pub const EMPTY: Self = Self(0xcbf2_9ce4_8422_2325);

    /// That of the bytes so far, and then these.
    #[must_use]
    pub fn and(self, bytes: &[u8]) -> Self {
        let hash = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        Self(bytes.iter().fold(self.0, hash))
    }

    /// As a number.
    pub const fn number(self) -> u64 {
        self.0
    }
}

impl std::fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_that_of_fnv_1a() {
        assert_eq!(Fingerprint::EMPTY.and(b"").to_string(), "cbf29ce484222325");
        let [at_once, in_parts] = [
            Fingerprint::EMPTY.and(b"foobar"),
            Fingerprint::EMPTY.and(b"foo").and(b"bar"),
        ];
        assert_eq!(at_once.to_string(), "85944171f73967e8");
        assert_eq!(at_once, in_parts);
    }
}
