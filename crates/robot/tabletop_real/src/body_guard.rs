//! The guard of the robot's body: a model of it that runs beside.

use tabletop_bridge::{Guard, PredictedMotion, RobotState};
use tabletop_controller::{Angles, angles};
use tabletop_core::Table;
use tabletop_planner::{GuardedGaps, PartGap, RobotBody, Ways};

/// The widths of gaps that a motion may not make narrower, in units: 3.5 cm, and 1 cm for fingers above the table. (`links_and_fingers_keep_their_distance`)
const LINKS: f32 = 0.35;
const FINGERS: f32 = 0.1;

/// What noise of the states and the arm's own inaccuracy may take of them, in units; what a gap that was too narrow keeps. (`noise_is_no_ratchet`)
const BAND: f32 = 0.05;

/// By how much, in units, an arm may be beside the way that was planned for it. (`no_way_is_planned_that_the_guard_refuses`)
const BESIDE: f32 = 0.02;

/// Gaps are measured if they may be narrower than what they keep and this, in units, and up to this: what is known of them beyond holds for as long a way.
/// (`a_move_through_the_table_is_vetoed_before_it_begins`: it takes longer with other numbers)
const MEASURED: f32 = 0.2;
const KNOWN: f32 = 3.0;

/// The finest steps, in units, of any point of the robot, in which a motion is looked at. (`links_and_fingers_keep_their_distance`)
const STEP: f32 = 0.05;

/// What a gap may become narrower by within a motion, in units: the accuracy of the distances. (`what_is_too_near_can_only_leave`)
const ACCURACY: f32 = 1e-3;

/// Refuses motions on which a limb comes nearer than 3 cm to the table or to the robot itself; fingers may come as near as 1 cm to the table. What is nearer
/// already can only leave.
pub struct BodyGuard {
    body: RobotBody,
    table: Table,
    gaps: Vec<WatchedGap>,
    /// The posture from which the last motion began.
    posture: Vec<Angles>,
    openings: Vec<f32>,
}

/// A gap, and what is known of it.
struct WatchedGap {
    gap: PartGap,
    /// It is at least so wide, in units: in the posture that is looked at, and in that from which the motion begins.
    least: f32,
    least_at_first: f32,
    /// What it must keep at least, in units, if it was too narrow.
    floor: Option<f32>,
    /// The widest that it was on the way, but no wider than is kept.
    widest: f32,
}

impl WatchedGap {
    /// The width that it is to have.
    const fn kept(&self) -> f32 {
        match self.gap.is_of_fingers {
            true => FINGERS,
            false => LINKS,
        }
    }

    /// True if it may be so narrow that it matters.
    fn matters(&self) -> bool {
        self.least < self.kept() + MEASURED
    }

    /// Keeps in mind how wide it is before a motion.
    fn begin(&mut self) {
        self.least_at_first = self.least;
        self.widest = self.least.min(self.kept());
        self.floor = (self.least < self.kept() + BAND).then(|| {
            let floor = self.widest - BAND;
            self.floor.map_or(floor, |before| before.max(floor - BAND))
        });
    }

    /// False if a motion makes it too narrow, or narrower than it is.
    fn keeps(&mut self) -> bool {
        let floor = self.floor.unwrap_or(self.kept() - BAND);
        let is_narrowed = self.least < self.widest - ACCURACY;
        let is_below = self.least < self.widest && self.least < floor;
        self.widest = self.widest.max(self.least).min(self.kept());
        self.least >= self.kept() || !(is_narrowed || is_below)
    }
}

impl BodyGuard {
    /// The gaps that ways have to keep so that it lets an arm go them.
    pub const GAPS: GuardedGaps = GuardedGaps {
        links: LINKS + BESIDE,
        fingers_above_table: FINGERS + BESIDE,
    };

    /// A guard of this body at a table.
    pub fn new(body: RobotBody, table: Table) -> Self {
        let gaps = body.gaps().into_iter().map(|gap| WatchedGap {
            gap,
            least: f32::NEG_INFINITY,
            least_at_first: f32::NEG_INFINITY,
            floor: None,
            widest: 0.0,
        });
        Self {
            gaps: gaps.collect(),
            posture: body.limbs.iter().map(|limb| limb.home).collect(),
            openings: vec![0.0; body.limbs.len()],
            body,
            table,
        }
    }

    /// The motion as postures of the body.
    fn path(&self, motion: &PredictedMotion) -> BodyPath {
        let posture = |moment: usize| -> Vec<Angles> {
            let limbs = self.body.limbs.iter();
            let postures = limbs.map(|limb| match motion.angles(&limb.name, moment) {
                Some(own) => angles(own.iter().copied()),
                None => limb.home,
            });
            postures.collect()
        };
        let mut path = BodyPath::default();
        let mut turned = vec![Angles::default(); self.body.limbs.len()];
        for moment in 0..motion.moments() {
            let posture = posture(moment);
            if let Some(last) = path.postures.last() {
                let by = turns(last, &posture);
                for (sum, by) in turned.iter_mut().flatten().zip(by.iter().flatten()) {
                    *sum += by;
                }
            }
            path.postures.push(posture);
            path.turned.push(turned.clone());
        }
        path
    }

    fn openings(&self, state: &RobotState) -> Vec<f32> {
        let limbs = self.body.limbs.iter();
        let openings = limbs.map(|limb| {
            let reading = state.grippers.get(&limb.name);
            limb.widest * reading.map_or(1.0, |reading| reading.opening as f32)
        });
        openings.collect()
    }

    /// The parts have moved by these ways: gaps may be narrower by them, and those that matter are measured.
    fn measure(&mut self, posture: &[Angles], openings: &[f32], ways: &Ways, opened: f32) {
        let mut posed = None;
        for watched in &mut self.gaps {
            watched.least -= watched.gap.narrowing(ways) + opened;
            if watched.matters() {
                let posed = posed.get_or_insert_with(|| self.body.posed(posture, openings));
                let most = watched.kept() + KNOWN;
                watched.least = self.body.width(&watched.gap, posed, &self.table, most);
            }
        }
    }

    /// Goes to the posture from which a motion begins. It is near to that from which the last one began.
    fn begin_at(&mut self, posture: &[Angles], openings: &[f32]) {
        for watched in &mut self.gaps {
            watched.least = watched.least_at_first;
        }
        let opened = self.openings.iter().zip(openings);
        let opened: f32 = opened.map(|(from, to)| (to - from).abs()).sum();
        let ways = self.body.ways(&turns(&self.posture, posture));
        self.measure(posture, openings, &ways, opened);
        self.posture.clone_from_slice(posture);
        self.openings.clone_from_slice(openings);
        for watched in &mut self.gaps {
            watched.begin();
        }
    }

    /// The moment after another one up to which no gap that is watched can get too narrow, nor any point move farther than a fine step where one may be; and
    /// the ways until then.
    fn step_on(&self, path: &BodyPath, moment: usize) -> Option<(usize, Ways)> {
        let last = path.postures.len().checked_sub(1)?;
        if moment >= last {
            return None;
        }
        let ways = |later: usize| {
            let turned = turns(&path.turned[moment], &path.turned[later]);
            self.body.ways(&turned)
        };
        let is_free = |ways: &Ways| {
            self.gaps.iter().all(|watched| {
                let room = (watched.least - watched.kept()).max(STEP);
                watched.gap.narrowing(ways) <= room
            })
        };
        let (mut reached, mut beyond) = (moment + 1, last + 1);
        let mut until = ways(reached);
        let mut next = last;
        while beyond - reached > 1 {
            let there = ways(next);
            match is_free(&there) {
                true => (reached, until) = (next, there),
                false => beyond = next,
            }
            next = usize::midpoint(reached, beyond);
        }
        Some((reached, until))
    }
}

/// A motion as postures, and by how much each joint has turned until then, to and fro.
#[derive(Default)]
struct BodyPath {
    postures: Vec<Vec<Angles>>,
    turned: Vec<Vec<Angles>>,
}

/// By how much each joint differs.
fn turns(from: &[Angles], to: &[Angles]) -> Vec<Angles> {
    let limbs = from.iter().zip(to);
    let turns = limbs.map(|(from, to)| {
        let joints = from.iter().zip(to);
        angles(joints.map(|(from, to)| (to - from).abs()))
    });
    turns.collect()
}

impl Guard for BodyGuard {
    fn veto(&mut self, state: &RobotState, motion: &PredictedMotion) -> Option<String> {
        let openings = self.openings(state);
        let path = self.path(motion);
        let limbs = self.body.limbs.iter();
        let is_driven: Vec<_> = limbs
            .map(|limb| motion.driven.contains(&limb.name))
            .collect();
        self.begin_at(path.postures.first()?, &openings);
        let mut moment = 0;
        loop {
            let (next, ways) = self.step_on(&path, moment)?;
            moment = next;
            self.measure(&path.postures[moment], &openings, &ways, 0.0);
            for watched in &mut self.gaps {
                let mut limbs = watched.gap.limbs.iter().flatten();
                if limbs.any(|limb| is_driven[*limb]) && !watched.keeps() {
                    return Some(self.body.name(&watched.gap).to_string());
                }
            }
        }
    }
}
