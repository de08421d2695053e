//! Arrangements: where objects are at a moment, and how they relate to each other.

use std::{collections::BTreeMap, f32::consts::TAU};

use bevy::math::Vec3;
use tabletop_core::Shape;
use tabletop_geometry::{PlacedSolid, Pose, Solid};

/// Objects with their poses at one moment.
#[derive(Clone, Debug, Default)]
pub struct Arrangement {
    objects: BTreeMap<String, Placed>,
}

/// An object with its pose.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub pose: Pose,
    solids: Vec<BoundedSolid>,
    /// Its lowest and highest Z.
    heights: [f32; 2],
    /// Radius of the ball about its origin that encloses it.
    radius: f32,
}

/// A solid with its bounds, which tell most pairs apart.
#[derive(Clone, Debug)]
struct BoundedSolid {
    solid: PlacedSolid,
    /// Its lowest and highest Z.
    heights: [f32; 2],
    /// Radius of the ball about its centre that encloses it.
    radius: f32,
}

/// Largest gap, in units, at which objects count as touching.
pub const TOUCH: f32 = 0.06;
/// Largest overhang of an edge, in units, that does not count as support.
const EDGE: f32 = 0.03;
/// Step, in units, in which distances of supports are compared: of those that are as near, the first by id comes first, however a demonstration trembles.
const AS_NEAR: f32 = 0.1;
/// Largest gap between objects, as seen from above, that are not beside each other, in units.
const BESIDE: f32 = 1e-3;
/// Least angle, in rad, by which all sides of an object that leans are off the level.
const TILTED: f32 = 0.1;

impl Arrangement {
    /// An arrangement of objects, by their ids, shapes and poses.
    pub fn new<'a>(objects: impl IntoIterator<Item = (&'a str, &'a Shape, Pose)>) -> Self {
        let placed = objects
            .into_iter()
            .map(|(id, shape, pose)| (id.to_owned(), Placed::new(shape, pose)));
        Self {
            objects: placed.collect(),
        }
    }

    /// Pose of an object.
    pub fn pose(&self, id: &str) -> Option<Pose> {
        self.get(id).map(|object| object.pose)
    }

    pub(crate) fn get(&self, id: &str) -> Option<&Placed> {
        self.objects.get(id)
    }

    /// All but one, in the order of their ids.
    pub(crate) fn others<'a>(
        &'a self,
        id: &str,
    ) -> impl Iterator<Item = (&'a str, &'a Placed)> + use<'a> {
        let id = id.to_owned();
        let others = self.objects.iter().filter(move |(other, _)| **other != id);
        others.map(|(id, object)| (id.as_str(), object))
    }

    /// The objects that an object stands on, the nearest to its centre first. The table is not among them.
    pub fn supports(&self, id: &str) -> Vec<&str> {
        let Some(object) = self.get(id) else {
            return Vec::new();
        };
        let mut supports: Vec<_> = self
            .others(id)
            .filter(|(_, other)| object.rests_on(other))
            .map(|(other, placed)| {
                let distance = placed.across(object.pose.location);
                ((distance / AS_NEAR).round(), other)
            })
            .collect();
        supports.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(b.1)));
        supports.into_iter().map(|(_, id)| id).collect()
    }

    /// The objects that hold up an object which leans: it touches them and the table, and none of its sides is level.
    pub fn props(&self, id: &str) -> Vec<&str> {
        let Some(object) = self.get(id) else {
            return Vec::new();
        };
        if !self.is_on_table(id) || !object.is_tilted() {
            return Vec::new();
        }
        let props = self
            .others(id)
            .filter(|(_, other)| object.gap(other) < TOUCH && !other.rests_on(object));
        props.map(|(other, _)| other).collect()
    }

    /// The objects that stand directly on an object, in the order of their ids.
    pub fn standing_on(&self, id: &str) -> Vec<&str> {
        let Some(support) = self.get(id) else {
            return Vec::new();
        };
        let above = self.others(id).filter(|(_, other)| other.rests_on(support));
        above.map(|(other, _)| other).collect()
    }

    /// True if an object touches the table's top.
    pub fn is_on_table(&self, id: &str) -> bool {
        self.get(id)
            .is_some_and(|object| object.lowest().abs() < TOUCH)
    }

    /// The objects that contain an object, with walls on all sides.
    pub fn containers(&self, id: &str) -> Vec<&str> {
        let Some(object) = self.get(id) else {
            return Vec::new();
        };
        let holds = |other: &Placed| {
            let [low, high] = overlap(object.heights, other.heights);
            let inner = object.pose.location.with_z(f32::midpoint(low, high));
            high - low > TOUCH
                && other.encloses(inner)
                && !other.holds(inner)
                && object.is_within(other)
                && !other.is_over(inner)
        };
        let all = self.others(id).filter(|(_, other)| holds(other));
        all.map(|(id, _)| id).collect()
    }

    /// The objects that go along with an object when it is moved: those on it and in it, and those on and in these. Each comes after what it is on
    /// or in.
    pub fn load(&self, id: &str) -> Vec<&str> {
        let mut load = Vec::<&str>::new();
        let carrier = self.objects.get_key_value(id);
        let mut carriers: Vec<_> = carrier.map(|(id, _)| id.as_str()).into_iter().collect();
        while !carriers.is_empty() {
            let is_carried = |other: &&str| {
                let bases = [self.supports(other), self.containers(other)].concat();
                bases.iter().any(|base| carriers.contains(base))
            };
            let others = self.others(id).map(|(other, _)| other);
            let others = others.filter(|other| !load.contains(other));
            carriers = others.filter(is_carried).collect();
            load.extend(&carriers);
        }
        load
    }

    /// The objects that an object surrounds, as a ring surrounds a peg. What lies in it is not among them.
    pub fn posts(&self, id: &str) -> Vec<&str> {
        let Some(object) = self.get(id) else {
            return Vec::new();
        };
        let is_around = |other: &Placed| {
            other.solids.iter().any(|part| {
                let [low, high] = overlap(object.heights, part.heights);
                let inner = part.solid.pose.location.with_z(f32::midpoint(low, high));
                high - low > TOUCH
                    && object.encloses(inner)
                    && !object.holds(inner)
                    && !object.is_hit_by(inner, Vec3::NEG_Z)
            })
        };
        let all = self.others(id).filter(|(_, other)| is_around(other));
        all.map(|(id, _)| id).collect()
    }

    /// True if an object touches another one or the table.
    pub(crate) fn touches_anything(&self, id: &str) -> bool {
        let touches = |object: &Placed| self.others(id).any(|(_, other)| object.gap(other) < TOUCH);
        self.is_on_table(id) || self.get(id).is_some_and(touches)
    }

    /// The objects that an object is around, and the one below it that it is on, for all that is known of their sizes: the vertical through
    /// a post passes through the object's hole, and a support is below its centre.
    pub(crate) fn presumed_bases(&self, id: &str) -> (Vec<&str>, Option<&str>) {
        let Some(object) = self.get(id) else {
            return (Vec::new(), None);
        };
        let is_lower = |other: &Placed| other.lowest() < object.pose.location.z;
        let [low, high] = object.heights;
        let posts = self.others(id).filter(|(_, other)| {
            let axis = other.pose.location.with_z(f32::midpoint(low, high));
            is_lower(other) && object.encloses(axis) && !object.holds(axis)
        });
        let top = |placed: &Placed| placed.heights[1];
        let below = self.others(id).filter(|(_, other)| {
            top(other) < object.pose.location.z && object.shares_column_with(other)
        });
        let support = below.max_by(|(_, a), (_, b)| top(a).total_cmp(&top(b)));
        let support = support.map(|(id, _)| id);
        let others = posts.map(|(id, _)| id).filter(|id| Some(*id) != support);
        (others.collect(), support)
    }
}

impl Placed {
    pub fn new(shape: &Shape, pose: Pose) -> Self {
        let solids = shape.colliding();
        let solids = solids.iter().map(|solid| PlacedSolid::of(solid, pose));
        let solids: Vec<_> = solids.map(BoundedSolid::new).collect();
        let heights = solids.iter().map(|part| part.heights);
        let reaches = solids
            .iter()
            .map(|part| part.solid.pose.location.distance(pose.location) + part.radius);
        Self {
            pose,
            heights: heights
                .reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)])
                .unwrap_or([pose.location.z; 2]),
            radius: reaches.fold(0.0, f32::max),
            solids,
        }
    }

    pub fn lowest(&self) -> f32 {
        self.heights[0]
    }

    /// True if it neither stands nor lies on a side of it.
    fn is_tilted(&self) -> bool {
        self.solids.iter().all(|part| is_tilted(&part.solid))
    }

    /// Distance of a point from its origin, seen from above.
    fn across(&self, point: Vec3) -> f32 {
        (self.pose.location - point).truncate().length()
    }

    fn pairs<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = (&'a BoundedSolid, &'a BoundedSolid)> {
        let own = self.solids.iter();
        own.flat_map(|own| other.solids.iter().map(move |other| (own, other)))
    }

    /// True if it lies on top of a part of the other: if only these two were there, it would fall without the other.
    fn rests_on(&self, other: &Self) -> bool {
        const LIFT: f32 = 0.15;
        if self.across(other.pose.location) > self.radius + other.radius + BESIDE {
            return false;
        }
        let is_above = |(own, other): &(&BoundedSolid, &BoundedSolid)| {
            let [own_low, own_high] = own.heights;
            let [other_low, other_high] = other.heights;
            let is_at_height = own_low - other_high < EDGE + TOUCH && own_high + LIFT > other_low;
            is_at_height
                && own.may_be_above(other)
                && own.solid.gap_from_above(&other.solid) < BESIDE
        };
        let mut above = self
            .pairs(other)
            .filter(is_above)
            .map(|(own, other)| (&own.solid, &other.solid));
        above.any(|(own, other)| {
            // A solid that touches has no direction; lifted, it has.
            let away = own.shrunk(EDGE).moved(Vec3::Z * LIFT).away_from(other);
            let gap = away.length() - LIFT;
            away.z > 0.7 * away.length() && away.z > 0.0 && (gap - EDGE).abs() < TOUCH
        })
    }

    /// Gap between the two.
    pub fn gap(&self, other: &Self) -> f32 {
        self.pairs(other)
            .map(|(own, other)| own.solid.away_from(&other.solid).length())
            .fold(f32::INFINITY, f32::min)
    }

    /// True if a part of it is above or below a part of the other.
    pub fn shares_column_with(&self, other: &Self) -> bool {
        self.pairs(other)
            .filter(|(own, other)| own.may_be_above(other))
            .any(|(own, other)| {
                let [own, other] = [own, other].map(|part| part.solid.shrunk(EDGE));
                own.gap_from_above(&other) <= 0.0
            })
    }

    /// True if every level line from a point meets it.
    fn encloses(&self, point: Vec3) -> bool {
        const WAYS: u16 = 16;
        // A line along the seam between two solids may miss both: one beside it does not.
        const BESIDE: f32 = 0.01;
        let [low, high] = self.heights;
        if self.across(point) > self.radius || !(low..=high).contains(&point.z) {
            return false;
        }
        let meets = |angle: f32| self.is_hit_by(point, Vec3::new(angle.cos(), angle.sin(), 0.0));
        (0..WAYS).all(|i| {
            let angle = TAU * (f32::from(i) + 0.5) / f32::from(WAYS);
            meets(angle) || meets(angle + BESIDE)
        })
    }

    /// True if a ray meets it.
    fn is_hit_by(&self, from: Vec3, towards: Vec3) -> bool {
        let mut solids = self.solids.iter().map(|part| &part.solid);
        solids.any(|solid| solid.is_hit_by(from, towards))
    }

    /// True if it covers a point that it does not carry, as a box that is upside down does.
    fn is_over(&self, point: Vec3) -> bool {
        self.is_hit_by(point, Vec3::Z) && !self.is_hit_by(point, Vec3::NEG_Z)
    }

    /// True if a point is in one of its solids.
    fn holds(&self, point: Vec3) -> bool {
        let spot = PlacedSolid {
            pose: Pose::at(point),
            solid: Solid::Ball(1e-3),
        };
        self.solids
            .iter()
            .any(|part| part.solid.away_from(&spot).length() < 1e-3)
    }

    /// True if it stays within the outline of the other, seen from above.
    fn is_within(&self, other: &Self) -> bool {
        let reach = |object: &Self, way: Vec3| {
            let all = object
                .solids
                .iter()
                .map(|part| part.solid.farthest(way).dot(way));
            all.fold(f32::NEG_INFINITY, f32::max)
        };
        let frame = other.pose.rotation;
        let ways = [Vec3::X, Vec3::Y].map(|axis| (frame * axis).with_z(0.0).normalize_or(axis));
        ways.into_iter()
            .flat_map(|way| [way, -way])
            .all(|way| reach(self, way) <= reach(other, way) + TOUCH)
    }
}

impl BoundedSolid {
    fn new(solid: PlacedSolid) -> Self {
        Self {
            heights: solid.heights(),
            radius: solid.radius(),
            solid,
        }
    }

    /// False if a level gap is between them, seen from above.
    fn may_be_above(&self, other: &Self) -> bool {
        let across = (self.solid.pose.location - other.solid.pose.location).truncate();
        across.length() < self.radius + other.radius + BESIDE
    }
}

/// True if none of a solid's sides is level. What is round about an axis lies on any side of that.
fn is_tilted(solid: &PlacedSolid) -> bool {
    let height = |axis: Vec3| (solid.pose.rotation * axis).z.abs();
    let is_between = |axis: Vec3| (TILTED.sin()..TILTED.cos()).contains(&height(axis));
    let is_off = || {
        [Vec3::X, Vec3::Y, Vec3::Z]
            .into_iter()
            .all(|axis| height(axis) < TILTED.cos())
    };
    match &solid.solid {
        Solid::Ball(_) => false,
        Solid::Cylinder { .. } => is_between(Vec3::Y),
        Solid::Cuboid(_) => is_off(),
        Solid::Polyhedron(polyhedron) => polyhedron.axis().map_or_else(is_off, is_between),
    }
}

fn overlap(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].max(b[0]), a[1].min(b[1])]
}

#[cfg(test)]
mod tests {
    use bevy::math::Quat;
    use tabletop_core::Part;
    use tabletop_geometry::Rgb;

    use super::*;

    fn cube() -> Shape {
        Shape::Block {
            span: Vec3::splat(2.0),
            color: Rgb::RED,
        }
    }

    fn at(x: f32, y: f32, z: f32) -> Pose {
        Pose::at(Vec3::new(x, y, z))
    }

    #[test]
    fn a_block_on_two_stands_on_both_and_not_on_its_neighbour() {
        let cube = cube();
        let arrangement = Arrangement::new([
            ("a", &cube, at(-1.0, 0.0, 1.0)),
            ("b", &cube, at(1.2, 0.0, 1.0)),
            ("top", &cube, at(0.0, 0.0, 3.0)),
            ("beside", &cube, at(2.001, 0.0, 3.0)),
            ("far", &cube, at(-6.0, 0.0, 1.0)),
            ("past", &cube, at(-3.9, 0.0, 3.0)),
        ]);
        assert_eq!(arrangement.supports("top"), ["a", "b"]);
        assert_eq!(arrangement.supports("beside"), ["b"]);
        assert!(arrangement.supports("past").is_empty());
        assert!(arrangement.supports("a").is_empty());
        assert_eq!(arrangement.standing_on("b"), ["beside", "top"]);
        assert!(arrangement.standing_on("top").is_empty());
        assert!(arrangement.is_on_table("a") && !arrangement.is_on_table("top"));
    }

    #[test]
    fn a_block_is_inside_a_box_and_not_inside_a_corner() {
        let (cube, container) = (
            cube(),
            Shape::Box {
                span: Vec3::new(4.0, 4.0, 1.5),
                thickness: 0.2,
                color: Rgb::BROWN,
            },
        );
        let arrangement = Arrangement::new([
            ("in", &cube, at(0.3, 0.0, 1.2)),
            ("out", &cube, at(3.5, 0.0, 1.0)),
            ("box", &container, at(0.0, 0.0, 0.75)),
        ]);
        assert_eq!(arrangement.containers("in"), ["box"]);
        assert_eq!(arrangement.supports("in"), ["box"]);
        assert!(arrangement.containers("out").is_empty());
        assert!(arrangement.containers("box").is_empty());
    }

    #[test]
    fn a_box_carries_what_is_in_it_and_is_not_around_it() {
        let (cube, container) = (
            cube(),
            Shape::Box {
                span: Vec3::new(4.0, 4.0, 1.5),
                thickness: 0.2,
                color: Rgb::BROWN,
            },
        );
        let arrangement = Arrangement::new([
            ("box", &container, at(0.0, 0.0, 0.75)),
            ("a top", &cube, at(0.3, 0.0, 3.2)),
            ("in", &cube, at(0.3, 0.0, 1.2)),
            ("beside", &cube, at(4.0, 0.0, 1.0)),
        ]);
        assert!(arrangement.posts("box").is_empty());
        assert_eq!(arrangement.load("box"), ["in", "a top"]);
        assert_eq!(arrangement.load("in"), ["a top"]);

        let over = Pose::from_degrees(Vec3::Z * 2.05, Vec3::X * 180.0);
        let arrangement = Arrangement::new([
            ("box", &container, over),
            ("under", &cube, at(0.3, 0.0, 1.0)),
        ]);
        assert!(arrangement.containers("under").is_empty());
        assert!(arrangement.load("box").is_empty());
    }

    #[test]
    fn a_ring_is_around_its_peg() {
        let plate = |x: f32, y: f32, at: Vec3| Part {
            pointable: false,
            id: String::new(),
            pose: Pose::at(at),
            shape: Shape::Block {
                span: Vec3::new(x, y, 0.5),
                color: Rgb::RED,
            },
        };
        let ring = Shape::Composite {
            parts: vec![
                plate(0.5, 2.0, Vec3::X),
                plate(0.5, 2.0, Vec3::NEG_X),
                plate(2.0, 0.5, Vec3::Y),
                plate(2.0, 0.5, Vec3::NEG_Y),
            ],
        };
        let peg = Shape::Block {
            span: Vec3::new(0.4, 0.4, 3.0),
            color: Rgb::GRAY,
        };
        let arrangement = Arrangement::new([
            ("ring", &ring, at(0.1, 0.0, 0.25)),
            ("free", &ring, at(5.0, 0.0, 0.25)),
            ("peg", &peg, at(0.0, 0.0, 1.5)),
        ]);
        assert_eq!(arrangement.posts("ring"), ["peg"]);
        assert!(arrangement.posts("free").is_empty());
        assert!(arrangement.posts("peg").is_empty());
        assert!(arrangement.containers("ring").is_empty());
    }

    #[test]
    fn a_ring_is_around_a_pole_whose_axis_is_in_the_planes_of_its_wedges() {
        let color = Rgb::RED;
        let pole = Shape::Cylinder {
            radius: 0.25,
            yspan: 1.4,
            color,
        };
        let upright = Pose::from_degrees(Vec3::new(0.0, -3.0, 0.9), Vec3::X * 90.0);
        // As a hand left it.
        let tilt = Quat::from_xyzw(
            9.281_648_5e-8,
            2.409_496_2e-8,
            -0.001_291_987_6,
            0.999_999_2,
        );
        let place = Pose::new(Vec3::new(-1.070_249_5e-8, -3.0, 0.399_999_9), tilt);
        for sides in [16, 32] {
            let ring = Shape::Ring {
                radius_outer: 1.07,
                radius_inner: 0.35,
                zspan: 0.4,
                sides,
                color,
            };
            let arrangement = Arrangement::new([("ring", &ring, place), ("pole", &pole, upright)]);
            assert_eq!(arrangement.posts("ring"), ["pole"], "{sides}");
        }
    }

    #[test]
    fn a_round_ring_is_around_a_round_pole_however_it_is_turned() {
        let color = Rgb::RED;
        let ring = Shape::Ring {
            radius_outer: 0.6,
            radius_inner: 0.35,
            zspan: 0.4,
            sides: 32,
            color,
        };
        let pole = Shape::Cylinder {
            radius: 0.25,
            yspan: 1.4,
            color,
        };
        let upright = Pose::from_degrees(Vec3::Z * 0.7, Vec3::X * 90.0);
        for degrees in 0..90_u8 {
            let turn = Vec3::Z * f32::from(degrees) / 4.0;
            let arrangement = Arrangement::new([
                ("ring", &ring, Pose::from_degrees(Vec3::Z * 0.2, turn)),
                ("pole", &pole, upright),
            ]);
            assert_eq!(arrangement.posts("ring"), ["pole"], "{degrees}");
            assert!(arrangement.containers("ring").is_empty());
        }
    }
}
