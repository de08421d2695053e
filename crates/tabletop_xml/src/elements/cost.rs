//! The cost of simulating a scene: the number of its solids, and of their overlaps.

use tabletop_core::{Bounds, ChainSpec, LidBoxSpec, Pose, SceneItem, Shape};

use crate::elements::overlap::Overlaps;

/// Largest number of convex solids of a task: a container has five, a link is one.
pub(crate) const MAX_SOLIDS: usize = 20_000;
/// Largest number of links of all chains of a task.
const MAX_LINKS: usize = 5_000;
/// Largest number of overlapping pairs of solids of different objects at the start.
const MAX_OVERLAPS: usize = 20_000;

/// The cost of a part of a scene.
#[derive(Debug, Default)]
pub(crate) struct Cost {
    solids: usize,
    links: usize,
    overlaps: Overlaps,
}

/// The reason why a cost is too high: the problem and the expectation.
#[derive(Debug, PartialEq)]
pub(crate) struct Excess {
    pub problem: &'static str,
    pub expected: String,
}

impl Cost {
    /// Adds an element of a scene. An element that exceeds the limits does not count for those after it.
    pub fn add(&mut self, item: &SceneItem) -> Result<(), Excess> {
        let bodies = bodies(item);
        let solids = self.solids + bodies.iter().map(Vec::len).sum::<usize>();
        let links = match item {
            SceneItem::Chain(chain) => self.links + chain.links() as usize,
            SceneItem::Object(_) | SceneItem::LidBox(_) | SceneItem::Jointed(_) => self.links,
        };
        if solids > MAX_SOLIDS {
            return Err(Excess {
                problem: "with it there are too many solids",
                expected: format!("at most {MAX_SOLIDS} solids"),
            });
        }
        if links > MAX_LINKS {
            return Err(Excess {
                problem: "with it there are too many links",
                expected: format!("at most {MAX_LINKS} links"),
            });
        }
        if !self.overlaps.add(&bodies, MAX_OVERLAPS) {
            return Err(Excess {
                problem: "with it too many solids of different objects overlap",
                expected: format!("at most {MAX_OVERLAPS} overlaps"),
            });
        }
        self.solids = solids;
        self.links = links;
        Ok(())
    }
}

/// The bodies of an element, each as the bounds of its solids.
fn bodies(item: &SceneItem) -> Vec<Vec<Bounds>> {
    match item {
        SceneItem::Object(object) => vec![solids(&object.shape, object.pose)],
        SceneItem::Chain(chain) => links(chain),
        SceneItem::LidBox(lidbox) => vec![parts_of_lidbox(lidbox)],
        SceneItem::Jointed(jointed) => {
            let [first, second] = jointed
                .placed()
                .map(|object| solids(&object.shape, object.pose));
            match jointed.collides {
                true => vec![first, second],
                false => vec![[first, second].concat()],
            }
        }
    }
}

fn solids(shape: &Shape, at: Pose) -> Vec<Bounds> {
    let bounds = |part| Bounds::of_primitive(part, at);
    shape.colliding().into_iter().map(bounds).collect()
}

fn links(chain: &ChainSpec) -> Vec<Vec<Bounds>> {
    let link = Shape::Block {
        span: chain.link_span,
        color: chain.color,
    };
    let pose = |index| chain.link_pose(index);
    (0..chain.links())
        .map(|index| solids(&link, pose(index)))
        .collect()
}

/// Box and lid, which do not collide with each other.
fn parts_of_lidbox(lidbox: &LidBoxSpec) -> Vec<Bounds> {
    let height = (lidbox.span.z + lidbox.thickness) / 2.0;
    let on_top = lidbox.pose * Pose::at(bevy::math::Vec3::Z * height);
    [
        solids(&lidbox.container(), lidbox.pose),
        solids(&lidbox.lid(), on_top),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use crate::test_support::{lines_of, scene_of};

    fn composite(solids: usize) -> String {
        let spheres = "<sphere location='(0,0,0)'/>".repeat(solids);
        format!("<composite location='(0,0,9)'>{spheres}</composite>")
    }

    #[test]
    fn objects_in_one_place_are_limited() {
        let balls = "<sphere location='(0,0,1)'/>".repeat(250);
        let problem = "sphere: with it too many solids of different objects overlap, expected at most 20000 overlaps";
        assert_eq!(lines_of(&balls), [problem; 50]);
        assert_eq!(scene_of("", &balls).items.len(), 200);
        assert_eq!(lines_of(&composite(98).repeat(20)).len(), 18);
        assert_eq!(lines_of(&composite(5_000)), [""; 0]);
    }

    #[test]
    fn solids_are_limited() {
        let apart = |index: usize| {
            let (x, y) = (index % 100 * 2, index / 100 * 2);
            format!("<box location='({x},{y},1)'/>")
        };
        let boxes: String = (0..4_002).map(apart).collect();
        let problem = "box: with it there are too many solids, expected at most 20000 solids";
        assert_eq!(lines_of(&boxes), [problem; 2]);
        let blocks: String = (0..10_000).map(apart).collect();
        assert_eq!(lines_of(&blocks.replace("box", "block")), [""; 0]);
    }

    #[test]
    fn links_are_limited() {
        let chain = |y: usize| format!("<chain start='(0,{y},1)' end='(900,{y},1)'/>");
        let chains: String = (0..6).map(chain).collect();
        let problem = "chain: with it there are too many links, expected at most 5000 links";
        assert_eq!(lines_of(&chains), [problem]);
        let squeezed = "<chain start='(0,0,1)' end='(1,0,1)' linkCount='1000'/>";
        assert_eq!(lines_of(squeezed).len(), 1);
    }
}
