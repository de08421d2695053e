//! The tree of links.

use std::collections::HashMap;

use crate::{ModelError, urdf::lines::Lines};

/// The parents of links, by places in the text.
pub(super) struct LinkTree {
    /// The joint that carries each link.
    pub carrier: Vec<Option<usize>>,
    /// The links, each one after the link that it hangs on.
    pub order: Vec<usize>,
}

impl LinkTree {
    pub fn new(
        lines: &Lines,
        robot: &urdf_rs::Robot,
        link_of: &HashMap<&str, usize>,
    ) -> Result<Self, ModelError> {
        let mut carrier: Vec<Option<usize>> = vec![None; robot.links.len()];
        let mut children = vec![Vec::new(); robot.links.len()];
        for (index, joint) in robot.joints.iter().enumerate() {
            let end = |link: &str| {
                link_of
                    .get(link)
                    .copied()
                    .ok_or_else(|| ModelError::MissingLink {
                        line: lines.joint(index),
                        joint: joint.name.clone(),
                        link: link.to_owned(),
                    })
            };
            let (parent, child) = (end(&joint.parent.link)?, end(&joint.child.link)?);
            if let Some(other) = carrier[child].replace(index) {
                return Err(ModelError::TwoParents {
                    line: lines.joint(index),
                    joint: joint.name.clone(),
                    link: joint.child.link.clone(),
                    other: robot.joints[other].name.clone(),
                });
            }
            children[parent].push(child);
        }

        let name = |link: usize| robot.links[link].name.clone();
        let mut roots = (0..robot.links.len()).filter(|&link| carrier[link].is_none());
        let root = match (roots.next(), roots.next()) {
            (Some(root), None) => root,
            (Some(root), Some(second)) => {
                return Err(ModelError::SecondRoot {
                    line: lines.link(second),
                    link: name(second),
                    root: name(root),
                });
            }
            (None, _) if robot.links.is_empty() => return Err(ModelError::Empty),
            (None, _) => {
                return Err(ModelError::Cycle {
                    line: lines.link(0),
                    link: name(0),
                });
            }
        };

        let mut order = vec![root];
        let mut next = 0;
        while let Some(&link) = order.get(next) {
            order.extend(&children[link]);
            next += 1;
        }
        let mut reached = vec![false; robot.links.len()];
        for &link in &order {
            reached[link] = true;
        }
        match reached.iter().position(|reached| !reached) {
            Some(link) => Err(ModelError::Cycle {
                line: lines.link(link),
                link: name(link),
            }),
            None => Ok(Self { carrier, order }),
        }
    }
}
