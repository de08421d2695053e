//! The lines in which a description's links and joints begin.

use crate::outline::Child;

/// Lines of links and joints, in the order in which the text has them.
pub(super) struct Lines {
    links: Vec<usize>,
    joints: Vec<usize>,
}

impl Lines {
    pub(super) fn new(outline: &[Child]) -> Self {
        let of = |tag| {
            let children = outline.iter().filter(|child| child.tag == tag);
            children.map(|child| child.line).collect()
        };
        Self {
            links: of("link"),
            joints: of("joint"),
        }
    }

    pub(super) fn link(&self, index: usize) -> usize {
        self.links.get(index).copied().unwrap_or(1)
    }

    pub(super) fn joint(&self, index: usize) -> usize {
        self.joints.get(index).copied().unwrap_or(1)
    }
}
