//! The sentences that may explain a deed, and those after it.

use tabletop_task::Relation;

use crate::{
    condition::Condition,
    finding::{
        example::{ExampleDeed, ExampleView},
        nouns::NounGuess,
        towers::towers_moved,
    },
    instruction::{Instruction, Pattern, TargetPlace},
    layout::{is_laid_out, sorted_in_place},
    noun::{HowMany, Noun, ObjectKind, Preposition, Restriction, Spot, Superlative, TableSide},
    program::Sentence,
    scene::SceneView,
};

/// Proposals for what was meant by a deed.
pub(crate) struct Proposals<'a> {
    example: &'a ExampleView<'a>,
    /// The number of the deed.
    at: usize,
    deed: &'a ExampleDeed,
    before: NounGuess<'a>,
    after: &'a SceneView<'a>,
    end: &'a SceneView<'a>,
}

/// A place where objects may have been meant to be.
struct Aim {
    to: TargetPlace,
    /// True if only one object can be there.
    is_single: bool,
}

impl<'a> Proposals<'a> {
    /// Proposals for a deed of an example. `None` if there is no such deed.
    pub fn at(example: &'a ExampleView<'a>, at: usize) -> Option<Self> {
        Some(Self {
            example,
            at,
            deed: example.deeds.get(at)?,
            before: NounGuess {
                view: example.views.get(at)?,
            },
            after: example.views.get(at + 1)?,
            end: example.views.last()?,
        })
    }

    /// All of them.
    pub fn all(&self) -> Vec<Sentence> {
        let singles = self.before.single(&self.deed.object);
        let sets = self.before.sets(&self.deed.object);
        let mut all = Vec::new();
        match self.deed.relations.first() {
            None => {}
            Some(Relation::Destroyed) => {
                let nouns = self.nouns(&singles, &sets, |id| self.end.object(id).is_none());
                all.extend(
                    nouns
                        .into_iter()
                        .map(|what| Instruction::Remove { what, first: None }),
                );
            }
            Some(Relation::Slid {
                object,
                opening,
                travel,
            }) => all.extend(self.slides(object, *opening > travel / 2.0)),
            Some(
                Relation::OnTable
                | Relation::On { .. }
                | Relation::Inside { .. }
                | Relation::Around { .. }
                | Relation::Against { .. }
                | Relation::Beside { .. }
                | Relation::AlignedWith { .. }
                | Relation::InPlaceOf { .. }
                | Relation::Aside
                | Relation::Turned { .. }
                | Relation::LetGo
                | Relation::Held,
            ) => {
                all.extend(self.puts(&singles, &sets));
                all.extend(self.patterns(&sets));
                all.extend(self.swaps(&singles));
                all.extend(self.copies(&sets));
                all.extend(towers_moved(self.example, self.at));
            }
        }
        let sentences = all.into_iter().map(|one| Sentence::Do {
            instructions: vec![one],
        });
        let loops = self.loops(&sets);
        sentences.chain(loops).collect()
    }

    /// Nouns for the object alone, and for sets of which all, or so many, or those with most of something, are where they belong in the end.
    fn nouns(
        &self,
        singles: &[Noun],
        sets: &[ObjectKind],
        is_there: impl Fn(&str) -> bool,
    ) -> Vec<Noun> {
        let mut nouns = singles.to_vec();
        for kind in sets {
            let described = |quantity| Noun::Described {
                quantity,
                of: kind.clone(),
            };
            let members = self.before.movable(kind);
            let there = members.iter().filter(|id| is_there(id)).count();
            let left = members.iter().filter(|id| !is_there(id)).count();
            // What the others are put to stays where it is.
            if left <= 1 {
                nouns.push(described(HowMany::Every));
            }
            if kind.restriction.is_none() {
                nouns.push(described(HowMany::Any));
            }
            if there > 1 {
                let count = number(there);
                nouns.push(described(HowMany::Count(count)));
                let selection = self.before.selection();
                let most = Superlative::ALL.into_iter().filter(|of| {
                    let sorted = selection.sorted(members.clone(), *of);
                    let (first, others) = sorted.split_at(there);
                    let limit = first.last().zip(others.first());
                    let is_strict = limit
                        .is_some_and(|(last, next)| selection.compared(*of, last, next).is_lt());
                    is_strict && first.iter().all(|id| is_there(id))
                });
                nouns.extend(most.map(|of| described(HowMany::Most { count, of })));
            }
        }
        nouns
    }

    fn puts(&self, singles: &[Noun], sets: &[ObjectKind]) -> Vec<Instruction> {
        let mut all = Vec::new();
        for Aim { to, is_single } in self.aims() {
            let sets = if is_single { &[] } else { sets };
            let nouns = self.nouns(singles, sets, |id| to.pairs() || self.is_there(id, &to));
            all.extend(nouns.into_iter().map(|what| Instruction::Put {
                what,
                to: to.clone(),
                first: None,
            }));
        }
        all
    }

    /// True if an object is at a place in the end.
    fn is_there(&self, id: &str, to: &TargetPlace) -> bool {
        let TargetPlace::Spot(spot) = to else {
            return false;
        };
        let end = NounGuess { view: self.end };
        end.selection().is_at(id, spot).unwrap_or_default()
    }

    /// The places that the object may have been meant to be at.
    fn aims(&self) -> Vec<Aim> {
        let id = self.deed.object.as_str();
        let mut spots = Vec::new();
        for (how, other) in self.neighbours() {
            let nouns = self.before.single(&other).into_iter();
            let paired = self.before.paired(&other, id);
            let any = self.before.kinds(&other).into_iter();
            let any = any.map(|of| Noun::Described {
                quantity: HowMany::Any,
                of,
            });
            let nouns = nouns.chain(paired).chain(any);
            spots.extend(nouns.map(|noun| Spot::at(how, noun)));
        }
        let here = self.after.location(id);
        if self.after.standing.is_on_table(id) {
            let sides = TableSide::ALL.into_iter().filter(|side| side.has(here));
            let sides = [None].into_iter().chain(sides.map(Some));
            spots.extend(sides.map(|side| Spot::Table { side }));
        }
        let spots = spots.into_iter().map(|spot| Aim {
            to: TargetPlace::Spot(spot),
            is_single: false,
        });
        let relations = self.deed.relations.iter();
        let places = relations.flat_map(|relation| match relation {
            Relation::InPlaceOf { object } => {
                let nouns = self.before.single(object).into_iter();
                nouns.map(|noun| TargetPlace::PlaceOf { noun }).collect()
            }
            Relation::Aside => vec![TargetPlace::Aside],
            Relation::OnTable => {
                let [x, y] = [here.x, here.y].map(|at| (at * 10.0).round() / 10.0 + 0.0);
                vec![TargetPlace::Location { x, y }]
            }
            Relation::On { .. }
            | Relation::Inside { .. }
            | Relation::Around { .. }
            | Relation::Against { .. }
            | Relation::Beside { .. }
            | Relation::AlignedWith { .. }
            | Relation::Slid { .. }
            | Relation::Turned { .. }
            | Relation::LetGo
            | Relation::Destroyed
            | Relation::Held => Vec::new(),
        });
        let places = places.map(|to| Aim {
            is_single: to != TargetPlace::Aside,
            to,
        });
        spots.chain(places).collect()
    }

    /// The objects that the object is at after the deed.
    fn neighbours(&self) -> Vec<(Preposition, String)> {
        let id = self.deed.object.as_str();
        let view = self.after;
        let objects = view.scene.objects.iter().map(|other| other.id.as_str());
        let others = objects.filter(|other| *other != id);
        let standing = others.flat_map(|other| {
            let related = [
                (Preposition::Inside, view.is_inside(id, other)),
                (Preposition::Around, view.standing.is_around(id, other)),
                (Preposition::On, view.is_upon(id, other)),
            ];
            let related = related.into_iter().find(|(_, is_so)| *is_so);
            related.map(|(how, _)| (how, other.to_owned()))
        });
        let beside = self
            .deed
            .relations
            .iter()
            .filter_map(|relation| match relation {
                Relation::Beside { object, side } => {
                    Some((Preposition::Beside(*side), object.clone()))
                }
                Relation::OnTable
                | Relation::On { .. }
                | Relation::Inside { .. }
                | Relation::Around { .. }
                | Relation::Against { .. }
                | Relation::AlignedWith { .. }
                | Relation::InPlaceOf { .. }
                | Relation::Aside
                | Relation::Slid { .. }
                | Relation::Turned { .. }
                | Relation::LetGo
                | Relation::Destroyed
                | Relation::Held => None,
            });
        standing.chain(beside).collect()
    }

    fn slides(&self, holder: &str, open: bool) -> Vec<Instruction> {
        let sets = self.before.sets(holder).into_iter();
        let every = sets.map(|of| Noun::Described {
            quantity: HowMany::Every,
            of,
        });
        let nouns = self.before.single(holder).into_iter().chain(every);
        let all = nouns.map(|what| match open {
            true => Instruction::Open { what },
            false => Instruction::Close { what },
        });
        all.collect()
    }

    fn patterns(&self, sets: &[ObjectKind]) -> Vec<Instruction> {
        let id = self.deed.object.as_str();
        let here = self.end.location(id);
        let on_table = self.end.standing.is_on_table(id);
        let sides = TableSide::ALL.into_iter().filter(|side| side.has(here));
        let sides: Vec<_> = sides.map(|side| Spot::Table { side: Some(side) }).collect();
        let bases = self.neighbours().into_iter().flat_map(|(how, other)| {
            let nouns = self.before.single(&other).into_iter();
            nouns.map(move |noun| Spot::at(how, noun))
        });
        let bases: Vec<_> = bases.collect();
        let mut patterns = vec![(Pattern::Tower, bases)];
        if on_table {
            let grids = (2..=MOST_COLUMNS).map(Pattern::Grid);
            let flat = [Pattern::Row, Pattern::Column].into_iter().chain(grids);
            patterns.extend(flat.map(|pattern| (pattern, sides.clone())));
        }
        let mut all = Vec::new();
        for (pattern, spots) in patterns {
            for of in sets {
                let orders = self.orders(of, pattern);
                let what = Noun::Described {
                    quantity: HowMany::Every,
                    of: of.clone(),
                };
                for first in orders {
                    let places = [None].into_iter().chain(spots.iter().cloned().map(Some));
                    all.extend(places.map(|at| Instruction::Put {
                        what: what.clone(),
                        to: TargetPlace::Arranged { pattern, at },
                        first,
                    }));
                }
            }
        }
        all
    }

    /// The orders of all objects of a kind in which they are in a pattern in the end.
    fn orders(&self, of: &ObjectKind, pattern: Pattern) -> Vec<Option<Superlative>> {
        let members = self.before.movable(of);
        let sorted = sorted_in_place(self.end, &members, pattern);
        if members.len() < 2 || !is_laid_out(self.end, &sorted, pattern) {
            return Vec::new();
        }
        let selection = self.before.selection();
        let is_order = |by: &Superlative| {
            let mut pairs = sorted.windows(2);
            pairs.all(|pair| selection.compared(*by, &pair[0], &pair[1]).is_lt())
        };
        let orders = Superlative::ALL.into_iter().filter(is_order).map(Some);
        [None].into_iter().chain(orders).collect()
    }

    /// Swaps of the object with one that comes to its place.
    fn swaps(&self, singles: &[Noun]) -> Vec<Instruction> {
        let id = self.deed.object.as_str();
        let mut later = self.example.deeds.iter().skip(self.at);
        let partner = later.find_map(|deed| match deed.relations.first() {
            Some(Relation::InPlaceOf { object }) if object == id => Some(&deed.object),
            Some(_) | None => None,
        });
        let others = partner.map(|other| self.before.single(other));
        let others = others.unwrap_or_default();
        let pairs = singles.iter().flat_map(|one| {
            others.iter().map(|other| Instruction::Swap {
                one: one.clone(),
                other: other.clone(),
            })
        });
        pairs.collect()
    }

    /// Copies of the objects that are on another side of the table.
    fn copies(&self, sets: &[ObjectKind]) -> Vec<Instruction> {
        let here = self.after.location(&self.deed.object);
        let sides = TableSide::ALL.into_iter().filter(|side| side.has(here));
        let copies = sides.flat_map(|to| {
            let kinds = sets.iter().filter(|kind| kind.restriction.is_none());
            kinds.map(move |kind| Instruction::Copy {
                what: Noun::Described {
                    quantity: HowMany::Every,
                    of: ObjectKind {
                        restriction: Some(Restriction::Where {
                            not: false,
                            spot: Spot::Table {
                                side: Some(to.opposite()),
                            },
                        }),
                        ..kind.clone()
                    },
                },
                to,
            })
        });
        copies.collect()
    }

    /// Loops that put one object of a kind after the other to the same place.
    fn loops(&self, sets: &[ObjectKind]) -> Vec<Sentence> {
        let mut all = Vec::new();
        for Aim { to, is_single } in self.aims() {
            let TargetPlace::Spot(Spot::At { noun: target, .. }) = &to else {
                continue;
            };
            if is_single || !target.is_definite() {
                continue;
            }
            for kind in sets {
                let what = Noun::Described {
                    quantity: HowMany::Any,
                    of: kind.clone(),
                };
                let put = Instruction::Put {
                    what,
                    to: to.clone(),
                    first: None,
                };
                let conditions = self.ends(kind, &to, target).into_iter();
                all.extend(conditions.map(|condition| Sentence::Until {
                    condition,
                    instructions: vec![put.clone()],
                }));
            }
        }
        all
    }

    /// The conditions that hold once objects of a kind are at a place.
    fn ends(&self, kind: &ObjectKind, to: &TargetPlace, target: &Noun) -> Vec<Condition> {
        let TargetPlace::Spot(spot) = to else {
            return Vec::new();
        };
        let end = NounGuess { view: self.end };
        let high = end
            .selection()
            .one(target)
            .ok()
            .map(|id| self.end.levels(&id));
        let high = high
            .filter(|levels| *levels > 2)
            .map(|levels| Condition::IsHigh {
                what: target.clone(),
                count: number(levels),
            });
        let members = self.before.movable(kind);
        let there = members.iter().filter(|id| self.is_there(id, to)).count();
        let full = (there > 1 && kind.restriction.is_none()).then(|| Condition::ThereAre {
            count: number(there),
            of: ObjectKind {
                restriction: Some(Restriction::Where {
                    not: false,
                    spot: spot.clone(),
                }),
                ..kind.clone()
            },
        });
        high.into_iter().chain(full).collect()
    }
}

/// The most columns of a grid that is looked for.
const MOST_COLUMNS: u32 = 4;

fn number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
