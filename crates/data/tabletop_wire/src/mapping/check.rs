//! What makes no sense in a mapping, whatever the robot is.

use std::collections::BTreeSet;

use super::{
    columns::{ActionColumn, ScaledJoint, StateColumn},
    error::at_column,
    policy_mapping::{MappedActions, MappedCamera, MappedImage, PolicyMapping},
};

/// The most pictures, and states, of an observation.
const MOST_PARTS: usize = 16;
/// The most numbers of a state or an action.
const MOST_COLUMNS: usize = 100;
/// The most bytes of all pictures together, so that they fit into a frame.
const MOST_PICTURE_BYTES: u64 = 48 << 20;
/// The most actions a second: one a tick.
const MOST_RATE: u32 = 60;
/// The most actions that are carried out before the policy is asked again.
const MOST_HORIZON: usize = 1000;
/// The greatest number in a mapping.
const GREATEST: f64 = 1e6;

/// The field, and its fault.
type FieldFault = (String, String);

impl PolicyMapping {
    /// What makes no sense whatever the robot is.
    pub(super) fn check_itself(&self) -> Result<(), FieldFault> {
        let parts = [("images", self.images.len()), ("states", self.states.len())];
        for (field, count) in parts {
            if count > MOST_PARTS {
                let fault = format!("{count} of them, expected at most {MOST_PARTS}");
                return Err((field.into(), fault));
            }
        }
        let mut keys = BTreeSet::new();
        for key in self.keys() {
            if key.is_empty() || !keys.insert(key) {
                let fault = match key.is_empty() {
                    true => "a key must have letters",
                    false => "the key is there twice",
                };
                return Err((format!("{key:?}"), fault.into()));
            }
        }
        for image in &self.images {
            image
                .check()
                .map_err(|fault| (format!("images, {:?}", image.key), fault))?;
        }
        let sizes = self.images.iter().filter_map(|image| image.size);
        let bytes = sizes.map(|(columns, rows)| u64::from(columns) * u64::from(rows) * 3);
        if bytes.sum::<u64>() > MOST_PICTURE_BYTES {
            let fault = format!("all together have more than {MOST_PICTURE_BYTES} bytes");
            return Err(("images".into(), fault));
        }
        for state in &self.states {
            let field = format!("states, {:?}", state.key);
            check_count(state.columns.len()).map_err(|fault| (field.clone(), fault))?;
            for (number, column) in state.columns.iter().enumerate() {
                let checked = match column {
                    StateColumn::Joint(joint) => joint.check(),
                    StateColumn::EndEffector { plus, .. } => check_number("plus", *plus),
                    StateColumn::Constant(number) => check_number("the constant", *number),
                };
                checked.map_err(|fault| (at_column(&field, number), fault))?;
            }
        }
        match &self.actions {
            MappedActions::Columns { .. } if self.objects.is_some() => Err((
                "objects".into(),
                "they are told to policies that say which of them is to be put where (Places)"
                    .into(),
            )),
            MappedActions::Columns { .. } => self.actions.check(),
            MappedActions::Places => {
                let is_head = |image: &MappedImage| image.camera == MappedCamera::Head;
                match (&self.images[..], &self.objects) {
                    ([image], _) if is_head(image) && self.states.is_empty() => Ok(()),
                    ([], Some(_)) if self.states.is_empty() => Ok(()),
                    _ => Err((
                        "actions".into(),
                        "Places are decided by one picture of the head camera or by objects, and not by states"
                            .into(),
                    )),
                }
            }
        }
    }
}

impl MappedActions {
    fn check(&self) -> Result<(), FieldFault> {
        let Self::Columns {
            rate,
            horizon,
            columns,
        } = self
        else {
            return Ok(());
        };
        let fault = |fault: String| ("actions".to_owned(), fault);
        if !(1..=MOST_RATE).contains(rate) {
            return Err(fault(format!("rate is {rate}, expected 1 to {MOST_RATE}")));
        }
        if !(1..=MOST_HORIZON).contains(horizon) {
            return Err(fault(format!(
                "horizon is {horizon}, expected 1 to {MOST_HORIZON}"
            )));
        }
        check_count(columns.len()).map_err(fault)?;
        for (number, column) in columns.iter().enumerate() {
            let checked = match column {
                ActionColumn::Position(joint) => joint.check(),
                ActionColumn::Velocity { scale, .. } | ActionColumn::Displacement { scale, .. } => {
                    check_number("scale", *scale)
                }
                ActionColumn::Ignored => Ok(()),
            };
            checked.map_err(|fault| (at_column("actions", number), fault))?;
        }
        Ok(())
    }
}

impl MappedImage {
    fn check(&self) -> Result<(), String> {
        let sides = [("size", self.size), ("aspect", self.aspect)];
        for (field, pair) in sides {
            let is_wrong = |side: u32| !(1..=Self::LONGEST_SIDE).contains(&side);
            if let Some((columns, rows)) = pair.filter(|pair| is_wrong(pair.0) || is_wrong(pair.1))
            {
                return Err(format!(
                    "{field} is ({columns}, {rows}), expected 1 to {}",
                    Self::LONGEST_SIDE
                ));
            }
        }
        let three = |field, at: &(f32, f32, f32)| {
            let each = [at.0, at.1, at.2];
            each.iter()
                .try_for_each(|part| check_number(field, f64::from(*part)))
        };
        let angle = |fov: f32| match (0.001..=3.1).contains(&fov) {
            true => Ok(()),
            false => Err(format!("fov is {fov}, expected 0.001 to 3.1 rad")),
        };
        let is_own = match &self.camera {
            MappedCamera::Head => true,
            MappedCamera::Hand(_) => false,
            MappedCamera::Standing { at, looks_at, fov } => {
                three("at", at)?;
                three("looks_at", looks_at)?;
                angle(*fov)?;
                if at == looks_at {
                    return Err("it stands where it looks at".into());
                }
                false
            }
            MappedCamera::OnLimb { at, tilt, fov, .. } => {
                three("at", at)?;
                check_number("tilt", f64::from(*tilt))?;
                angle(*fov)?;
                false
            }
        };
        match (self.size, &self.numbers) {
            (None, _) if !is_own => Err("size is missing: only the head camera has its own".into()),
            (None, _) if self.aspect.is_some() => Err("size is missing, which aspect needs".into()),
            (_, Some(_)) if !is_own => {
                Err("numbers: only those of the head camera are known".into())
            }
            (Some(_) | None, _) => Ok(()),
        }
    }
}

impl ScaledJoint {
    fn check(&self) -> Result<(), String> {
        check_number("zero", self.zero)?;
        check_number("one", self.one)?;
        match (self.one - self.zero).abs() < 1.0 / GREATEST {
            true => Err("zero and one are the same position".into()),
            false => Ok(()),
        }
    }
}

fn check_count(columns: usize) -> Result<(), String> {
    match (1..=MOST_COLUMNS).contains(&columns) {
        true => Ok(()),
        false => Err(format!("{columns} columns, expected 1 to {MOST_COLUMNS}")),
    }
}

fn check_number(field: &str, number: f64) -> Result<(), String> {
    match number.abs() <= GREATEST {
        true => Ok(()),
        false => Err(format!("{field} is {number}, expected at most {GREATEST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::EXAMPLE;

    #[test]
    fn a_fault_names_the_field_and_the_nearest_name() {
        PolicyMapping::parse(EXAMPLE, "a.ron").unwrap();
        for (old, new, fault) in [
            (
                "images:",
                "image:",
                "a.ron:2:5: there is no field \"image\"; did you mean \"images\"?",
            ),
            (
                "\"state\"",
                "\"image\"",
                "a.ron: \"image\": the key is there twice",
            ),
            (
                "rate: 20",
                "rate: 0",
                "a.ron: actions: rate is 0, expected 1 to 60",
            ),
            ("horizon: 4", "horizon: 0", "a.ron: actions: horizon is 0"),
            ("fov: 1", "fov: 4", "a.ron: images, \"image\": fov is 4"),
            (
                ", size: (8, 8)",
                "",
                "a.ron: images, \"image\": size is missing",
            ),
            (
                "(8, 8)",
                "(8, 9999)",
                "a.ron: images, \"image\": size is (8, 9999)",
            ),
            (
                "Constant(1)",
                "Constant(inf)",
                "a.ron: states, \"state\", column 2: the constant is inf",
            ),
            (
                "Position(name: \"elbow\"",
                "Position(name: \"elbow\", zero: 1",
                "a.ron: actions, column 1: zero and one are the same position",
            ),
        ] {
            assert!(EXAMPLE.contains(old), "{old}");
            let refusal = PolicyMapping::parse(&EXAMPLE.replacen(old, new, 1), "a.ron");
            let refusal = refusal.unwrap_err().to_string();
            assert!(refusal.starts_with(fault), "{refusal}");
        }
    }

    #[test]
    fn places_are_decided_by_a_picture_or_by_objects() {
        let parse = |fields: &str| {
            let text = format!("PolicyMapping({fields}, actions: Places)");
            let parsed = PolicyMapping::parse(&text, "a.ron");
            parsed.map(drop).map_err(|fault| fault.to_string())
        };
        let image = "images: [(key: \"image\", camera: Head)]";
        assert_eq!(parse(image), Ok(()));
        assert_eq!(parse(&format!("{image}, prompt: \"task\"")), Ok(()));
        assert_eq!(parse("objects: \"objects\", prompt: \"task\""), Ok(()));
        let refusal = parse("prompt: \"task\"").unwrap_err();
        assert!(refusal.contains("or by objects"), "{refusal}");
        let moving = EXAMPLE.replacen("prompt:", "objects: \"objects\", prompt:", 1);
        let refusal = PolicyMapping::parse(&moving, "a.ron").unwrap_err();
        assert!(
            refusal
                .to_string()
                .starts_with("a.ron: objects: they are told")
        );
    }
}
