//! Sentences with a condition, for examples in which different things were done.

use crate::{
    finding::{
        conditions::conditions,
        example::ExampleView,
        explanation::{Explanation, Progress},
        length::sentence,
        proposals::Proposals,
    },
    instruction::Instruction,
    program::Sentence,
};

/// The most ways in which each branch of a condition is said.
const WAYS: usize = 2;

/// Proposals of sentences that do one thing in this example, and another one, or nothing, in others.
pub(crate) fn branches(
    examples: &[ExampleView],
    readings: &[Explanation],
    progress: &[Progress],
    example: usize,
) -> Vec<Sentence> {
    let Some(view) = examples[example].views.get(progress[example].next()) else {
        return Vec::new();
    };
    let own = explaining(examples, readings, progress, example);
    let mut of_others = vec![None; examples.len()];
    let mut all = Vec::new();
    for condition in conditions(view) {
        let holds = |i: &usize| readings[*i].holds(&condition, &progress[*i]) == Some(true);
        let (true_of, false_of): (Vec<_>, Vec<_>) = (0..examples.len()).partition(holds);
        if false_of.is_empty() {
            continue;
        }
        let otherwise = match false_of
            .iter()
            .find(|i| !progress[**i].is_complete(&examples[**i]))
        {
            None => vec![Vec::new()],
            Some(i) => {
                let found = of_others[*i]
                    .get_or_insert_with(|| explaining(examples, readings, progress, *i));
                fitting(found, &false_of)
            }
        };
        for then in fitting(&own, &true_of) {
            all.extend(otherwise.iter().map(|otherwise| Sentence::If {
                condition: condition.clone(),
                then: then.clone(),
                otherwise: otherwise.clone(),
            }));
        }
    }
    all
}

/// Instructions that explain the next deed of an example, the shortest first, and the examples that they do not contradict.
fn explaining(
    examples: &[ExampleView],
    readings: &[Explanation],
    progress: &[Progress],
    example: usize,
) -> Vec<(Instruction, Vec<bool>)> {
    let next = progress[example].next();
    let proposals = Proposals::at(&examples[example], next);
    let mut all: Vec<_> = proposals.map_or(Vec::new(), |all| all.all());
    all.sort_by_key(sentence);
    let read = all.into_iter().filter_map(|proposal| {
        let mut progress = progress.to_vec();
        let both = readings.iter().zip(&mut progress);
        let fits = both.map(|(reading, progress)| reading.sentence(&proposal, progress).is_some());
        let fits: Vec<_> = fits.collect();
        match proposal {
            Sentence::Do { mut instructions }
                if fits[example] && progress[example].next() > next =>
            {
                Some((instructions.pop()?, fits))
            }
            Sentence::Do { .. } | Sentence::If { .. } | Sentence::Until { .. } => None,
        }
    });
    read.collect()
}

/// The shortest of these instructions that contradict none of some examples.
fn fitting(found: &[(Instruction, Vec<bool>)], examples: &[usize]) -> Vec<Vec<Instruction>> {
    let fitting = found
        .iter()
        .filter(|(_, fits)| examples.iter().all(|i| fits[*i]));
    fitting
        .take(WAYS)
        .map(|(one, _)| vec![one.clone()])
        .collect()
}
