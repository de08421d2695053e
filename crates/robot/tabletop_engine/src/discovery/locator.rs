//! Finds the engine that runs the scripts.

use std::{
    env,
    path::{Path, PathBuf},
};

use crate::{
    discovery::choice::{ENGINE_VARIABLE, EngineChoice},
    discovery::platform::{Platform, is_program, matching},
    error::EngineError,
    kind::EngineKind,
};

/// An engine that is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundEngine {
    /// Its kind.
    pub kind: EngineKind,
    /// Its program.
    pub program: PathBuf,
}

/// Finds engines: in the folders of PATH, then where each platform usually has them.
#[derive(Clone, Debug)]
pub struct EngineLocator {
    /// The platform.
    pub platform: Platform,
    /// The folders of PATH.
    pub path: Vec<PathBuf>,
    /// The value of the variable `TABLETOP_ENGINE`.
    pub variable: Option<String>,
    /// The root of the file system, under which the usual places are.
    pub root: PathBuf,
}

impl EngineLocator {
    /// Those of this process.
    pub fn system() -> Self {
        let platform = Platform::here();
        let drive = || env::var("SystemDrive").map(|drive| PathBuf::from(drive + "\\"));
        Self {
            platform,
            path: env::var_os("PATH").map_or(Vec::new(), |path| env::split_paths(&path).collect()),
            variable: env::var(ENGINE_VARIABLE).ok(),
            root: match platform {
                Platform::Windows => drive().unwrap_or_else(|_| "C:\\".into()),
                Platform::Linux | Platform::MacOs => "/".into(),
            },
        }
    }

    /// The engine that was asked for.
    ///
    /// # Errors
    /// It is not there; the message says what to do.
    pub fn find(&self, choice: &EngineChoice) -> Result<FoundEngine, EngineError> {
        match choice {
            EngineChoice::Kind(kind) => self
                .find_kind(*kind)
                .ok_or_else(|| self.not_found(&[*kind])),
            EngineChoice::Program(program) => self.find_program(program),
            EngineChoice::Driver(program) => Ok(FoundEngine {
                kind: EngineKind::Driver,
                program: self.program(program)?,
            }),
            EngineChoice::Auto => match &self.variable {
                Some(variable) if !matches!(variable.as_str(), "" | "auto") => {
                    let Ok(choice) = variable.parse::<EngineChoice>();
                    if choice == EngineChoice::Auto {
                        return self.first();
                    }
                    self.find(&choice).map_err(|error| {
                        EngineError::NotFound(format!("{ENGINE_VARIABLE}: {error}"))
                    })
                }
                _ => self.first(),
            },
        }
    }

    fn first(&self) -> Result<FoundEngine, EngineError> {
        let kinds = [EngineKind::Matlab, EngineKind::Octave];
        let mut found = kinds.iter().filter_map(|kind| self.find_kind(*kind));
        found.next().ok_or_else(|| self.not_found(&kinds))
    }

    fn find_kind(&self, kind: EngineKind) -> Option<FoundEngine> {
        let usual = kind.usual_places(self.platform).iter();
        let usual = usual.flat_map(|place| matching(&self.root, place));
        let mut folders = self.path.iter().cloned().chain(usual);
        let program = folders.find_map(|folder| self.program_in(&folder, kind))?;
        Some(FoundEngine { kind, program })
    }

    fn program_in(&self, folder: &Path, kind: EngineKind) -> Option<PathBuf> {
        let mut programs = kind
            .programs(self.platform)
            .iter()
            .map(|name| folder.join(name));
        programs.find(|program| is_program(program))
    }

    fn find_program(&self, program: &Path) -> Result<FoundEngine, EngineError> {
        let kinds = [EngineKind::Matlab, EngineKind::Octave, EngineKind::Python];
        if program.is_dir() {
            let folders = [program.to_owned(), program.join("bin")];
            let found = kinds.iter().find_map(|kind| {
                let program = folders
                    .iter()
                    .find_map(|folder| self.program_in(folder, *kind))?;
                Some(FoundEngine {
                    kind: *kind,
                    program,
                })
            });
            return found.ok_or_else(|| {
                EngineError::NotFound(format!(
                    "there is no MATLAB, Octave or Python in {}",
                    program.display()
                ))
            });
        }
        let found = self.program(program)?;
        let name = program
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase();
        let kind = kinds.into_iter().find(|kind| {
            name.contains(match kind {
                EngineKind::Matlab => "matlab",
                EngineKind::Octave => "octave",
                EngineKind::Python => "python",
                EngineKind::Driver => return false,
            })
        });
        match kind {
            Some(kind) => Ok(FoundEngine {
                kind,
                program: found,
            }),
            None => Err(EngineError::NotFound(format!(
                "{} is a program, but its name does not identify its engine: it must contain matlab, octave or python",
                program.display()
            ))),
        }
    }

    /// A program by its path, or by its name on PATH.
    fn program(&self, program: &Path) -> Result<PathBuf, EngineError> {
        let shown = program.display();
        let is_bare = program.components().count() == 1;
        let mut on_path = self.path.iter().map(|folder| folder.join(program));
        let found = match is_bare {
            true => on_path.find(|program| is_program(program)),
            false => is_program(program).then(|| program.to_owned()),
        };
        found.ok_or_else(|| {
            EngineError::NotFound(if is_bare {
                format!("there is no program \"{shown}\" on PATH; an engine is auto, matlab, octave, python or the path of a program")
            } else if program.exists() {
                format!("{shown} cannot be run")
            } else {
                format!("there is no program {shown}")
            })
        })
    }

    fn not_found(&self, kinds: &[EngineKind]) -> EngineError {
        let names: Vec<_> = kinds.iter().map(EngineKind::to_string).collect();
        let help = match (kinds, self.platform) {
            ([EngineKind::Matlab], _) => {
                "install it, add its bin folder to PATH, or say --engine octave"
            }
            ([EngineKind::Python], Platform::Windows) => {
                "install it from https://www.python.org/downloads"
            }
            ([EngineKind::Python], Platform::MacOs) => "install it with \"brew install python\"",
            ([EngineKind::Python], Platform::Linux) => "install python3 with your package manager",
            (_, Platform::Linux) => {
                "install Octave, which is free, with \"sudo apt install octave\" (Debian, Ubuntu), \"sudo dnf install octave\" \
                 (Fedora) or \"sudo pacman -S octave\" (Arch)"
            }
            (_, Platform::MacOs) => "install Octave, which is free, with \"brew install octave\"",
            (_, Platform::Windows) => {
                "install Octave, which is free, with \"winget install GNU.Octave\" or from https://octave.org/download"
            }
        };
        let there = if kinds.len() > 1 {
            "neither is"
        } else {
            "it is not"
        };
        let message = format!(
            "{} runs scripts, but {there} there: {help}",
            names.join(" or ")
        );
        EngineError::NotFound(message)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// A file system with programs in it.
    struct Disk(PathBuf);

    impl Disk {
        fn new(name: &str, programs: &[&str]) -> Self {
            let root = env::temp_dir().join(format!("tabletop-find-{name}-{}", std::process::id()));
            for program in programs {
                let program = root.join(program);
                fs::create_dir_all(program.parent().unwrap()).unwrap();
                fs::write(&program, "").unwrap();
                #[cfg(unix)]
                {
                    use std::os::unix::fs::PermissionsExt as _;
                    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
                }
            }
            Self(root)
        }

        fn surroundings(&self, platform: Platform) -> EngineLocator {
            EngineLocator {
                platform,
                path: vec![self.0.join("path")],
                variable: None,
                root: self.0.clone(),
            }
        }

        fn find(&self, platform: Platform, choice: &str) -> Result<String, String> {
            let choice = choice.parse().unwrap();
            self.relative(self.surroundings(platform).find(&choice))
        }

        fn relative(&self, found: Result<FoundEngine, EngineError>) -> Result<String, String> {
            let found = found.map_err(|error| error.to_string())?;
            let program = found.program.strip_prefix(&self.0).unwrap();
            Ok(format!("{}: {}", found.kind, program.display()))
        }
    }

    impl Drop for Disk {
        fn drop(&mut self) {
            drop(fs::remove_dir_all(&self.0));
        }
    }

    #[test]
    fn matlab_comes_first_and_the_newest_of_it() {
        let octave = "path/octave-cli";
        let old = "usr/local/MATLAB/R2019b/bin/matlab";
        let new = "usr/local/MATLAB/R2023a/bin/matlab";
        let disk = Disk::new("first", &[octave, old, new]);
        assert_eq!(
            disk.find(Platform::Linux, "auto").unwrap(),
            format!("MATLAB: {new}")
        );
        assert_eq!(
            disk.find(Platform::Linux, "octave").unwrap(),
            format!("GNU Octave: {octave}")
        );
    }

    #[test]
    fn the_usual_places_of_other_platforms_are_known() {
        let nine = "Program Files/GNU Octave/Octave-9.1.0/mingw64/bin/octave-cli.exe";
        let ten = "Program Files/GNU Octave/Octave-10.1.0/mingw64/bin/octave-cli.exe";
        let mac = "Applications/MATLAB_R2024b.app/bin/matlab";
        let disk = Disk::new("places", &[nine, ten, mac]);
        assert_eq!(
            disk.find(Platform::Windows, "auto").unwrap(),
            format!("GNU Octave: {ten}")
        );
        assert_eq!(
            disk.find(Platform::MacOs, "auto").unwrap(),
            format!("MATLAB: {mac}")
        );
    }

    #[test]
    fn an_explicit_choice_wins_over_the_variable() {
        let disk = Disk::new(
            "variable",
            &["path/octave-cli", "path/matlab", "mine/octave-cli-8"],
        );
        let mut surroundings = disk.surroundings(Platform::Linux);
        surroundings.variable = Some("octave".into());
        let find = |choice| disk.relative(surroundings.find(&choice)).unwrap();
        assert_eq!(find(EngineChoice::Auto), "GNU Octave: path/octave-cli");
        assert_eq!(
            find(EngineChoice::Kind(EngineKind::Matlab)),
            "MATLAB: path/matlab"
        );
        let mine = EngineChoice::Program(disk.0.join("mine/octave-cli-8"));
        assert_eq!(find(mine), "GNU Octave: mine/octave-cli-8");
        assert_eq!(
            find(EngineChoice::Program(disk.0.join("path"))),
            "MATLAB: path/matlab"
        );
        assert_eq!(
            find(EngineChoice::Program("octave-cli".into())),
            "GNU Octave: path/octave-cli"
        );
    }

    #[test]
    fn a_driver_may_have_any_name_and_an_engine_must_say_which_it_is() {
        let disk = Disk::new("driver", &["path/lua", "mine/lua"]);
        let mut surroundings = disk.surroundings(Platform::Linux);
        let driver = |path: PathBuf| {
            disk.relative(surroundings.find(&EngineChoice::Driver(path)))
                .unwrap()
        };
        assert_eq!(driver("lua".into()), "a driver: path/lua");
        assert_eq!(driver(disk.0.join("mine/lua")), "a driver: mine/lua");
        surroundings.variable = Some("lua".into());
        let fault = surroundings.find(&EngineChoice::Auto).unwrap_err();
        let message =
            "TABLETOP_ENGINE: lua is a program, but its name does not identify its engine";
        assert!(fault.to_string().starts_with(message), "{fault}");
    }

    #[test]
    fn a_missing_engine_is_reported_with_a_remedy() {
        let disk = Disk::new("missing", &[]);
        let fault = disk.find(Platform::Linux, "auto").unwrap_err();
        assert!(
            fault.contains("neither is there") && fault.contains("apt install octave"),
            "{fault}"
        );
        assert!(
            disk.find(Platform::MacOs, "octave")
                .unwrap_err()
                .contains("brew install octave")
        );
        assert!(
            disk.find(Platform::Windows, "octave")
                .unwrap_err()
                .contains("winget")
        );
        assert!(
            disk.find(Platform::Linux, "scilab")
                .unwrap_err()
                .contains("no program \"scilab\" on PATH; an engine is auto")
        );
        assert!(
            disk.find(Platform::Linux, "/x/octave")
                .unwrap_err()
                .contains("no program /x/octave")
        );
    }
}
