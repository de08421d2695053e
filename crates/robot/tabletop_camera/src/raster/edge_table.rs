//! The edge table: the triangles that begin in each row.

use std::ops::Range;

/// The triangles of each band of rows, in the order of the rows in which they come up, as in a scan-line algorithm.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeTable {
    /// The first and the last band of each triangle.
    bands: Vec<[u32; 2]>,
    by_row: Buckets,
    by_band: Buckets,
}

/// Numbers that are sorted into buckets, in the order in which they come.
#[derive(Clone, Debug, Default)]
struct Buckets {
    numbers: Vec<u32>,
    /// The start of each bucket, and the end of the last one.
    starts: Vec<u32>,
}

impl EdgeTable {
    /// Sorts triangles that come up in these rows and may be seen in those.
    pub fn sort<'a, const ROWS_IN_BAND: u32>(
        &mut self,
        comes_up: &[u32],
        rows: impl Iterator<Item = &'a Range<u32>>,
        height: u32,
    ) {
        self.bands.clear();
        let bands = rows.map(|rows| [rows.start, rows.end - 1].map(|row| row / ROWS_IN_BAND));
        self.bands.extend(bands);
        self.by_row.clear(height);
        for &row in comes_up {
            self.by_row.count(row);
        }
        self.by_row.make_room();
        for (&row, number) in comes_up.iter().zip(0..) {
            self.by_row.put(row, number);
        }
        self.by_band.clear(height.div_ceil(ROWS_IN_BAND));
        for &[first, last] in &self.bands {
            (first..=last).for_each(|band| self.by_band.count(band));
        }
        self.by_band.make_room();
        for &number in &self.by_row.numbers {
            let [first, last] = self.bands[number as usize];
            (first..=last).for_each(|band| self.by_band.put(band, number));
        }
    }

    /// The triangles of a band. Those that come up in the same row are in the order of the scene.
    pub fn in_band(&self, band: u32) -> &[u32] {
        // A bucket starts where, once all are filled, the one before ends.
        let ends = &self.by_band.starts;
        let [start, end] = [band, band + 1].map(|i| ends[i as usize] as usize);
        &self.by_band.numbers[start..end]
    }
}

impl Buckets {
    /// Empties this number of buckets.
    fn clear(&mut self, buckets: u32) {
        self.starts.clear();
        self.starts.resize(buckets as usize + 2, 0);
    }

    /// Counts one more number for a bucket.
    fn count(&mut self, bucket: u32) {
        self.starts[bucket as usize + 2] += 1;
    }

    /// Makes room for the numbers that were counted.
    fn make_room(&mut self) {
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        self.numbers.resize(sum as usize, 0);
    }

    /// Puts a number into a bucket, behind those that are there.
    fn put(&mut self, bucket: u32, number: u32) {
        // The start of the next bucket moves, and is where it belongs once this one is full.
        let end = &mut self.starts[bucket as usize + 1];
        self.numbers[*end as usize] = number;
        *end += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_are_in_all_their_bands_and_come_up_in_order() {
        let mut table = EdgeTable::default();
        let rows = [4..6, 0..9, 3..4, 3..5];
        table.sort::<4>(&rows.clone().map(|rows| rows.start), rows.iter(), 12);
        assert_eq!(
            [0, 1, 2].map(|band| table.in_band(band).to_vec()),
            [vec![1, 2, 3], vec![1, 3, 0], vec![1]]
        );
    }
}
