//! Operators of mechanisms.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

use crate::{Hand, LimbName};

/// The operator of a control or a bond.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Operator {
    /// A hand of the demonstrator.
    Hand(Hand),
    /// A limb of the robot.
    Limb(LimbName),
    /// An object, by its id.
    Object(String),
}

/// Prefix of operators in recordings that are limbs.
const LIMB: &str = "robot:";
const OBJECT: &str = "object:";

impl fmt::Display for Operator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hand(hand) => write!(f, "{hand}"),
            Self::Limb(limb) => write!(f, "{LIMB}{limb}"),
            Self::Object(id) => write!(f, "{OBJECT}{id}"),
        }
    }
}

/// The error of a text that is no operator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OperatorError(String);

impl fmt::Display for OperatorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "expected a hand such as LeftHand, {LIMB} with a limb or {OBJECT} with an id, found `{}`",
            self.0
        )
    }
}

impl std::error::Error for OperatorError {}

impl FromStr for Operator {
    type Err = OperatorError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if let Some(hand) = Hand::ALL.into_iter().find(|hand| hand.name() == text) {
            return Ok(Self::Hand(hand));
        }
        if let Some(limb) = text.strip_prefix(LIMB) {
            let limb = LimbName::new(limb).map_err(|_| OperatorError(text.to_owned()))?;
            return Ok(Self::Limb(limb));
        }
        match text.strip_prefix(OBJECT) {
            Some(id) => Ok(Self::Object(id.to_owned())),
            None => Err(OperatorError(text.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operators_read_back() {
        for operator in [
            Operator::Hand(Hand::Left),
            Operator::Limb(LimbName::from_static("left")),
            Operator::Object("robot#1".into()),
        ] {
            assert_eq!(operator.to_string().parse(), Ok(operator));
        }
        assert!("left".parse::<Operator>().is_err());
    }
}
