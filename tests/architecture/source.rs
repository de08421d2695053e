//! A file of Rust as far as its arrows to other files go.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use crate::FLOORS;

/// The names that a file has from elsewhere, those that it defines, and the paths that it spells out.
#[derive(Default)]
pub struct Source {
    pub uses: Vec<Use>,
    pub items: BTreeSet<String>,
    /// Its types: structures, enumerations and traits, those of modules within it, too.
    pub types: Vec<String>,
    pub paths: Vec<Vec<String>>,
    /// The arguments of its calls of `join`, without texts.
    pub joined: Vec<Vec<String>>,
    /// Its conditions in `#[cfg]`, such as `unix`.
    pub conditions: BTreeSet<String>,
}

/// A name that a file has from elsewhere.
pub struct Use {
    pub is_public: bool,
    pub path: Vec<String>,
    /// The name in this file; `*` for all that is at the path.
    pub name: String,
}

/// Words before the name of a type.
const TYPES: [&str; 3] = ["struct", "enum", "trait"];

/// Words before the name of an item.
const ITEMS: [&str; 9] = [
    "struct", "enum", "union", "trait", "type", "fn", "const", "static", "mod",
];

/// The folders of the crates, floor by floor.
pub fn crates() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates");
    let folders = FLOORS.iter().flat_map(|floor| {
        let entries = fs::read_dir(root.join(floor)).unwrap();
        let mut folders: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
        folders.sort();
        folders
    });
    folders.collect()
}

/// The files of the program, tests apart, by their paths in this workspace.
pub fn program() -> Vec<(PathBuf, Source)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for folder in crates() {
        collect(&folder.join("src"), &mut files);
    }
    collect(&root.join("src"), &mut files);
    let read = |path: PathBuf| {
        let source = Source::parse(&fs::read_to_string(&path).unwrap());
        (path.strip_prefix(root).unwrap().to_owned(), source)
    };
    files.into_iter().map(read).collect()
}

/// The files of Rust below a folder that are no tests.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap_or_default();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|it| it == "rs") && stem != "tests" {
            files.push(path);
        }
    }
}

impl Source {
    pub fn parse(text: &str) -> Self {
        Self::of(&tokens(text))
    }

    fn of(mut rest: &[String]) -> Self {
        let mut source = Self::default();
        let mut is_public = false;
        while let Some(token) = rest.first() {
            if rest.starts_with(&["#", "[", "cfg", "(", "test", ")", "]"].map(String::from)) {
                rest = after_item(&rest[7..]);
                continue;
            }
            if rest.starts_with(&["#", "[", "cfg", "("].map(String::from)) {
                let end = position(rest, "]");
                source.conditions.insert(rest[4..end - 1].concat());
            }
            if rest.starts_with(&[".", "join", "("].map(String::from)) {
                let end = position(rest, ")");
                source.joined.push(rest[3..end].to_vec());
            }
            match token.as_str() {
                "pub" => {
                    rest = after_visibility(&rest[1..]);
                    is_public = true;
                    continue;
                }
                "use" => {
                    let end = position(rest, ";");
                    source.add_uses(&[], &rest[1..end], is_public);
                    rest = &rest[end..];
                }
                "mod" if rest.get(2).is_some_and(|token| token == "{") => {
                    let after = after_item(rest);
                    let inside = &rest[3..rest.len() - after.len()];
                    source.add_inline_module(Self::of(inside));
                    source.items.insert(rest[1].clone());
                    rest = after;
                }
                item if ITEMS.contains(&item) && rest.len() > 1 => {
                    if TYPES.contains(&item) {
                        source.types.push(rest[1].clone());
                    }
                    source.items.insert(rest[1].clone());
                    rest = &rest[1..];
                }
                _ => {
                    let length = path_length(rest);
                    if length > 1 {
                        let path = rest[..length].iter().filter(|token| *token != "::");
                        source.paths.push(path.cloned().collect());
                    }
                    rest = &rest[length.max(1)..];
                }
            }
            is_public = false;
        }
        source
    }

    /// Adds the needs of a module within the file. Its `super` is the file.
    fn add_inline_module(&mut self, module: Self) {
        self.types.extend(module.types);
        self.conditions.extend(module.conditions);
        self.joined.extend(module.joined);
        let uses = module.uses.into_iter().filter(|it| !it.is_public);
        let uses = uses.map(|it| it.path);
        for mut path in module.paths.into_iter().chain(uses) {
            if let Some(first) = path.first_mut().filter(|first| *first == "super") {
                *first = "self".to_owned();
            }
            self.paths.push(path);
        }
    }

    /// Adds the names of a tree such as `a::{b, c::{d as e, *}}`.
    fn add_uses(&mut self, before: &[String], tree: &[String], is_public: bool) {
        if let Some(brace) = tree.iter().position(|token| token == "{") {
            let head = tree[..brace].iter().filter(|token| *token != "::");
            let before: Vec<_> = before.iter().chain(head).cloned().collect();
            let inside = &tree[brace + 1..tree.len() - 1];
            for branch in branches(inside) {
                self.add_uses(&before, branch, is_public);
            }
            return;
        }
        let end = tree.iter().position(|token| token == "as");
        let own = tree[..end.unwrap_or(tree.len())].iter();
        let mut path: Vec<_> = before.to_owned();
        path.extend(own.filter(|token| *token != "::").cloned());
        if path.last().is_some_and(|last| last == "self") && path.len() > 1 {
            path.pop();
        }
        let name = match end {
            Some(end) => tree.get(end + 1),
            None => path.last(),
        };
        if let Some(name) = name.cloned() {
            self.uses.push(Use {
                is_public,
                path,
                name,
            });
        }
    }
}

fn branches(tree: &[String]) -> Vec<&[String]> {
    let mut depth = 0;
    let parts = tree.split(|token| {
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            _ => {}
        }
        depth == 0 && token == ","
    });
    parts.filter(|part| !part.is_empty()).collect()
}

/// Number of tokens of a path at this place: names with `::` between them.
fn path_length(tokens: &[String]) -> usize {
    let is_name = |place: usize| {
        let first = tokens.get(place).and_then(|token| token.chars().next());
        first.is_some_and(|letter| letter.is_alphabetic() || letter == '_')
    };
    if !is_name(0) {
        return 0;
    }
    let mut length = 1;
    while tokens.get(length).is_some_and(|token| token == "::") && is_name(length + 1) {
        length += 2;
    }
    length
}

fn position(tokens: &[String], wanted: &str) -> usize {
    let place = tokens.iter().position(|token| token == wanted);
    place.unwrap_or(tokens.len())
}

fn after_visibility(tokens: &[String]) -> &[String] {
    match tokens.first().is_some_and(|token| token == "(") {
        true => &tokens[(position(tokens, ")") + 1).min(tokens.len())..],
        false => tokens,
    }
}

/// The tokens after an item that ends with a semicolon or a block.
fn after_item(tokens: &[String]) -> &[String] {
    let mut depth = 0;
    for (place, token) in tokens.iter().enumerate() {
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            ";" => {}
            _ => continue,
        }
        if depth == 0 {
            return &tokens[place + 1..];
        }
    }
    &[]
}

/// Names, `::` and single signs; no comments, texts or letters.
fn tokens(text: &str) -> Vec<String> {
    let letters: Vec<char> = text.chars().collect();
    let at = |place: usize| letters.get(place).copied().unwrap_or('\0');
    let is_of_name = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut tokens = Vec::new();
    let mut place = 0;
    while place < letters.len() {
        match at(place) {
            '/' if at(place + 1) == '/' => {
                while place < letters.len() && at(place) != '\n' {
                    place += 1;
                }
            }
            '/' if at(place + 1) == '*' => {
                while place < letters.len() && (at(place), at(place + 1)) != ('*', '/') {
                    place += 1;
                }
                place += 2;
            }
            'r' if matches!(at(place + 1), '"' | '#') && {
                let hashes = (place + 1..).take_while(|place| at(*place) == '#').count();
                at(place + 1 + hashes) == '"'
            } =>
            {
                let hashes = (place + 1..).take_while(|place| at(*place) == '#').count();
                place += hashes + 2;
                let ends = |place: usize| {
                    at(place) == '"' && (1..=hashes).all(|more| at(place + more) == '#')
                };
                while place < letters.len() && !ends(place) {
                    place += 1;
                }
                place += hashes + 1;
            }
            '"' => {
                place += 1;
                while place < letters.len() && at(place) != '"' {
                    place += if at(place) == '\\' { 2 } else { 1 };
                }
                place += 1;
            }
            // A letter, or the name of a lifetime.
            '\'' if at(place + 1) == '\\' => {
                place += 3;
                while place < letters.len() && at(place) != '\'' {
                    place += 1;
                }
                place += 1;
            }
            '\'' if at(place + 2) == '\'' => place += 3,
            ':' if at(place + 1) == ':' => {
                tokens.push("::".to_owned());
                place += 2;
            }
            letter if is_of_name(letter) => {
                let start = place;
                while is_of_name(at(place)) {
                    place += 1;
                }
                tokens.push(letters[start..place].iter().collect());
            }
            letter => {
                if !letter.is_whitespace() {
                    tokens.push(letter.to_string());
                }
                place += 1;
            }
        }
    }
    tokens
}
