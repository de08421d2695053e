//! The limbs of a robot, found in the tree of its joints.

use std::collections::BTreeSet;

use tabletop_kinematics::{JointType, MOST_ARM_JOINTS, ModelJoint, ModelJointId, RobotModel};

/// Words in the names of joints that move fingers.
const FINGER_JOINTS: [&str; 7] = [
    "finger", "gripper", "jaw", "knuckle", "thumb", "claw", "pinch",
];

/// Words in the names of links that are fingers.
const FINGER_LINKS: [&str; 5] = ["finger", "jaw", "knuckle", "thumb", "claw"];

/// Longest way, in m, that a finger slides.
const LONGEST_FINGER_SLIDE: f64 = 0.15;

/// Longest way, in m, from the first joint of a finger without a telling name to its tip.
const LONGEST_FINGER: f64 = 0.15;

/// Moving joints in a row after which a robot branches into fingers, and no longer into arms, if the branches are short.
const HAND_DEPTH: usize = 5;

/// Longest way, in m, from the first joint of such a branch to its tip.
const LONGEST_DIGIT: f64 = 0.25;

/// Fewest joints of a limb that has no fingers.
const FEWEST_JOINTS: usize = 3;

/// Most moving joints of a robot whose limbs are found.
const MOST_JOINTS: usize = 1000;

/// The parts of a robot that move.
pub(super) struct Anatomy {
    pub limbs: Vec<Branch>,
    /// The joint that turns the head.
    pub neck: Option<ModelJointId>,
    /// The joints that several limbs hang on, such as those of a torso.
    pub shared: Vec<ModelJointId>,
    /// The joints of none of these, such as those of wheels.
    pub others: Vec<ModelJointId>,
}

/// The joints of a limb.
pub(super) struct Branch {
    /// A name that no other limb has.
    pub name: String,
    /// The joints from the base to the hand.
    pub joints: Vec<ModelJointId>,
    /// The joints of its fingers.
    pub fingers: Vec<ModelJointId>,
}

impl Anatomy {
    /// The parts of a robot, as far as its tree and its names tell them apart.
    pub fn of(model: &RobotModel) -> Self {
        let tree = JointTree::of(model);
        let (heads, arms): (Vec<_>, Vec<_>) = tree
            .paths()
            .into_iter()
            .partition(|path| tree.is_head(path));
        let limbs = arms.into_iter().filter(|path| tree.is_limb(path));
        let limbs: Vec<_> = limbs.collect();
        let in_limbs = |node: &usize| limbs.iter().filter(|path| path.contains(node)).count();
        let shared: Vec<_> = (0..tree.joints.len())
            .filter(|node| in_limbs(node) > 1)
            .collect();
        let branches = limbs.iter().filter_map(|path| {
            let own = path.iter().filter(|node| !shared.contains(node));
            let joints: Vec<_> = own.map(|&node| tree.joints[node]).collect();
            let hand = *path.last()?;
            (!joints.is_empty()).then(|| Branch {
                name: String::new(),
                fingers: tree.fingers_on(hand),
                joints,
            })
        });
        let mut limbs: Vec<_> = branches.collect();
        name(model, &mut limbs);
        // As the rows of scripts have them.
        limbs.sort_by_key(|limb| limb.name.starts_with("right"));
        let neck = heads.iter().flatten().find(|&&node| tree.turns_aside(node));
        let neck = neck.map(|&node| tree.joints[node]);
        let shared: Vec<_> = shared.into_iter().map(|node| tree.joints[node]).collect();
        let others = tree.joints.iter().filter(|joint| {
            let is_limbs = limbs
                .iter()
                .any(|limb| limb.joints.contains(joint) || limb.fingers.contains(joint));
            let is_free = model.joint(**joint).mimic.is_none();
            is_free && !is_limbs && !shared.contains(joint) && neck != Some(**joint)
        });
        Self {
            others: others.copied().collect(),
            limbs,
            neck,
            shared,
        }
    }
}

/// The tree of the joints that move; they are named by their places in it, parents before children.
struct JointTree<'m> {
    model: &'m RobotModel,
    joints: Vec<ModelJointId>,
    parents: Vec<Option<usize>>,
    is_finger: Vec<bool>,
}

impl<'m> JointTree<'m> {
    fn of(model: &'m RobotModel) -> Self {
        let (mut joints, mut parents) = (Vec::new(), Vec::new());
        // The moving joint that carries each link.
        let mut carriers = vec![None; model.links().len()];
        for id in model.links().iter().filter_map(|link| link.joint) {
            let joint = model.joint(id);
            let carrier = carriers[joint.parent.index()];
            carriers[joint.child.index()] = match joint.kind {
                JointType::Fixed => carrier,
                JointType::Revolute | JointType::Continuous | JointType::Prismatic => {
                    joints.push(id);
                    parents.push(carrier);
                    Some(joints.len() - 1)
                }
            };
        }
        joints.truncate(MOST_JOINTS);
        parents.truncate(MOST_JOINTS);
        let mut tree = Self {
            is_finger: vec![false; joints.len()],
            model,
            joints,
            parents,
        };
        let spans = tree.spans();
        tree.find_digits(&spans);
        tree.find_fingers(&spans);
        tree
    }

    /// Finds the joints below the place where a long arm branches.
    fn find_digits(&mut self, spans: &[f64]) {
        let mut depths: Vec<usize> = Vec::new();
        for node in 0..self.joints.len() {
            let parent = self.parents[node];
            depths.push(1 + parent.map_or(0, |parent| depths[parent]));
            let branches = |parent: usize| {
                let children = self.children(parent);
                let is_short =
                    |&child: &usize| spans[self.joint(child).child.index()] < LONGEST_DIGIT;
                depths[parent] >= HAND_DEPTH && children.len() > 1 && children.iter().all(is_short)
            };
            self.is_finger[node] =
                parent.is_some_and(|parent| self.is_finger[parent] || branches(parent));
        }
    }

    /// Finds the joints that carry fingers alone and move, or are named, as fingers do.
    fn find_fingers(&mut self, spans: &[f64]) {
        let leaders = self.model.joints().iter();
        let leaders: BTreeSet<_> = leaders
            .filter_map(|joint| Some(joint.mimic?.leader))
            .collect();
        for node in (0..self.joints.len()).rev() {
            let children = self.children(node);
            let is_short = |&child: &usize| {
                let below = self.children(child);
                let is_end = below.iter().all(|&below| self.is_finger[below]);
                let span = spans[self.joint(child).child.index()];
                self.is_finger[child] || is_end && (below.is_empty() || span < LONGEST_FINGER)
            };
            let short: Vec<_> = children.iter().copied().filter(is_short).collect();
            if short.len() > 1 {
                for child in short {
                    self.is_finger[child] = true;
                }
            }
            let joint = self.joint(node);
            let is_end = children.iter().all(|&child| self.is_finger[child]);
            let [least, largest] = joint.limits;
            let slides =
                joint.kind == JointType::Prismatic && largest - least <= LONGEST_FINGER_SLIDE;
            let follows = joint.mimic.is_some() || leaders.contains(&self.joints[node]);
            let link = &self.model.link(joint.child).name;
            let is_named = has_word(&joint.name, &FINGER_JOINTS) || has_word(link, &FINGER_LINKS);
            self.is_finger[node] |= is_end && (slides || follows || is_named);
        }
    }

    /// The longest way, in m, from the origin of each link to one of a link that hangs on it.
    fn spans(&self) -> Vec<f64> {
        let mut spans = vec![0.0_f64; self.model.links().len()];
        for joint in self.model.joints().iter().rev() {
            let span = joint.origin.translation.length() + spans[joint.child.index()];
            let longest = &mut spans[joint.parent.index()];
            *longest = longest.max(span);
        }
        spans
    }

    fn joint(&self, node: usize) -> &'m ModelJoint {
        self.model.joint(self.joints[node])
    }

    fn children(&self, node: usize) -> Vec<usize> {
        let nodes = node + 1..self.joints.len();
        nodes
            .filter(|&child| self.parents[child] == Some(node))
            .collect()
    }

    /// The ways from the root to each joint that carries no other one but fingers.
    fn paths(&self) -> Vec<Vec<usize>> {
        let arms = (0..self.joints.len()).filter(|&node| !self.is_finger[node]);
        let ends = arms.filter(|&node| {
            let children = self.children(node);
            children.iter().all(|&child| self.is_finger[child])
        });
        ends.map(|end| {
            let up = std::iter::successors(Some(end), |&node| self.parents[node]);
            let mut path: Vec<_> = up.collect();
            path.reverse();
            path
        })
        .collect()
    }

    /// The joints of the fingers that a joint carries.
    fn fingers_on(&self, hand: usize) -> Vec<ModelJointId> {
        let mut carried = vec![false; self.joints.len()];
        let mut fingers = Vec::new();
        for node in hand + 1..self.joints.len() {
            let is_on = |parent| parent == hand || carried[parent];
            if self.parents[node].is_some_and(is_on) {
                carried[node] = true;
                fingers.push(self.joints[node]);
            }
        }
        fingers
    }

    fn is_head(&self, path: &[usize]) -> bool {
        let named = |&node: &usize| has_word(&self.joint(node).name, &["head", "neck"]);
        let hand = path.last();
        path.iter().any(named) && hand.is_some_and(|&hand| self.fingers_on(hand).is_empty())
    }

    fn is_limb(&self, path: &[usize]) -> bool {
        let Some(&hand) = path.last() else {
            return false;
        };
        let has_fingers = !self.fingers_on(hand).is_empty();
        let moves_by_itself = |&node: &usize| self.joint(node).mimic.is_none();
        let is_wheel = |&node: &usize| has_word(&self.joint(node).name, &["wheel", "caster"]);
        (path.len() >= FEWEST_JOINTS || has_fingers)
            && path.len() <= MOST_ARM_JOINTS
            && path.iter().all(moves_by_itself)
            && !path.iter().any(is_wheel)
    }

    /// True if a joint of a head turns it to the sides, about a vertical axis when the robot is at 0.
    fn turns_aside(&self, node: usize) -> bool {
        let joint = self.joint(node);
        let frames = self.model.frames(&self.model.zero());
        let axis = frames[joint.child].transform_vector3(joint.axis);
        has_word(&joint.name, &["head", "neck"]) && joint.kind.turns() && axis.z.abs() > 0.9
    }
}

fn has_word(name: &str, words: &[&str]) -> bool {
    let name = name.to_lowercase();
    words.iter().any(|word| name.contains(word))
}

/// Gives each limb the plainest name that no other has.
fn name(model: &RobotModel, limbs: &mut [Branch]) {
    let names_of = |limb: &Branch| -> Vec<String> {
        let joints = limb.joints.iter();
        joints
            .map(|&joint| model.joint(joint).name.to_lowercase())
            .collect()
    };
    let side = |limb: &Branch| {
        let names = names_of(limb);
        let is_on = |side: &str| {
            let letter = &side[..1];
            names
                .iter()
                .all(|name| name.contains(side) || words_of(name).any(|word| word == letter))
        };
        ["left", "right"].into_iter().find(|side| is_on(side))
    };
    let part = |limb: &Branch| {
        let names = names_of(limb).join(" ");
        match has_word(&names, &["hip", "knee", "ankle", "leg"]) {
            true => "leg",
            false => "arm",
        }
    };
    let ways: [&dyn Fn(&Branch) -> Option<String>; 4] = [
        // Of one limb it tells nothing more than the robot's name.
        &|_| identifier(model.name()),
        &|limb| side(limb).map(str::to_owned),
        &|limb| Some(format!("{}_{}", side(limb)?, part(limb))),
        &|limb| common_start(&names_of(limb)),
    ];
    let numbered = || {
        (1..=limbs.len())
            .map(|number| format!("limb{number}"))
            .collect()
    };
    let names: Vec<String> = ways
        .iter()
        .find_map(|way| {
            let names: Option<Vec<String>> = limbs.iter().map(way).collect();
            let names = names?;
            let different: BTreeSet<_> = names.iter().collect();
            (different.len() == names.len()).then_some(names)
        })
        .unwrap_or_else(numbered);
    for (limb, name) in limbs.iter_mut().zip(names) {
        limb.name = name;
    }
}

/// A name as scenarios can write it.
fn identifier(name: &str) -> Option<String> {
    let name = name.to_ascii_lowercase();
    let words = name.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
    let name = words.join("_");
    name.starts_with(|first: char| first.is_ascii_alphabetic())
        .then_some(name)
}

fn words_of(name: &str) -> impl Iterator<Item = &str> {
    name.split(|letter: char| !letter.is_alphanumeric())
}

/// The words with which all names begin.
fn common_start(names: &[String]) -> Option<String> {
    let first = names.first()?;
    let ends = first.rmatch_indices('_').map(|(end, _)| end);
    let mut starts = ends.map(|end| &first[..end]);
    let common = starts.find(|start| {
        let start = format!("{start}_");
        names.iter().all(|name| name.starts_with(&start))
    });
    common.map(str::to_owned)
}
