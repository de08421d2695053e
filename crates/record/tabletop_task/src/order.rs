//! The partial order of steps.

use std::collections::BTreeSet;

use crate::{
    demonstration::Demonstration, detour::places, manipulation::Manipulation, relation::Relation,
};

/// For each manipulation, the indices of those that must come before it: it needs their object or place, lies above or below their places,
/// or needs the room that they make. An order that follows from others is left out.
pub(crate) fn partial_order(
    shown: &Demonstration,
    manipulations: &[Manipulation],
    relations: &[Vec<Relation>],
) -> Vec<Vec<usize>> {
    let places: Vec<_> = manipulations.iter().map(|one| places(shown, one)).collect();
    let needs = |later: usize, earlier: usize| {
        let moved = &manipulations[earlier].object;
        let is_meant = relations[later]
            .iter()
            .any(|relation| relation.object() == Some(moved));
        let shares = places[later].iter().any(|one| {
            places[earlier]
                .iter()
                .any(|other| one.shares_column_with(other))
        });
        let carries = |one: usize, other: usize| {
            manipulations[one]
                .load
                .contains(&manipulations[other].object)
        };
        let goes_along = carries(later, earlier) || carries(earlier, later);
        is_meant || goes_along || manipulations[later].object == *moved || shares
    };
    let mut before = Vec::<BTreeSet<usize>>::new();
    for later in 0..manipulations.len() {
        before.push(
            (0..later)
                .filter(|&earlier| needs(later, earlier))
                .collect(),
        );
    }
    let mut all = before.clone();
    for later in 0..all.len() {
        let inherited: Vec<_> = all[later]
            .iter()
            .flat_map(|&earlier| all[earlier].clone())
            .collect();
        all[later].extend(inherited);
    }
    let direct = before.iter().map(|steps| {
        let is_direct = |step: &&usize| !steps.iter().any(|other| all[*other].contains(step));
        steps.iter().filter(is_direct).copied().collect()
    });
    direct.collect()
}
