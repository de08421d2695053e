//! A chapter: its page as HTML, with links to the other chapters.

use std::collections::BTreeMap;

use pulldown_cmark::{CowStr, Event, HeadingLevel, LinkType, Options, Parser, Tag, TagEnd, html};

use crate::{
    contents::{chapters, name},
    sources::{page, picture, resolved},
};

/// A chapter of the book.
pub(crate) struct BookChapter {
    /// Its name in addresses.
    pub name: String,
    pub title: String,
    /// Its headings below the title that stand in the contents: names in addresses, and texts.
    pub sections: Vec<(String, String)>,
    pub html: String,
}

impl BookChapter {
    /// The chapter that a page is.
    pub fn of(path: &str) -> Self {
        let name = name(path);
        let text = page(path).unwrap_or_default();
        let events: Vec<_> = Parser::new_ext(text, Options::ENABLE_TABLES).collect();
        let headings = headings(&events, &name);
        let mut ids = headings.iter().map(|heading| heading.id.clone());
        let mut is_linked = Vec::new();
        let events = events.into_iter().filter_map(|event| {
            let Event::Start(mut tag) = event else {
                let ends_link = event == Event::End(TagEnd::Link);
                return (!ends_link || is_linked.pop()?).then_some(event);
            };
            if let Tag::Heading { id, .. } = &mut tag {
                *id = ids.next().map(CowStr::from);
            }
            if let Tag::Image { dest_url, .. } = &mut tag
                && let Some(held) = picture(&resolved(path, dest_url))
            {
                *dest_url = held.into();
            }
            if let Tag::Link {
                link_type,
                dest_url,
                ..
            } = &mut tag
            {
                let address = address(path, &name, *link_type, dest_url);
                is_linked.push(address.is_some());
                *dest_url = address?.into();
            }
            Some(Event::Start(tag))
        });
        let mut html = String::new();
        html::push_html(&mut html, events);
        let title = headings.iter().find(|it| it.level == HeadingLevel::H1);
        let title = title.map_or_else(|| name.clone(), |title| title.text.clone());
        let sections = headings
            .into_iter()
            .filter(|heading| heading.level == HeadingLevel::H2)
            .map(|heading| (heading.id, heading.text));
        Self {
            title,
            sections: sections.collect(),
            html,
            name,
        }
    }
}

struct BookHeading {
    level: HeadingLevel,
    id: String,
    text: String,
}

/// The headings of a page. Their names in addresses begin with that of the chapter.
fn headings(events: &[Event], chapter: &str) -> Vec<BookHeading> {
    let mut headings = Vec::new();
    let mut seen = BTreeMap::<String, usize>::new();
    let mut present: Option<(HeadingLevel, String)> = None;
    for event in events {
        match (event, &mut present) {
            (Event::Start(Tag::Heading { level, .. }), _) => {
                present = Some((*level, String::new()));
            }
            (Event::Text(text) | Event::Code(text), Some((_, heading))) => heading.push_str(text),
            (Event::End(TagEnd::Heading(_)), _) => {
                let Some((level, text)) = present.take() else {
                    continue;
                };
                let anchor = anchor(&text);
                let count = seen.entry(anchor.clone()).or_default();
                let id = match *count {
                    0 => format!("{chapter}--{anchor}"),
                    count => format!("{chapter}--{anchor}-{count}"),
                };
                *count += 1;
                headings.push(BookHeading { level, id, text });
            }
            _ => {}
        }
    }
    headings
}

/// The anchor of a heading, as GitHub makes it.
fn anchor(heading: &str) -> String {
    let letters = heading.to_lowercase();
    let letters = letters.chars().filter_map(|letter| match letter {
        ' ' => Some('-'),
        '-' | '_' => Some(letter),
        letter => letter.is_alphanumeric().then_some(letter),
    });
    letters.collect()
}

/// The address in the book of what a link leads to; `None` if it leads to a file that is not in it.
fn address(path: &str, chapter: &str, kind: LinkType, link: &str) -> Option<String> {
    let is_elsewhere = link.contains("://") || link.starts_with("mailto:");
    if is_elsewhere || matches!(kind, LinkType::Autolink | LinkType::Email) {
        return Some(link.to_owned());
    }
    let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
    let chapter = match file {
        "" => chapter.to_owned(),
        file => {
            let file = resolved(path, file);
            name(chapters().find(|chapter| *chapter == file)?)
        }
    };
    Some(match anchor {
        "" => format!("#{chapter}"),
        anchor => format!("#{chapter}--{anchor}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_into_the_book_out_of_it_or_nowhere() {
        let of = |link| address("docs/eyes.md", "eyes", LinkType::Inline, link);
        assert_eq!(of("robot.md").unwrap(), "#robot");
        assert_eq!(
            of("robot.md#another-robot").unwrap(),
            "#robot--another-robot"
        );
        assert_eq!(of("#watching").unwrap(), "#eyes--watching");
        assert_eq!(of("../README.md").unwrap(), "#readme");
        assert_eq!(of("https://bevy.org").unwrap(), "https://bevy.org");
        assert_eq!(of("../src/lib.rs"), None);
    }

    #[test]
    fn anchors_are_those_of_github() {
        assert_eq!(
            anchor("Robot (report 5, 5.1 and 5.2)"),
            "robot-report-5-51-and-52"
        );
        assert_eq!(anchor("`--record`, a_b"), "--record-a_b");
    }
}
