//! The search for the shortest programs that explain examples.

use std::{
    cmp::Reverse,
    collections::{BTreeMap, BTreeSet, BinaryHeap},
};

use crate::{
    finding::{
        branches::branches,
        example::ExampleView,
        explanation::{Explanation, Progress},
        length::{Length, sentence},
        proposals::Proposals,
    },
    program::{Sentence, TaskProgram},
};

/// How far the search goes.
mod bound {
    use super::Length;

    /// The most sentences that are tried: the bound on time, which no clock decides.
    pub const TRIED: usize = 60_000;
    /// The most programs that are found.
    pub const FOUND: usize = 30;
    /// The most by which a program may be longer than the shortest, in quarters of a bit.
    pub const LONGER: Length = 60;
    /// The most ways in which the same deeds are explained on the way to further ones, and with the last one.
    pub const SAME: usize = 3;
    pub const LAST: usize = 30;
}

/// Sentences that explain the first deeds of examples.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct PartialProgram {
    length: Length,
    /// The order in which it was found, which decides between equals.
    number: usize,
    progress: Vec<Progress>,
    sentences: Vec<usize>,
}

/// The programs that explain all examples, the shortest first, as far as the search goes.
pub(crate) fn search(examples: &[ExampleView]) -> Vec<TaskProgram> {
    let readings: Vec<_> = examples
        .iter()
        .map(|example| Explanation::of(example, &[]))
        .collect();
    let mut programs = Vec::new();
    let mut known = Vec::<Sentence>::new();
    let mut open = BinaryHeap::new();
    let mut visits = BTreeMap::<Vec<BTreeSet<usize>>, usize>::new();
    let (mut tried, mut number) = (0, 0);
    let mut shortest = None;
    open.push(Reverse(PartialProgram {
        length: 0,
        number,
        progress: vec![Progress::default(); examples.len()],
        sentences: Vec::new(),
    }));
    while let Some(Reverse(partial)) = open.pop() {
        if shortest.is_some_and(|least| partial.length > least + bound::LONGER) {
            break;
        }
        let mut unfinished =
            (0..examples.len()).filter(|i| !partial.progress[*i].is_complete(&examples[*i]));
        let Some(example) = unfinished.next() else {
            shortest.get_or_insert(partial.length);
            let sentences = partial.sentences.iter().map(|i| known[*i].clone());
            programs.push(TaskProgram {
                procedures: Vec::new(),
                sentences: sentences.collect(),
            });
            if programs.len() >= bound::FOUND {
                break;
            }
            continue;
        };
        let explained = |progress: &[Progress]| -> Vec<_> {
            progress.iter().map(|one| one.explained().clone()).collect()
        };
        let visits = visits.entry(explained(&partial.progress)).or_default();
        *visits += 1;
        if *visits > bound::SAME {
            continue;
        }
        let next = partial.progress[example].next();
        let Some(proposals) = Proposals::at(&examples[example], next) else {
            continue;
        };
        let mut children =
            BTreeMap::<Vec<BTreeSet<usize>>, Vec<(Length, usize, Vec<Progress>)>>::new();
        let mut proposals = proposals.all();
        if examples.len() > 1 {
            proposals.extend(branches(examples, &readings, &partial.progress, example));
        }
        for proposal in proposals {
            if tried >= bound::TRIED {
                return programs;
            }
            tried += 1;
            let mut progress = partial.progress.clone();
            let choices: Option<Length> = readings
                .iter()
                .zip(&mut progress)
                .map(|(reading, progress)| reading.sentence(&proposal, progress))
                .sum();
            let Some(choices) = choices.filter(|_| progress[example].next() > next) else {
                continue;
            };
            let length = partial.length + sentence(&proposal) + choices;
            let same = children.entry(explained(&progress)).or_default();
            same.push((length, known.len(), progress));
            known.push(proposal);
        }
        for (_, mut same) in children {
            same.sort();
            let is_last = same.first().is_some_and(|(_, _, progress)| {
                progress
                    .iter()
                    .zip(examples)
                    .all(|(one, example)| one.is_complete(example))
            });
            let most = if is_last { bound::LAST } else { bound::SAME };
            for (length, sentence, progress) in same.into_iter().take(most) {
                number += 1;
                let sentences = partial.sentences.iter().copied().chain([sentence]);
                open.push(Reverse(PartialProgram {
                    length,
                    number,
                    progress,
                    sentences: sentences.collect(),
                }));
            }
        }
    }
    programs
}
