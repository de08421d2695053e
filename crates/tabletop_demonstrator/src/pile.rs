//! Piles: free objects that are pushed by a hand, and what they push in turn.

use bevy::prelude::*;
use bevy_rapier3d::parry::bounding_volume::{Aabb, BoundingVolume as _};
use tabletop_geometry::Pose;
use tabletop_physics::{Convex, Nearby, depth};

/// Distance, in units, by which it is tried whether an object gives way.
const PROBE: f32 = 0.05;

/// Increase of depth with the way from which an object does not give way, or pushes another one.
const STEEP: f32 = 0.1;

/// A free object.
pub(crate) struct PiledObject {
    pub entity: Entity,
    /// Its convex parts, in the frame of the world.
    pub parts: Vec<Convex>,
    bounds: Aabb,
    /// True if a joint holds it, perhaps inside another object.
    is_jointed: bool,
}

impl PiledObject {
    pub fn new(nearby: &Nearby, is_jointed: &dyn Fn(Entity) -> bool) -> Self {
        Self {
            entity: nearby.entity,
            parts: nearby.parts(),
            bounds: nearby.bounds,
            is_jointed: is_jointed(nearby.entity),
        }
    }

    fn is_near(&self, bounds: &Aabb) -> bool {
        self.bounds.loosened(PROBE).intersects(bounds)
    }

    /// Depth, in units, of the shifted object in solids.
    fn depth(&self, by: Vec3, solids: &[Convex]) -> f32 {
        depth(&self.parts, Pose::at(by), solids)
    }
}

/// How an object gives way to a push.
#[derive(Default)]
pub(crate) struct Resistance {
    /// The greatest depth, in units, of what is pushed, in what does not give way.
    pub depth: f32,
    /// Increase of that depth with the way; 0 if it gives way.
    steepness: f32,
}

impl Resistance {
    /// The way, in units, by which the object can be pushed until this depth.
    pub fn give(&self, depth: f32) -> f32 {
        match self.steepness > STEEP {
            true => ((depth - self.depth) / self.steepness).max(0.0),
            false => f32::INFINITY,
        }
    }

    /// The resistance of solids to an object that is shifted by the probe.
    fn of(solids: &[Convex], object: &PiledObject, probe: Vec3) -> Self {
        let depth = object.depth(Vec3::ZERO, solids);
        let steepness = (object.depth(probe, solids) - depth) / PROBE;
        Self { depth, steepness }
    }

    fn max(&self, other: &Self) -> Self {
        Self {
            depth: self.depth.max(other.depth),
            steepness: self.steepness.max(other.steepness),
        }
    }
}

/// Free objects that touch each other in turn, and what does not move near them.
pub(crate) struct Pile {
    free: Vec<PiledObject>,
    immovable: Vec<Convex>,
}

impl Pile {
    /// The pile of some free objects.
    pub fn of<'a>(
        first: &[PiledObject],
        others: impl Iterator<Item = Nearby<'a>>,
        is_jointed: &dyn Fn(Entity) -> bool,
    ) -> Self {
        let mut pile = Self {
            free: Vec::new(),
            immovable: Vec::new(),
        };
        let is_first = |other: &Nearby| first.iter().any(|it| it.entity == other.entity);
        let (mut found, mut others): (Vec<_>, Vec<_>) = others.partition(is_first);
        while let Some(member) = found.pop() {
            let object = PiledObject::new(&member, is_jointed);
            for other in others.extract_if(.., |other| object.is_near(&other.bounds)) {
                match other.body.is_dynamic() {
                    true => found.push(other),
                    false => pile.immovable.extend(other.parts()),
                }
            }
            pile.free.push(object);
        }
        pile
    }

    /// How an object gives way to a push in a direction: with what it pushes in turn, but for what joints hold, which may be inside others.
    pub fn resistance(&self, object: Entity, direction: Vec3) -> Resistance {
        let probe = direction * PROBE;
        let mut resistance = Resistance::default();
        let free = self.free.iter().filter(|object| !object.is_jointed);
        let (mut pushed, mut others): (Vec<_>, Vec<_>) =
            free.partition(|other| other.entity == object);
        while let Some(object) = pushed.pop() {
            let of_solids = |solids: &[Convex]| Resistance::of(solids, object, probe);
            resistance = resistance.max(&of_solids(&self.immovable));
            pushed.extend(others.extract_if(.., |other| {
                object.is_near(&other.bounds) && of_solids(&other.parts).steepness > STEEP
            }));
        }
        resistance
    }
}
