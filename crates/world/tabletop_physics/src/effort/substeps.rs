//! Numbers of sub-steps that bodies need.

use bevy_rapier3d::rapier::prelude::{JointAxesMask, RigidBody, RigidBodyHandle};

use super::{engine::Engine, touches::Touches};

/// Number of sub-steps of every body; each has more in addition. Low stacks need no more.
pub(crate) const BASE_SUBSTEPS: usize = 2;

/// Least number of sub-steps of bodies outside low stacks, and of all bodies while any such body is awake.
const LEAST_SUBSTEPS: usize = 4;

/// Number of sub-steps of handled bodies.
pub(crate) const MOST_SUBSTEPS: usize = 36;

/// Number of sub-steps of a body that touches nothing yet, so that it lands well.
pub(crate) const SUBSTEPS_OF_FREE: usize = 20;

/// Number of sub-steps by the greatest depth of a body in its stack, from 1 on; the last one holds for all greater depths.
const SUBSTEPS_BY_DEPTH: [usize; 16] = [4, 4, 4, 4, 6, 11, 12, 12, 13, 13, 13, 13, 14, 14, 14, 16];

/// Least number of sub-steps of shapes other than blocks: they touch with fewer points.
const SUBSTEPS_OF_OTHER_SHAPES: usize = 9;

/// Least number of sub-steps of bodies held by joints.
const SUBSTEPS_OF_JOINTED: usize = 7;

/// Least number of sub-steps of bodies that are fastened to others: a row of them must hold like one piece.
const SUBSTEPS_OF_BONDED: usize = 36;

/// Least number of sub-steps of bodies that touch one of a much different mass.
const SUBSTEPS_OF_UNEVEN: usize = 16;

/// Least number of sub-steps of fast bodies.
const SUBSTEPS_OF_FAST: usize = 20;

/// Speed, in units/s and rad/s together, from which a body is fast.
const FAST: f32 = 20.0;

/// Greatest depth of a body in a low stack.
const LOW: u32 = 5;

/// Speed, in units/s and rad/s together, below which a body of a low stack stands.
const CALM: f32 = 1.0;

/// The factors that decide a body's number of sub-steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SubstepFactors {
    /// Its depth in its stack, if it is supported.
    depth: Option<u32>,
    is_block: bool,
    is_uneven: bool,
    /// True if joints hold it.
    pub is_jointed: bool,
    /// True if one of the joints leaves it no freedom.
    is_bonded: bool,
    /// True if a hand or a robot touches it.
    pub is_handled: bool,
    /// True if it is near one.
    pub is_near_hand: bool,
    /// True if it is near something else, too.
    pub is_near_others: bool,
    speed: f32,
}

impl SubstepFactors {
    pub fn of(handle: RigidBodyHandle, engine: &Engine, touches: &Touches) -> Self {
        let body = &engine.bodies[handle];
        let number = handle.into_raw_parts().0;
        let mut shapes = body.colliders().iter();
        Self {
            depth: touches.depths.of(number),
            is_block: shapes.all(|shape| engine.colliders[*shape].shape().as_cuboid().is_some()),
            is_uneven: touches.uneven.contains(&number),
            is_jointed: engine.joints.attached_joints(handle).next().is_some(),
            is_bonded: engine
                .joints
                .attached_joints(handle)
                .any(|(.., joint)| joint.data.locked_axes == JointAxesMask::LOCKED_FIXED_AXES),
            is_handled: touches.handled.contains(&number),
            is_near_hand: touches.near_hands.contains(&number),
            is_near_others: touches.near_others.contains(&number),
            speed: speed(body),
        }
    }

    pub fn substeps(self) -> usize {
        let by_depth = match self.depth {
            Some(depth) => SUBSTEPS_BY_DEPTH[(depth as usize - 1).min(SUBSTEPS_BY_DEPTH.len() - 1)],
            None if self.is_jointed => LEAST_SUBSTEPS,
            None => SUBSTEPS_OF_FREE,
        };
        let others = [
            (!self.is_block, SUBSTEPS_OF_OTHER_SHAPES),
            (self.is_uneven, SUBSTEPS_OF_UNEVEN),
            (self.is_jointed, SUBSTEPS_OF_JOINTED),
            (self.is_bonded, SUBSTEPS_OF_BONDED),
            (self.is_handled, MOST_SUBSTEPS),
            (self.speed > FAST && !self.is_jointed, SUBSTEPS_OF_FAST),
        ];
        let others = others.into_iter().filter(|(applies, _)| *applies);
        others.fold(by_depth, |most, (_, substeps)| most.max(substeps))
    }

    /// True if it stands in a low stack of blocks that are about equally heavy.
    pub fn is_in_low_stack(self) -> bool {
        self.depth.is_some_and(|depth| depth <= LOW)
            && self.is_block
            && self.speed < CALM
            && !(self.is_uneven || self.is_jointed || self.is_handled)
    }
}

/// Number of sub-steps that a body has at present.
pub(crate) fn substeps(body: &RigidBody) -> usize {
    BASE_SUBSTEPS + body.additional_solver_iterations()
}

/// Number of sub-steps that a body needs which no force moves.
pub(crate) fn substeps_of_unmoved(body: &RigidBody) -> usize {
    if body.is_fixed() {
        // While anything moves, Rapier keeps a fixed body that was held among the moving ones, and solves its contacts with the sub-steps of the
        // body that has fewer.
        MOST_SUBSTEPS
    } else {
        LEAST_SUBSTEPS
    }
}

/// Speed of a body, in units/s and rad/s together.
pub(crate) fn speed(body: &RigidBody) -> f32 {
    body.linvel().length() + body.angvel().length()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: SubstepFactors = SubstepFactors {
        depth: Some(1),
        is_block: true,
        is_uneven: false,
        is_jointed: false,
        is_bonded: false,
        is_handled: false,
        is_near_hand: false,
        is_near_others: false,
        speed: 0.0,
    };

    #[test]
    fn deeper_bodies_get_more_substeps() {
        let substeps = |depth| {
            let depth = Some(depth);
            SubstepFactors { depth, ..BLOCK }.substeps()
        };
        assert_eq!([1, 5, 6, 16, 1000].map(substeps), [4, 6, 11, 16, 16]);
        assert!((1..40).all(|depth| substeps(depth) <= substeps(depth + 1)));
    }

    #[test]
    fn the_greatest_need_counts() {
        let uneven = SubstepFactors {
            is_uneven: true,
            is_block: false,
            ..BLOCK
        };
        assert_eq!(uneven.substeps(), SUBSTEPS_OF_UNEVEN);
        let handled = SubstepFactors {
            is_handled: true,
            ..uneven
        };
        assert_eq!(handled.substeps(), MOST_SUBSTEPS);
    }

    #[test]
    fn low_stacks_are_of_even_blocks_that_stand() {
        let others = [
            SubstepFactors {
                depth: None,
                ..BLOCK
            },
            SubstepFactors {
                depth: Some(LOW + 1),
                ..BLOCK
            },
            SubstepFactors {
                is_block: false,
                ..BLOCK
            },
            SubstepFactors {
                is_uneven: true,
                ..BLOCK
            },
            SubstepFactors {
                is_jointed: true,
                ..BLOCK
            },
            SubstepFactors {
                is_handled: true,
                ..BLOCK
            },
            SubstepFactors {
                speed: CALM,
                ..BLOCK
            },
        ];
        assert!(BLOCK.is_in_low_stack());
        assert!(!others.into_iter().any(SubstepFactors::is_in_low_stack));
    }

    #[test]
    fn a_link_that_swings_gets_no_more_than_one_that_hangs() {
        let hanging = SubstepFactors {
            depth: None,
            is_jointed: true,
            ..BLOCK
        };
        let swinging = SubstepFactors {
            speed: 2.0 * FAST,
            ..hanging
        };
        assert_eq!(swinging.substeps(), hanging.substeps());
    }
}
