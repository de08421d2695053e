//! Requirements on the objects that take the roles of a task: the report's "symbolic properties, such as specifying that a block being
//! picked up must be red".

use std::{
    collections::BTreeMap,
    io::ErrorKind,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};
use tabletop_core::ObjectSpec;
use tabletop_geometry::Rgb;
use tabletop_storage::{Storage, Symlinks, WriterLock, read_regular_text};

use crate::{
    noun::color_name,
    possibility::{ImpossibleRequirement, SAME},
    property::{has_value, property},
    role::Role,
    task::Task,
};

/// The requirements on the objects that take a task's roles. They are kept in the file `task.json` in the recording's folder.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Requirements {
    /// Required properties and their values, by role. A role that is missing here takes the object most like the demonstrated one; a
    /// role without properties takes any object.
    pub roles: BTreeMap<String, BTreeMap<String, String>>,
}

/// The error of a requirement or its file.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message says it")]
pub enum RequirementError {
    #[error("{path}: {source}", path = .path.display())]
    Io {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{path}: {source}", path = .path.display())]
    File {
        path: PathBuf,
        source: serde_json::Error,
    },
    #[error("{path}: {role}: {reason}", path = .path.display())]
    OfRole {
        path: PathBuf,
        role: String,
        reason: ImpossibleRequirement,
    },
    #[error("{path}: the demonstration has no object `{role}`; expected one of {known}", path = .path.display())]
    NoRole {
        path: PathBuf,
        role: String,
        known: String,
    },
    #[error(transparent)]
    Impossible(#[from] ImpossibleRequirement),
    #[error(
        "`{text}` is no requirement: expected `name=value`, the name of a property that {noun} has ({known}), or `any`"
    )]
    Unknown {
        text: String,
        noun: String,
        known: String,
    },
}

/// The most bytes of their file that are read.
const MOST_BYTES: u64 = 1 << 20;

/// A change of a recording's requirements. Whoever else changes them meanwhile waits for its end, so that nothing of either is lost.
#[derive(Debug)]
pub struct RequirementEdit {
    /// The requirements.
    pub requirements: Requirements,
    folder: PathBuf,
    _alone: WriterLock,
}

impl RequirementEdit {
    /// Writes the requirements.
    ///
    /// # Errors
    /// As [`write`](Requirements::write).
    pub fn finish(self) -> Result<Requirements, RequirementError> {
        self.requirements.write(&self.folder)?;
        Ok(self.requirements)
    }
}

impl Requirements {
    /// The name of their file in a recording's folder.
    pub const FILE: &str = "task.json";

    /// Reads the requirements of a recording; without a file there are none.
    ///
    /// # Errors
    /// The file is a link, is larger than 1 MiB, cannot be read, or has not the format that [`write`](Self::write) gives it.
    pub fn read(folder: &Path) -> Result<Self, RequirementError> {
        let path = folder.join(Self::FILE);
        let text = match read_regular_text(&path, MOST_BYTES, Symlinks::Refused) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Self::default()),
            Err(source) => return Err(RequirementError::Io { path, source }),
        };
        serde_json::from_str(&text).map_err(|source| RequirementError::File { path, source })
    }

    /// [Reads](Self::read) the requirements of a recording that shows this task.
    ///
    /// # Errors
    /// As of [`read`](Self::read); or no object can meet a requirement, or it is on no object of the demonstration.
    pub fn read_for(task: &Task, folder: &Path) -> Result<Self, RequirementError> {
        let all = Self::read(folder)?;
        let path = || folder.join(Self::FILE);
        for (role, required) in &all.roles {
            if !task.has_object(role) {
                let ids = task.roles.iter().map(|role| role.id.as_str());
                return Err(RequirementError::NoRole {
                    path: path(),
                    role: role.clone(),
                    known: ids.collect::<Vec<_>>().join(", "),
                });
            }
            let mut required = required.iter();
            let checked = required.try_for_each(|(name, value)| task.check(name, value));
            checked.map_err(|reason| RequirementError::OfRole {
                path: path(),
                role: role.clone(),
                reason,
            })?;
        }
        Ok(all)
    }

    /// Begins to change those of a recording.
    ///
    /// # Errors
    /// As [`read`](Self::read); or another program changes them, and the storage is not to wait for it.
    pub fn edit(folder: &Path, storage: &Storage) -> Result<RequirementEdit, RequirementError> {
        let path = folder.join(Self::FILE);
        let lock = WriterLock::of_place(&path, storage);
        let lock = lock.map_err(|source| RequirementError::Io { path, source })?;
        Ok(RequirementEdit {
            requirements: Self::read(folder)?,
            folder: folder.to_owned(),
            _alone: lock,
        })
    }

    /// Writes the requirements to a recording's folder; if there are none, the file is removed.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), RequirementError> {
        let path = folder.join(Self::FILE);
        let failed = |source| RequirementError::Io {
            path: path.clone(),
            source,
        };
        let storage = Storage::default();
        if self.roles.is_empty() {
            return match storage.remove_file(&path) {
                Err(error) if error.kind() != ErrorKind::NotFound => Err(failed(error)),
                _ => Ok(()),
            };
        }
        let text = serde_json::to_string_pretty(self).map_err(|error| failed(error.into()))?;
        let written = storage.replace_name(&path, format!("{text}\n").as_bytes());
        written.map_err(failed)
    }

    /// Adds a requirement: `name=value`, `name` for the demonstrated value, `same=STEP`, or `any` for no requirement at all.
    ///
    /// # Errors
    /// The object has no such property, or no object can have the value.
    pub fn add(&mut self, task: &Task, role: &Role, text: &str) -> Result<(), RequirementError> {
        if text == "any" {
            self.roles.insert(role.id.clone(), BTreeMap::new());
            return Ok(());
        }
        let unknown = || {
            let known: Vec<_> = crate::property::properties(&role.shown)
                .into_iter()
                .map(|(name, _)| name)
                .collect();
            RequirementError::Unknown {
                text: text.to_owned(),
                noun: role.noun.clone(),
                known: known.join(", "),
            }
        };
        match text.split_once('=') {
            Some((name, value)) if !name.trim().is_empty() => {
                self.require(task, role, name.trim(), value.trim())
            }
            Some(_) => Err(unknown()),
            None => {
                let value = property(&role.shown, text).ok_or_else(unknown)?;
                self.require(task, role, text, &value)
            }
        }
    }

    /// Requires a value of a property.
    ///
    /// # Errors
    /// No object can have it.
    pub fn require(
        &mut self,
        task: &Task,
        role: &Role,
        name: &str,
        value: &str,
    ) -> Result<(), RequirementError> {
        task.check(name, value)?;
        let of_role = self.roles.entry(role.id.clone()).or_default();
        of_role.insert(name.to_owned(), value.to_owned());
        Ok(())
    }

    /// Removes the requirement on a property, or all requirements of a role. True if there was one.
    pub fn remove(&mut self, role: &Role, name: Option<&str>) -> bool {
        let Some(name) = name else {
            return self.roles.remove(&role.id).is_some();
        };
        let Some(of_role) = self.roles.get_mut(&role.id) else {
            return false;
        };
        let was_there = of_role.remove(name).is_some();
        if of_role.is_empty() {
            self.roles.remove(&role.id);
        }
        was_there
    }

    /// The properties that an object lacks for a role, as `name value`; empty if it fits, `None` if the role has no requirements.
    pub fn lacks(&self, role: &str, object: &ObjectSpec) -> Option<Vec<String>> {
        let wanted = self
            .roles
            .get(role)?
            .iter()
            .filter(|(name, _)| *name != SAME);
        let lacks = wanted.filter(|(name, wanted)| {
            !property(object, name).is_some_and(|value| has_value(name, &value, wanted))
        });
        Some(
            lacks
                .map(|(name, wanted)| format!("{name} {wanted}"))
                .collect(),
        )
    }

    /// The step whose object a role must take as well.
    pub(crate) fn same_as(&self, role: &str) -> Option<usize> {
        self.roles.get(role)?.get(SAME)?.parse().ok()
    }

    /// Name of a role in sentences, if its requirements determine one.
    pub(crate) fn phrase(&self, role: &str) -> Option<String> {
        let wanted = self.roles.get(role)?;
        if wanted.is_empty() {
            return Some("any object".into());
        }
        let get = |name: &str| wanted.get(name).map(String::as_str);
        let color = get("color").map(|color| match color.parse::<Rgb>() {
            Ok(rgb) if color.starts_with('#') => color_name(rgb),
            _ => color,
        });
        let shape = get("shape").unwrap_or("object");
        let named: Vec<_> = color.into_iter().chain([shape]).collect();
        let others: Vec<_> = wanted
            .iter()
            .filter(|(name, _)| !["color", "shape"].contains(&name.as_str()))
            .map(|(name, value)| match name.as_str() {
                SAME => format!("that is moved in step {value}"),
                "id" => format!("\"{value}\""),
                name => format!("with {name} {value}"),
            })
            .collect();
        let all: Vec<_> = ["the"].into_iter().chain(named).collect();
        Some([&[all.join(" ")][..], &others].concat().join(" "))
    }
}
