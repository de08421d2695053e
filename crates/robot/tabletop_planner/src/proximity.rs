//! Proximity: the gaps between a robot's moving parts and the table, and between its parts.

use std::fmt;

use bevy::math::Vec3;
use tabletop_controller::Angles;
use tabletop_core::Table;
use tabletop_geometry::{PlacedSolid, Pose, Solid};

use crate::body::RobotBody;

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

/// Two parts of a robot that can meet, or a part and the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartGap {
    /// The part, and what is on the other side.
    sides: (usize, OtherSide),
    /// The limbs of the two, by their numbers; none for the trunk and the table.
    pub limbs: [Option<usize>; 2],
    /// True if it is one of fingers above the table, which take what lies there.
    pub is_of_fingers: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OtherSide {
    Table,
    /// A solid of the trunk.
    Trunk(usize),
    /// A part of a limb.
    Part(usize),
}

/// How far any point of each part can get, in units.
#[derive(Clone, Debug)]
pub struct Ways(Vec<f32>);

impl PartGap {
    /// What it can become narrower by if parts move by these ways, in units.
    pub fn narrowing(&self, ways: &Ways) -> f32 {
        let (part, side) = self.sides;
        let other = match side {
            OtherSide::Part(place) => ways.0[place],
            OtherSide::Table | OtherSide::Trunk(_) => 0.0,
        };
        ways.0[part] + other
    }
}

/// How far down the table is solid, in units.
const TABLE_DEPTH: f32 = 10.0;

/// A robot in a posture.
#[derive(Clone, Debug)]
pub struct Posed {
    parts: Vec<LimbPart>,
}

/// A solid of a limb, and of which link it is. Fingers are of no link.
#[derive(Clone, Debug)]
struct LimbPart {
    solid: PlacedSolid,
    link: Option<usize>,
    limb: usize,
}

impl RobotBody {
    /// All gaps that there are. The trunk does not move, so those within it are left out.
    pub fn gaps(&self) -> Vec<PartGap> {
        let home: Vec<_> = self.limbs.iter().map(|limb| limb.home).collect();
        let Posed { parts } = self.posed(&home, &vec![0.0; home.len()]);
        let mut gaps = Vec::new();
        for (number, part) in parts.iter().enumerate() {
            let is_of_fingers = part.link.is_none();
            let mut add = |side: OtherSide, limb: Option<usize>| {
                gaps.push(PartGap {
                    sides: (number, side),
                    limbs: [Some(part.limb), limb],
                    is_of_fingers: is_of_fingers && side == OtherSide::Table,
                });
            };
            if part.link.is_none_or(|link| self.is_far_out(link)) {
                add(OtherSide::Table, None);
            }
            for (place, other) in self.trunk().iter().enumerate() {
                if part.link.is_none_or(|link| self.can_meet(link, other.link)) {
                    add(OtherSide::Trunk(place), None);
                }
            }
            for (place, other) in parts.iter().enumerate().skip(number + 1) {
                let can_meet = match (part.link, other.link) {
                    (Some(one), Some(other)) => self.can_meet(one, other),
                    // Fingers are always near to their own hand.
                    (None, _) | (_, None) => part.limb != other.limb,
                };
                if can_meet {
                    add(OtherSide::Part(place), Some(other.limb));
                }
            }
        }
        gaps
    }

    /// The robot at these angles of all limbs and with grippers opened by these, in units.
    pub fn posed(&self, angles: &[Angles], openings: &[f32]) -> Posed {
        let (mut parts, mut own) = (Vec::new(), Vec::new());
        for (limb, angles) in angles.iter().enumerate() {
            self.own(limb, angles, &mut own);
            parts.extend(own.drain(..).map(|part| LimbPart {
                solid: part.solid,
                link: Some(part.link),
                limb,
            }));
            let fingers = self.fingers(limb, self.end_effector(limb, angles), openings[limb]);
            parts.extend(fingers.map(|solid| LimbPart {
                solid,
                link: None,
                limb,
            }));
        }
        Posed { parts }
    }

    /// The width of a gap, in units, but at most this; negative where the two overlap, and the more so the deeper they do.
    pub fn width(&self, gap: &PartGap, posed: &Posed, table: &Table, most: f32) -> f32 {
        let (part, side) = gap.sides;
        let one = &posed.parts[part].solid;
        match side {
            OtherSide::Table => height_above(table, one, most),
            OtherSide::Trunk(place) => distance(one, &self.trunk()[place].solid, most),
            OtherSide::Part(place) => distance(one, &posed.parts[place].solid, most),
        }
    }

    /// How far any point of each part can get if the joints of all limbs turn by so much, in rad, in whatever directions: an upper bound, in units.
    pub fn ways(&self, turned: &[Angles]) -> Ways {
        let limbs = self.limbs.iter().zip(turned);
        let parts = limbs.flat_map(|(limb, turned)| {
            let reaches = limb.reaches().iter();
            reaches.map(move |reach| {
                let ways = reach
                    .iter()
                    .zip(turned)
                    .map(|(reach, turned)| reach * turned);
                ways.sum::<f64>() as f32
            })
        });
        Ways(parts.collect())
    }

    /// What is on the two sides of a gap, seen from its limb.
    pub fn name(&self, gap: &PartGap) -> NearThing {
        let limb = gap.limbs.iter().flatten().next();
        let limb = limb.map_or_else(String::new, |limb| self.limbs[*limb].name.clone());
        match gap.sides.1 == OtherSide::Table {
            true => NearThing::Table { limb },
            false => NearThing::Robot { limb },
        }
    }
}

/// The distance of two solids, but at most this; negative if they overlap, since GJK does not tell how deep they do: by what their centres are nearer than
/// their balls allow.
fn distance(one: &PlacedSolid, other: &PlacedSolid, most: f32) -> f32 {
    let radii = one.radius() + other.radius();
    let between = one.pose.location.distance(other.pose.location);
    if between - radii >= most || !one.is_within(most, other) {
        return most;
    }
    match one.away_from(other).length() {
        0.0 => between - radii,
        distance => distance.min(most),
    }
}

/// The distance of a solid from the table, but at most this; how far it is below the top, negative, if it is in it.
fn height_above(table: &Table, solid: &PlacedSolid, most: f32) -> f32 {
    let [low, _] = solid.heights();
    if low >= most {
        return most;
    }
    let slab = PlacedSolid {
        pose: Pose::at(Vec3::NEG_Z * TABLE_DEPTH / 2.0),
        solid: Solid::Cuboid(Vec3::new(table.xspan, table.yspan, TABLE_DEPTH)),
    };
    match solid.away_from(&slab).length() {
        0.0 => low.min(0.0),
        distance => distance.min(most),
    }
}
