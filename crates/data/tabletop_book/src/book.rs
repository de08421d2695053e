//! The whole book.

use std::fmt::Write as _;

use pulldown_cmark::Event;

use crate::{
    chapter::BookChapter,
    contents::{PARTS, chapters},
};

const STYLE: &str = include_str!("book.css");
const SCRIPT: &str = include_str!("book.js");

/// The tag that tells the book from other pages.
pub const GENERATOR: &str = "<meta name=\"generator\" content=\"tabletop docs\">";

/// The book as one page of HTML, with everything in it.
pub fn book() -> String {
    let chapters: Vec<_> = chapters().map(BookChapter::of).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{GENERATOR}\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <link rel=\"icon\" href=\"data:,\">\n<title>tabletop</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <nav aria-label=\"Contents\">\n\
         <input id=\"search\" type=\"search\" placeholder=\"Search\" aria-label=\"Search\" autocomplete=\"off\">\n\
         <ol id=\"found\" hidden></ol>\n<div id=\"contents\">\n{}</div>\n</nav>\n\
         <main>\n{}</main>\n<script>{SCRIPT}</script>\n</body>\n</html>\n",
        contents(&chapters),
        articles(&chapters),
    )
}

/// The contents, part by part.
fn contents(chapters: &[BookChapter]) -> String {
    let mut chapters = chapters.iter();
    let mut html = String::new();
    for part in &PARTS {
        let _infallible = writeln!(html, "<h2>{}</h2>\n<ul>", escaped(part.title));
        for chapter in chapters.by_ref().take(part.chapters.len()) {
            let entry = link(&chapter.name, &chapter.title);
            let sections = chapter.sections.iter();
            let sections: String = sections
                .map(|(id, text)| format!("<li>{}</li>\n", link(id, text)))
                .collect();
            let _infallible = writeln!(html, "<li>{entry}\n<ul>\n{sections}</ul>\n</li>");
        }
        html += "</ul>\n";
    }
    html
}

/// The chapters, each with the way to its neighbours.
fn articles(chapters: &[BookChapter]) -> String {
    let mut html = String::new();
    for (i, chapter) in chapters.iter().enumerate() {
        let neighbour = |i: Option<usize>, kind: &str| {
            let chapter = i.and_then(|i| chapters.get(i))?;
            let link = link(&chapter.name, &chapter.title);
            Some(format!("<span class=\"{kind}\">{link}</span>\n"))
        };
        let before = neighbour(i.checked_sub(1), "before").unwrap_or_default();
        let after = neighbour(Some(i + 1), "after").unwrap_or_default();
        let _infallible = writeln!(
            html,
            "<article id=\"{}\">\n{}<footer>{before}{after}</footer>\n</article>",
            chapter.name, chapter.html
        );
    }
    html
}

fn link(id: &str, text: &str) -> String {
    format!("<a href=\"#{id}\">{}</a>", escaped(text))
}

/// A text of whatever letters as HTML.
fn escaped(text: &str) -> String {
    let mut html = String::new();
    pulldown_cmark::html::push_html(&mut html, [Event::Text(text.into())].into_iter());
    html
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// What stands between a mark and the next quotation mark, wherever it does.
    fn all_after<'a>(html: &'a str, mark: &str) -> Vec<&'a str> {
        let parts = html.split(mark).skip(1);
        parts.filter_map(|part| part.split('"').next()).collect()
    }

    #[test]
    fn every_link_leads_to_a_place_of_the_book() {
        let book = book();
        let ids = all_after(&book, " id=\"");
        let places: BTreeSet<_> = ids.iter().copied().collect();
        assert_eq!(places.len(), ids.len(), "two places have the same name");
        let links = all_after(&book, "href=\"#");
        assert!(links.len() > 300, "{}", links.len());
        let dead = links.into_iter().filter(|link| !places.contains(link));
        assert_eq!(dead.collect::<Vec<_>>(), [""; 0]);
    }

    #[test]
    fn every_picture_is_in_it_and_nothing_is_loaded() {
        let book = book();
        let pictures = all_after(&book, "src=\"");
        assert!(pictures.len() > 10);
        assert!(pictures.iter().all(|it| it.starts_with("data:image/")));
    }

    #[test]
    fn chapters_lead_to_their_neighbours() {
        let book = book();
        let tutorial = book.split("<article id=\"tutorial\">").nth(1).unwrap();
        let footer = tutorial.split("<footer>").nth(1).unwrap();
        assert!(footer.starts_with("<span class=\"before\"><a href=\"#readme\">"));
        assert!(footer.contains("<span class=\"after\"><a href=\"#coming-from\">"));
    }
}
