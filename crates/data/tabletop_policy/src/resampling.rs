//! Halving, doubling and joining of planes, forward and backward.

use crate::planes::Planes;

/// Planes of half the size: the largest of each four pixels.
pub(crate) fn max_pooled(input: &Planes) -> Planes {
    let mut output = input.like(input.width() / 2, input.height() / 2);
    for plane in 0..input.count() {
        for row in 0..output.height() {
            let [upper, lower] = [0, 1].map(|below| input.row(plane, 2 * row + below));
            let fours = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks().0);
            for (most, (upper, lower)) in output.row_mut(plane, row).iter_mut().zip(fours) {
                let lower: &[f32; 2] = lower;
                *most = upper[0].max(upper[1]).max(lower[0].max(lower[1]));
            }
        }
    }
    output
}

/// The gradient before [`max_pooled`], from that behind it: it goes to the first of the largest.
pub(crate) fn max_pooled_backward(input: &Planes, gradient: &Planes) -> Planes {
    let mut before = input.like(input.width(), input.height());
    for plane in 0..input.count() {
        for row in 0..gradient.height() {
            for column in 0..gradient.width() {
                let four = [(0, 0), (1, 0), (0, 1), (1, 1)];
                let mut four = four.map(|(x, y)| (2 * column + x, 2 * row + y)).into_iter();
                let first = four.next().unwrap_or_default();
                let number = |(column, row)| input.get(plane, column, row);
                let (column_of_most, row_of_most) =
                    four.fold(first, |most, next| match number(next) > number(most) {
                        true => next,
                        false => most,
                    });
                *before.get_mut(plane, column_of_most, row_of_most) =
                    gradient.get(plane, column, row);
            }
        }
    }
    before
}

/// Planes, each pixel of which becomes four, before others of that size.
pub(crate) fn doubled_before(input: &Planes, others: &Planes) -> Planes {
    let (width, height) = (others.width(), others.height());
    let mut output = Planes::new(input.count() + others.count(), width, height);
    for plane in 0..input.count() {
        for row in 0..height {
            let small = input.row(plane, row / 2);
            let pairs = output.row_mut(plane, row).as_chunks_mut::<2>().0.iter_mut();
            for (pair, number) in pairs.zip(small) {
                *pair = [*number; 2];
            }
        }
    }
    for (joined, plane) in output.each_mut().skip(input.count()).zip(others.each()) {
        joined.copy_from_slice(plane);
    }
    output
}

/// The gradients of the first `count` planes and of the others before [`doubled_before`], from that behind it.
pub(crate) fn doubled_before_backward(gradient: &Planes, count: usize) -> [Planes; 2] {
    let (width, height) = (gradient.width(), gradient.height());
    let mut input = Planes::new(count, width / 2, height / 2);
    let mut others = Planes::new(gradient.count() - count, width, height);
    for plane in 0..count {
        for row in 0..height / 2 {
            let [upper, lower] = [0, 1].map(|below| gradient.row(plane, 2 * row + below));
            let fours = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks().0);
            for (sum, (upper, lower)) in input.row_mut(plane, row).iter_mut().zip(fours) {
                let lower: &[f32; 2] = lower;
                *sum = (upper[0] + upper[1]) + (lower[0] + lower[1]);
            }
        }
    }
    for (plane, joined) in others.each_mut().zip(gradient.each().skip(count)) {
        plane.copy_from_slice(joined);
    }
    [input, others]
}
