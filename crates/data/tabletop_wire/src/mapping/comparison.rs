//! A mapping beside the robot that is to act, and beside what a server wants.

use super::{
    columns::{ActionColumn, StateColumn},
    error::{MappingError, at_column, instead},
    policy_mapping::{MappedActions, MappedCamera, PolicyMapping},
};
use crate::value::{WireMap, WireValue};

/// The names of a robot's parts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RobotNames {
    /// The robot's own.
    pub robot: String,
    /// Its joints and the openings of its grippers.
    pub joints: Vec<String>,
    /// Its limbs.
    pub limbs: Vec<String>,
    /// The cameras in its hands.
    pub cameras: Vec<String>,
}

impl PolicyMapping {
    /// Compares it with the robot that the policy is to act for.
    ///
    /// # Errors
    /// The first thing that this robot does not have: the field, and the nearest name that it has.
    pub fn check_for(&self, names: &RobotNames) -> Result<(), MappingError> {
        if let Some(robot) = self.robot.as_ref().filter(|robot| **robot != names.robot) {
            let fault = format!(
                "it is made for {robot:?}, and the robot is {:?}",
                names.robot
            );
            return Err(MappingError::new("robot", fault));
        }
        let joint = |field: &str, name: &str| require(field, "joint", name, &names.joints);
        let limb = |field: &str, name: &str| require(field, "limb", name, &names.limbs);
        for image in &self.images {
            let field = format!("images, {:?}, camera", image.key);
            match &image.camera {
                MappedCamera::Head | MappedCamera::Standing { .. } => {}
                MappedCamera::Hand(name) => {
                    let whole = format!("{name}_camera");
                    let is_known = |known: &String| *known == *name || *known == whole;
                    if !names.cameras.iter().any(is_known) {
                        require(&field, "camera", name, &names.cameras)?;
                    }
                }
                MappedCamera::OnLimb { limb: name, .. } => limb(&field, name)?,
            }
        }
        for state in &self.states {
            let field = format!("states, {:?}", state.key);
            for (number, column) in state.columns.iter().enumerate() {
                let field = at_column(&field, number);
                match column {
                    StateColumn::Joint(it) => joint(&field, &it.name)?,
                    StateColumn::EndEffector { limb: name, .. } => limb(&field, name)?,
                    StateColumn::Constant(_) => {}
                }
            }
        }
        let MappedActions::Columns { columns, .. } = &self.actions else {
            return Ok(());
        };
        for (number, column) in columns.iter().enumerate() {
            let field = at_column("actions", number);
            match column {
                ActionColumn::Position(it) => joint(&field, &it.name)?,
                ActionColumn::Velocity { joint: name, .. } => joint(&field, name)?,
                ActionColumn::Displacement { limb: name, .. } => limb(&field, name)?,
                ActionColumn::Ignored => {}
            }
        }
        Ok(())
    }

    /// Compares it with what a server says that it wants, as far as it says so: `observation`, a map by the keys, and `action`, a map with the `shape`.
    ///
    /// # Errors
    /// The server wants a key that is not sent, or gives actions of other numbers.
    pub fn check_with(&self, metadata: &WireMap) -> Result<(), MappingError> {
        let wanted = metadata.get("observation").and_then(WireValue::map);
        for key in wanted.into_iter().flat_map(WireMap::keys) {
            if !self.keys().any(|known| known == key) {
                let fault = format!(
                    "the server wants it, and the mapping has no such key{}",
                    instead(key, self.keys())
                );
                return Err(MappingError::new(format!("{key:?}"), fault));
            }
        }
        let action = metadata.get("action").and_then(WireValue::map);
        let shape = action.and_then(|action| action.get("shape"));
        let Some(WireValue::List(shape)) = shape else {
            return Ok(());
        };
        let columns = self.actions.columns();
        match shape.last() {
            Some(WireValue::Integer(width)) if usize::try_from(*width) != Ok(columns) => {
                let fault =
                    format!("the mapping has {columns} columns, and the server gives {width}");
                Err(MappingError::new("actions", fault))
            }
            Some(_) | None => Ok(()),
        }
    }
}

fn require(field: &str, kind: &str, name: &str, known: &[String]) -> Result<(), MappingError> {
    if known.iter().any(|known| known == name) {
        return Ok(());
    }
    let others = instead(name, known.iter().map(String::as_str));
    let fault = format!("the robot has no {kind} {name:?}{others}");
    Err(MappingError::new(field, fault))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::mapping::EXAMPLE;

    fn names() -> RobotNames {
        let list = |all: &[&str]| all.iter().map(|it| (*it).to_owned()).collect();
        RobotNames {
            robot: "Any".into(),
            joints: list(&["elbow", "shoulder"]),
            limbs: list(&["arm"]),
            cameras: Vec::new(),
        }
    }

    #[test]
    fn a_robot_lacks_what_is_named() {
        let check = |old: &str, new: &str| {
            let mapping = PolicyMapping::parse(&EXAMPLE.replace(old, new), "a.ron").unwrap();
            mapping.check_for(&names())
        };
        check("elbow", "elbow").unwrap();
        let refusal = check("elbow", "elbov").unwrap_err().to_string();
        assert_eq!(
            refusal,
            "states, \"state\", column 1: the robot has no joint \"elbov\"; did you mean \"elbow\"?"
        );
        let refusal = check("\"arm\"", "\"left_tentacle\"")
            .unwrap_err()
            .to_string();
        assert_eq!(
            refusal,
            "images, \"image\", camera: the robot has no limb \"left_tentacle\", only arm"
        );
        let panda = PolicyMapping::named(Path::new("droid")).unwrap();
        let refusal = panda.check_for(&names()).unwrap_err().to_string();
        assert_eq!(
            refusal,
            "robot: it is made for \"Panda\", and the robot is \"Any\""
        );
    }

    #[test]
    fn a_server_wants_what_is_not_sent() {
        let mapping = PolicyMapping::parse(EXAMPLE, "a.ron").unwrap();
        let with = |key: &str, width: i64| {
            let wanted = WireMap::from([(key.to_owned(), WireValue::Nil)]);
            let shape = WireValue::List(vec![WireValue::Integer(4), WireValue::Integer(width)]);
            let action = WireMap::from([("shape".to_owned(), shape)]);
            let metadata = [("observation", wanted), ("action", action)];
            let metadata = metadata.map(|(key, map)| (key.to_owned(), map.into()));
            mapping.check_with(&metadata.into())
        };
        with("image", 2).unwrap();
        mapping.check_with(&WireMap::new()).unwrap();
        let refusal = with("imagee", 2).unwrap_err().to_string();
        assert_eq!(
            refusal,
            "\"imagee\": the server wants it, and the mapping has no such key; did you mean \"image\"?"
        );
        let refusal = with("image", 7).unwrap_err().to_string();
        assert_eq!(
            refusal,
            "actions: the mapping has 2 columns, and the server gives 7"
        );
    }
}
