//! The objects of a procedure's call in the place of its names.

use crate::{
    condition::Condition,
    instruction::{Instruction, TargetPlace},
    noun::{Noun, ObjectKind, Restriction, Spot},
    program::{Procedure, Sentence},
};

impl Procedure {
    /// Its sentences about these objects; `None` if their number is another.
    pub(crate) fn with(&self, objects: &[Noun]) -> Option<Vec<Sentence>> {
        let names = ArgumentNames {
            names: &self.objects,
            objects,
        };
        let is_complete = self.objects.len() == objects.len();
        is_complete.then(|| {
            self.sentences
                .iter()
                .map(|one| names.in_sentence(one))
                .collect()
        })
    }
}

struct ArgumentNames<'a> {
    names: &'a [String],
    objects: &'a [Noun],
}

impl ArgumentNames<'_> {
    fn in_sentence(&self, sentence: &Sentence) -> Sentence {
        let all = |instructions: &[Instruction]| -> Vec<_> {
            let all = instructions.iter();
            all.map(|one| self.in_instruction(one)).collect()
        };
        match sentence {
            Sentence::Do { instructions } => Sentence::Do {
                instructions: all(instructions),
            },
            Sentence::If {
                condition,
                then,
                otherwise,
            } => Sentence::If {
                condition: self.in_condition(condition),
                then: all(then),
                otherwise: all(otherwise),
            },
            Sentence::Until {
                condition,
                instructions,
            } => Sentence::Until {
                condition: self.in_condition(condition),
                instructions: all(instructions),
            },
        }
    }

    fn in_instruction(&self, instruction: &Instruction) -> Instruction {
        let noun = |noun: &Noun| self.in_noun(noun);
        match instruction {
            Instruction::Put { what, to, first } => Instruction::Put {
                what: noun(what),
                to: self.in_place(to),
                first: *first,
            },
            Instruction::Remove { what, first } => Instruction::Remove {
                what: noun(what),
                first: *first,
            },
            Instruction::Open { what } => Instruction::Open { what: noun(what) },
            Instruction::Close { what } => Instruction::Close { what: noun(what) },
            Instruction::Swap { one, other } => Instruction::Swap {
                one: noun(one),
                other: noun(other),
            },
            Instruction::MoveTower { from, to, by } => Instruction::MoveTower {
                from: noun(from),
                to: noun(to),
                by: noun(by),
            },
            Instruction::Copy { what, to } => Instruction::Copy {
                what: noun(what),
                to: *to,
            },
            Instruction::Call { verb, with } => Instruction::Call {
                verb: verb.clone(),
                with: with.iter().map(noun).collect(),
            },
        }
    }

    fn in_place(&self, place: &TargetPlace) -> TargetPlace {
        match place {
            TargetPlace::Spot(spot) => TargetPlace::Spot(self.in_spot(spot)),
            TargetPlace::PlaceOf { noun } => TargetPlace::PlaceOf {
                noun: self.in_noun(noun),
            },
            TargetPlace::Arranged { pattern, at } => TargetPlace::Arranged {
                pattern: *pattern,
                at: at.as_ref().map(|at| self.in_spot(at)),
            },
            TargetPlace::Location { .. } | TargetPlace::Aside => place.clone(),
        }
    }

    fn in_condition(&self, condition: &Condition) -> Condition {
        let noun = |noun: &Noun| self.in_noun(noun);
        let kind = |kind: &ObjectKind| self.in_kind(kind);
        match condition {
            Condition::Is { what, not, spot } => Condition::Is {
                what: noun(what),
                not: *not,
                spot: self.in_spot(spot),
            },
            Condition::IsOpen { what } => Condition::IsOpen { what: noun(what) },
            Condition::IsClosed { what } => Condition::IsClosed { what: noun(what) },
            Condition::IsHigh { what, count } => Condition::IsHigh {
                what: noun(what),
                count: *count,
            },
            Condition::ThereIsNo { of } => Condition::ThereIsNo { of: kind(of) },
            Condition::ThereAre { count, of } => Condition::ThereAre {
                count: *count,
                of: kind(of),
            },
            Condition::ThereAreMore { of, than } => Condition::ThereAreMore {
                of: kind(of),
                than: kind(than),
            },
        }
    }

    fn in_noun(&self, noun: &Noun) -> Noun {
        match noun {
            Noun::Named { id } => {
                let name = self.names.iter().position(|name| name == id);
                let object = name.and_then(|name| self.objects.get(name));
                object.unwrap_or(noun).clone()
            }
            Noun::Described { quantity, of } => Noun::Described {
                quantity: *quantity,
                of: self.in_kind(of),
            },
        }
    }

    fn in_kind(&self, kind: &ObjectKind) -> ObjectKind {
        let boxed = |noun: &Noun| Box::new(self.in_noun(noun));
        let restriction = kind
            .restriction
            .as_ref()
            .map(|restriction| match restriction {
                Restriction::Where { not, spot } => Restriction::Where {
                    not: *not,
                    spot: self.in_spot(spot),
                },
                Restriction::From { whole } => Restriction::From {
                    whole: boxed(whole),
                },
                Restriction::Except { others } => Restriction::Except {
                    others: boxed(others),
                },
                Restriction::OfIts { .. } | Restriction::Whose { .. } => restriction.clone(),
            });
        ObjectKind {
            restriction,
            ..kind.clone()
        }
    }

    fn in_spot(&self, spot: &Spot) -> Spot {
        match spot {
            Spot::Table { .. } => spot.clone(),
            Spot::At { preposition, noun } => Spot::at(*preposition, self.in_noun(noun)),
        }
    }
}
