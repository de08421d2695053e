//! The nouns that may have been meant by an object.

use std::collections::BTreeSet;

use crate::{
    look::is_called,
    noun::{
        Feature, HowMany, Noun, ObjectKind, Preposition, RelativeSize, Restriction, Spot,
        Superlative, TableSide,
    },
    scene::SceneView,
    selection::{ANYTHING, NounSelection},
    words::KINDS,
};

/// The nouns that may have been meant by objects of a table.
pub(crate) struct NounGuess<'a> {
    pub view: &'a SceneView<'a>,
}

impl<'a> NounGuess<'a> {
    pub fn selection(&self) -> NounSelection<'a> {
        const NOTHING: &BTreeSet<String> = &BTreeSet::new();
        NounSelection {
            view: self.view,
            named: NOTHING,
            paired: None,
        }
    }

    /// Nouns that mean this object alone, the shortest first: by its kind, by a comparison, and by its id.
    pub fn single(&self, id: &str) -> Vec<Noun> {
        let kinds = self.kinds(id);
        let the = kinds.iter().map(|of| Noun::Described {
            quantity: HowMany::The,
            of: of.clone(),
        });
        let unique = the.filter(|noun| self.selection().candidates(noun).is_ok());
        let compared = |kind: &&ObjectKind| kind.size.is_none() && kind.is != ANYTHING;
        let most = kinds.iter().filter(compared).flat_map(|of| {
            let all = self.extremes(id, of).into_iter();
            all.map(|most| Noun::Described {
                quantity: HowMany::Most { count: 1, of: most },
                of: of.clone(),
            })
        });
        unique.chain(most).chain([Noun::named(id)]).collect()
    }

    /// The comparisons by which an object comes first among the others of a kind.
    fn extremes(&self, id: &str, kind: &ObjectKind) -> Vec<Superlative> {
        let selection = self.selection();
        let members = selection.members(kind).unwrap_or_default();
        let is_first = |by: &Superlative| {
            let mut others = members.iter().filter(|other| *other != id);
            others.all(|other| selection.compared(*by, id, other).is_lt())
        };
        let all = Superlative::ALL.into_iter();
        all.filter(|by| members.len() > 1 && is_first(by)).collect()
    }

    /// The object with the feature of another one that is put to it.
    pub fn paired(&self, id: &str, with: &str) -> Vec<Noun> {
        let words = self.words(id).into_iter().map(ObjectKind::of);
        let all = words.flat_map(|of| {
            [Feature::Color, Feature::Shape, Feature::Size].map(|feature| Noun::Described {
                quantity: HowMany::The,
                of: ObjectKind {
                    restriction: Some(Restriction::OfIts { feature }),
                    ..of.clone()
                },
            })
        });
        let selection = NounSelection {
            paired: Some(with),
            ..self.selection()
        };
        all.filter(|noun| selection.one(noun).is_ok_and(|one| one == id))
            .collect()
    }

    /// The kinds that an object is by what it is.
    pub fn kinds(&self, id: &str) -> Vec<ObjectKind> {
        let color = self.view.color(id).map(str::to_owned);
        let colors = [None].into_iter().chain(color.map(Some));
        let words = self.words(id);
        let plain = colors.flat_map(|color| {
            words.iter().map(move |word| ObjectKind {
                color: color.clone(),
                ..ObjectKind::of(*word)
            })
        });
        let mut kinds: Vec<_> = plain.collect();
        let sized = kinds.iter().flat_map(|kind| {
            [RelativeSize::Small, RelativeSize::Large].map(|size| ObjectKind {
                size: Some(size),
                ..kind.clone()
            })
        });
        let sized: Vec<_> = sized.filter(|kind| self.is_one(id, kind)).collect();
        kinds.extend(sized);
        kinds
    }

    /// The kinds that an object is by what it is and where it is.
    pub fn sets(&self, id: &str) -> Vec<ObjectKind> {
        let kinds = self.kinds(id);
        let restrictions = self.restrictions(id);
        let restricted = kinds
            .iter()
            .filter(|kind| kind.size.is_none())
            .flat_map(|kind| {
                restrictions.iter().map(|restriction| ObjectKind {
                    restriction: Some(restriction.clone()),
                    ..kind.clone()
                })
            });
        // A restriction to which all are subject says nothing.
        let is_telling = |kind: &ObjectKind| {
            let all = ObjectKind {
                restriction: None,
                ..kind.clone()
            };
            let count = |kind| self.selection().members(kind).map_or(0, |all| all.len());
            count(kind) < count(&all)
        };
        let restricted: Vec<_> = restricted.filter(is_telling).collect();
        kinds.into_iter().chain(restricted).collect()
    }

    /// The objects of a kind that can be moved.
    pub fn movable(&self, kind: &ObjectKind) -> Vec<String> {
        let mut members = self.selection().members(kind).unwrap_or_default();
        members.retain(|id| self.view.is_movable(id));
        members
    }

    fn is_one(&self, id: &str, kind: &ObjectKind) -> bool {
        let members = self.selection().members(kind).unwrap_or_default();
        members.iter().any(|member| member == id)
    }

    fn words(&self, id: &str) -> Vec<&'static str> {
        let Some(object) = self.view.object(id) else {
            return Vec::new();
        };
        let names = KINDS.iter().filter_map(|words| words.first().copied());
        let called = names.filter(|word| *word != ANYTHING && is_called(object, word));
        called.chain([ANYTHING]).collect()
    }

    fn restrictions(&self, id: &str) -> Vec<Restriction> {
        let at = self.view.location(id);
        let is_on_table = self.view.standing.is_on_table(id);
        let sides = TableSide::ALL.into_iter().filter(|side| side.has(at));
        let sides = [None].into_iter().chain(sides.map(Some));
        let tables = sides
            .filter(|_| is_on_table)
            .map(|side| Restriction::Where {
                not: false,
                spot: Spot::Table { side },
            });
        let objects = self.view.scene.objects.iter();
        let others = objects.filter(|other| other.id != id).flat_map(|other| {
            let related = [Preposition::On, Preposition::Inside, Preposition::Around];
            let related = related
                .into_iter()
                .filter(|how| self.selection().is_related(id, *how, &other.id));
            related.flat_map(|how| {
                let nouns = self.single(&other.id).into_iter().take(NOUNS_OF_PLACES);
                nouns.map(move |noun| Restriction::Where {
                    not: false,
                    spot: Spot::at(how, noun),
                })
            })
        });
        let object = self.view.object(id).into_iter();
        let described = object.flat_map(|object| &object.descriptions);
        let described = described
            .filter(|(name, _)| name != "shape")
            .map(|(property, value)| Restriction::Whose {
                property: property.clone(),
                value: value.clone(),
            });
        tables.chain(others).chain(described).collect()
    }
}

/// The most nouns by which a place is called that restricts a set.
const NOUNS_OF_PLACES: usize = 2;
