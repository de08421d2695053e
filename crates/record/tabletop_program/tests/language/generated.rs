//! Programs and words at random.

use proptest::{option, prelude::*, sample::select};
use tabletop_program::{
    Condition, Feature, HowMany, Instruction, Noun, ObjectKind, Pattern, Preposition, Procedure,
    RelativeSize, Restriction, Sentence, Spot, Superlative, TableSide, TargetPlace, TaskProgram,
};
use tabletop_task::RelativeSide;

const SUPERLATIVES: [Superlative; 11] = [
    Superlative::Largest,
    Superlative::Smallest,
    Superlative::Heaviest,
    Superlative::Lightest,
    Superlative::Tallest,
    Superlative::Shortest,
    Superlative::Leftmost,
    Superlative::Rightmost,
    Superlative::Nearest,
    Superlative::Farthest,
    Superlative::Topmost,
];
const SIDES: [TableSide; 4] = [
    TableSide::Left,
    TableSide::Right,
    TableSide::Front,
    TableSide::Back,
];

fn id() -> impl Strategy<Value = String> {
    select(vec![
        "RedBlock",
        "A",
        "block_2",
        "One",
        "odd id",
        "chest-lid",
        "red",
        "The",
        "it",
    ])
    .prop_map(str::to_owned)
}

fn quantity() -> impl Strategy<Value = HowMany> {
    prop_oneof![
        Just(HowMany::The),
        Just(HowMany::Any),
        Just(HowMany::Every),
        (2..99_u32).prop_map(HowMany::Count),
        (1..20_u32, select(SUPERLATIVES.to_vec()))
            .prop_map(|(count, of)| HowMany::Most { count, of }),
    ]
}

fn preposition() -> impl Strategy<Value = Preposition> {
    select(vec![
        Preposition::On,
        Preposition::Inside,
        Preposition::Around,
        Preposition::Beside(RelativeSide::Left),
        Preposition::Beside(RelativeSide::Right),
        Preposition::Beside(RelativeSide::Front),
        Preposition::Beside(RelativeSide::FrontLeft),
        Preposition::Beside(RelativeSide::FrontRight),
        Preposition::Beside(RelativeSide::Behind),
        Preposition::Beside(RelativeSide::BehindLeft),
        Preposition::Beside(RelativeSide::BehindRight),
    ])
}

fn spot_of(noun: impl Strategy<Value = Noun> + 'static) -> BoxedStrategy<Spot> {
    prop_oneof![
        option::of(select(SIDES.to_vec())).prop_map(|side| Spot::Table { side }),
        (preposition(), noun).prop_map(|(preposition, noun)| Spot::at(preposition, noun)),
    ]
    .boxed()
}

fn restriction(inner: BoxedStrategy<Noun>) -> impl Strategy<Value = Restriction> {
    prop_oneof![
        (any::<bool>(), spot_of(inner.clone()))
            .prop_map(|(not, spot)| Restriction::Where { not, spot }),
        inner.clone().prop_map(|noun| Restriction::From {
            whole: Box::new(noun)
        }),
        inner.prop_map(|noun| Restriction::Except {
            others: Box::new(noun)
        }),
        select(vec![Feature::Color, Feature::Shape, Feature::Size])
            .prop_map(|feature| Restriction::OfIts { feature }),
        (
            select(vec!["use", "mass", "radiusTop"]),
            select(vec!["tool", "2", "1..2", "two words", "is"])
        )
            .prop_map(|(property, value)| Restriction::Whose {
                property: property.into(),
                value: value.into()
            }),
    ]
}

fn kind(inner: BoxedStrategy<Noun>) -> BoxedStrategy<ObjectKind> {
    let color =
        select(vec!["red", "blue", "gray", "dark gray", "light gray"]).prop_map(str::to_owned);
    let is =
        select(vec!["object", "block", "box", "tower", "ball", "switch"]).prop_map(str::to_owned);
    let size = select(vec![RelativeSize::Small, RelativeSize::Large]);
    (
        any::<bool>(),
        option::of(size),
        option::of(color),
        is,
        option::of(restriction(inner)),
    )
        .prop_map(|(other, size, color, is, restriction)| ObjectKind {
            other,
            size,
            color,
            is,
            restriction,
        })
        .boxed()
}

fn noun() -> BoxedStrategy<Noun> {
    let named = id().prop_map(Noun::named).boxed();
    named
        .prop_recursive(3, 8, 1, |inner| {
            (quantity(), kind(inner)).prop_map(|(quantity, of)| Noun::Described { quantity, of })
        })
        .boxed()
}

fn place() -> impl Strategy<Value = TargetPlace> {
    let pattern = prop_oneof![
        Just(Pattern::Tower),
        Just(Pattern::Row),
        Just(Pattern::Column),
        (2..9_u32).prop_map(Pattern::Grid),
    ];
    prop_oneof![
        spot_of(noun()).prop_map(TargetPlace::Spot),
        (-100..100_i16, -100..100_i16).prop_map(|(x, y)| TargetPlace::Location {
            x: f32::from(x) / 8.0,
            y: f32::from(y) / 10.0
        }),
        Just(TargetPlace::Aside),
        noun().prop_map(|noun| TargetPlace::PlaceOf { noun }),
        (pattern, option::of(spot_of(noun())))
            .prop_map(|(pattern, at)| TargetPlace::Arranged { pattern, at }),
    ]
}

fn is_one(noun: &Noun) -> bool {
    match noun {
        Noun::Named { .. } => true,
        Noun::Described { quantity, .. } => {
            matches!(quantity, HowMany::The | HowMany::Most { count: 1, .. })
        }
    }
}

fn instruction() -> BoxedStrategy<Instruction> {
    let first = || option::of(select(SUPERLATIVES.to_vec()));
    prop_oneof![
        4 => (noun(), place(), first())
            .prop_filter("one object is no pattern", |(what, to, _)| {
                !is_one(what) || !matches!(to, TargetPlace::Arranged { at: None, .. })
            })
            .prop_map(|(what, to, first)| Instruction::Put { what, to, first }),
        1 => (noun(), first()).prop_map(|(what, first)| Instruction::Remove { what, first }),
        1 => noun().prop_map(|what| Instruction::Open { what }),
        1 => noun().prop_map(|what| Instruction::Close { what }),
        1 => (noun(), noun()).prop_map(|(one, other)| Instruction::Swap { one, other }),
        1 => (noun(), noun(), noun()).prop_map(|(from, to, by)| Instruction::MoveTower { from, to, by }),
        1 => (noun(), select(SIDES.to_vec())).prop_map(|(what, to)| Instruction::Copy { what, to }),
        1 => proptest::collection::vec(noun(), 0..3)
            .prop_map(|with| Instruction::Call { verb: "pack".into(), with }),
    ]
    .boxed()
}

fn condition() -> impl Strategy<Value = Condition> {
    let kind = || kind(noun());
    prop_oneof![
        (noun(), any::<bool>(), spot_of(noun())).prop_map(|(what, not, spot)| Condition::Is {
            what,
            not,
            spot
        }),
        noun().prop_map(|what| Condition::IsOpen { what }),
        noun().prop_map(|what| Condition::IsClosed { what }),
        (noun(), 2..99_u32).prop_map(|(what, count)| Condition::IsHigh { what, count }),
        kind().prop_map(|of| Condition::ThereIsNo { of }),
        (1..99_u32, kind()).prop_map(|(count, of)| Condition::ThereAre { count, of }),
        (kind(), kind()).prop_map(|(of, than)| Condition::ThereAreMore { of, than }),
    ]
}

fn sentence() -> impl Strategy<Value = Sentence> {
    let some = || proptest::collection::vec(instruction(), 1..3);
    let perhaps = proptest::collection::vec(instruction(), 0..2);
    prop_oneof![
        2 => some().prop_map(|instructions| Sentence::Do { instructions }),
        1 => (condition(), some(), perhaps)
            .prop_map(|(condition, then, otherwise)| Sentence::If { condition, then, otherwise }),
        1 => (condition(), some())
            .prop_map(|(condition, instructions)| Sentence::Until { condition, instructions }),
    ]
}

/// A program that defines the verb which its sentences may use.
pub fn program() -> impl Strategy<Value = TaskProgram> {
    let some = || proptest::collection::vec(sentence(), 1..3);
    (proptest::collection::vec(id(), 0..3), some(), some()).prop_map(
        |(objects, body, sentences)| {
            let pack = Procedure {
                verb: "pack".into(),
                objects,
                sentences: body,
            };
            TaskProgram {
                procedures: vec![pack],
                sentences,
            }
        },
    )
}

/// A word or a mark of the grammar, or none.
pub fn word() -> impl Strategy<Value = String> {
    let words = "put every the red block blocks on into box that is not table until if , . ; it six high all each other \
        first largest from to left side of its colour where was aside in a row there are more than whose ( ) 1 -2 xyzzy \" swap and then";
    select(
        words
            .split(' ')
            .filter(|word| !word.is_empty())
            .map(str::to_owned)
            .collect::<Vec<_>>(),
    )
}
