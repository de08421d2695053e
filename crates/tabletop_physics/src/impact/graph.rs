//! Impacts between bodies, as a problem of mechanics: velocities before in, velocities after out.

use bevy::math::{DMat3, DVec3};

/// Speed, in units/s, below which two bodies do not approach.
const STILL: f64 = 1e-4;

/// Most rounds of collisions in an impact. A row of equal balls needs as many as it has contacts; balls of decreasing elasticity approach rest.
const MOST_ROUNDS: usize = 256;

/// Most sweeps over the contacts that collide at once.
const MOST_SWEEPS: usize = 200;

/// A body in an impact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Striker {
    /// 1/kg.
    pub inverse_mass: f64,
    /// 1/(kg units²), in the axes of the world.
    pub inverse_inertia: DMat3,
    pub velocity: Velocity,
}

/// A velocity of a body's centre of mass, in units/s, and its angular velocity, in rad/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Velocity {
    pub linear: DVec3,
    pub angular: DVec3,
}

/// A point in which bodies touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Collision {
    /// The bodies, by number. `None` moves by no force.
    pub bodies: [Option<usize>; 2],
    /// The point, from each body's centre of mass.
    pub arms: [DVec3; 2],
    /// Direction from the first body to the second one.
    pub normal: DVec3,
    /// Speed at which they approach besides, because a body that no force moves does.
    pub drive: f64,
    /// Share of the speed of approach with which they part.
    pub restitution: f64,
    /// Speed of approach from which they meet within the tick.
    pub meets_from: f64,
    /// Square of the speed that gravity takes from bodies that part before they have met: Rapier stops them up to a sub-step earlier.
    pub ahead: f64,
    /// Speed of parting below which they are back within the tick, so that they do not part.
    pub rests_below: f64,
}

impl Collision {
    /// Speed at which the bodies approach each other here.
    pub fn approach(&self, velocities: &[Velocity]) -> f64 {
        let [first, second] = [0, 1].map(|side| self.speed(side, velocities));
        first - second + self.drive
    }

    /// True if the bodies meet, and part again.
    pub fn bounces(&self, velocities: &[Velocity]) -> bool {
        let approach = self.approach(velocities);
        approach > self.meets_from.max(STILL) && self.parting(approach) > 0.0
    }

    /// The speed of parting after an approach with this speed.
    fn parting(&self, approach: f64) -> f64 {
        let speed = self.restitution * approach;
        match speed > self.rests_below {
            true => speed,
            false => 0.0,
        }
    }

    fn speed(&self, side: usize, velocities: &[Velocity]) -> f64 {
        let velocity = self.bodies[side].map(|body| velocities[body]);
        velocity.map_or(0.0, |Velocity { linear, angular }| {
            (linear + angular.cross(self.arms[side])).dot(self.normal)
        })
    }

    /// Mass, in kg, that an impulse here has to move.
    fn mass(&self, bodies: &[Striker]) -> f64 {
        let inverse = |side: usize| {
            self.bodies[side].map_or(0.0, |body| {
                let arm = self.arms[side].cross(self.normal);
                bodies[body].inverse_mass + arm.dot(bodies[body].inverse_inertia * arm)
            })
        };
        1.0 / (inverse(0) + inverse(1))
    }

    fn push(&self, impulse: f64, bodies: &[Striker], velocities: &mut [Velocity]) {
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            if let Some(body) = self.bodies[side] {
                let impulse = sign * impulse * self.normal;
                velocities[body].linear += bodies[body].inverse_mass * impulse;
                velocities[body].angular +=
                    bodies[body].inverse_inertia * self.arms[side].cross(impulse);
            }
        }
    }
}

/// The velocities after an impact, and whether there was an impulse in each contact.
///
/// Whatever approaches collides at once and parts with its restitution; what approaches because of that collides next, and so on
/// ("Reflections on Simultaneous Impact", Smith et al., 2012). So the corners of a face collide together, a row of balls hands on its speed, and
/// energy and momentum are those of the textbook.
pub(super) fn collide(bodies: &[Striker], contacts: &[Collision]) -> (Vec<Velocity>, Vec<bool>) {
    let mut velocities: Vec<_> = bodies.iter().map(|body| body.velocity).collect();
    let mut collided = vec![false; contacts.len()];
    for round in 0..MOST_ROUNDS {
        let is_last = round + 1 == MOST_ROUNDS;
        let targets: Vec<_> = contacts
            .iter()
            .enumerate()
            .filter_map(|(number, contact)| {
                let approach = contact.approach(&velocities);
                let parting = if is_last {
                    0.0
                } else {
                    contact.parting(approach)
                };
                (approach > contact.meets_from.max(STILL)).then_some((number, parting))
            })
            .collect();
        if targets.is_empty() {
            break;
        }
        let impulses = separate(bodies, contacts, &targets, &mut velocities);
        for ((number, _), impulse) in targets.iter().zip(impulses) {
            collided[*number] |= impulse > 0.0;
        }
    }
    (velocities, collided)
}

/// Lets bodies part in some contacts, each given by its number, at least with these speeds. Returns the impulses.
fn separate(
    bodies: &[Striker],
    contacts: &[Collision],
    targets: &[(usize, f64)],
    velocities: &mut [Velocity],
) -> Vec<f64> {
    let mut impulses = vec![0.0; targets.len()];
    sweep(
        bodies,
        contacts,
        targets,
        velocities,
        &mut |which, change| {
            let before: f64 = impulses[which];
            impulses[which] = (before + change).max(0.0);
            impulses[which] - before
        },
    );
    impulses
}

/// Lets bodies part in some contacts exactly with these speeds.
pub(super) fn part(
    bodies: &[Striker],
    contacts: &[Collision],
    targets: &[(usize, f64)],
    velocities: &mut [Velocity],
) {
    sweep(bodies, contacts, targets, velocities, &mut |_, change| {
        change
    });
}

fn sweep(
    bodies: &[Striker],
    contacts: &[Collision],
    targets: &[(usize, f64)],
    velocities: &mut [Velocity],
    allowed: &mut dyn FnMut(usize, f64) -> f64,
) {
    let masses: Vec<_> = targets
        .iter()
        .map(|(number, _)| contacts[*number].mass(bodies))
        .collect();
    for _ in 0..MOST_SWEEPS {
        let mut largest = 0.0_f64;
        for (which, (number, parting)) in targets.iter().enumerate() {
            let contact = &contacts[*number];
            let lack = parting + contact.approach(velocities);
            let impulse = allowed(which, lack * masses[which]);
            largest = largest.max((impulse / masses[which]).abs());
            contact.push(impulse, bodies, velocities);
        }
        if largest < STILL * STILL {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(speed: f64) -> Striker {
        Striker {
            inverse_mass: 1.0,
            inverse_inertia: DMat3::IDENTITY * 10.0,
            velocity: Velocity {
                linear: DVec3::X * speed,
                angular: DVec3::ZERO,
            },
        }
    }

    fn contact(bodies: [Option<usize>; 2], arms: [DVec3; 2], restitution: f64) -> Collision {
        Collision {
            bodies,
            arms,
            normal: DVec3::X,
            drive: 0.0,
            restitution,
            meets_from: 0.0,
            ahead: 0.0,
            rests_below: 0.0,
        }
    }

    fn row(speeds: &[f64], restitution: f64) -> Vec<f64> {
        let bodies: Vec<_> = speeds.iter().map(|speed| ball(*speed)).collect();
        let arms = [DVec3::X * 0.5, DVec3::X * -0.5];
        let contacts: Vec<_> = (1..bodies.len())
            .map(|next| contact([Some(next - 1), Some(next)], arms, restitution))
            .collect();
        let (after, _) = collide(&bodies, &contacts);
        after.iter().map(|velocity| velocity.linear.x).collect()
    }

    #[test]
    fn a_row_of_elastic_balls_hands_on_its_speed() {
        let after = row(&[10.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1.0);
        for (speed, expected) in after.iter().zip([0.0, 0.0, 0.0, 0.0, 0.0, 10.0]) {
            assert!((speed - expected).abs() < 1e-6, "{after:?}");
        }
        let after = row(&[10.0, 10.0, 0.0, 0.0, 0.0], 1.0);
        for (speed, expected) in after.iter().zip([0.0, 0.0, 0.0, 10.0, 10.0]) {
            assert!((speed - expected).abs() < 1e-6, "{after:?}");
        }
    }

    #[test]
    fn inelastic_balls_go_on_together() {
        let after = row(&[12.0, 0.0, 0.0], 0.0);
        assert!(
            after.iter().all(|speed| (speed - 4.0).abs() < 1e-3),
            "{after:?}"
        );
    }

    #[test]
    fn half_elastic_balls_part_with_half_their_speed() {
        let after = row(&[10.0, 0.0], 0.5);
        assert!((after[0] - 2.5).abs() < 1e-6 && (after[1] - 7.5).abs() < 1e-6);
    }

    #[test]
    fn the_corners_of_a_face_collide_together() {
        let cube = Striker {
            inverse_inertia: DMat3::IDENTITY * 6.0,
            ..ball(10.0)
        };
        let corners = [
            (-0.5, -0.5),
            (0.5, -0.5),
            (0.5, 0.5),
            (-0.5, 0.5),
            (0.2, 0.1),
        ];
        let contacts = corners.map(|(y, z)| {
            let arm = DVec3::new(0.5, y, z);
            contact([Some(0), None], [arm, DVec3::ZERO], 0.8)
        });
        let (after, _) = collide(&[cube], &contacts);
        assert!(
            (after[0].linear - DVec3::X * -8.0).length() < 1e-3,
            "{after:?}"
        );
        assert!(after[0].angular.length() < 1e-3, "{after:?}");
    }
}
