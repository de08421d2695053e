//! The times in which grippers hold something.

use std::collections::BTreeSet;

use tabletop_core::{LimbName, Manipulator, RobotLayout, SimTick};
use tabletop_task::{ActDeed, Demonstration};

use crate::episode::FrameVectors;

/// What the grippers of a robot hold in an episode.
pub(crate) struct GripTrack {
    /// From each tick on, the grippers that hold something.
    holding: Vec<(SimTick, BTreeSet<LimbName>)>,
}

impl GripTrack {
    pub fn of(shown: &Demonstration) -> Self {
        let mut held: BTreeSet<(LimbName, &str)> = BTreeSet::new();
        let mut holding = Vec::new();
        for act in &shown.acts {
            let Manipulator::Gripper(limb) = act.by else {
                continue;
            };
            match &act.deed {
                ActDeed::Grasp(object) => drop(held.insert((limb, object))),
                ActDeed::Release(Some(object)) => drop(held.remove(&(limb, object.as_str()))),
                ActDeed::Release(None) | ActDeed::Destroy => held.retain(|(by, _)| *by != limb),
            }
            holding.push((act.tick, held.iter().map(|(limb, _)| *limb).collect()));
        }
        Self { holding }
    }

    /// True if a gripper holds something at any time.
    pub fn grips(&self) -> bool {
        !self.holding.is_empty()
    }

    /// True if the gripper of a limb holds something at the end of a tick.
    fn holds(&self, limb: LimbName, tick: SimTick) -> bool {
        let changes = self.holding.partition_point(|(at, _)| *at <= tick);
        changes > 0 && self.holding[changes - 1].1.contains(&limb)
    }

    /// The positions that joints were ordered to have in each frame, by those that they had: fingers that hold something, or close on it, were to
    /// close entirely, and those that open or close otherwise were to come to where they did.
    pub fn orders(
        &self,
        joints: &FrameVectors,
        layout: &RobotLayout,
        ticks: &[SimTick],
    ) -> FrameVectors {
        let mut orders = joints.clone();
        let width = orders.names.len();
        for limb in &layout.limbs {
            let joint = layout.joint(limb.gripper.joint);
            let Some(column) = joints
                .names
                .iter()
                .position(|name| joint.name.as_str() == name)
            else {
                continue;
            };
            let openings: Vec<_> = joints.frames().map(|frame| frame[column]).collect();
            let frames = orders
                .values
                .chunks_mut(width)
                .map(|frame| &mut frame[column]);
            let mut after = None;
            for ((number, order), tick) in frames.enumerate().zip(ticks).rev() {
                let way = openings[number] - openings[number.saturating_sub(1)];
                let opening = openings[number];
                *order = match after {
                    _ if self.holds(limb.name, *tick) => joint.limits[0] as f32,
                    Some(after) if goes_on(way, opening, after) => after,
                    Some(_) | None => opening,
                };
                after = Some(*order);
            }
        }
        orders
    }
}

/// True if a motion of this way to a position goes on to the order after it.
fn goes_on(way: f32, position: f32, order: f32) -> bool {
    way != 0.0 && (order - position) * way > 0.0
}

#[cfg(test)]
mod tests {
    use tabletop_core::LimbId;
    use tabletop_task::ShownAct;

    use super::*;

    /// The gripper of a limb holds a block from one of these ticks to the other.
    fn held(limb: LimbName, [from, to]: [u64; 2]) -> Demonstration {
        let act = |tick, deed| ShownAct {
            tick: SimTick(tick),
            by: Manipulator::Gripper(limb),
            deed,
        };
        Demonstration {
            acts: vec![
                act(from, ActDeed::Grasp("Red".into())),
                act(to, ActDeed::Release(Some("Red".into()))),
            ],
            ..Demonstration::default()
        }
    }

    #[test]
    fn fingers_that_hold_something_are_ordered_to_close_entirely() {
        let layout = RobotLayout::baxter();
        let limb = layout.limb(LimbId(1));
        let joint = layout.joint(limb.gripper.joint);
        let shown = held(limb.name, [5, 15]);
        let joints = FrameVectors {
            names: vec!["right_s0".into(), joint.name.to_string()],
            values: vec![0.5, 0.9, 0.5, 0.4, 0.5, 0.6],
        };
        let grips = GripTrack::of(&shown);
        let ticks = [0, 10, 20].map(SimTick);
        let orders = grips.orders(&joints, layout, &ticks);
        assert_eq!(orders.values, [0.5, 0.9, 0.5, 0.0, 0.5, 0.6]);
        assert!(grips.grips());
    }

    #[test]
    fn fingers_that_move_are_ordered_to_where_they_come() {
        let layout = RobotLayout::baxter();
        let limb = layout.limb(LimbId(1));
        let shown = held(limb.name, [4, 6]);
        let joints = FrameVectors {
            names: vec![layout.joint(limb.gripper.joint).name.to_string()],
            values: vec![0.9, 0.9, 0.7, 0.5, 0.4, 0.4, 0.5, 0.7, 0.8, 0.8, 0.6, 0.6],
        };
        let ticks: Vec<_> = (0..12).map(SimTick).collect();
        let orders = GripTrack::of(&shown).orders(&joints, layout, &ticks);
        let expected = [0.9, 0.9, 0.0, 0.0, 0.0, 0.0, 0.8, 0.8, 0.8, 0.8, 0.6, 0.6];
        assert_eq!(orders.values, expected);
    }
}
