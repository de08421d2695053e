//! The folder in which the commands of a page are carried out, with what a reader has.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use super::page::Page;

/// A folder of a page.
pub struct Place(PathBuf);

/// A command that has ended.
pub struct Ended {
    pub is_success: bool,
    pub stdout: String,
    pub stderr: String,
}

/// A table of the reader's own.
const OWN_TABLE: &str = r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
  <block id="Red" location="(-4,-3,0.25)" xspan="0.5" yspan="0.5" zspan="0.5" color="red"/>
  <block id="Crimson" location="(-2,-4,0.25)" xspan="0.5" yspan="0.5" zspan="0.5" color="red"/>
  <block id="Green" location="(0,-4,0.25)" xspan="0.5" yspan="0.5" zspan="0.5" color="green"/>
  <box id="Box" location="(4,-3,0)" xspan="3" yspan="3" zspan="0.8" color="blue"/>
</tabletop>
"#;

impl Place {
    /// A fresh one for a page.
    pub fn new(page: &Page) -> Self {
        let name = page.file.file_stem().unwrap().to_str().unwrap();
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join("docs")
            .join(name);
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(&folder).unwrap();
        let place = Self(folder);
        place.furnish(page);
        place
    }

    /// Puts what pages take for granted there: the folders of `init`, a table, a recording of the original program, a URDF.
    fn furnish(&self, page: &Page) {
        let at = |path: &str| self.0.join(path);
        fs::write(at("my.xml"), OWN_TABLE).unwrap();
        copy(Path::new("assets"), &at("assets"));
        fs::copy("assets/panda/panda.urdf", at("arm.urdf")).unwrap();
        fs::copy("scenarios/stack_two_blocks.ron", at("scenario.ron")).unwrap();
        let text = fs::read_to_string(at("scenario.ron")).unwrap();
        fs::write(
            at("scenario.ron"),
            text.replace("../tablesetup/", "shipped:tablesetup/"),
        )
        .unwrap();
        for (scenario, out) in [
            ("stack_three", "demo"),
            ("stack_three", "more"),
            ("stack_two_blocks", "two"),
        ] {
            let line = format!("tabletop run scenarios/{scenario}.ron --record {out} --quiet");
            assert!(self.run(&line).is_success, "{line}");
        }
        // The original program has written events alone.
        fs::create_dir(at("old")).unwrap();
        for number in 0.. {
            let name = format!("{number}.txt");
            if fs::copy(at("two").join(&name), at("old").join(&name)).is_err() {
                break;
            }
        }
        let makes_many = |text: &str| text.contains("--out many");
        if !page.commands.iter().any(|it| makes_many(&it.text)) {
            let line = "tabletop multiply demo --count 2 --out many";
            assert!(self.run(line).is_success, "{line}");
        }
    }

    /// Carries out a line of a shell.
    pub fn run(&self, line: &str) -> Ended {
        let program = Path::new(env!("CARGO_BIN_EXE_tabletop"));
        let paths = env::split_paths(&env::var_os("PATH").unwrap_or_default()).collect::<Vec<_>>();
        let paths = [program.parent().unwrap().to_owned()]
            .into_iter()
            .chain(paths);
        let output = Command::new("sh")
            .args(["-c", line])
            .current_dir(&self.0)
            .env("PATH", env::join_paths(paths).unwrap())
            .env("HOME", &self.0)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .stdin(Stdio::null())
            .output()
            .unwrap();
        Ended {
            is_success: output.status.success(),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    pub fn remove(self) {
        fs::remove_dir_all(self.0).unwrap();
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &target),
            false => drop(fs::copy(entry.path(), target).unwrap()),
        }
    }
}
