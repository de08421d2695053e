//! The edge table: the triangles that begin in each row.

use std::ops::Range;

/// The triangles of each band of rows, in the order of the rows in which they begin, as in a scan-line algorithm.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeTable {
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
    /// Sorts triangles that may be seen in these rows.
    pub fn sort<'a>(
        &mut self,
        rows: impl Iterator<Item = &'a Range<u32>> + Clone,
        height: u32,
        rows_in_band: u32,
    ) {
        let first_rows = rows.clone().zip(0..).map(|(rows, i)| (rows.start, i));
        self.by_row.fill(height, first_rows);
        let rows: Vec<_> = rows.collect();
        let bands = self.by_row.numbers.iter().flat_map(|&i| {
            let rows = rows[i as usize];
            let last = (rows.end - 1) / rows_in_band;
            (rows.start / rows_in_band..=last).map(move |band| (band, i))
        });
        self.by_band.fill(height.div_ceil(rows_in_band), bands);
    }

    /// The triangles of a band. Those that come up in the same row are in the order of the scene.
    pub fn in_band(&self, band: u32) -> &[u32] {
        let band = band as usize;
        let [start, end] = [band, band + 1].map(|i| self.by_band.starts[i] as usize);
        &self.by_band.numbers[start..end]
    }
}

impl Buckets {
    /// Fills buckets, of this number, from pairs of a bucket and a number.
    fn fill(&mut self, buckets: u32, pairs: impl Iterator<Item = (u32, u32)> + Clone) {
        let Self { numbers, starts } = self;
        starts.clear();
        starts.resize(buckets as usize + 1, 0);
        for (bucket, _) in pairs.clone() {
            starts[bucket as usize + 1] += 1;
        }
        let mut sum = 0;
        for start in starts.iter_mut() {
            sum += *start;
            *start = sum;
        }
        // While they are being filled, a bucket's numbers start where those of the bucket before end.
        numbers.clear();
        numbers.resize(sum as usize, 0);
        for (bucket, number) in pairs {
            let end = &mut starts[bucket as usize];
            numbers[*end as usize] = number;
            *end += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_are_in_all_their_bands_and_come_up_in_order() {
        let mut table = EdgeTable::default();
        table.sort([4..6, 0..9, 3..4, 3..5].iter(), 12, 4);
        assert_eq!(
            [0, 1, 2].map(|band| table.in_band(band).to_vec()),
            [vec![1, 2, 3], vec![1, 3, 0], vec![1]]
        );
    }
}
