//! Where there is room for an object.

use std::f32::consts::FRAC_PI_2;

use bevy::math::{Quat, Vec2, Vec3};
use tabletop_core::{ObjectSpec, Table};
use tabletop_geometry::{PlacedSolid, Pose, Solid};
use tabletop_task::{RelativeSide, twist_about};

use crate::{
    noun::TableSide,
    scene::{SceneView, solids_at},
};

/// Gaps to other objects, in units, the first that there is room for: fingers reach what has the first around it.
pub(crate) const GAPS: [f32; 4] = [0.9, 0.5, 0.2, 0.02];
/// Distance between places that are tried, in units.
const GRID: f32 = 0.25;
/// Distance from the edges of the table, in units.
const EDGE: f32 = 0.3;
/// Overlap, in units, of things that are not above each other.
const OVERLAP: f32 = 0.03;
/// Distance, in units, of things that touch.
const TOUCHING: f32 = 1e-3;
/// Gap between things beside each other, in units.
const BESIDE: f32 = 0.4;

/// The room that there is for an object among all others. What stands on it does not count.
pub(crate) struct Room<'a> {
    view: &'a SceneView<'a>,
    object: &'a ObjectSpec,
    others: Vec<SpotOccupant<'a>>,
}

/// A solid of another object.
struct SpotOccupant<'a> {
    id: &'a str,
    solid: PlacedSolid,
    footprint: Footprint,
}

/// The solids of an object at a pose, from which it is moved without being turned.
struct OwnSolids {
    solids: Vec<(PlacedSolid, Footprint)>,
    low: f32,
}

impl OwnSolids {
    fn of(solids: Vec<PlacedSolid>) -> Self {
        let low = lowest(&solids);
        let solids = solids.into_iter().map(|solid| {
            let footprint = Footprint::of(&solid);
            (solid, footprint)
        });
        Self {
            solids: solids.collect(),
            low,
        }
    }

    /// The rectangle around them, seen from above.
    fn footprint(&self) -> Footprint {
        let nowhere = Footprint {
            low: Vec2::INFINITY,
            high: Vec2::NEG_INFINITY,
        };
        let footprints = self.solids.iter().map(|(_, footprint)| footprint);
        footprints.fold(nowhere, |all, one| Footprint {
            low: all.low.min(one.low),
            high: all.high.max(one.high),
        })
    }
}

/// The rectangle around a solid, seen from above.
#[derive(Clone, Copy)]
struct Footprint {
    low: Vec2,
    high: Vec2,
}

impl Footprint {
    fn of(solid: &PlacedSolid) -> Self {
        let end = |axis: Vec3| solid.farthest(axis);
        Self {
            low: Vec2::new(end(Vec3::NEG_X).x, end(Vec3::NEG_Y).y),
            high: Vec2::new(end(Vec3::X).x, end(Vec3::Y).y),
        }
    }

    fn moved(&self, by: Vec3) -> Self {
        Self {
            low: self.low + by.truncate(),
            high: self.high + by.truncate(),
        }
    }

    fn is_on(&self, table: &Table) -> bool {
        let half = Vec2::new(table.xspan, table.yspan) / 2.0 - EDGE;
        let farthest = self.low.abs().max(self.high.abs());
        farthest.cmplt(half).all()
    }

    fn is_at(&self, side: TableSide) -> bool {
        let mut corners = [self.low, self.high].into_iter();
        corners.all(|corner| side.has(corner.extend(0.0)))
    }

    /// A lower bound of the gap between two solids, which is fast.
    fn gap(&self, other: &Self) -> f32 {
        let gap = (other.low - self.high).max(self.low - other.high);
        gap.max_element()
    }
}

impl<'a> SpotOccupant<'a> {
    fn new(id: &'a str, solid: PlacedSolid) -> Self {
        let footprint = Footprint::of(&solid);
        Self {
            id,
            solid,
            footprint,
        }
    }
}

impl<'a> Room<'a> {
    pub fn new(view: &'a SceneView<'a>, object: &'a ObjectSpec) -> Self {
        let above = view.stack_above(&object.id);
        let others = view.scene.objects.iter();
        let others = others.filter(|other| other.id != object.id && !above.contains(&other.id));
        let solids = others.flat_map(|other| {
            let solids = solids_at(other, other.pose).into_iter();
            solids.map(|solid| SpotOccupant::new(&other.id, solid))
        });
        Self {
            view,
            object,
            others: solids.collect(),
        }
    }

    /// The same without these objects.
    pub fn without(mut self, ids: &[&str]) -> Self {
        self.others.retain(|other| !ids.contains(&other.id));
        self
    }

    /// The same, with these solids to be kept clear of.
    pub fn keeping(mut self, solids: impl IntoIterator<Item = PlacedSolid>) -> Self {
        self.others
            .extend(solids.into_iter().map(|solid| SpotOccupant::new("", solid)));
        self
    }

    fn solids_at(&self, pose: Pose) -> Vec<PlacedSolid> {
        solids_at(self.object, pose)
    }

    /// The pose in this orientation in which it rests with its origin above or below a location, on whatever is there.
    pub fn resting(&self, at: Vec3, rotation: Quat) -> Pose {
        let solids = self.solids_at(Pose::new(at.with_z(0.0), rotation));
        let solids_inside: Vec<_> = solids.iter().map(|own| own.shrunk(OVERLAP)).collect();
        let footprints: Vec<_> = solids.iter().map(Footprint::of).collect();
        let below = self.others.iter().filter(|other| {
            let shrunk = other.solid.shrunk(OVERLAP);
            let mut own = solids_inside.iter().zip(&footprints);
            own.any(|(own, footprint)| {
                footprint.gap(&other.footprint) <= 0.0 && own.gap_from_above(&shrunk) <= 0.0
            })
        });
        let height = below
            .map(|other| other.solid.heights()[1])
            .fold(0.0, f32::max);
        Pose::new(at.with_z(height - lowest(&solids)), rotation)
    }

    /// The pose on another object, or on what stands on that, if there is no room.
    pub fn upon(&self, base: &str) -> Option<Pose> {
        let mut surfaces = self.view.stack_above(base);
        surfaces.retain(|surface| *surface != self.object.id);
        surfaces.push(base.to_owned());
        let mut from_below = surfaces.iter().rev();
        from_below.find_map(|surface| self.directly_upon(surface))
    }

    /// The pose on another object, as near to its centre as there is room.
    pub fn directly_upon(&self, base: &str) -> Option<Pose> {
        let (center, top) = (self.view.location(base), self.view.top(base));
        let base_solids = self.view.solids(base);
        let is_over = |pose: &Pose| {
            let spot = point(pose.location);
            let mut tops = base_solids
                .iter()
                .filter(|solid| solid.heights()[1] > top - OVERLAP);
            tops.any(|solid| spot.gap_from_above(solid) <= 0.0)
        };
        let poses = around(center, &base_solids, [Vec3::X, Vec3::Y]).into_iter();
        let poses = poses.map(|place| self.resting(place, self.object.pose.rotation));
        let is_on = |pose: &Pose| (lowest(&self.solids_at(*pose)) - top).abs() < OVERLAP;
        let poses = poses.filter(|pose| is_on(pose) && is_over(pose));
        roomiest(poses, |pose, gap| self.is_free(*pose, gap, &[base]))
    }

    /// The pose in a container, as low as there is room, and as far to the back and to the left: so there is room for more.
    pub fn within(&self, container: &str) -> Option<Pose> {
        let (center, top) = (self.view.location(container), self.view.top(container));
        let turn = self.view.object(container)?.pose.rotation;
        // Places beyond the walls of a turned box are none in it.
        let right = (turn * Vec3::X).with_z(0.0).normalize_or(Vec3::X);
        let sides = [right, Vec3::new(-right.y, right.x, 0.0)];
        let mut places = around(center, &self.view.solids(container), sides);
        places.sort_by(|a, b| b.y.total_cmp(&a.y).then(a.x.total_cmp(&b.x)));
        let mut best: Option<Pose> = None;
        for place in places {
            let pose = self.resting(place, self.object.pose.rotation);
            let is_lower = best.is_none_or(|best| pose.location.z < best.location.z - OVERLAP);
            // Neither on the walls, nor in them.
            let is_in = (lowest(&self.solids_at(pose)) - top).abs() > OVERLAP;
            if is_lower && is_in && self.occupant(pose).is_none() {
                best = Some(pose);
            }
        }
        best
    }

    /// The pose beside another object.
    pub fn beside(&self, other: &str, side: RelativeSide) -> Option<Pose> {
        let (way, center) = (side.way(), self.view.location(other));
        let rotation = self.object.pose.rotation;
        let here = self.solids_at(Pose::new(Vec3::ZERO, rotation));
        let [_, end] = PlacedSolid::extent(&self.view.solids(other), way);
        let [begin, _] = PlacedSolid::extent(&here, way);
        let across = Vec3::new(-way.y, way.x, 0.0);
        let beyond = end - center.dot(way) + BESIDE - begin;
        let steps = [0.0, 1.0, -1.0, 2.0, -2.0].map(|step| across * step * GRID);
        let mut poses = steps
            .into_iter()
            .map(|aside| self.resting(center + way * beyond + aside, rotation));
        poses.find(|pose| {
            RelativeSide::of(pose.location - center) == side
                && self.is_on_table(*pose)
                && self.is_free(*pose, GAPS[3], &[])
        })
    }

    /// A free place on the table, as near to a location as there is room.
    pub fn free_spot(&self, near: Vec3, side: Option<TableSide>) -> Option<Pose> {
        let table = &self.view.scene.table;
        let lying = on_table(self.object, Vec3::ZERO, self.object.pose.rotation);
        let own = OwnSolids::of(self.solids_at(lying));
        let footprint = own.footprint();
        let places = places(table).filter(|place| {
            let there = footprint.moved(*place);
            there.is_on(table) && side.is_none_or(|side| there.is_at(side))
        });
        let places = from_near_to_far(places, near);
        let place = roomiest(places, |place, gap| self.clears(&own, *place, gap, &[]))?;
        Some(Pose::new(lying.location + place, lying.rotation))
    }

    /// An object that is where this one would be at a pose.
    pub fn occupant(&self, pose: Pose) -> Option<&'a str> {
        let raised = Pose::new(pose.location + Vec3::Z * OVERLAP, pose.rotation);
        let solids = self.solids_at(raised);
        let own: Vec<_> = solids
            .iter()
            .map(|own| (own.shrunk(OVERLAP / 3.0), Footprint::of(own)))
            .collect();
        let meets = |other: &&SpotOccupant| {
            own.iter().any(|(own, footprint)| {
                footprint.gap(&other.footprint) <= TOUCHING && own.is_within(TOUCHING, &other.solid)
            })
        };
        self.others.iter().find(meets).map(|other| other.id)
    }

    /// True if others are so far from it, seen from above; its bases do not count, nor what is wholly below.
    pub fn is_free(&self, pose: Pose, gap: f32, bases: &[&str]) -> bool {
        self.clears(&OwnSolids::of(self.solids_at(pose)), Vec3::ZERO, gap, bases)
    }

    /// The same of its solids, moved by a way.
    fn clears(&self, own: &OwnSolids, by: Vec3, gap: f32, bases: &[&str]) -> bool {
        let is_apart = |other: &SpotOccupant| {
            own.solids.iter().all(|(own, footprint)| {
                let moved = || PlacedSolid {
                    pose: Pose::new(own.pose.location + by, own.pose.rotation),
                    solid: own.solid.clone(),
                };
                footprint.moved(by).gap(&other.footprint) > gap
                    || moved().gap_from_above(&other.solid) > gap
            })
        };
        self.others.iter().all(|other| {
            is_apart(other)
                || bases.contains(&other.id)
                || other.solid.heights()[1] <= own.low + by.z + OVERLAP
        })
    }

    pub fn is_on_table(&self, pose: Pose) -> bool {
        let own = OwnSolids::of(self.solids_at(pose));
        own.footprint().is_on(&self.view.scene.table)
    }
}

/// The first place that has most room around it.
fn roomiest<P: Copy>(
    places: impl IntoIterator<Item = P>,
    is_free: impl Fn(&P, f32) -> bool,
) -> Option<P> {
    let mut best = None;
    let mut gaps = &GAPS[..];
    for place in places {
        while let Some((least, wider)) = gaps.split_last() {
            if !is_free(&place, *least) {
                break;
            }
            best = Some(place);
            gaps = wider;
        }
        if gaps.is_empty() {
            break;
        }
    }
    best
}

/// The pose of an object that lies on the table in this orientation.
pub(crate) fn on_table(object: &ObjectSpec, at: Vec3, rotation: Quat) -> Pose {
    let solids = solids_at(object, Pose::new(Vec3::ZERO, rotation));
    Pose::new(at.with_z(-lowest(&solids)), rotation)
}

/// Locations on the table, the nearest to one first.
pub(crate) fn places_on(table: &Table, near: Vec3) -> Vec<Vec3> {
    from_near_to_far(places(table), near)
}

/// Locations on the table.
fn places(table: &Table) -> impl Iterator<Item = Vec3> {
    let steps = |span: f32| {
        let count = (span / 2.0 / GRID) as i16;
        (-count..=count).map(|step| f32::from(step) * GRID)
    };
    let across = steps(table.yspan);
    steps(table.xspan).flat_map(move |x| across.clone().map(move |y| Vec3::new(x, y, 0.0)))
}

/// Locations above solids along two directions, the nearest to a centre first.
fn around(center: Vec3, solids: &[PlacedSolid], [right, back]: [Vec3; 2]) -> Vec<Vec3> {
    let steps = |axis: Vec3| {
        let [low, high] = PlacedSolid::extent(solids, axis);
        let reach = (center.dot(axis) - low).max(high - center.dot(axis));
        let count = (reach / GRID) as i16;
        (-count..=count).map(move |step| axis * f32::from(step) * GRID)
    };
    let places = steps(right).flat_map(|x| steps(back).map(move |y| center + x + y));
    from_near_to_far(places, center)
}

fn from_near_to_far(places: impl Iterator<Item = Vec3>, near: Vec3) -> Vec<Vec3> {
    let places = places.map(|place| ((place - near).truncate().length(), place));
    let mut places: Vec<_> = places.collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places.into_iter().map(|(_, place)| place).collect()
}

/// The orientation with sides along the axes of the table that is nearest.
pub(crate) fn aligned(rotation: Quat) -> Quat {
    let twist = twist_about(rotation, Vec3::Z);
    let angle = 2.0 * twist.z.atan2(twist.w);
    let nearest = (angle / FRAC_PI_2).round() * FRAC_PI_2;
    (Quat::from_rotation_z(nearest - angle) * rotation).normalize()
}

pub(crate) fn lowest(solids: &[PlacedSolid]) -> f32 {
    let lows = solids.iter().map(|solid| solid.heights()[0]);
    lows.reduce(f32::min).unwrap_or_default()
}

fn point(location: Vec3) -> PlacedSolid {
    PlacedSolid {
        pose: Pose::at(location),
        solid: Solid::Ball(1e-3),
    }
}
