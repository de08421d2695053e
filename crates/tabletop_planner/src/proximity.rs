//! Proximity: how near a robot is to the table and to itself.

use std::fmt;

use tabletop_controller::Angles;
use tabletop_core::Table;
use tabletop_geometry::PlacedSolid;

use crate::body::{LinkSolid, RobotBody};

/// What a limb is near to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NearThing {
    /// The table.
    Table {
        /// The limb.
        limb: String,
    },
    /// Another part of the robot.
    Robot {
        /// The limb.
        limb: String,
    },
}

impl fmt::Display for NearThing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table { limb } => write!(f, "limb {limb} would come too near to the table"),
            Self::Robot { limb } => {
                write!(f, "limb {limb} would come too near to the robot itself")
            }
        }
    }
}

/// Distance, in units, of fingers from the table: they take what lies on it.
const FINGERS: f32 = 0.1;

impl RobotBody {
    /// What a limb is nearer to than a distance, in units, at these angles of all limbs, with grippers opened by these, in units. Fingers may be nearer to the table.
    pub fn near(
        &self,
        table: &Table,
        angles: &[Angles],
        openings: &[f32],
        distance: f32,
    ) -> Option<NearThing> {
        let mut own = Vec::new();
        for (number, limb) in self.limbs.iter().enumerate() {
            let name = || limb.name.clone();
            self.own(number, &angles[number], &mut own);
            let fingers = self.fingers(
                number,
                self.end_effector(number, &angles[number]),
                openings[number],
            );
            let far_out = own.iter().filter(|link| self.is_far_out(link.link));
            let is_low = far_out
                .clone()
                .any(|link| is_at_table(table, &link.solid, distance))
                || fingers.iter().any(|it| is_at_table(table, it, FINGERS));
            if is_low {
                return Some(NearThing::Table { limb: name() });
            }
            let rest = self.rest(number, angles);
            let meets = |one: &LinkSolid, other: &LinkSolid| {
                let between = one.solid.pose.location.distance(other.solid.pose.location);
                between < one.solid.radius() + other.solid.radius() + distance
                    && self.can_meet(one.link, other.link)
                    && one.solid.is_within(distance, &other.solid)
            };
            let is_folded = own.iter().enumerate().any(|(i, one)| {
                let others = own[..i].iter().chain(&rest);
                others.into_iter().any(|other| meets(one, other))
            });
            if is_folded {
                return Some(NearThing::Robot { limb: name() });
            }
        }
        None
    }
}

fn is_at_table(table: &Table, solid: &PlacedSolid, distance: f32) -> bool {
    let [low, _] = solid.heights();
    let reach = solid.radius() + distance;
    let at = solid.pose.location.abs();
    at.x < table.xspan / 2.0 + reach && at.y < table.yspan / 2.0 + reach && low < distance
}
