//! The cost of simulating a scene: the number of its solids, and of pairs of them that are near each other.

use tabletop_core::{ChainSpec, LidBoxSpec, ObjectSpec, SceneItem, Shape};
use tabletop_geometry::{Bounds, PAIR_GAP, Pose};

use crate::elements::nearness::{BodyBounds, Nearness};

/// Largest number of convex solids of a task: a container has five, a link is one.
pub(crate) const MAX_SOLIDS: usize = 20_000;
/// Largest number of links of all chains of a task.
const MAX_LINKS: usize = 5_000;
/// Largest number of pairs of solids of different objects that are near each other at the start. The physics keeps up to 3 kB for each.
const MAX_PAIRS: usize = 200_000;

/// The cost of a part of a scene.
#[derive(Debug, Default)]
pub(crate) struct Cost {
    solids: usize,
    links: usize,
    nearness: Nearness,
}

/// The reason why a cost is too high: the problem and the expectation.
#[derive(Debug, PartialEq)]
pub(crate) struct Excess {
    pub problem: &'static str,
    pub expected: String,
}

impl Cost {
    /// Adds an element of a scene. One with too many links or solids does not count for those after it.
    pub fn add(&mut self, item: &SceneItem) -> Result<(), Excess> {
        let links = match item {
            SceneItem::Chain(chain) => self.links + chain.links() as usize,
            SceneItem::Object(_) | SceneItem::LidBox(_) | SceneItem::Jointed(_) => self.links,
        };
        if links > MAX_LINKS {
            return Err(Excess {
                problem: "with it there are too many links",
                expected: format!("at most {MAX_LINKS} links"),
            });
        }
        let bodies = bodies(item);
        let solids = self.solids + bodies.iter().map(|body| body.solids.len()).sum::<usize>();
        if solids > MAX_SOLIDS {
            return Err(Excess {
                problem: "with it there are too many solids",
                expected: format!("at most {MAX_SOLIDS} solids"),
            });
        }
        // Those with too many pairs do count: to look for pairs of ever more elements would take minutes.
        self.solids = solids;
        self.links = links;
        if !self.nearness.add(&bodies, MAX_PAIRS) {
            return Err(Excess {
                problem: "with it too many solids of different objects are near each other",
                expected: format!("at most {MAX_PAIRS} pairs with a gap of less than {PAIR_GAP}"),
            });
        }
        Ok(())
    }
}

/// The bodies of an element. The physics pairs those that do not collide, too, before it passes over them.
fn bodies(item: &SceneItem) -> Vec<BodyBounds> {
    match item {
        SceneItem::Object(object) => vec![body(object)],
        SceneItem::Chain(chain) => links(chain),
        SceneItem::LidBox(lidbox) => parts_of_lidbox(lidbox).into(),
        SceneItem::Jointed(jointed) => jointed.placed().map(|object| body(&object)).into(),
    }
}

fn body(object: &ObjectSpec) -> BodyBounds {
    BodyBounds {
        solids: solids(&object.shape, object.pose),
        is_fixed: object.is_fixed(),
    }
}

fn movable(shape: &Shape, at: Pose) -> BodyBounds {
    BodyBounds {
        solids: solids(shape, at),
        is_fixed: false,
    }
}

fn solids(shape: &Shape, at: Pose) -> Vec<Bounds> {
    let bounds = |part| Bounds::of_primitive(part, at);
    shape.colliding().iter().map(bounds).collect()
}

fn links(chain: &ChainSpec) -> Vec<BodyBounds> {
    let link = Shape::Block {
        span: chain.link_span,
        color: chain.color,
    };
    (0..chain.links())
        .map(|index| movable(&link, chain.link_pose(index)))
        .collect()
}

/// Box and lid.
fn parts_of_lidbox(lidbox: &LidBoxSpec) -> [BodyBounds; 2] {
    let height = (lidbox.span.z + lidbox.thickness) / 2.0;
    let on_top = lidbox.pose * Pose::at(bevy::math::Vec3::Z * height);
    [
        movable(&lidbox.container(), lidbox.pose),
        movable(&lidbox.lid(), on_top),
    ]
}

#[cfg(test)]
mod tests {
    use crate::test_support::{lines_of, scene_of};

    fn composite(solids: usize) -> String {
        let spheres = "<sphere location='(0,0,0)'/>".repeat(solids);
        format!("<composite location='(0,0,9)'>{spheres}</composite>")
    }

    const NEAR: &str = "with it too many solids of different objects are near each other, expected at most 200000 pairs with a gap of less than 0.28";

    /// Cubes in a cube of this many along each edge.
    fn cubes(count: usize, edge: f32, distance: f32, more: &str) -> String {
        let at = |index: usize| {
            let place = [
                index % count,
                index / count % count,
                index / (count * count),
            ];
            let [x, y, z] = place.map(|steps| steps as f32 * distance);
            format!(
                "<block location='({x},{y},{z})' xspan='{edge}' yspan='{edge}' zspan='{edge}' {more}/>"
            )
        };
        (0..count.pow(3)).map(at).collect()
    }

    #[test]
    fn objects_in_one_place_are_limited() {
        let balls = "<sphere location='(0,0,1)'/>".repeat(650);
        let problem = format!("sphere: {NEAR}");
        assert_eq!(lines_of(&balls), vec![problem; 18]);
        assert_eq!(scene_of("", &balls).items.len(), 632);
        assert_eq!(lines_of(&composite(98).repeat(20)).len(), 14);
        assert_eq!(lines_of(&composite(5_000)), [""; 0]);
    }

    #[test]
    fn objects_that_are_near_each_other_are_limited() {
        assert_eq!(lines_of(&cubes(9, 0.001, 0.002, "")).len(), 97);
        assert_eq!(lines_of(&cubes(10, 0.001, 0.3, "")), [""; 0]);
        assert_eq!(lines_of(&cubes(15, 1.0, 1.0, "")), [""; 0]);
        let chain = "<chain start='(0,0,1)' end='(0.5,0,1)' linkCount='1000'/>";
        assert_eq!(lines_of(chain), [format!("chain: {NEAR}")]);
    }

    #[test]
    fn items_refused_for_their_pairs_count_as_solids() {
        let chain = "<chain start='(0,0,1)' end='(0.5,0,1)' linkCount='1000'/>";
        let links = "chain: with it there are too many links, expected at most 5000 links";
        let problems = lines_of(&chain.repeat(7));
        assert_eq!(problems[..5], vec![format!("chain: {NEAR}"); 5]);
        assert_eq!(problems[5..], [links; 2]);
    }

    #[test]
    fn fixed_solids_are_not_near_each_other() {
        assert_eq!(lines_of(&cubes(10, 0.001, 0.002, "mass='0'")), [""; 0]);
    }

    #[test]
    fn jointed_objects_that_do_not_collide_are_near_each_other() {
        let jointed = |solids: usize| {
            let composite = composite(solids);
            format!("<sliderJoint location='(0,0,9)'>{composite}{composite}</sliderJoint>")
        };
        assert_eq!(lines_of(&jointed(400)), [""; 0]);
        assert_eq!(lines_of(&jointed(500)), [format!("sliderJoint: {NEAR}")]);
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
