//! Every command of README.md and docs, in the order of its page, in a fresh folder: it ends as its page says, with the output that its page shows.
//!
//! Numbers of demonstrations, trials and samples are made small. Commands that need a window, a robot or a name of the reader's own are not carried out.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod page;
mod place;

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use self::{
    page::{Documented, Page},
    place::Place,
};

/// README.md and the pages of docs.
fn pages() -> Vec<Page> {
    let docs = fs::read_dir("docs").unwrap();
    let mut files: Vec<PathBuf> = docs.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "md"));
    files.sort();
    files.insert(0, "README.md".into());
    files.iter().map(|file| Page::read(file)).collect()
}

/// Carries out a page. Returns the faults.
fn carry_out(page: &Page) -> Vec<String> {
    let place = Place::new(page);
    let mut faults = Vec::new();
    for documented in page.commands.iter().filter(|it| it.can_be_run()) {
        let Documented { line, text, .. } = documented;
        let at = format!("{}:{line}: {text}", page.file.display());
        let ended = place.run(&documented.made_small());
        let said = format!("{}{}", ended.stdout, ended.stderr);
        match ended.is_success {
            true if documented.fails() => faults.push(format!("{at}\n  is to fail\n{said}")),
            false if !documented.fails() => faults.push(format!("{at}\n  fails\n{said}")),
            true | false => {}
        }
        let missing = documented.claims.iter();
        let missing = missing.filter(|claim| !said.lines().any(|line| line.trim() == claim.trim()));
        let missing: Vec<_> = missing.map(String::as_str).collect();
        if !missing.is_empty() {
            faults.push(format!("{at}\n  does not say {missing:?} but\n{said}"));
        }
    }
    if faults.is_empty() {
        place.remove();
    }
    faults
}

#[test]
fn every_command_of_the_docs_does_what_its_page_says() {
    let pages = pages();
    let (next, faults) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let threads = thread::available_parallelism().map_or(2, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(page) = pages.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let found = carry_out(page);
                    faults.lock().unwrap().extend(found);
                }
            });
        }
    });
    let faults = faults.into_inner().unwrap();
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}

/// A page is found with its commands and its claims.
#[test]
fn commands_and_claims_are_read() {
    let text = "# Page\n\n```\ntabletop run a.ron   # does it\ntabletop explain demo\n```\n\nsays\n\n```\n1. Put it there.\n```\n\n\
        ```\ntabletop tell \"x\"\ntabletop: 1:1: no\n```\n\n| write | `tabletop check my.xml`, `other` |\n\n```xml\n<tabletop x/>\n```\n";
    let page = Page::parse(Path::new("README.md"), text);
    let found: Vec<_> = page
        .commands
        .iter()
        .map(|it| (it.line, it.text.as_str(), it.claims.len(), it.fails()))
        .collect();
    assert_eq!(
        found,
        [
            (4, "tabletop run a.ron", 0, false),
            (5, "tabletop explain demo", 1, false),
            (15, "tabletop tell \"x\"", 1, true),
            (19, "tabletop check my.xml", 0, false),
        ]
    );
}

/// A page on which nothing can be carried out would not be tried at all.
#[test]
fn most_commands_are_carried_out() {
    let pages = pages();
    let commands: Vec<_> = pages.iter().flat_map(|page| &page.commands).collect();
    let run = commands.iter().filter(|it| it.can_be_run()).count();
    assert!(
        run > 60 && run * 10 > commands.len() * 7,
        "{run} of {}",
        commands.len()
    );
}
