//! Patterns and copies of objects, as goals.

use std::collections::BTreeSet;

use bevy::math::Vec3;
use tabletop_core::ObjectSpec;
use tabletop_geometry::Pose;
use tabletop_task::{RelativeSide, property};

use crate::{
    expansion::{ChosenObjects, Expanded, Expansion, Goals},
    goal::{GoalKind, Hindrance, ObjectGoal},
    instruction::{Pattern, TargetPlace},
    layout::{is_laid_out, laid_out, sorted_in_place},
    noun::{Noun, Preposition, Spot, Superlative, TableSide},
    scene::SceneView,
};

/// How far the objects of a copied pattern may be out of place, in units.
const OUT_OF_PLACE: f32 = 0.4;

/// The objects of a pattern.
pub(crate) struct PatternSet {
    /// In their order.
    pub ids: Vec<String>,
    /// The object at which it is made.
    pub target: Option<String>,
    /// The number of ways in which others could have been chosen.
    pub ways: u128,
    /// True if their order matters.
    pub is_sorted: bool,
}

impl PatternSet {
    /// True if the pattern is made.
    pub fn is_made(&self, on: &Expansion, pattern: Pattern, at: Option<&Spot>) -> bool {
        let ids = match self.is_sorted {
            true => self.ids.clone(),
            false => sorted_in_place(on.view, &self.ids, pattern),
        };
        let Some(first) = ids.first() else {
            return true;
        };
        let is_there = match (at, pattern) {
            (None, _) => true,
            (Some(spot), Pattern::Tower) => {
                let to = TargetPlace::Spot(spot.clone());
                let goal = on.goal_of(first, &to, self.target.as_deref());
                goal.is_ok_and(|goal| ObjectGoal::new(first, goal).is_met(on.view))
            }
            (Some(Spot::Table { side }), Pattern::Row | Pattern::Column | Pattern::Grid(_)) => {
                let is_at_side = |id: &String| side.is_none_or(|it| it.has(on.view.location(id)));
                ids.iter().all(is_at_side)
            }
            (
                Some(Spot::At { preposition, .. }),
                Pattern::Row | Pattern::Column | Pattern::Grid(_),
            ) => {
                let target = self.target.as_deref().unwrap_or_default();
                let way = middle(on.view, &ids) - on.view.location(target);
                *preposition == Preposition::Beside(RelativeSide::of(way))
            }
        };
        is_there && is_laid_out(on.view, &ids, pattern)
    }
}

/// Objects on a side of the table that are like these and arranged like them.
pub(crate) fn copies_of(view: &SceneView, models: &[String], to: TableSide) -> Option<Vec<String>> {
    let first = view.object(models.first()?)?;
    let objects = || view.scene.objects.iter();
    let is_copy = |copy: &&ObjectSpec, model: &ObjectSpec| {
        !models.contains(&copy.id) && is_like(copy, model) && to.has(copy.pose.location)
    };
    let mut starts = objects().filter(|copy| is_copy(copy, first));
    starts.find_map(|start| {
        let by = start.pose.location - first.pose.location;
        let copies = models.iter().map(|model| {
            let model = view.object(model)?;
            let is_there = |copy: &&ObjectSpec| {
                copy.pose.location.distance(model.pose.location + by) < OUT_OF_PLACE
            };
            let copy = objects().find(|copy| is_copy(copy, model) && is_there(copy))?;
            Some(copy.id.clone())
        });
        copies.collect()
    })
}

/// True if two objects have the same shape, size and colour.
fn is_like(one: &ObjectSpec, other: &ObjectSpec) -> bool {
    let is_same = |name| property(one, name) == property(other, name);
    ["shape", "size", "color"].into_iter().all(is_same)
}

/// The middle of objects.
fn middle(view: &SceneView, ids: &[String]) -> Vec3 {
    let count = ids.len().max(1) as f32;
    ids.iter().map(|id| view.location(id)).sum::<Vec3>() / count
}

impl Expansion<'_> {
    pub fn copy(&self, what: &Noun, to: TableSide) -> Expanded {
        let mut models = self.chosen(what, &[], None, |_| false)?.ids;
        models.sort_by(|a, b| {
            let height = |id: &str| self.view.location(id).z;
            height(a).total_cmp(&height(b))
        });
        let center = middle(self.view, &models);
        let by = (to.center(self.view) - center) * to.across();
        let mut used: BTreeSet<_> = models.iter().cloned().collect();
        let mut goals = Vec::new();
        let left = match copies_of(self.view, &models, to) {
            Some(copies) => {
                used.extend(copies);
                &[]
            }
            None => &models[..],
        };
        for model in left {
            let Some(shown) = self.view.object(model) else {
                continue;
            };
            let is_free = |other: &&ObjectSpec| !used.contains(&other.id) && is_like(other, shown);
            let copy = self.view.scene.objects.iter().find(is_free);
            let copy = copy.ok_or_else(|| Hindrance::of(model, "there is nothing like it left"))?;
            used.insert(copy.id.clone());
            let pose = Pose::new(shown.pose.location + by, shown.pose.rotation);
            goals.push(ObjectGoal::new(&copy.id, GoalKind::At(pose)));
        }
        Ok(Goals {
            goals,
            is_ordered: true,
            named: used.into_iter().collect(),
            ways: 1,
        })
    }

    /// Goals that make a pattern, none if it is made already.
    pub fn arrange(
        &self,
        what: &Noun,
        pattern: Pattern,
        at: Option<&Spot>,
        first: Option<Superlative>,
    ) -> Expanded {
        let set = self.pattern_set(what, at, first)?;
        let goals = match (set.is_made(self, pattern, at), pattern) {
            (true, _) => Vec::new(),
            (false, Pattern::Tower) => self.tower(&set.ids, at, set.target.as_deref())?,
            (false, Pattern::Row | Pattern::Column | Pattern::Grid(_)) => {
                self.flat_pattern(&set.ids, pattern, at, set.target.as_deref())?
            }
        };
        Ok(Goals {
            goals,
            is_ordered: true,
            named: set.ids.into_iter().chain(set.target).collect(),
            ways: set.ways,
        })
    }

    /// The objects of a pattern.
    pub fn pattern_set(
        &self,
        what: &Noun,
        at: Option<&Spot>,
        first: Option<Superlative>,
    ) -> Result<PatternSet, Hindrance> {
        let target = match at {
            Some(Spot::At { noun, .. }) => Some(self.target(noun, what)?.0),
            Some(Spot::Table { .. }) | None => None,
        };
        let except: Vec<_> = target.iter().map(String::as_str).collect();
        let ChosenObjects { ids, ways } = self.chosen(what, &except, first, |_| false)?;
        Ok(PatternSet {
            ids,
            target,
            ways,
            is_sorted: first.is_some(),
        })
    }

    /// Each on the one before. The first one stays where it is, unless it stands on another one or is to be somewhere else.
    fn tower(
        &self,
        chosen: &[String],
        at: Option<&Spot>,
        target: Option<&str>,
    ) -> Result<Vec<ObjectGoal>, Hindrance> {
        let Some(first) = chosen.first() else {
            return Ok(Vec::new());
        };
        let stands_on_others = chosen.iter().any(|other| self.view.is_upon(first, other));
        let to = match at {
            Some(spot) => Some(TargetPlace::Spot(spot.clone())),
            None => stands_on_others.then_some(TargetPlace::Spot(Spot::TABLE)),
        };
        let mut goals = Vec::new();
        if let Some(to) = to {
            goals.push(ObjectGoal::new(first, self.goal_of(first, &to, target)?));
        }
        let pairs = chosen.windows(2);
        goals.extend(
            pairs.map(|pair| ObjectGoal::new(&pair[1], GoalKind::Directly(pair[0].clone()))),
        );
        Ok(goals)
    }

    fn flat_pattern(
        &self,
        chosen: &[String],
        pattern: Pattern,
        at: Option<&Spot>,
        target: Option<&str>,
    ) -> Result<Vec<ObjectGoal>, Hindrance> {
        let objects: Vec<_> = chosen
            .iter()
            .filter_map(|id| self.view.object(id))
            .collect();
        let center = middle(self.view, chosen);
        let (near, side) = match (at, target) {
            (Some(Spot::At { preposition, .. }), Some(target)) => match preposition {
                Preposition::Beside(side) => (self.view.location(target) + side.way() * 3.0, None),
                Preposition::On | Preposition::Inside | Preposition::Around => {
                    let reason = "rows, columns and grids are made on the table".to_owned();
                    return Err(Hindrance::from(reason));
                }
            },
            (Some(Spot::Table { side: Some(side) }), _) => {
                let near = center + (side.center(self.view) - center) * side.across();
                (near, Some(*side))
            }
            (Some(Spot::Table { side: None } | Spot::At { .. }) | None, _) => (center, None),
        };
        let poses = laid_out(self.view, &objects, pattern, near, side);
        let poses =
            poses.ok_or_else(|| Hindrance::from("there is no room for the pattern".to_owned()))?;
        let goals = chosen.iter().zip(poses);
        Ok(goals
            .map(|(id, pose)| ObjectGoal::new(id, GoalKind::At(pose)))
            .collect())
    }
}

impl TableSide {
    /// The middle of it.
    fn center(self, view: &SceneView) -> Vec3 {
        let table = view.scene.table;
        match self {
            Self::Left => Vec3::NEG_X * table.xspan / 4.0,
            Self::Right => Vec3::X * table.xspan / 4.0,
            Self::Front => Vec3::NEG_Y * table.yspan / 4.0,
            Self::Back => Vec3::Y * table.yspan / 4.0,
        }
    }

    /// The other side.
    pub(crate) const fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }

    /// 1 along the axis on which it is a side.
    const fn across(self) -> Vec3 {
        match self {
            Self::Left | Self::Right => Vec3::X,
            Self::Front | Self::Back => Vec3::Y,
        }
    }
}

/// The next move of a tower from wherever its parts are to a place, by way of the others: the part, and where it is to go.
pub(crate) fn next_of_tower(view: &SceneView, places: &[String; 3]) -> Option<ObjectGoal> {
    let [_, to, _] = places;
    let is_around = |id: &str, place: &String| view.standing.is_around(id, place);
    let place_of = |id: &str| {
        let mut all = places.iter();
        all.position(|place| is_around(id, place) || view.is_upon(id, place))
    };
    let objects = view.scene.objects.iter();
    let objects =
        objects.filter(|object| view.is_movable(&object.id) && !places.contains(&object.id));
    let mut parts: Vec<_> = objects
        .filter_map(|object| Some((object, place_of(&object.id)?)))
        .collect();
    parts.sort_by(|(a, _), (b, _)| view.volume(&b.id).total_cmp(&view.volume(&a.id)));
    let mut goal = places.iter().position(|place| place == to)?;
    let mut next = None;
    for (part, place) in parts {
        if place != goal {
            next = Some((part, goal));
            // All smaller ones have to be at the third place meanwhile.
            goal = 3 - place - goal;
        }
    }
    let (part, goal) = next?;
    let place = places[goal].clone();
    let goal = match view.standing.is_ring(&part.id) {
        true => GoalKind::Around(place),
        false => GoalKind::Upon(place),
    };
    Some(ObjectGoal::new(&part.id, goal))
}
