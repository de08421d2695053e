//! The assignment problem: the cheapest way to give each row a column of its own.

use std::collections::BTreeSet;

/// The column assigned to each row, with the least sum of costs; among equal assignments, the columns come in order. `None` if there is no
/// assignment. A row cannot take a column without a cost.
pub(crate) fn cheapest(costs: &[Vec<Option<i64>>]) -> Option<Vec<usize>> {
    const FORBIDDEN: i64 = 1 << 44;
    const UNIT: i64 = 1 << 24;
    let rows = costs.len();
    let columns = costs.first().map_or(0, Vec::len);
    if columns < rows {
        return None;
    }
    // Among equal costs, the first columns go to the first rows.
    let cost = |row: usize, column: usize| match costs[row][column] {
        None => FORBIDDEN,
        Some(cost) => cost * UNIT + (column * (2 * rows - row)) as i64,
    };
    // The Hungarian method: row by row along the cheapest path to a free column. Index 0 is no row and no column.
    let mut of_row = vec![0; rows + 1];
    let mut of_column = vec![0; columns + 1];
    let mut taken_by = vec![0; columns + 1];
    for row in 1..=rows {
        taken_by[0] = row;
        let mut column = 0;
        let mut least = vec![i64::MAX; columns + 1];
        let mut came_from = vec![0; columns + 1];
        let mut is_done = vec![false; columns + 1];
        while taken_by[column] != 0 {
            is_done[column] = true;
            let row = taken_by[column];
            let (mut delta, mut next) = (i64::MAX, 0);
            for other in (1..=columns).filter(|&other| !is_done[other]) {
                let reduced = cost(row - 1, other - 1) - of_row[row] - of_column[other];
                if reduced < least[other] {
                    (least[other], came_from[other]) = (reduced, column);
                }
                if least[other] < delta {
                    (delta, next) = (least[other], other);
                }
            }
            for other in 0..=columns {
                if is_done[other] {
                    of_row[taken_by[other]] += delta;
                    of_column[other] -= delta;
                } else if least[other] != i64::MAX {
                    least[other] -= delta;
                }
            }
            column = next;
        }
        while column != 0 {
            let before = came_from[column];
            taken_by[column] = taken_by[before];
            column = before;
        }
    }
    let mut given = vec![0; rows];
    for (column, taken_by) in taken_by[1..].iter().enumerate() {
        if let Some(row) = taken_by.checked_sub(1) {
            given[row] = column;
        }
    }
    let is_allowed = given
        .iter()
        .enumerate()
        .all(|(row, &column)| costs[row][column].is_some());
    is_allowed.then_some(given)
}

/// Rows that share fewer columns than there are rows, and those columns. There are some if no assignment exists.
pub(crate) fn shortage(costs: &[Vec<Option<i64>>]) -> (Vec<usize>, Vec<usize>) {
    let columns_of =
        |row: usize| (0..costs[row].len()).filter(move |&column| costs[row][column].is_some());
    let mut taken_by = vec![None; costs.first().map_or(0, Vec::len)];
    for row in 0..costs.len() {
        // Breadth first along columns and the rows that have them.
        let mut seen = BTreeSet::new();
        let mut came_from = std::collections::BTreeMap::new();
        let mut rows = vec![row];
        let mut next = 0;
        let mut free = None;
        while free.is_none() && next < rows.len() {
            let from = rows[next];
            next += 1;
            for column in columns_of(from) {
                if seen.insert(column) {
                    came_from.insert(column, from);
                    match taken_by[column] {
                        Some(other) => rows.push(other),
                        None => {
                            free = Some(column);
                            break;
                        }
                    }
                }
            }
        }
        let Some(mut column) = free else {
            rows.sort_unstable();
            return (rows, seen.into_iter().collect());
        };
        loop {
            let from = came_from[&column];
            let before = taken_by.iter().position(|&taken| taken == Some(from));
            taken_by[column] = Some(from);
            match before {
                Some(before) if from != row => column = before,
                _ => break,
            }
        }
    }
    (Vec::new(), Vec::new())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn equals_are_taken_in_their_order() {
        let row = vec![Some(1); 4];
        assert_eq!(cheapest(&vec![row; 3]), Some(vec![0, 1, 2]));
        let costs = [vec![Some(0), Some(5)], vec![Some(1), None]];
        assert_eq!(cheapest(&costs), Some(vec![1, 0]));
        assert_eq!(cheapest(&[vec![Some(0)], vec![Some(0)]]), None);
        assert_eq!(cheapest(&[]), Some(vec![]));
    }

    #[test]
    fn too_few_columns_are_named() {
        let costs = [
            vec![Some(0), None, Some(0)],
            vec![None, Some(0), None],
            vec![None, Some(0), None],
        ];
        assert_eq!(cheapest(&costs), None);
        assert_eq!(shortage(&costs), (vec![1, 2], vec![1]));
    }

    fn best_by_trying(costs: &[Vec<Option<i64>>], taken: &mut Vec<usize>) -> Option<i64> {
        let Some(row) = costs.get(taken.len()) else {
            return Some(0);
        };
        let mut best: Option<i64> = None;
        for (column, cost) in row.iter().enumerate() {
            if let Some(cost) = cost
                && !taken.contains(&column)
            {
                taken.push(column);
                let rest = best_by_trying(costs, taken).map(|rest| rest + cost);
                taken.pop();
                best = [best, rest].into_iter().flatten().min();
            }
        }
        best
    }

    proptest! {
        #[test]
        fn nothing_is_cheaper(
            costs in (1..5_usize, 0..3_usize).prop_flat_map(|(rows, more)| {
                let cost = proptest::option::weighted(0.7, 0..10_i64);
                proptest::collection::vec(proptest::collection::vec(cost, rows + more), rows)
            }),
        ) {
            let best = best_by_trying(&costs, &mut Vec::new());
            let found = cheapest(&costs);
            let sum = found.map(|given| given.iter().enumerate().map(|(row, &column)| {
                costs[row][column].unwrap_or(i64::MAX / 8)
            }).sum());
            prop_assert_eq!(sum, best);
            let (rows, columns) = shortage(&costs);
            prop_assert_eq!(rows.is_empty(), best.is_some());
            prop_assert!(rows.is_empty() || rows.len() > columns.len());
            for row in rows {
                for (column, cost) in costs[row].iter().enumerate() {
                    prop_assert!(cost.is_none() || columns.contains(&column));
                }
            }
        }
    }
}
