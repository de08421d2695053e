//! In which order triangles come up from row to row.

/// Triangles in the order in which they come up, as a scan-line algorithm has it.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeTable {
    /// The triangles, by the first row in which they may be seen.
    order: Vec<u32>,
    /// Where those of each row start in the order, and where those of the last one end.
    starts: Vec<u32>,
}

impl EdgeTable {
    /// Sorts triangles that come up in these rows.
    pub fn sort(&mut self, first_rows: impl ExactSizeIterator<Item = u32> + Clone, height: u32) {
        let Self { order, starts } = self;
        starts.clear();
        starts.resize(height as usize + 1, 0);
        for row in first_rows.clone() {
            starts[row as usize + 1] += 1;
        }
        let mut sum = 0;
        for start in starts.iter_mut() {
            sum += *start;
            *start = sum;
        }
        // While they are filled, what belongs to a row is where that of the row before ends.
        order.clear();
        order.resize(first_rows.len(), 0);
        for (row, i) in first_rows.zip(0..) {
            let end = &mut starts[row as usize];
            order[*end as usize] = i;
            *end += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
    }

    /// Those that come up in this row.
    pub fn in_row(&self, row: u32) -> &[u32] {
        let row = row as usize;
        &self.order[self.starts[row] as usize..self.starts[row + 1] as usize]
    }

    /// Those that come up above this row.
    pub fn above_row(&self, row: u32) -> &[u32] {
        &self.order[..self.starts[row as usize] as usize]
    }
}
