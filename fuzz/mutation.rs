//! Small changes of texts and bytes.

/// A small random stream (SplitMix64).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64, number: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ number);
        Self(random.next())
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below this one, or 0.
    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

/// Numbers that are at the end of something.
const NUMBERS: [&str; 24] = [
    "0",
    "-0",
    "-0.0",
    "1",
    "-1",
    "0.001",
    "0.000999",
    "1000",
    "1000.1",
    "1e-45",
    "1e38",
    "1e39",
    "-1e39",
    "1e308",
    "1e309",
    "NaN",
    "inf",
    "-inf",
    "2147483648",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "360",
    "0x10",
];

const BYTES: [u8; 12] = [
    0, 1, 0x7f, 0x80, 0xff, b'<', b'>', b'"', b'{', b'}', b'\n', b' ',
];

/// Changes something somewhere.
pub fn mutate(bytes: &mut Vec<u8>, corpus: &[Vec<u8>], words: &[Vec<u8>], random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    let length = 1 << random.below(8);
    let end = bytes.len().min(at + 1 + random.below(length));
    match random.below(12) {
        0 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        1 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte = BYTES[random.below(BYTES.len())];
            }
        }
        2 => bytes.insert(at, random.next() as u8),
        3 => drop(bytes.drain(at..end)),
        4 => {
            // Something again, perhaps often.
            let most = 1 << random.below(9);
            let times = 1 + random.below(most);
            let part = bytes[at..end].repeat(times.min(1 + 20_000 / (end - at).max(1)));
            bytes.splice(at..at, part);
        }
        5 => bytes.truncate(at),
        6 | 7 => replace_number(bytes, at, random),
        8 => {
            // The end of another one.
            let other = &corpus[random.below(corpus.len())];
            let from = random.below(other.len() + 1);
            bytes.splice(at.., other[from..].iter().copied());
        }
        9 => {
            // A part from elsewhere in it.
            let from = random.below(bytes.len() + 1);
            let to = bytes.len().min(from + 1 + random.below(length));
            let part = bytes[from..to].to_vec();
            bytes.splice(at..end, part);
        }
        _ => {
            if let Some(word) = words.get(random.below(words.len())) {
                let end = [at, end][random.below(2)];
                bytes.splice(at..end, word.iter().copied());
            }
        }
    }
}

/// Puts another number in the place of the next one.
fn replace_number(bytes: &mut Vec<u8>, at: usize, random: &mut Random) {
    let is_of_number = |byte: &u8| byte.is_ascii_digit() || b"+-.e".contains(byte);
    let Some(start) = bytes[at..].iter().position(u8::is_ascii_digit) else {
        return;
    };
    let start = at + start;
    let length = bytes[start..].iter().position(|byte| !is_of_number(byte));
    let end = length.map_or(bytes.len(), |length| start + length);
    let number = NUMBERS[random.below(NUMBERS.len())];
    bytes.splice(start..end, number.bytes());
}
