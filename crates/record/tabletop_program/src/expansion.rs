//! Instructions, as the goals of objects on the table as it is now.

use std::collections::{BTreeMap, BTreeSet};

use bevy::math::Vec3;
use tabletop_core::ObjectSpec;
use tabletop_geometry::Pose;

use crate::{
    goal::{GoalKind, Hindrance, ObjectGoal},
    instruction::TargetPlace,
    noun::{HowMany, Noun, ObjectKind, Preposition, Spot, Superlative},
    placement::{lowest, on_table},
    scene::{SceneView, solids_at},
    selection::{NounSelection, described, too_few},
};

/// An instruction on the table as it is now.
pub(crate) struct Expansion<'a> {
    pub view: &'a SceneView<'a>,
    /// The objects that the program has named before.
    pub named: &'a BTreeSet<String>,
    /// Where objects were in the beginning.
    pub beginning: &'a BTreeMap<String, ObjectSpec>,
    /// True if it is done again and again: then objects that are there already are none of those to be put.
    pub is_repeated: bool,
    /// The objects to take first where it is free which: those of a demonstration, in its order.
    pub preferred: &'a [String],
}

/// The objects that a noun means, and in how many ways it might have been others.
pub(crate) struct ChosenObjects {
    pub ids: Vec<String>,
    pub ways: u128,
}

/// Goals, and the objects that they name.
pub(crate) struct Goals {
    pub goals: Vec<ObjectGoal>,
    pub is_ordered: bool,
    pub named: Vec<String>,
    /// The number of ways in which others could have been chosen.
    pub ways: u128,
}

pub(crate) type Expanded = Result<Goals, Hindrance>;

/// The most objects of which the choice is counted.
const MOST_CHOSEN: u128 = 12;

impl<'a> Expansion<'a> {
    pub fn selection(&self) -> NounSelection<'a> {
        NounSelection {
            view: self.view,
            named: self.named,
            paired: None,
        }
    }

    pub fn put(&self, what: &Noun, to: &TargetPlace, first: Option<Superlative>) -> Expanded {
        let (target, places) = match to.noun() {
            Some(noun) if !noun.pairs() => self.target(noun, what).map(|it| (Some(it.0), it.1))?,
            Some(_) | None => (None, 1),
        };
        let goal_of = |id: &str| self.goal_of(id, to, target.as_deref());
        let others = self.places_among(what, to)?;
        let except = target.iter().chain(&others).map(String::as_str);
        let except: Vec<_> = except.collect();
        let ChosenObjects { ids: chosen, ways } = self.chosen(what, &except, first, |id| {
            goal_of(id).is_ok_and(|goal| ObjectGoal::new(id, goal).is_met(self.view))
        })?;
        if matches!(
            to,
            TargetPlace::Location { .. } | TargetPlace::PlaceOf { .. }
        ) && chosen.len() > 1
        {
            return Err(Hindrance::from(
                "only one object can be at one location".to_owned(),
            ));
        }
        let goals: Result<Vec<_>, Hindrance> = chosen
            .iter()
            .map(|id| Ok(ObjectGoal::new(id, goal_of(id)?)))
            .collect();
        Ok(Goals {
            goals: goals?,
            is_ordered: first.is_some(),
            named: chosen.into_iter().chain(target).collect(),
            ways: ways * places,
        })
    }

    /// The objects that stay where they are since others are put to them, each to its own: of each object that goes into the box of its colour, the boxes.
    fn places_among(&self, what: &Noun, to: &TargetPlace) -> Result<Vec<String>, Hindrance> {
        let Some(Noun::Described { of, .. }) = to.noun().filter(|noun| noun.pairs()) else {
            return Ok(Vec::new());
        };
        let kind = ObjectKind {
            restriction: None,
            ..of.clone()
        };
        let places = self.selection().members(&kind)?;
        let moved = self.selection().candidates(what)?;
        let is_all = moved.iter().all(|id| places.contains(id));
        Ok(if is_all { Vec::new() } else { places })
    }

    pub fn remove(&self, what: &Noun, first: Option<Superlative>) -> Expanded {
        let ChosenObjects { ids, ways } = self.chosen(what, &[], first, |_| false)?;
        let goals = ids.iter().map(|id| ObjectGoal::new(id, GoalKind::Removed));
        Ok(Goals {
            goals: goals.collect(),
            is_ordered: first.is_some(),
            named: ids,
            ways,
        })
    }

    pub fn slide(&self, what: &Noun, open: bool) -> Expanded {
        let mut ids = self.selection().candidates(what)?;
        let goal = |id: &str| ObjectGoal::new(id, GoalKind::Slid(open));
        match what.quantity() {
            None | Some(HowMany::The | HowMany::Most { .. }) => {}
            Some(HowMany::Every) => ids.retain(|id| self.is_holder(id)),
            Some(HowMany::Any) => {
                ids.retain(|id| self.is_holder(id));
                ids.sort_by_key(|id| goal(id).is_met(self.view) == self.is_repeated);
                ids.truncate(1);
                if ids.is_empty() {
                    return Err(Hindrance::from(too_few(1, 0, what)));
                }
            }
            Some(HowMany::Count(count)) => {
                ids.retain(|id| self.is_holder(id));
                ids.truncate(count as usize);
                if ids.len() < count as usize {
                    return Err(Hindrance::from(too_few(count as usize, ids.len(), what)));
                }
            }
        }
        Ok(Goals {
            goals: ids.iter().map(|id| goal(id)).collect(),
            is_ordered: false,
            named: ids,
            ways: 1,
        })
    }

    fn is_holder(&self, id: &str) -> bool {
        self.view
            .sliding_part(id)
            .is_some_and(|part| part.holder == id)
    }

    pub fn swap(&self, one: &Noun, other: &Noun) -> Expanded {
        let selection = self.selection();
        let (one, other) = (selection.one(one)?, selection.one(other)?);
        if one == other {
            return Err(Hindrance::of(&one, "it cannot change places with itself"));
        }
        if self.view.is_upon(&one, &other) || self.view.is_upon(&other, &one) {
            return Err(Hindrance::of(
                &one,
                format!("it and {other} stand on each other"),
            ));
        }
        let [Some(first), Some(second)] = [&one, &other].map(|id| self.view.object(id)) else {
            return Err(Hindrance::of(&one, "it is not there"));
        };
        let goals = vec![
            ObjectGoal::new(&one, GoalKind::Aside),
            ObjectGoal::new(&other, GoalKind::At(in_place_of(second, first))),
            ObjectGoal::new(&one, GoalKind::At(in_place_of(first, second))),
        ];
        Ok(Goals {
            goals,
            is_ordered: true,
            named: vec![one, other],
            ways: 1,
        })
    }

    /// The object to which others are put, and the number of objects that it might have been.
    pub fn target(&self, noun: &Noun, what: &Noun) -> Result<(String, u128), Hindrance> {
        let selection = self.selection();
        let mut candidates = selection.candidates(noun)?;
        match noun.quantity() {
            None | Some(HowMany::The | HowMany::Most { count: 1, .. }) => {}
            Some(HowMany::Any) => {
                if what.is_definite() {
                    let moved = selection.candidates(what)?;
                    candidates.retain(|id| !moved.contains(id));
                }
                let is_covered = |id: &str| !self.view.stack_above(id).is_empty();
                candidates.sort_by_key(|id| (self.rank(id), is_covered(id)));
            }
            Some(HowMany::Every | HowMany::Count(_) | HowMany::Most { .. }) => {
                return Err(Hindrance::from(format!("`{noun}` is not one place")));
            }
        }
        let count = candidates.len() as u128;
        let first = candidates.into_iter().next();
        let none = || Hindrance::from(format!("there is no {}", described(noun)));
        Ok((first.ok_or_else(none)?, count))
    }

    /// The place of an object among those that are preferred.
    fn rank(&self, id: &str) -> usize {
        let mut preferred = self.preferred.iter();
        preferred
            .position(|other| other == id)
            .unwrap_or(usize::MAX)
    }

    pub fn goal_of(
        &self,
        id: &str,
        to: &TargetPlace,
        target: Option<&str>,
    ) -> Result<GoalKind, Hindrance> {
        let object = self
            .view
            .object(id)
            .ok_or_else(|| Hindrance::of(id, "it is not there"))?;
        let other = |noun: &Noun| match target {
            Some(target) => Ok(target.to_owned()),
            None => {
                let selection = NounSelection {
                    paired: Some(id),
                    ..self.selection()
                };
                selection
                    .one(noun)
                    .map_err(|reason| Hindrance::of(id, reason))
            }
        };
        Ok(match to {
            TargetPlace::Spot(Spot::Table { side }) => GoalKind::Table(*side),
            TargetPlace::Spot(Spot::At { preposition, noun }) => {
                let other = other(noun)?;
                match preposition {
                    Preposition::On => GoalKind::Upon(other),
                    Preposition::Inside => GoalKind::Inside(other),
                    Preposition::Around => GoalKind::Around(other),
                    Preposition::Beside(side) => GoalKind::Beside(other, *side),
                }
            }
            TargetPlace::Location { x, y } => GoalKind::At(on_table(
                object,
                Vec3::new(*x, *y, 0.0),
                object.pose.rotation,
            )),
            TargetPlace::Aside => GoalKind::Aside,
            TargetPlace::PlaceOf { noun } => {
                let other = other(noun)?;
                let was = self.beginning.get(&other);
                let was =
                    was.ok_or_else(|| Hindrance::of(&other, "it was not there in the beginning"))?;
                GoalKind::At(in_place_of(object, was))
            }
            TargetPlace::Arranged { .. } => GoalKind::Aside,
        })
    }

    /// The objects that a noun means, but none of `except`, in their order.
    pub fn chosen(
        &self,
        what: &Noun,
        except: &[&str],
        first: Option<Superlative>,
        is_there: impl Fn(&str) -> bool,
    ) -> Result<ChosenObjects, Hindrance> {
        let selection = self.selection();
        let mut ids = selection.candidates(what)?;
        let limit = match what.quantity() {
            None | Some(HowMany::The | HowMany::Most { .. }) => None,
            Some(quantity) => {
                ids.retain(|id| self.view.is_movable(id) && !except.contains(&id.as_str()));
                match quantity {
                    HowMany::Any => Some(1),
                    HowMany::Count(count) => Some(count as usize),
                    HowMany::The | HowMany::Every | HowMany::Most { .. } => None,
                }
            }
        };
        if let Some(first) = first {
            ids = selection.sorted(ids, first);
        }
        let mut ways = 1;
        if let Some(count) = limit {
            if self.is_repeated {
                ids.retain(|id| !is_there(id));
            }
            if ids.len() < count {
                return Err(Hindrance::from(too_few(count, ids.len(), what)));
            }
            // Rather those that are there already, and those with nothing on them.
            let there = ids.iter().filter(|id| is_there(id)).count();
            if first.is_none() {
                ways = combinations(ids.len() - there, count.saturating_sub(there));
                let load = |id: &str| self.view.stack_above(id).len();
                ids.sort_by_key(|id| (!is_there(id), self.rank(id), load(id)));
            } else {
                ids.sort_by_key(|id| !is_there(id));
            }
            ids.truncate(count);
        }
        Ok(ChosenObjects { ids, ways })
    }
}

/// The number of ways to choose so many of these.
fn combinations(all: usize, chosen: usize) -> u128 {
    let chosen = chosen.min(all - chosen.min(all)) as u128;
    // A product of so many numbers after each other is divisible by their factorial.
    (0..chosen.min(MOST_CHOSEN)).fold(1, |ways, i| ways * (all as u128 - i) / (i + 1))
}

/// The pose of an object that stands, as it lies now, where another one stands.
fn in_place_of(object: &ObjectSpec, other: &ObjectSpec) -> Pose {
    let bottom = lowest(&solids_at(other, other.pose));
    let rotation = object.pose.rotation;
    let own = lowest(&solids_at(object, Pose::new(Vec3::ZERO, rotation)));
    Pose::new(other.pose.location.with_z(bottom - own), rotation)
}

impl Noun {
    fn quantity(&self) -> Option<HowMany> {
        match self {
            Self::Named { .. } => None,
            Self::Described { quantity, .. } => Some(*quantity),
        }
    }
}

impl TargetPlace {
    /// The object that it is at.
    fn noun(&self) -> Option<&Noun> {
        match self {
            Self::Spot(Spot::At { noun, .. }) => Some(noun),
            Self::PlaceOf { noun } => Some(noun),
            Self::Spot(Spot::Table { .. })
            | Self::Location { .. }
            | Self::Aside
            | Self::Arranged { .. } => None,
        }
    }
}
