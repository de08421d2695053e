//! Which command began which segment.

use tabletop_core::{Hand, SimCommand, SimFact};

/// Where a segment begins among the commands of its tick.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Beginning {
    /// How many of the tick's commands come before it.
    pub(crate) before: usize,
    /// What the command after those has already released, in segments of its own: a grasp that takes an object out of
    /// another hand is a release and a grasp.
    pub(crate) released: Vec<Hand>,
}

/// Where each of the segments that a tick's facts begin stands among the commands of that tick.
pub(crate) fn beginnings(commands: &[SimCommand], facts: &[SimFact]) -> Vec<Beginning> {
    let mut next = Beginning::default();
    let mut all = Vec::new();
    for (index, fact) in facts.iter().enumerate() {
        if *fact != SimFact::SegmentBegun {
            continue;
        }
        let facts = &facts[index..];
        let act = facts.iter().find(|fact| is_act(fact));
        let grasp = facts
            .iter()
            .find(|fact| matches!(fact, SimFact::Grasped { .. }));
        let causes = |command: &SimCommand, fact: Option<&SimFact>| {
            fact.is_some_and(|fact| has_caused(command, fact))
        };
        let cause = (next.before..commands.len())
            .find(|&at| causes(&commands[at], act) || causes(&commands[at], grasp));
        let Some(cause) = cause else {
            all.push(Beginning {
                before: commands.len(),
                released: Vec::new(),
            });
            continue;
        };
        next.before = cause;
        all.push(next.clone());
        match act {
            Some(SimFact::Released { hand, .. }) if !causes(&commands[cause], act) => {
                next.released.push(*hand);
            }
            _ => {
                next.before += 1;
                next.released.clear();
            }
        }
    }
    all
}

fn is_act(fact: &SimFact) -> bool {
    matches!(
        fact,
        SimFact::Grasped { .. } | SimFact::Released { .. } | SimFact::Destroyed { .. }
    )
}

fn has_caused(command: &SimCommand, fact: &SimFact) -> bool {
    match (command, fact) {
        (SimCommand::Grasp { hand, object }, SimFact::Grasped { hand: by, id }) => {
            hand == by && object == id
        }
        (SimCommand::Release(hand), SimFact::Released { hand: by, .. })
        | (SimCommand::Destroy(hand), SimFact::Destroyed { hand: by, .. }) => hand == by,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEFT: Hand = Hand::Left;
    const RIGHT: Hand = Hand::Right;

    fn grasp(hand: Hand) -> SimCommand {
        let object = "it".into();
        SimCommand::Grasp { hand, object }
    }

    fn grasped(hand: Hand) -> SimFact {
        let id = "it".into();
        SimFact::Grasped { hand, id }
    }

    fn released(hand: Hand) -> SimFact {
        let id = "it".into();
        SimFact::Released { hand, id }
    }

    fn check(commands: &[SimCommand], facts: &[SimFact], expected: &[(usize, &[Hand])]) {
        let found = beginnings(commands, facts);
        let found: Vec<_> = found
            .iter()
            .map(|beginning| (beginning.before, &beginning.released[..]))
            .collect();
        assert_eq!(found, expected, "{commands:?} {facts:?}");
    }

    use SimFact::SegmentBegun as BEGUN;

    #[test]
    fn a_segment_begins_before_its_command() {
        check(
            &[SimCommand::ClearTable, grasp(LEFT)],
            &[BEGUN, grasped(LEFT)],
            &[(1, &[])],
        );
        check(
            &[SimCommand::Release(LEFT), grasp(LEFT), grasp(RIGHT)],
            &[BEGUN, released(LEFT), BEGUN, grasped(LEFT)],
            &[(0, &[]), (1, &[])],
        );
    }

    #[test]
    fn what_was_refused_begins_none() {
        check(
            &[grasp(RIGHT), SimCommand::Release(RIGHT), grasp(LEFT)],
            &[BEGUN, grasped(LEFT)],
            &[(2, &[])],
        );
    }

    #[test]
    fn taking_an_object_out_of_the_other_hand_is_a_release_and_a_grasp() {
        check(
            &[
                SimCommand::ClearTable,
                grasp(LEFT),
                SimCommand::Release(LEFT),
            ],
            &[
                BEGUN,
                released(RIGHT),
                BEGUN,
                grasped(LEFT),
                BEGUN,
                released(LEFT),
            ],
            &[(1, &[]), (1, &[RIGHT]), (2, &[])],
        );
        check(
            &[grasp(Hand::Both)],
            &[
                BEGUN,
                released(LEFT),
                BEGUN,
                released(RIGHT),
                BEGUN,
                grasped(Hand::Both),
            ],
            &[(0, &[]), (0, &[LEFT]), (0, &[LEFT, RIGHT])],
        );
    }

    #[test]
    fn a_segment_without_a_command_begins_after_all_of_them() {
        check(&[SimCommand::ClearTable], &[BEGUN], &[(1, &[])]);
    }
}
