//! The sources of the book: pages in Markdown and the pictures in them, which are inside the program.

use base64::{Engine as _, engine::general_purpose::STANDARD};
use include_dir::{Dir, include_dir};

static DOCS: Dir = include_dir!("$CARGO_MANIFEST_DIR/../../../docs");

/// The folder of most pages and of all pictures.
const FOLDER: &str = "docs/";

/// The text of a page; `None` if there is none at this path.
pub(crate) fn page(path: &str) -> Option<&'static str> {
    match path {
        "README.md" => Some(include_str!("../../../../README.md")),
        "ARCHITECTURE.md" => Some(include_str!("../../../../ARCHITECTURE.md")),
        _ => DOCS.get_file(path.strip_prefix(FOLDER)?)?.contents_utf8(),
    }
}

/// A picture as an address that holds it; `None` if there is none at this path.
pub(crate) fn picture(path: &str) -> Option<String> {
    let file = DOCS.get_file(path.strip_prefix(FOLDER)?)?;
    let kind = match file.path().extension()?.to_str()? {
        "png" => "png",
        "svg" => "svg+xml",
        _ => return None,
    };
    let bytes = STANDARD.encode(file.contents());
    Some(format!("data:image/{kind};base64,{bytes}"))
}

/// The path to which a relative link of a page leads.
pub(crate) fn resolved(page: &str, link: &str) -> String {
    let folder = page.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut names: Vec<_> = folder.split('/').filter(|name| !name.is_empty()).collect();
    for name in link.split('/') {
        match name {
            "" | "." => {}
            ".." => {
                names.pop();
            }
            name => names.push(name),
        }
    }
    names.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contents::chapters;

    #[test]
    fn every_page_of_docs_is_one_chapter() {
        let pages = DOCS.files().filter_map(|file| {
            let name = file.path().to_str()?;
            name.ends_with(".md").then(|| format!("{FOLDER}{name}"))
        });
        for page in pages {
            let count = chapters().filter(|chapter| *chapter == page).count();
            assert_eq!(count, 1, "{page}");
        }
        for chapter in chapters() {
            assert!(page(chapter).is_some(), "{chapter}");
        }
    }

    #[test]
    fn links_are_resolved_from_the_folder_of_their_page() {
        assert_eq!(resolved("docs/eyes.md", "robot.md"), "docs/robot.md");
        assert_eq!(resolved("docs/eyes.md", "../README.md"), "README.md");
        assert_eq!(resolved("README.md", "docs/eyes.md"), "docs/eyes.md");
        assert_eq!(resolved("docs/eyes.md", "../src/lib.rs"), "src/lib.rs");
    }
}
