//! The reach of a scenario: the task files that it may name, around it and in folders that the user allows.

use std::path::{Path, PathBuf};

use tabletop_core::{Reach, is_shipped};

/// Name of the folder of scenarios in a working folder, beside the folder of the task files.
const SCENARIOS: &str = "scenarios";

/// The folders in which, including their subfolders, a scenario may name task files.
pub(crate) struct ScenarioReach(Reach);

impl ScenarioReach {
    /// The reach of a scenario in this folder. In a folder `scenarios`, it includes the folders beside that.
    pub fn of(folder: &Path, allowed: &[PathBuf]) -> Self {
        let folder = match folder == Path::new("") {
            true => Path::new("."),
            false => folder,
        };
        let own = folder.canonicalize().ok().map(|folder| {
            let is_in_working_folder = folder.ends_with(SCENARIOS);
            let around = folder.parent().filter(|_| is_in_working_folder);
            around.map(Path::to_owned).unwrap_or(folder)
        });
        Self(Reach::of(own.iter().chain(allowed)))
    }

    /// Checks that the scenario may name this file. A missing file is left to its reader.
    ///
    /// # Errors
    /// The path leads out of the reach; the error says what the user can do.
    pub fn check(&self, file: &Path) -> Result<(), String> {
        match is_shipped(file) || !file.exists() || self.0.contains(file) {
            true => Ok(()),
            false => Err(format!(
                "{} leads out of the folder of the scenario; `--allow-path DIR` lets it name files in DIR",
                file.display()
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_scenario_reaches_the_folders_around_it() {
        let root = std::env::temp_dir().join(format!("tabletop_reach_{}", std::process::id()));
        for file in ["scenarios/a.xml", "tablesetup/b.xml", "else/c.xml"] {
            let file = root.join(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, "").unwrap();
        }
        let [scenarios, elsewhere] = ["scenarios", "else"].map(|name| root.join(name));
        let b = scenarios.join("../tablesetup/b.xml");
        assert_eq!(ScenarioReach::of(&scenarios, &[]).check(&b), Ok(()));
        assert_eq!(
            ScenarioReach::of(&elsewhere, &[]).check(&elsewhere.join("c.xml")),
            Ok(())
        );
        let b = elsewhere.join("../tablesetup/b.xml");
        assert!(ScenarioReach::of(&elsewhere, &[]).check(&b).is_err());
        let allowed = [root.join("tablesetup")];
        assert_eq!(ScenarioReach::of(&elsewhere, &allowed).check(&b), Ok(()));
        assert!(
            ScenarioReach::of(&elsewhere, &allowed)
                .check(Path::new("/etc"))
                .is_err()
        );
        assert_eq!(
            ScenarioReach::of(&elsewhere, &[]).check(&root.join("nothing")),
            Ok(())
        );
        fs::remove_dir_all(root).unwrap();
    }
}
