//! Rules of grasping: the hands that must let go before one can grasp.

use tabletop_core::{Hand, Hands};

/// The reason why a hand cannot grasp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BothHandsOccupied;

/// The hands that let go, in order, before this one grasps. Never more than two hands hold something.
pub(crate) fn letting_go_for(hand: Hand, hands: &Hands) -> Result<Vec<Hand>, BothHandsOccupied> {
    let holds = |hand| hands.held_by(hand).is_some();
    let mut letting_go = Vec::new();
    match hand {
        Hand::Left | Hand::Right => {
            let other = if hand == Hand::Left {
                Hand::Right
            } else {
                Hand::Left
            };
            if holds(Hand::Both) {
                letting_go.push(Hand::Both);
            }
            if holds(other) && holds(Hand::Any) {
                letting_go.push(Hand::Any);
            }
        }
        Hand::Both => {
            letting_go.extend(
                [Hand::Left, Hand::Right, Hand::Any]
                    .into_iter()
                    .filter(|&hand| holds(hand)),
            );
        }
        Hand::Any => {
            if holds(Hand::Both) || (holds(Hand::Left) && holds(Hand::Right)) {
                return Err(BothHandsOccupied);
            }
        }
    }
    if holds(hand) {
        letting_go.push(hand);
    }
    Ok(letting_go)
}

#[cfg(test)]
mod tests {
    use bevy::prelude::*;

    use super::*;

    fn holding(hands: &[Hand]) -> Hands {
        let mut world = World::new();
        let mut state = Hands::default();
        for &hand in hands {
            state.set_held(hand, Some(world.spawn_empty().id()));
        }
        state
    }

    #[test]
    fn the_rules_of_the_original() {
        use Hand::{Any, Both, Left, Right};
        for (held, hand, expected) in [
            (&[][..], Left, Ok(vec![])),
            (&[Both], Left, Ok(vec![Both])),
            (&[Right, Any], Left, Ok(vec![Any])),
            (&[Left, Any], Right, Ok(vec![Any])),
            (&[Right], Left, Ok(vec![])),
            (&[Left], Left, Ok(vec![Left])),
            (&[Left, Right], Both, Ok(vec![Left, Right])),
            (&[Right, Any], Both, Ok(vec![Right, Any])),
            (&[Left], Any, Ok(vec![])),
            (&[Left, Any], Any, Ok(vec![Any])),
            (&[Both], Any, Err(BothHandsOccupied)),
            (&[Left, Right], Any, Err(BothHandsOccupied)),
        ] {
            let letting_go = letting_go_for(hand, &holding(held));
            assert_eq!(letting_go, expected, "{held:?} hold, {hand:?} grasps");
        }
    }
}
