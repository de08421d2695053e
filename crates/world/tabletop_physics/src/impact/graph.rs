//! Impacts between bodies, as a problem of mechanics: velocities before in, velocities after out.

use bevy::math::DVec3;

use super::{
    energy::{energy, limit_energy},
    striker::{Striker, Velocity},
};

/// Speed, in units/s, below which two bodies do not approach.
const STILL: f64 = 1e-4;

/// Most rounds of collisions in an impact. A row of equal balls needs as many as it has contacts; balls of decreasing elasticity approach rest.
const MOST_ROUNDS: usize = 256;

/// Most sweeps over the contacts that collide at once.
const MOST_SWEEPS: usize = 200;

/// A point in which bodies touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Collision {
    /// The bodies, by number. `None` moves by no force.
    pub bodies: [Option<usize>; 2],
    /// The point, from each body's centre of mass.
    pub arms: [DVec3; 2],
    /// Direction from the first body to the second one.
    pub normal: DVec3,
    /// Velocity with which they approach besides, because a body that no force moves does.
    pub drive: DVec3,
    /// Share of the speed of approach with which they part.
    pub restitution: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// True if Rapier has pushed the bodies elsewhere.
    pub is_skewed: bool,
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
        self.closing(velocities).dot(self.normal)
    }

    /// Velocity with which the first body slips along the second one.
    pub fn slip(&self, velocities: &[Velocity]) -> DVec3 {
        let closing = self.closing(velocities);
        closing - closing.dot(self.normal) * self.normal
    }

    /// True if the bodies meet.
    pub fn meets(&self, velocities: &[Velocity]) -> bool {
        self.approach(velocities) > self.meets_from.max(STILL)
    }

    /// True if the bodies meet, and part again.
    pub fn bounces(&self, velocities: &[Velocity]) -> bool {
        self.meets(velocities) && self.parting(self.approach(velocities)) > 0.0
    }

    /// The speed of parting after an approach with this speed.
    fn parting(&self, approach: f64) -> f64 {
        let speed = self.restitution * approach;
        match speed > self.rests_below {
            true => speed,
            false => 0.0,
        }
    }

    /// Velocity of the first body here, as the second one sees it.
    fn closing(&self, velocities: &[Velocity]) -> DVec3 {
        let [first, second] = [0, 1].map(|side| {
            let velocity = self.bodies[side].map(|body| velocities[body]);
            velocity.map_or(DVec3::ZERO, |Velocity { linear, angular }| {
                linear + angular.cross(self.arms[side])
            })
        });
        first - second + self.drive
    }

    /// The change of the bodies' closing velocity here, along a direction, by an impulse of 1 along it, in 1/kg.
    fn yielding(&self, direction: DVec3, bodies: &[Striker]) -> f64 {
        let inverse = |side: usize| {
            self.bodies[side].map_or(0.0, |body| {
                let arm = self.arms[side].cross(direction);
                bodies[body].inverse_mass + arm.dot(bodies[body].inverse_inertia * arm)
            })
        };
        inverse(0) + inverse(1)
    }

    /// Masses, in kg, that an impulse here has to move: along the normal, and at least along the plane of touch.
    fn masses(&self, bodies: &[Striker]) -> [f64; 2] {
        let (one, other) = self.normal.any_orthonormal_pair();
        let along = self.yielding(one, bodies) + self.yielding(other, bodies);
        [self.yielding(self.normal, bodies), along].map(f64::recip)
    }

    fn push(&self, impulse: DVec3, bodies: &[Striker], velocities: &mut [Velocity]) {
        for (side, impulse) in [(0, -impulse), (1, impulse)] {
            if let Some(body) = self.bodies[side] {
                velocities[body].linear += bodies[body].inverse_mass * impulse;
                velocities[body].angular +=
                    bodies[body].inverse_inertia * self.arms[side].cross(impulse);
            }
        }
    }
}

/// What becomes of bodies in one of their contacts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parting {
    /// The contact, by its number.
    pub contact: usize,
    /// Speed, in units/s, with which they part.
    pub speed: f64,
    /// Velocity with which the first body slips along the second one.
    pub slip: DVec3,
}

/// The impulse in a contact, in kg units/s.
#[derive(Clone, Copy, Debug, Default)]
struct Impulse {
    normal: f64,
    /// Along the plane of touch.
    friction: DVec3,
}

impl Impulse {
    /// What Coulomb's law leaves of an impulse: bodies do not pull, and friction is in proportion to their pressure.
    fn allowed(self, coefficient: f64) -> Self {
        let normal = self.normal.max(0.0);
        let friction = self.friction.clamp_length_max(coefficient * normal);
        Self { normal, friction }
    }
}

/// The velocities after an impact, and whether there was an impulse in each contact.
///
/// Whatever approaches collides at once and parts with its restitution; what approaches because of that collides next, and so on
/// ("Reflections on Simultaneous Impact", Smith et al., 2012). So the corners of a face collide together, a row of balls hands on its speed, and
/// energy and momentum are those of the textbook. Friction acts at the same time, in Coulomb's cone.
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
                let speed = if is_last {
                    0.0
                } else {
                    contact.parting(approach)
                };
                contact.meets(&velocities).then_some(Parting {
                    contact: number,
                    speed,
                    slip: DVec3::ZERO,
                })
            })
            .collect();
        if targets.is_empty() {
            break;
        }
        let impulses = separate(bodies, contacts, &targets, &mut velocities);
        for (target, impulse) in targets.iter().zip(impulses) {
            collided[target.contact] |= impulse.normal > 0.0;
        }
    }
    (velocities, collided)
}

/// Lets bodies part in some contacts, at least with these speeds, and with Coulomb's friction. Returns the impulses.
fn separate(
    bodies: &[Striker],
    contacts: &[Collision],
    targets: &[Parting],
    velocities: &mut [Velocity],
) -> Vec<Impulse> {
    let before = velocities.to_vec();
    let allowed = |contact: &Collision, impulse: Impulse| impulse.allowed(contact.friction);
    let impulses = sweep(bodies, contacts, targets, velocities, &allowed);
    let is_driven = |target: &Parting| contacts[target.contact].drive != DVec3::ZERO;
    let most = energy(bodies, &before);
    if energy(bodies, velocities) > most && !targets.iter().any(is_driven) {
        // With friction, the speeds of parting may need more energy than there is.
        let stopped = targets.iter().map(|it| Parting { speed: 0.0, ..*it });
        let mut still = before;
        sweep(
            bodies,
            contacts,
            &stopped.collect::<Vec<_>>(),
            &mut still,
            &allowed,
        );
        limit_energy(bodies, &still, velocities, most);
    }
    impulses
}

/// Lets bodies part in some contacts exactly with these speeds, and where there is friction, with these slips.
pub(super) fn part(
    bodies: &[Striker],
    contacts: &[Collision],
    targets: &[Parting],
    velocities: &mut [Velocity],
) {
    let allowed = |contact: &Collision, impulse: Impulse| match contact.friction > 0.0 {
        true => impulse,
        false => Impulse {
            friction: DVec3::ZERO,
            ..impulse
        },
    };
    sweep(bodies, contacts, targets, velocities, &allowed);
}

/// Gauss and Seidel's sweeps over contacts, until the bodies part as they are to, as far as impulses are allowed.
fn sweep(
    bodies: &[Striker],
    contacts: &[Collision],
    targets: &[Parting],
    velocities: &mut [Velocity],
    allowed: &dyn Fn(&Collision, Impulse) -> Impulse,
) -> Vec<Impulse> {
    let masses: Vec<_> = targets
        .iter()
        .map(|target| contacts[target.contact].masses(bodies))
        .collect();
    let mut impulses = vec![Impulse::default(); targets.len()];
    for _ in 0..MOST_SWEEPS {
        let mut largest = 0.0_f64;
        for (which, target) in targets.iter().enumerate() {
            let contact = &contacts[target.contact];
            let [across, along] = masses[which];
            for is_friction in [false, true] {
                if is_friction && contact.friction == 0.0 {
                    continue;
                }
                let mut wanted = impulses[which];
                if is_friction {
                    wanted.friction += along * (contact.slip(velocities) - target.slip);
                } else {
                    wanted.normal += across * (target.speed + contact.approach(velocities));
                }
                let next = allowed(contact, wanted);
                let normal = next.normal - impulses[which].normal;
                let change = next.friction - impulses[which].friction;
                largest = largest
                    .max((normal / across).abs())
                    .max(change.length() / along);
                contact.push(normal * contact.normal + change, bodies, velocities);
                impulses[which] = next;
            }
        }
        if largest < STILL * STILL {
            break;
        }
    }
    impulses
}

#[cfg(test)]
mod tests {
    use bevy::math::DMat3;

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
            drive: DVec3::ZERO,
            restitution,
            friction: 0.0,
            is_skewed: false,
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
