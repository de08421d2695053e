//! The neighborhood of a dragged object: where it snaps to, and how it gets there.

use bevy::prelude::*;
use tabletop_geometry::Bounds;

use crate::Dragging;

/// Distance, in units, from which a dragged object snaps.
const SNAP: f32 = 0.3;

/// Gap, in units, that is left to what a dragged object is put beside or onto: more than the distance from which hands push.
const GAP: f32 = 0.02;

/// Overlap, in units, up to which solids only touch: more than that to which resting things sink in.
const TOUCH: f32 = 0.05;

/// A dragged object, and the solids around it.
#[derive(Clone, Debug)]
pub struct Neighborhood {
    /// Where the object is, in units.
    pub here: Vec3,
    /// The bounds of the object where it is.
    pub bounds: Bounds,
    /// The bounds of each solid of other objects.
    pub others: Vec<Bounds>,
}

impl Neighborhood {
    /// The height of the object, in units, over the highest thing below it.
    pub fn clearance(&self) -> f32 {
        (self.bounds.low.z - self.support(self.bounds)).max(0.0)
    }

    /// The place where an object that is dragged to a goal in an upright plane comes to, in units.
    pub fn snapped(&self, dragging: &Dragging, goal: Vec3) -> Vec3 {
        let mut place = goal;
        let grid = (goal / Dragging::GRID).round() * Dragging::GRID;
        for axis in 0..3 {
            let near = self.snaps(dragging, goal, axis);
            let nearest = near.min_by(|a, b| a.abs().total_cmp(&b.abs()));
            match nearest.filter(|by| by.abs() <= SNAP) {
                Some(by) => place[axis] += by,
                None if dragging.snaps_to_grid && axis < 2 => place[axis] = grid[axis],
                None => {}
            }
        }
        place
    }

    /// The place where an object that is dragged to a goal in a level plane comes to, in units: so high over the highest thing below it.
    pub fn on_top(&self, dragging: &Dragging, goal: Vec3, clearance: f32) -> Vec3 {
        let place = self.snapped(dragging, goal);
        let below = self.support(self.bounds_at(place));
        place.with_z(below + self.above_bottom() + clearance.max(GAP))
    }

    /// The next place on the way to another one: over what is in between, which is first risen above.
    pub fn way_to(&self, place: Vec3) -> Vec3 {
        let highest = self.highest_between(place) + self.above_bottom() + GAP;
        let aside = place.with_z(self.here.z).distance(self.here);
        if aside > TOUCH && self.here.z < highest - TOUCH {
            self.here.with_z(highest.max(place.z))
        } else if aside > TOUCH {
            place.with_z(highest.max(place.z))
        } else {
            place
        }
    }

    /// Height of the object's origin over its lowest point.
    fn above_bottom(&self) -> f32 {
        self.here.z - self.bounds.low.z
    }

    fn bounds_at(&self, place: Vec3) -> Bounds {
        let by = place - self.here;
        Bounds {
            low: self.bounds.low + by,
            high: self.bounds.high + by,
        }
    }

    /// The height of the highest thing under these bounds, the table's top if there is nothing.
    fn support(&self, bounds: Bounds) -> f32 {
        let below = self.others.iter().filter(|other| is_over(bounds, other));
        below.map(|other| other.high.z).fold(0.0, f32::max)
    }

    /// The height of the highest thing on the straight way to a place.
    fn highest_between(&self, place: Vec3) -> f32 {
        let way = place - self.here;
        let met = self
            .others
            .iter()
            .filter(|other| meets(self.bounds, way, other));
        met.map(|other| other.high.z).fold(0.0, f32::max)
    }

    /// The ways, along an axis, from a goal to where the object would be flush with another or centred on it.
    fn snaps<'a>(
        &'a self,
        dragging: &'a Dragging,
        goal: Vec3,
        axis: usize,
    ) -> impl Iterator<Item = f32> + 'a {
        let held = self.bounds_at(goal);
        let table = Bounds {
            low: Vec3::splat(f32::NEG_INFINITY),
            high: Vec3::new(f32::INFINITY, f32::INFINITY, 0.0),
        };
        let flush = move |other: Bounds| {
            let is_beside = (0..3).all(|across| {
                let depth = overlap(held, &other, across);
                across == axis || depth > TOUCH
            });
            let after = other.high[axis] - held.low[axis] + GAP;
            let before = other.low[axis] - held.high[axis] - GAP;
            [after, before]
                .into_iter()
                .filter(move |by| is_beside && by.is_finite())
        };
        let centered = move |other: &Bounds| {
            let is_near = (0..2).all(|across| overlap(held, other, across) > -SNAP);
            let by = (other.low + other.high - held.low - held.high) / 2.0;
            (is_near && axis < 2).then_some(by[axis])
        };
        let faces = self.others.iter().copied().chain([table]);
        let faces = faces
            .filter(move |_| dragging.snaps_to_faces)
            .flat_map(flush);
        let centers = self.others.iter();
        let centers = centers.filter(move |_| dragging.snaps_to_centers);
        faces.chain(centers.filter_map(centered))
    }
}

/// Depth to which two overlap along an axis.
fn overlap(a: Bounds, b: &Bounds, axis: usize) -> f32 {
    (a.high[axis] - b.low[axis]).min(b.high[axis] - a.low[axis])
}

fn is_over(bounds: Bounds, other: &Bounds) -> bool {
    (0..2).all(|axis| overlap(bounds, other, axis) > TOUCH)
}

/// True if bounds that move straight, seen from above, come over another.
fn meets(bounds: Bounds, way: Vec3, other: &Bounds) -> bool {
    let (mut from, mut to) = (0.0_f32, 1.0_f32);
    for axis in 0..2 {
        let low = other.low[axis] - bounds.high[axis] + TOUCH;
        let high = other.high[axis] - bounds.low[axis] - TOUCH;
        if way[axis].abs() < f32::EPSILON {
            if low >= 0.0 || high <= 0.0 {
                return false;
            }
        } else {
            let (a, b) = (low / way[axis], high / way[axis]);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
    }
    from < to
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of edge 1 on the table at x = -5, and others of edge 2 with their middles at the bottom here.
    fn neighborhood(others: &[Vec3]) -> Neighborhood {
        let here = Vec3::new(-5.0, 0.0, 0.5);
        Neighborhood {
            here,
            bounds: Bounds::around(here, Vec3::splat(0.5)),
            others: others
                .iter()
                .map(|&foot| Bounds::around(foot + Vec3::Z, Vec3::ONE))
                .collect(),
        }
    }

    const PLAIN: Dragging = Dragging {
        is_level: true,
        goes_on_top: true,
        snaps_to_faces: false,
        snaps_to_centers: false,
        snaps_to_grid: false,
        turns_in_steps: false,
    };

    fn assert_near(actual: Vec3, expected: Vec3) {
        assert!(actual.distance(expected) < 2.0 * GAP, "{actual} {expected}");
    }

    #[test]
    fn what_is_dragged_over_an_object_comes_on_top_of_it() {
        let around = neighborhood(&[Vec3::ZERO, Vec3::Z * 2.0]);
        let goal = |x: f32| Vec3::new(x, 0.0, 0.5);
        for (x, z) in [(0.0, 4.5), (1.3, 4.5), (1.6, 0.5), (-3.0, 0.5)] {
            assert_near(around.on_top(&PLAIN, goal(x), 0.0), Vec3::new(x, 0.0, z));
        }
        assert_near(around.on_top(&PLAIN, goal(0.0), 1.0), Vec3::Z * 5.5);
    }

    #[test]
    fn it_rises_before_what_is_in_its_way_and_sinks_behind_it() {
        let mut around = neighborhood(&[Vec3::ZERO]);
        let beyond = Vec3::new(5.0, 0.0, 0.5);
        assert_near(around.way_to(beyond), Vec3::new(-5.0, 0.0, 2.5));
        let mut go = |to: Vec3| {
            around = Neighborhood {
                here: to,
                bounds: around.bounds_at(to),
                ..around.clone()
            };
            around.way_to(beyond)
        };
        let over = go(Vec3::new(-5.0, 0.0, 2.52));
        assert_near(over, Vec3::new(5.0, 0.0, 2.5));
        assert_eq!(go(over), beyond);
        assert_eq!(go(beyond), beyond);
    }

    #[test]
    fn it_goes_straight_past_what_is_not_in_its_way() {
        let around = neighborhood(&[Vec3::Y * 4.0]);
        let beyond = Vec3::new(5.0, 0.0, 0.6);
        assert_eq!(around.way_to(beyond), beyond);
    }

    #[test]
    fn a_stack_is_left_at_its_height() {
        let mut around = neighborhood(&[Vec3::ZERO]);
        around.here = Vec3::Z * 2.49;
        around.bounds = Bounds::around(around.here, Vec3::splat(0.5));
        assert_eq!(around.clearance(), 0.0);
        let aside = around.on_top(&PLAIN, Vec3::X * 4.0, around.clearance());
        assert_near(aside, Vec3::new(4.0, 0.0, 0.5));
        assert_near(around.way_to(aside), Vec3::new(4.0, 0.0, 2.5));
    }

    #[test]
    fn it_snaps_to_faces_middles_and_the_grid() {
        let around = neighborhood(&[Vec3::ZERO]);
        let faces = Dragging {
            snaps_to_faces: true,
            ..PLAIN
        };
        let centers = Dragging {
            snaps_to_centers: true,
            ..PLAIN
        };
        let grid = Dragging {
            snaps_to_grid: true,
            ..PLAIN
        };
        for (dragging, goal, place) in [
            (faces, [1.7, 0.3, 0.6], [1.5, 0.3, 0.5]),
            (faces, [1.3, 0.3, 0.6], [1.5, 0.3, 0.5]),
            (faces, [1.9, 0.3, 2.0], [1.9, 0.3, 2.0]),
            (faces, [0.1, 0.2, 2.6], [0.1, 0.2, 2.5]),
            (centers, [0.2, -0.1, 3.0], [0.0, 0.0, 3.0]),
            (centers, [1.5, 0.2, 0.5], [1.5, 0.0, 0.5]),
            (centers, [4.0, 0.2, 0.5], [4.0, 0.2, 0.5]),
            (grid, [3.2, -1.3, 0.6], [3.0, -1.5, 0.6]),
        ] {
            assert_near(around.snapped(&dragging, goal.into()), place.into());
        }
        let free = Vec3::new(1.6, 0.1, 0.6);
        assert_eq!(around.snapped(&PLAIN, free), free);
    }
}
