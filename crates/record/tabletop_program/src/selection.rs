//! The objects of a scene that a noun means.

use std::{cmp::Ordering, collections::BTreeSet};

use tabletop_core::ObjectSpec;
use tabletop_task::{has_value, property};

use crate::{
    look::is_called,
    noun::{
        Feature, HowMany, Noun, ObjectKind, Preposition, RelativeSize, Restriction, Spot,
        Superlative, TableSide,
    },
    scene::SceneView,
};

/// What a noun means where it stands.
pub(crate) struct NounSelection<'a> {
    pub view: &'a SceneView<'a>,
    /// The objects that the program has named before.
    pub named: &'a BTreeSet<String>,
    /// The object that is put to the noun's, for nouns such as `the bowl of its colour`.
    pub paired: Option<&'a str>,
}

/// The name of things of any kind.
pub(crate) const ANYTHING: &str = "object";
/// The name of a stack of objects, which is given by the lowest one.
pub(crate) const TOWER: &str = "tower";

impl NounSelection<'_> {
    /// All objects that a noun may mean, whatever their number, in the order of the scene.
    ///
    /// # Errors
    /// There is none, or the noun has to be unique and is not.
    pub fn candidates(&self, noun: &Noun) -> Result<Vec<String>, String> {
        match noun {
            Noun::Named { id } => match self.view.object(id) {
                Some(_) => Ok(vec![id.clone()]),
                None => Err(format!("there is no object {id}")),
            },
            Noun::Described { quantity, of } => {
                let members = self.members(of)?;
                match quantity {
                    HowMany::The => match &members[..] {
                        [] => Err(format!("there is no {}", described(noun))),
                        [_] => Ok(members),
                        [..] => Err(format!("{} can be any of {}", noun, members.join(", "))),
                    },
                    HowMany::Any | HowMany::Every | HowMany::Count(_) => Ok(members),
                    HowMany::Most { count, of } => {
                        let sorted = self.sorted(members, *of);
                        let count = *count as usize;
                        match sorted.len() < count {
                            true => Err(too_few(count, sorted.len(), noun)),
                            false => Ok(sorted.into_iter().take(count).collect()),
                        }
                    }
                }
            }
        }
    }

    /// The only object that a noun means, or the first of those that it may mean.
    ///
    /// # Errors
    /// There is none.
    pub fn one(&self, noun: &Noun) -> Result<String, String> {
        let candidates = self.candidates(noun)?;
        let first = candidates.into_iter().next();
        first.ok_or_else(|| format!("there is no {}", described(noun)))
    }

    /// All objects of a kind, in the order of the scene.
    ///
    /// # Errors
    /// A noun that the kind depends on means nothing.
    pub fn members(&self, kind: &ObjectKind) -> Result<Vec<String>, String> {
        let objects = &self.view.scene.objects;
        let alike: Vec<_> = objects
            .iter()
            .filter(|object| self.is_alike(kind, object))
            .collect();
        let volume = |object: &ObjectSpec| self.view.volume(&object.id);
        let volumes = alike.iter().map(|object| volume(object));
        let [least, most] = volumes.fold([f32::INFINITY, 0.0], |[least, most], volume| {
            [least.min(volume), most.max(volume)]
        });
        let has_size = |object: &ObjectSpec| {
            let (small, large) = (volume(object) - least, most - volume(object));
            match kind.size {
                None => true,
                Some(RelativeSize::Small) => small < large,
                Some(RelativeSize::Large) => large < small,
            }
        };
        let mut members = Vec::new();
        for object in alike.into_iter().filter(|object| has_size(object)) {
            if self.is_restricted_to(kind.restriction.as_ref(), object)? {
                members.push(object.id.clone());
            }
        }
        Ok(members)
    }

    /// True if an object is of a kind, its size and its restriction apart.
    fn is_alike(&self, kind: &ObjectKind, object: &ObjectSpec) -> bool {
        let color = || self.view.color(&object.id);
        (!kind.other || !self.named.contains(&object.id))
            && kind
                .color
                .as_ref()
                .is_none_or(|wanted| color() == Some(wanted.as_str()))
            && match kind.is.as_str() {
                ANYTHING => true,
                TOWER => self.is_foot_of_tower(&object.id),
                kind => is_called(object, kind),
            }
    }

    fn is_foot_of_tower(&self, id: &str) -> bool {
        let stands_on_others = self
            .view
            .scene
            .objects
            .iter()
            .any(|base| self.view.is_upon(id, &base.id));
        !stands_on_others && !self.view.stack_above(id).is_empty()
    }

    fn is_restricted_to(
        &self,
        restriction: Option<&Restriction>,
        object: &ObjectSpec,
    ) -> Result<bool, String> {
        let id = object.id.as_str();
        Ok(match restriction {
            None => true,
            Some(Restriction::Where { not, spot }) => self.is_at(id, spot)? != *not,
            Some(Restriction::From { whole }) => {
                let wholes = self.candidates(whole)?;
                wholes.iter().any(|whole| self.is_part(id, whole))
                    || is_tower(whole) && wholes.iter().any(|whole| whole == id)
            }
            Some(Restriction::Except { others }) => {
                !self.candidates(others)?.iter().any(|other| other == id)
            }
            Some(Restriction::OfIts { feature }) => {
                let paired = self.paired.and_then(|paired| self.view.object(paired));
                let Some(paired) = paired else {
                    return Err(format!("it is not said whose {} is meant", feature.word()));
                };
                paired.id != object.id && self.has_same(*feature, paired, object)
            }
            Some(Restriction::Whose {
                property: name,
                value,
            }) => {
                let found = property(object, name);
                found.is_some_and(|found| has_value(name, &found, value))
            }
        })
    }

    /// True if one is in, on or around the other.
    fn is_part(&self, id: &str, whole: &str) -> bool {
        self.view.is_upon(id, whole) || self.view.is_inside(id, whole) || self.is_around(id, whole)
    }

    fn is_around(&self, id: &str, post: &str) -> bool {
        self.view.standing.is_around(id, post)
    }

    /// True if an object is at a spot.
    ///
    /// # Errors
    /// There is no such spot.
    pub fn is_at(&self, id: &str, spot: &Spot) -> Result<bool, String> {
        match spot {
            Spot::Table { side } => Ok(self.view.standing.is_on_table(id)
                && side.is_none_or(|side| side.has(self.view.location(id)))),
            Spot::At { preposition, noun } => {
                let others = self.candidates(noun)?;
                Ok(others
                    .iter()
                    .any(|other| self.is_related(id, *preposition, other)))
            }
        }
    }

    /// True if an object has this relation to another one.
    pub fn is_related(&self, id: &str, preposition: Preposition, other: &str) -> bool {
        match preposition {
            Preposition::On => self.view.is_upon(id, other),
            Preposition::Inside => self.view.is_inside(id, other),
            Preposition::Around => self.is_around(id, other),
            Preposition::Beside(side) => self.view.is_beside(id, other, side),
        }
    }

    fn has_same(&self, feature: Feature, one: &ObjectSpec, other: &ObjectSpec) -> bool {
        let [color, of_other] = [one, other].map(|object| self.view.color(&object.id));
        match feature {
            Feature::Color => color.is_some() && color == of_other,
            Feature::Shape => property(one, "shape") == property(other, "shape"),
            Feature::Size => {
                let [one, other] = [one, other].map(|object| self.view.volume(&object.id));
                (one - other).abs() < 0.05 * one.max(other)
            }
        }
    }

    /// These objects, those that have most of a property first. Equal ones stay in their order.
    pub fn sorted(&self, mut ids: Vec<String>, by: Superlative) -> Vec<String> {
        ids.sort_by(|a, b| self.compared(by, a, b));
        ids
    }

    /// Which of two objects comes first in a comparison.
    pub fn compared(&self, by: Superlative, a: &str, b: &str) -> Ordering {
        let amount = |id: &str| -> f32 {
            let volume = self.view.volume(id);
            let mass = self.view.object(id).map_or(0.0, |object| object.mass);
            let location = self.view.location(id);
            match by {
                Superlative::Largest => volume,
                Superlative::Smallest => -volume,
                Superlative::Heaviest => mass,
                Superlative::Lightest => -mass,
                Superlative::Tallest => self.view.height(id),
                Superlative::Shortest => -self.view.height(id),
                Superlative::Leftmost => -location.x,
                Superlative::Rightmost => location.x,
                Superlative::Nearest => -location.y,
                Superlative::Farthest => location.y,
                Superlative::Topmost => self.view.top(id),
            }
        };
        // Trembling does not change an order.
        let steps = |id: &str| (amount(id) * 100.0).round();
        steps(b).total_cmp(&steps(a))
    }
}

impl SceneView<'_> {
    /// The height of an object from its lowest to its highest point.
    pub fn height(&self, id: &str) -> f32 {
        let solids = self.solids(id);
        let lows = solids.iter().map(|solid| solid.heights()[0]);
        self.top(id) - lows.fold(f32::INFINITY, f32::min)
    }
}

impl TableSide {
    /// True if a location on the table is there.
    pub(crate) fn has(self, location: bevy::math::Vec3) -> bool {
        match self {
            Self::Left => location.x < 0.0,
            Self::Right => location.x > 0.0,
            Self::Front => location.y < 0.0,
            Self::Back => location.y > 0.0,
        }
    }
}

/// True if a noun means stacks of objects.
pub(crate) fn is_tower(noun: &Noun) -> bool {
    matches!(noun, Noun::Described { of, .. } if of.is == TOWER)
}

/// A noun without its article.
pub(crate) fn described(noun: &Noun) -> String {
    let text = noun.to_string();
    let articles = ["the ", "any ", "every "];
    let bare = articles
        .iter()
        .find_map(|article| text.strip_prefix(article));
    bare.map_or(text.clone(), str::to_owned)
}

/// That there are fewer objects than wanted.
pub(crate) fn too_few(wanted: usize, there: usize, noun: &Noun) -> String {
    match there {
        0 => format!("there is no {}", described(noun)),
        there => format!("there are only {there} of the {wanted} that are meant by `{noun}`"),
    }
}
