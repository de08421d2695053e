//! Piles: free objects that are pushed, those that they push in turn, and how far they give way.

use std::{cell::OnceCell, collections::VecDeque, iter};

use bevy::prelude::*;
use tabletop_core::TICK_SECONDS;

use super::{
    approach::Approach,
    environment::{Environment, FreeObject},
    limits::{PRESSED, PROBE, SQUEEZE, STEEP},
    swept_solid::{SweptSolid, are_near},
};

/// A free object that something moved reaches.
pub struct Pushed<'a> {
    environment: &'a Environment,
    object: &'a FreeObject,
    squeeze: OnceCell<f32>,
}

impl<'a> Pushed<'a> {
    fn new(environment: &'a Environment, object: &'a FreeObject) -> Self {
        Self {
            environment,
            object,
            squeeze: OnceCell::new(),
        }
    }

    /// The part of its way that a solid can go in a tick: it reaches the object in one tick and pushes it from the next one on, the slower the
    /// more anything is squeezed, and not deeper into an immovable solid than a push may.
    pub fn part(&self, approach: Approach) -> f32 {
        if !approach.is_push() {
            return approach.part(0.0);
        }
        let room = self.give(approach.direction) + approach.gap.min(0.0);
        approach
            .part(self.squeeze())
            .min((room / approach.way).clamp(0.0, 1.0))
    }

    /// How far, in units, the object goes in a direction by itself in a tick.
    pub fn retreat(&self, direction: Vec3) -> f32 {
        (self.object.velocity.dot(direction) * TICK_SECONDS).max(0.0)
    }

    /// How far, in units, the object can be pushed in a direction before anything is squeezed more than a push may; without end if it gives
    /// way.
    fn give(&self, direction: Vec3) -> f32 {
        match self.environment.is_stopped(self.object, direction) {
            true => PRESSED - self.squeeze(),
            false => f32::INFINITY,
        }
    }

    fn squeeze(&self) -> f32 {
        let squeeze = || self.environment.squeeze(self.object);
        *self.squeeze.get_or_init(squeeze)
    }
}

impl Environment {
    /// A free object, if it is one of these.
    pub fn pushed(&self, object: Entity) -> Option<Pushed<'_>> {
        let object = self.free.iter().find(|it| it.object == object)?;
        Some(Pushed::new(self, object))
    }

    /// The part of their way that solids can go in a tick, and the object that they push with most trouble.
    pub fn part<Owner: Copy>(&self, solids: &[SweptSolid<Owner>]) -> (f32, Option<Entity>) {
        let (mut part, mut most_pushed) = (1.0, None);
        for object in &self.free {
            let pushed = Pushed::new(self, object);
            let near = solids.iter().filter(|solid| solid.passes(&object.bounds));
            let approaches = near.flat_map(|solid| {
                let places = object.solids.iter();
                places.filter_map(|place| solid.approach(place))
            });
            let (mut can_go, mut is_pushed) = (1.0_f32, false);
            for mut approach in approaches {
                approach.retreat = pushed.retreat(approach.direction);
                can_go = can_go.min(pushed.part(approach));
                is_pushed |= approach.is_push();
            }
            if can_go < part {
                (part, most_pushed) = (can_go, is_pushed.then_some(object.object));
            }
        }
        (part, most_pushed)
    }

    /// True if a free object, or one that it is near in turn, is squeezed more than a push may.
    pub fn is_crushed(&self, object: Entity) -> bool {
        let mut free = self.free.iter();
        free.find(|it| it.object == object)
            .is_some_and(|object| self.squeeze(object) > SQUEEZE)
    }

    /// Depth, in units, to which a free object and those that are near it in turn are squeezed into each other and into immovable solids.
    fn squeeze(&self, object: &FreeObject) -> f32 {
        let are_near = |one: &FreeObject, other: &FreeObject| are_near(&other.bounds, &one.bounds);
        let depth = |(object, by): (&FreeObject, Option<&FreeObject>)| {
            let by = by.filter(|by| !self.pass(by.object, object.object));
            let depth = by.map_or(0.0, |by| depth_in(by, Vec3::ZERO, &object.solids));
            depth.max(self.depth(object, Vec3::ZERO))
        };
        self.pile(object, are_near).map(depth).fold(0.0, f32::max)
    }

    /// True if a free object, or one that it pushes in turn, cannot go in a direction because something immovable is in the way.
    fn is_stopped(&self, object: &FreeObject, direction: Vec3) -> bool {
        let by = direction * PROBE;
        let pushes = |one: &FreeObject, other: &FreeObject| {
            !self.pass(one.object, other.object)
                && is_met(|by| depth_in(one, by, &other.solids), by)
        };
        self.pile(object, pushes)
            .any(|(object, _)| is_met(|by| self.depth(object, by), by))
    }

    /// A free object and those to which it leads in turn, each with the one that leads to it.
    fn pile<'a>(
        &'a self,
        first: &'a FreeObject,
        leads_to: impl Fn(&FreeObject, &FreeObject) -> bool,
    ) -> impl Iterator<Item = (&'a FreeObject, Option<&'a FreeObject>)> {
        let others = self.free.iter().filter(|it| it.object != first.object);
        let mut others: Vec<_> = others.collect();
        let mut found: VecDeque<(&FreeObject, Option<&FreeObject>)> = [(first, None)].into();
        let mut last = None;
        iter::from_fn(move || {
            if let Some(last) = last {
                let next = others.extract_if(.., |other| leads_to(last, other));
                found.extend(next.map(|other| (other, Some(last))));
            }
            let member = found.pop_front()?;
            last = Some(member.0);
            Some(member)
        })
    }

    /// Penetration depth, in units, of a shifted free object in immovable solids.
    fn depth(&self, object: &FreeObject, by: Vec3) -> f32 {
        let solids = self.immovable.iter();
        depth_in(
            object,
            by,
            solids.filter(|solid| !self.pass(object.object, solid.owner)),
        )
    }
}

/// Depth, in units, of a shifted free object in solids.
fn depth_in<'a>(
    object: &FreeObject,
    by: Vec3,
    solids: impl IntoIterator<Item = &'a SweptSolid<Entity>>,
) -> f32 {
    let depth = |solid: &SweptSolid<Entity>| {
        let own = object.solids.iter();
        own.map(|own| own.depth_if_shifted(by, solid))
            .fold(0.0, f32::max)
    };
    solids.into_iter().map(depth).fold(0.0, f32::max)
}

/// True if a shift leads into something, by the depth in it after a shift.
fn is_met(depth: impl Fn(Vec3) -> f32, by: Vec3) -> bool {
    depth(by) - depth(Vec3::ZERO) > STEEP * PROBE
}
