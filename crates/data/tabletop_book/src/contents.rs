//! The parts of the book, and their chapters in the order in which they are read.

/// A part of the book.
pub(crate) struct BookPart {
    pub title: &'static str,
    /// Paths of the chapters' sources.
    pub chapters: &'static [&'static str],
}

pub(crate) const PARTS: [BookPart; 6] = [
    BookPart {
        title: "Begin",
        chapters: &[
            "README.md",
            "docs/tutorial.md",
            "docs/coming-from.md",
            "docs/troubleshooting.md",
            "docs/glossary.md",
        ],
    },
    BookPart {
        title: "Show and record",
        chapters: &[
            "docs/window.md",
            "docs/demonstrating.md",
            "docs/task-files.md",
            "docs/scenarios.md",
            "docs/recordings.md",
            "docs/films.md",
        ],
    },
    BookPart {
        title: "Understand and learn",
        chapters: &[
            "docs/imitation.md",
            "docs/task-programs.md",
            "docs/multiply.md",
            "docs/eyes.md",
            "docs/learning.md",
            "docs/policies.md",
        ],
    },
    BookPart {
        title: "Data",
        chapters: &[
            "docs/export.md",
            "docs/datasets.md",
            "docs/roads.md",
            "docs/cluster.md",
        ],
    },
    BookPart {
        title: "Robots and programs",
        chapters: &[
            "docs/robot.md",
            "docs/real-robots.md",
            "docs/scripts.md",
            "docs/script-protocol.md",
            "docs/python.md",
        ],
    },
    BookPart {
        title: "Reference",
        chapters: &[
            "docs/controls.md",
            "docs/validation.md",
            "docs/performance.md",
            "docs/decisions.md",
            "ARCHITECTURE.md",
        ],
    },
];

/// The paths of all chapters.
pub(crate) fn chapters() -> impl DoubleEndedIterator<Item = &'static str> {
    PARTS.iter().flat_map(|part| part.chapters.iter().copied())
}

/// The name of a chapter in addresses: that of its file.
pub(crate) fn name(path: &str) -> String {
    let file = path.rsplit('/').next().unwrap_or(path);
    file.trim_end_matches(".md").to_lowercase()
}
