//! No two files of a crate need each other, directly or by a detour: who reads one of them need not read the other.
//!
//! The arrows between files are found in their text: a path that begins with `crate`, `self`, `super` or the name of a module
//! below leads to the file that defines the item. A module that declares or re-exports another one does not need it.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use crate::source::{self, Source, Use};

#[test]
fn no_two_files_of_a_crate_need_each_other() {
    for (name, folder) in crates() {
        let modules = Modules::read(&folder);
        assert!(modules.0.contains_key(&Vec::new()), "{name} has no lib.rs");
        let circles = modules.circles();
        assert!(
            circles.is_empty(),
            "files of {name} that need each other: {circles:#?}"
        );
    }
}

/// The crates of this workspace and where their sources are.
fn crates() -> Vec<(String, PathBuf)> {
    let named = |folder: PathBuf| {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        (name, folder.join("src"))
    };
    let mut crates: Vec<_> = source::crates().into_iter().map(named).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    crates.push(("tabletop".to_owned(), root.join("src")));
    crates
}

/// The modules of a crate that are files, by their paths; the crate's root has the empty one.
struct Modules(BTreeMap<Vec<String>, Source>);

type Arrows<'a> = BTreeMap<&'a [String], BTreeSet<Vec<String>>>;

impl Modules {
    fn read(folder: &Path) -> Self {
        let mut modules = BTreeMap::new();
        let mut folders = vec![(folder.to_owned(), Vec::new())];
        while let Some((folder, path)) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let file = entry.unwrap().path();
                let mut path = path.clone();
                let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
                if file.is_dir() {
                    path.push(stem);
                    folders.push((file, path));
                    continue;
                }
                if file.extension().is_none_or(|extension| extension != "rs") || stem == "main" {
                    continue;
                }
                if !matches!(stem.as_str(), "lib" | "mod") {
                    path.push(stem);
                }
                modules.insert(path, Source::parse(&fs::read_to_string(file).unwrap()));
            }
        }
        Self(modules)
    }

    /// The files that need each other, as sorted groups.
    fn circles(&self) -> BTreeSet<Vec<String>> {
        let arrows = self.arrows();
        let mut circles = BTreeSet::new();
        for module in self.0.keys() {
            let ahead = reachable(&arrows, module);
            let circle: Vec<_> = ahead
                .iter()
                .filter(|other| reachable(&arrows, other).contains(module))
                .map(|module| match module.is_empty() {
                    true => "(root)".to_owned(),
                    false => module.join("::"),
                })
                .collect();
            if !circle.is_empty() {
                circles.insert(circle);
            }
        }
        circles
    }

    /// The other files that each file needs.
    fn arrows(&self) -> Arrows<'_> {
        let arrows = self.0.iter().map(|(module, source)| {
            let uses = source.uses.iter().filter(|it| !it.is_public);
            let paths = uses.map(|it| &it.path).chain(&source.paths);
            let needed = paths.filter_map(|path| self.file_of(module, path, 0));
            let needed = needed.filter(|file| file != module).collect();
            (module.as_slice(), needed)
        });
        arrows.collect()
    }

    /// The file that defines the item of a path in a module; none if that is not in this crate.
    fn file_of(&self, module: &[String], path: &[String], depth: usize) -> Option<Vec<String>> {
        if depth > 20 {
            return None;
        }
        let mut file = module.to_owned();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => {
                file.clear();
                rest = &rest[1..];
            }
            "self" | "super" => {
                while let Some(first @ ("self" | "super")) = rest.first().map(String::as_str) {
                    if first == "super" {
                        file.pop();
                    }
                    rest = &rest[1..];
                }
            }
            first => {
                if !self.has(&file, first) {
                    return None;
                }
            }
        }
        while let Some((name, after)) = rest.split_first() {
            if self.has(&file, name) {
                file.push(name.clone());
                rest = after;
                continue;
            }
            return Some(self.through_uses(&file, rest, depth).unwrap_or(file));
        }
        Some(file)
    }

    fn has(&self, module: &[String], child: &str) -> bool {
        let mut path = module.to_owned();
        path.push(child.to_owned());
        self.0.contains_key(&path)
    }

    /// The file that defines a name which a module has from another one.
    fn through_uses(
        &self,
        module: &[String],
        rest: &[String],
        depth: usize,
    ) -> Option<Vec<String>> {
        let source = self.0.get(module)?;
        let (name, after) = rest.split_first()?;
        let named = source.uses.iter().filter(|it| it.name == *name);
        let mut files = named.filter_map(|it: &Use| {
            let path = [&it.path, after].concat();
            self.file_of(module, &path, depth + 1)
        });
        if let Some(file) = files.next() {
            return Some(file);
        }
        if source.items.contains(name) {
            return None;
        }
        let all = source.uses.iter().filter(|it| it.name == "*");
        let mut files = all.filter_map(|it| {
            let within = it.path.split_last()?.1;
            let file = self.file_of(module, &[within, rest].concat(), depth + 1)?;
            self.0.get(&file)?.items.contains(name).then_some(file)
        });
        files.next()
    }
}

/// The files that a file needs, directly or by a detour.
fn reachable(arrows: &Arrows, from: &[String]) -> BTreeSet<Vec<String>> {
    let mut found = BTreeSet::new();
    let mut next = vec![from.to_owned()];
    while let Some(file) = next.pop() {
        for needed in arrows.get(file.as_slice()).into_iter().flatten() {
            if found.insert(needed.clone()) {
                next.push(needed.clone());
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        let modules = files.iter().map(|(path, text)| {
            let path = path.split("::").filter(|name| !name.is_empty());
            (path.map(str::to_owned).collect(), Source::parse(text))
        });
        let circles = Modules(modules.collect()).circles().into_iter();
        circles.map(|circle| circle.join(" ")).collect()
    }

    #[test]
    fn a_circle_is_found_by_any_path() {
        let lib = ("", "mod a; mod b; pub use a::A; pub use b::*;");
        let a = ("a", "use crate::B; pub struct A;");
        assert_eq!(
            circles(&[lib, a, ("b", "pub struct B; fn f(_: super::A) {}")]),
            ["a b"]
        );
        assert_eq!(
            circles(&[lib, a, ("b", "use crate::{a::A as Other}; struct B;")]),
            ["a b"]
        );
        assert_eq!(
            circles(&[lib, a, ("b", "pub struct B;")]),
            Vec::<String>::new()
        );
        let through_root = [
            ("", "mod a; use a::A; pub struct Root;"),
            ("a", "use crate::Root;"),
        ];
        assert_eq!(circles(&through_root), ["(root) a"]);
        let called = [
            ("", "mod a; fn f() { a::g() }"),
            ("a", "fn g() { crate::f() }"),
        ];
        assert_eq!(circles(&called), ["(root) a"]);
    }

    #[test]
    fn the_parent_of_a_module_within_a_file_is_the_file() {
        let root = ("", "mod a; use a::A;");
        let own = ("a", "pub struct A; mod inner { use super::A; }");
        assert_eq!(circles(&[root, own]), Vec::<String>::new());
        let outer = ("a", "pub struct A; mod inner { use super::super::b; }");
        let b = ("b", "use crate::a::A;");
        assert_eq!(circles(&[root, outer, b]), ["a b"]);
    }

    #[test]
    fn declarations_tests_texts_and_comments_are_no_need() {
        let child = (
            "a",
            "use super::Root; // a::A\nconst T: &str = \"use crate::b;\";",
        );
        let root = "pub mod a; pub(crate) use a::A; pub struct Root;\n#[cfg(test)]\nmod tests { use super::a::A; }";
        assert_eq!(circles(&[("", root), child]), Vec::<String>::new());
    }
}
