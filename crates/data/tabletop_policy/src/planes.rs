//! Planes of numbers: pictures, and what a network makes of them.

/// Numbers beyond the end of a plane that a product may read and write.
const SLACK: usize = 32;

/// Planes of one size. Each has a border of zeros, one pixel wide, so that a 3×3 convolution is nine shifted sums along the whole plane.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Planes {
    width: usize,
    height: usize,
    numbers: Vec<f32>,
}

impl Planes {
    /// This many planes of zeros.
    pub fn new(count: usize, width: usize, height: usize) -> Self {
        let mut planes = Self {
            width,
            height,
            numbers: Vec::new(),
        };
        planes.numbers = vec![0.0; count * planes.stride()];
        planes
    }

    /// The same number of planes of another size.
    pub fn like(&self, width: usize, height: usize) -> Self {
        Self::new(self.count(), width, height)
    }

    pub fn count(&self) -> usize {
        self.numbers.len() / self.stride()
    }

    pub fn width(&self) -> usize {
        self.width
    }

    pub fn height(&self) -> usize {
        self.height
    }

    /// Numbers from a row of a plane to the next.
    pub fn pitch(&self) -> usize {
        self.width + 2
    }

    /// Numbers from a plane to the next.
    pub fn stride(&self) -> usize {
        self.pitch() * (self.height + 2) + SLACK
    }

    /// Index of the first pixel in a plane.
    pub fn first(&self) -> usize {
        self.pitch() + 1
    }

    /// Numbers from the first pixel of a plane to behind the last, borders between rows included.
    pub fn span(&self) -> usize {
        self.pitch() * (self.height - 1) + self.width
    }

    /// The planes, with their borders.
    pub fn each(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.numbers.chunks_exact(self.stride())
    }

    /// The planes, with their borders.
    pub fn each_mut(&mut self) -> impl ExactSizeIterator<Item = &mut [f32]> {
        let stride = self.stride();
        self.numbers.chunks_exact_mut(stride)
    }

    /// All numbers, with the borders.
    pub fn numbers_mut(&mut self) -> &mut [f32] {
        &mut self.numbers
    }

    /// A row of pixels.
    pub fn row(&self, plane: usize, row: usize) -> &[f32] {
        let first = self.index(plane, 0, row);
        &self.numbers[first..first + self.width]
    }

    /// A row of pixels.
    pub fn row_mut(&mut self, plane: usize, row: usize) -> &mut [f32] {
        let first = self.index(plane, 0, row);
        &mut self.numbers[first..first + self.width]
    }

    /// The pixels of a plane, row by row.
    pub fn pixels(&self, plane: usize) -> impl Iterator<Item = f32> {
        (0..self.height).flat_map(move |row| self.row(plane, row).iter().copied())
    }

    pub fn get(&self, plane: usize, column: usize, row: usize) -> f32 {
        self.numbers[self.index(plane, column, row)]
    }

    pub fn get_mut(&mut self, plane: usize, column: usize, row: usize) -> &mut f32 {
        let index = self.index(plane, column, row);
        &mut self.numbers[index]
    }

    fn index(&self, plane: usize, column: usize, row: usize) -> usize {
        plane * self.stride() + self.first() + row * self.pitch() + column
    }

    /// Makes the borders zero again.
    pub fn clear_borders(&mut self) {
        let (first, pitch, width, span) = (self.first(), self.pitch(), self.width, self.span());
        for plane in self.each_mut() {
            plane[..first].fill(0.0);
            plane[first + span..].fill(0.0);
            for gap in (first + width..first + span).step_by(pitch) {
                plane[gap..gap + 2].fill(0.0);
            }
        }
    }

    /// Adds others, number by number.
    pub fn add(&mut self, other: &Self) {
        for (sum, number) in self.numbers.iter_mut().zip(&other.numbers) {
            *sum += number;
        }
    }

    /// Makes all negative numbers zero.
    pub fn rectify(&mut self) {
        for number in &mut self.numbers {
            *number = number.max(0.0);
        }
    }

    /// Makes zero what is not positive in the others: the gradient before [`rectify`](Self::rectify), from that behind it.
    pub fn keep_where_positive(&mut self, rectified: &Self) {
        for (number, rectified) in self.numbers.iter_mut().zip(&rectified.numbers) {
            if *rectified <= 0.0 {
                *number = 0.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_borders_are_cleared() {
        let mut planes = Planes::new(2, 3, 2);
        planes.numbers_mut().fill(1.0);
        planes.clear_borders();
        assert_eq!(planes.pixels(1).collect::<Vec<_>>(), [1.0; 6]);
        assert_eq!(planes.each().flatten().sum::<f32>(), 12.0);
    }
}
