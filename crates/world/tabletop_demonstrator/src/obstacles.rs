//! Obstacles of a held object, and its way along them.

use bevy::prelude::*;
use tabletop_geometry::Pose;
use tabletop_physics::{
    Convex, depth,
    limits::{INSIDE, LEAVING, MOST_SLIDING_STEPS, SAME_DEPTH, SAME_LENGTH, SLIDING_STEP},
    nearest, pushed_out,
};

/// The pose of an object a tick later on its way out of the obstacles that it is inside of, as after something was put, or appeared, there.
/// If they leave no way out, it goes towards its target, but no deeper into them. `None` if it is inside nothing.
pub(crate) fn leave(held: &[Convex], from: Pose, to: Pose, obstacles: &[Convex]) -> Option<Pose> {
    let is_entered = |obstacle: &Convex| depth(held, from, std::slice::from_ref(obstacle)) > INSIDE;
    if !obstacles.iter().any(is_entered) {
        return None;
    }
    let Some(out) = outside(held, from, obstacles, &mut Vec::new()) else {
        let (entered, others): (Vec<_>, Vec<_>) = obstacles.iter().cloned().partition(is_entered);
        return Some(pinned(held, from, to, &entered, &others));
    };
    let way = (out.location - from.location).clamp_length_max(LEAVING);
    Some(Pose::new(from.location + way, from.rotation))
}

/// The pose of a pinned object a tick later: towards its target as far as the obstacles that it has not entered allow, but no deeper
/// into the entered ones; so that nothing presses it through the table by and by.
fn pinned(held: &[Convex], from: Pose, to: Pose, entered: &[Convex], others: &[Convex]) -> Pose {
    let away: Vec<_> = nearest(held, from, entered, 0.0)
        .map(|nearest| nearest.away)
        .collect();
    let location = from.location + clipped(to.location - from.location, &away);
    let is_deeper = |at: &Pose| {
        entered.iter().any(|obstacle| {
            let obstacle = std::slice::from_ref(obstacle);
            depth(held, *at, obstacle) > depth(held, from, obstacle) + SAME_DEPTH
        })
    };
    [to.rotation, from.rotation]
        .into_iter()
        .map(|rotation| slide(held, from, Pose::new(location, rotation), others))
        .find(|at| !is_deeper(at))
        .unwrap_or(from)
}

/// The pose without depth: pushed out of all entered obstacles. `None` if there is no way out. Every direction of a push is added to `pushed`.
fn outside(
    held: &[Convex],
    at: Pose,
    obstacles: &[Convex],
    pushed: &mut Vec<Vec3>,
) -> Option<Pose> {
    pushed_out(held, at, obstacles, [SAME_LENGTH, 0.0], pushed)
}

/// The pose that an object reaches on its way from `from` to `to`, sliding along its obstacles. It turns first, if there
/// is room. The result touches obstacles at most; if `from` is inside one, it is a way out or `from` itself.
pub(crate) fn slide(held: &[Convex], from: Pose, to: Pose, obstacles: &[Convex]) -> Pose {
    let mut at = from;
    if from.rotation != to.rotation {
        let turned = Pose::new(from.location, to.rotation);
        let room = outside(held, turned, obstacles, &mut Vec::new());
        at = room
            .filter(|room| room.location.distance(from.location) < turning_reach(held, from, to))
            .unwrap_or(from);
    }
    let farthest = at.location.distance(to.location) + SLIDING_STEP;
    let start = at.location;
    let mut sliding_along: Vec<Vec3> = Vec::new();
    for _ in 0..MOST_SLIDING_STEPS {
        let way = clipped(to.location - at.location, &sliding_along);
        let length = way.length();
        if length < 1e-6 {
            if way == to.location - at.location {
                at.location = to.location;
            }
            break;
        }
        let step = free_way(held, at, way / length, length, obstacles);
        let ahead = Pose::new(at.location + way / length * step, at.rotation);
        let mut pushed = Vec::new();
        let Some(next) = outside(held, ahead, obstacles, &mut pushed) else {
            break;
        };
        if next.location.distance(start) > farthest {
            // Obstacles that almost meet push it away from both.
            break;
        }
        let is_stuck = next.location.distance(at.location) < 1e-5;
        if is_stuck && pushed.iter().all(|away| sliding_along.contains(away)) {
            break;
        }
        sliding_along.extend(pushed);
        at = next;
    }
    at
}

/// A little more than the greatest distance, in units, that a point of an object goes when it turns.
fn turning_reach(held: &[Convex], from: Pose, to: Pose) -> f32 {
    let radius = |part: &Convex| {
        let ball = part.shape.compute_local_bounding_sphere();
        part.pose.location.length() + ball.center().length() + ball.radius()
    };
    let radius = held.iter().map(radius).fold(0.0, f32::max);
    radius * from.rotation.angle_between(to.rotation) + SLIDING_STEP
}

/// The distance that the object may go in a direction. Convex solids stay apart while they approach by less than their gap;
/// but it is at least a step, after which the object is pushed out again.
fn free_way(held: &[Convex], at: Pose, direction: Vec3, length: f32, obstacles: &[Convex]) -> f32 {
    nearest(held, at, obstacles, length)
        .map(|nearest| {
            let approach = -direction.dot(nearest.away);
            match approach > 1e-4 {
                true => (nearest.distance / approach).max(SLIDING_STEP),
                false => length,
            }
        })
        .fold(length, f32::min)
}

/// The rest of a way after the components against these normals are removed.
fn clipped(way: Vec3, normals: &[Vec3]) -> Vec3 {
    let mut clipped = way;
    for &normal in normals {
        clipped -= normal * clipped.dot(normal).min(0.0);
    }
    // In a corner, clipping against one plane may turn the way into another.
    if normals.iter().any(|normal| clipped.dot(*normal) < -1e-5) {
        return Vec3::ZERO;
    }
    clipped
}

#[cfg(test)]
mod tests {
    use bevy_rapier3d::rapier::prelude as rapier;

    use super::*;

    fn cuboid(span: Vec3, location: Vec3) -> Convex {
        Convex {
            pose: Pose::at(location),
            shape: rapier::SharedShape::cuboid(span.x / 2.0, span.y / 2.0, span.z / 2.0),
        }
    }

    fn table() -> Convex {
        cuboid(Vec3::new(20.0, 12.0, 4.0), Vec3::NEG_Z * 2.0)
    }

    fn unit_block() -> [Convex; 1] {
        [cuboid(Vec3::ONE, Vec3::ZERO)]
    }

    fn moved(from: Vec3, to: Vec3, obstacles: &[Convex]) -> Vec3 {
        slide(&unit_block(), Pose::at(from), Pose::at(to), obstacles).location
    }

    #[test]
    fn nothing_in_the_way_means_exactly_there() {
        let to = Vec3::new(3.0, -2.0, 5.0);
        assert_eq!(moved(Vec3::Z * 3.0, to, &[table()]), to);
        assert_eq!(moved(Vec3::Z * 3.0, to, &[]), to);
    }

    #[test]
    fn a_block_slides_along_the_table_to_the_point_above_the_target() {
        let at = moved(
            Vec3::new(-4.0, 0.0, 2.0),
            Vec3::new(4.0, 1.0, -3.0),
            &[table()],
        );
        assert!((at - Vec3::new(4.0, 1.0, 0.5)).length() < 0.01, "{at}");
    }

    #[test]
    fn a_block_stops_at_a_thin_wall_and_never_enters_it() {
        let wall = cuboid(Vec3::new(0.05, 20.0, 20.0), Vec3::ZERO);
        let at = moved(
            Vec3::new(-5.0, 0.0, 3.0),
            Vec3::new(50.0, 0.0, 3.0),
            &[table(), wall],
        );
        assert!((at.x + 0.525).abs() < 0.01, "{at}");
    }

    #[test]
    fn a_block_goes_into_a_corner_and_stays_there() {
        let wall = cuboid(Vec3::new(1.0, 20.0, 20.0), Vec3::X * 3.0);
        let at = moved(
            Vec3::new(0.0, 0.0, 3.0),
            Vec3::new(9.0, 0.0, -9.0),
            &[table(), wall],
        );
        assert!((at - Vec3::new(2.0, 0.0, 0.5)).length() < 0.01, "{at}");
    }

    #[test]
    fn a_block_on_the_table_rises_when_it_is_turned() {
        let from = Pose::at(Vec3::Z * 0.5);
        let to = Pose::from_degrees(from.location, Vec3::X * 45.0);
        let at = slide(&unit_block(), from, to, &[table()]);
        assert!(at.rotation.angle_between(to.rotation) < 1e-3);
        assert!((at.location.z - 0.5f32.sqrt()).abs() < 0.01, "{at:?}");
    }

    #[test]
    fn a_block_inside_an_obstacle_leaves_it_by_and_by() {
        let step = |from: Vec3, obstacles: &[Convex]| {
            let target = Pose::at(Vec3::X * 9.0);
            leave(&unit_block(), Pose::at(from), target, obstacles).map(|pose| pose.location)
        };
        assert_eq!(step(Vec3::Z * 0.5, &[table()]), None);
        let mut at = Vec3::Z * -0.2;
        let mut ticks = 0;
        while let Some(next) = step(at, &[table()]) {
            assert!(next.distance(at) < LEAVING + 1e-6, "{next}");
            (at, ticks) = (next, ticks + 1);
        }
        assert_eq!(ticks, 7);
        let above = cuboid(Vec3::new(20.0, 12.0, 4.0), Vec3::Z * 2.5);
        let pinned = step(Vec3::Z * 0.2, &[table(), above]).unwrap();
        assert!(pinned.distance(Vec3::new(9.0, 0.0, 0.2)) < 1e-3, "{pinned}");
    }

    #[test]
    fn a_block_that_is_pinned_is_not_turned_deeper() {
        let above = cuboid(Vec3::new(20.0, 12.0, 4.0), Vec3::Z * 2.9);
        let from = Pose::at(Vec3::Z * 0.45);
        let target = |degrees: Vec3| {
            let target = Pose::from_degrees(from.location, degrees);
            let obstacles = [table(), above.clone()];
            let pose = leave(&unit_block(), from, target, &obstacles).unwrap();
            assert!(pose.location.distance(from.location) < 1e-3, "{pose:?}");
            (pose.rotation, target.rotation)
        };
        let (rotation, _) = target(Vec3::X * 20.0);
        assert_eq!(rotation, from.rotation);
        let (rotation, wanted) = target(Vec3::Z * 20.0);
        assert_eq!(rotation, wanted);
    }

    #[test]
    fn a_pinned_block_is_not_pressed_deeper_by_its_obstacles() {
        let above = cuboid(Vec3::new(20.0, 12.0, 4.0), Vec3::Z * 2.955);
        let from = Pose::at(Vec3::Z * 0.46);
        let to = Pose::at(Vec3::new(9.0, 0.0, 3.0));
        let pose = leave(&unit_block(), from, to, &[table(), above]).unwrap();
        assert!(pose.location.z > 0.46 - 1e-4, "{pose:?}");
    }

    #[test]
    fn a_block_between_two_walls_is_not_turned() {
        let walls = [-1.05, 1.05].map(|x| cuboid(Vec3::new(1.0, 20.0, 20.0), Vec3::X * x));
        let from = Pose::at(Vec3::Z * 3.0);
        let to = Pose::from_degrees(from.location, Vec3::Z * 45.0);
        let at = slide(&unit_block(), from, to, &walls);
        assert_eq!(at.rotation, from.rotation);
    }
}
