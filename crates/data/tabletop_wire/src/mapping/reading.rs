//! Mappings of files, and those inside the program.

use std::path::Path;

use ron::{Options, extensions::Extensions};
use tabletop_storage::{Symlinks, read_regular_text};

use super::{
    error::{MappingError, fault_of},
    policy_mapping::PolicyMapping,
};

/// The mappings inside the program, by their names.
const SHIPPED: [(&str, &str); 5] = [
    (
        "tabletop",
        include_str!("../../../../../assets/policies/tabletop.ron"),
    ),
    (
        "oracle",
        include_str!("../../../../../assets/policies/oracle.ron"),
    ),
    (
        "droid",
        include_str!("../../../../../assets/policies/droid.ron"),
    ),
    (
        "libero",
        include_str!("../../../../../assets/policies/libero.ron"),
    ),
    (
        "so101",
        include_str!("../../../../../assets/policies/so101.ron"),
    ),
];

/// The most bytes of a mapping's file.
const MOST_BYTES: u64 = 1 << 16;

impl PolicyMapping {
    /// The names of the mappings inside the program.
    pub fn shipped_names() -> impl Iterator<Item = &'static str> {
        SHIPPED.iter().map(|(name, _)| *name)
    }

    /// The mapping inside the program that has this name, or else the one in the file.
    ///
    /// # Errors
    /// There is neither, or it is no mapping.
    pub fn named(name_or_file: &Path) -> Result<Self, MappingError> {
        let is_meant = |known: &str| name_or_file.as_os_str() == known;
        if let Some((name, text)) = SHIPPED.iter().find(|(name, _)| is_meant(name)) {
            return Self::parse(text, &format!("the mapping {name}"));
        }
        let place = name_or_file.display().to_string();
        let text = read_regular_text(name_or_file, MOST_BYTES, Symlinks::Followed);
        let text = text.map_err(|error| {
            let names: Vec<_> = Self::shipped_names().collect();
            let names = names.join(", ");
            MappingError::new(
                &place,
                format!("{error}; it is neither a file nor one of {names}"),
            )
        })?;
        Self::parse(&text, &place)
    }

    /// The mapping in a text, which refusals call by the name of its place.
    ///
    /// # Errors
    /// It is none, or says what makes no sense.
    pub fn parse(text: &str, place: &str) -> Result<Self, MappingError> {
        let options = Options::default().with_default_extension(
            Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES,
        );
        let mapping: Self = options.from_str(text).map_err(|error| {
            let place = format!("{place}:{}", error.span.start);
            MappingError::new(place, fault_of(&error.code))
        })?;
        mapping
            .check_itself()
            .map_err(|(field, fault)| MappingError::new(format!("{place}: {field}"), fault))?;
        Ok(mapping)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_mappings_are_mappings() {
        for name in PolicyMapping::shipped_names() {
            PolicyMapping::named(Path::new(name)).unwrap();
        }
        let refusal = PolicyMapping::named(Path::new("droidd")).unwrap_err();
        let refusal = refusal.to_string();
        assert!(
            refusal.ends_with(
                "it is neither a file nor one of tabletop, oracle, droid, libero, so101"
            ),
            "{refusal}"
        );
    }

    #[test]
    fn keys_are_those_that_openpi_wants() {
        let droid = PolicyMapping::named(Path::new("droid")).unwrap();
        assert_eq!(
            droid.keys().collect::<Vec<_>>(),
            [
                "observation/exterior_image_1_left",
                "observation/wrist_image_left",
                "observation/joint_position",
                "observation/gripper_position",
                "prompt"
            ]
        );
    }
}
