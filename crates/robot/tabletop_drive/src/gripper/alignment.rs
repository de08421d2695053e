//! Alignment: closing fingers turn an object that lies askew until it is flush with them.

use bevy::prelude::*;

use crate::gripper::closing::STEEPEST_GRIP;

/// Depth to which fingers press into an object that they turn, in units per tick. An object that yields no more than this is pushed no harder.
pub(crate) const PRESS: f64 = 0.01;

/// The angle θ below which an object is flush, in rad.
const FLUSH: f32 = 0.02;
/// Least decrease of θ while an object is turned, in rad.
const PROGRESS: f32 = 0.002;
/// Number of ticks for which an object is pressed without turning.
const PATIENCE: u32 = 12;

/// An object that closing fingers turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Alignment {
    /// The object.
    pub object: Entity,
    /// Least angle θ so far, in rad.
    angle: f32,
    /// Number of ticks since it last decreased.
    still: u32,
}

/// The judgement on an object that both fingers touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Judgement {
    /// It is held.
    Hold,
    /// It is pressed on.
    Press,
    /// It cannot be held.
    Refuse,
}

/// The judgement on an object that both fingers touch at the angle θ, in rad.
pub(crate) fn judge(alignment: &mut Option<Alignment>, object: Entity, angle: f32) -> Judgement {
    let is_steep = angle >= STEEPEST_GRIP;
    let Some(known) = alignment.as_mut().filter(|known| known.object == object) else {
        if !is_steep {
            return Judgement::Hold;
        }
        *alignment = Some(Alignment {
            object,
            angle,
            still: 0,
        });
        return Judgement::Press;
    };
    if angle < known.angle - PROGRESS {
        (known.angle, known.still) = (angle, 0);
    } else {
        known.still += 1;
    }
    let is_over = angle < FLUSH || known.still > PATIENCE;
    match (is_over, is_steep) {
        (false, _) => Judgement::Press,
        (true, false) => Judgement::Hold,
        (true, true) => Judgement::Refuse,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJECT: Entity = Entity::PLACEHOLDER;

    #[test]
    fn a_nearly_flush_object_is_held_at_once() {
        assert_eq!(judge(&mut None, OBJECT, 0.19), Judgement::Hold);
    }

    #[test]
    fn an_askew_object_is_turned_until_it_is_flush() {
        let mut alignment = None;
        for angle in [0.3, 0.2, 0.1, 0.05] {
            assert_eq!(judge(&mut alignment, OBJECT, angle), Judgement::Press);
        }
        assert_eq!(judge(&mut alignment, OBJECT, 0.01), Judgement::Hold);
    }

    #[test]
    fn an_object_that_does_not_turn_is_given_up() {
        for (angle, expected) in [(0.3, Judgement::Refuse), (0.15, Judgement::Hold)] {
            let mut alignment = None;
            judge(&mut alignment, OBJECT, 0.31);
            let judged: Vec<_> = (0..20)
                .map(|_| judge(&mut alignment, OBJECT, angle))
                .collect();
            let pressed = judged.iter().take_while(|it| **it == Judgement::Press);
            let pressed = pressed.count();
            assert_eq!(pressed, 13);
            assert_eq!(judged[pressed], expected);
        }
    }
}
