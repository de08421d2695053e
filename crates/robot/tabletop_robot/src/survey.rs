//! What a description holds and what it lacks, for a person to read.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::{self, Display, Formatter},
};

use tabletop_core::{JointId, JointLayout, LayoutFile, LimbId};
use tabletop_kinematics::{JointType, Link, ModelError, ModelJoint};

use crate::{
    Description,
    articulation::tree::{Articulation, Body, Carrier, TreePosition},
    look::figure::figure_of,
};

/// What a description holds and what it lacks. Its text is for a person.
#[derive(Clone, Debug)]
pub struct Survey {
    /// What it holds, line by line.
    text: String,
    /// What it lacks, or has wrong in a way that it can be used all the same.
    pub shortcomings: Vec<Shortcoming>,
}

/// Something that a description lacks, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shortcoming {
    /// True if it is in the `robot.ron`, false if in the URDF.
    pub is_in_layout: bool,
    /// Its line, from 1.
    pub line: usize,
    /// What is missing, and what to write.
    pub text: String,
}

impl Display for Survey {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Description {
    /// What it holds and what it lacks. Its meshes are read.
    ///
    /// # Errors
    /// The URDF lacks joints or links that the layout names; that is found when it is read.
    pub fn survey(&self) -> Result<Survey, ModelError> {
        let mut articulation = Articulation::new(self.model.clone(), self.layout.clone())?;
        let untouched = articulation.add_meshes(self.source.as_ref());
        let surveyor = Surveyor {
            file: self.source.as_ref().and_then(|source| {
                let text = source.layout.as_ref()?;
                LayoutFile::read(text).ok()
            }),
            description: self,
            articulation: &articulation,
        };
        let mut shortcomings = surveyor.unseen();
        shortcomings.extend(untouched.into_iter().filter_map(|(link, error)| {
            let link = surveyor.link(&link)?;
            Some(in_urdf(
                link.line,
                format!(
                    "link {} is not touched where a mesh would be: {error}",
                    link.name
                ),
            ))
        }));
        shortcomings.extend(surveyor.untouchable());
        shortcomings.extend(surveyor.loose());
        shortcomings.extend(surveyor.unknown_names());
        let gaps = articulation.motor_gaps().into_iter();
        shortcomings
            .extend(gaps.map(|gap| in_urdf(gap.line, format!("with --dynamic, {}", gap.remedy()))));
        shortcomings.sort();
        shortcomings.dedup();
        Ok(Survey {
            text: surveyor.to_string(),
            shortcomings,
        })
    }
}

fn in_urdf(line: usize, text: String) -> Shortcoming {
    Shortcoming {
        is_in_layout: false,
        line,
        text,
    }
}

struct Surveyor<'a> {
    description: &'a Description,
    articulation: &'a Articulation,
    /// Its `robot.ron`.
    file: Option<LayoutFile>,
}

impl Surveyor<'_> {
    fn link(&self, name: &str) -> Option<&Link> {
        let model = &self.description.model;
        Some(model.link(model.find_link(name).ok()?))
    }

    /// The links whose looks cannot be read; one mesh is named once.
    fn unseen(&self) -> Vec<Shortcoming> {
        let source = self.description.source.as_ref();
        let mut links = BTreeMap::<String, Vec<&Link>>::new();
        for link in self.description.model.links() {
            let errors = link
                .visuals
                .iter()
                .filter_map(|visual| figure_of(visual, source).err());
            if let Some(error) = errors.take(1).next() {
                links.entry(error.to_string()).or_default().push(link);
            }
        }
        let unseen = links.into_iter().filter_map(|(error, links)| {
            let first = links.first()?;
            let names = links
                .iter()
                .map(|link| &*link.name)
                .collect::<Vec<_>>()
                .join(", ");
            let is_stood_in = links.iter().all(|link| !link.collisions.is_empty());
            let instead = match is_stood_in {
                true => "shown by the collision shape",
                false => "not shown as it looks",
            };
            Some(in_urdf(first.line, format!("{names}: {instead}: {error}")))
        });
        unseen.collect()
    }

    /// Links of limbs that are seen, and pass through things.
    fn untouchable(&self) -> Vec<Shortcoming> {
        let bodies = self.articulation.bodies.iter().filter(|body| {
            let is_moved = matches!(body.place, TreePosition::Limb(..));
            is_moved && body.parts.is_empty()
        });
        let links = bodies.filter_map(|body| self.link(&body.id));
        let bare = links.filter(|link| link.collisions.is_empty());
        bare.map(|link| {
            let text = format!(
                "link {} is seen and passes through things: give it a <collision>",
                link.name
            );
            in_urdf(link.line, text)
        })
        .collect()
    }

    /// Links on a limb that a joint carries which nothing moves: fingers, mostly, that stand before those of the simulator.
    fn loose(&self) -> Vec<Shortcoming> {
        let moved: BTreeSet<_> = self.moved_joints().collect();
        let loose = self.articulation.bodies.iter().filter_map(|body| {
            let (Carrier::Link(link), TreePosition::Limb(limb, _)) = (body.carrier, body.place) else {
                return None;
            };
            let joint = self.free_joint(body, &moved)?;
            let layout = self.articulation.layout.limb(limb);
            let gripper = self.articulation.layout.joint(layout.gripper.joint).name;
            let line = self.file.as_ref()?.line_of(gripper.as_str())?;
            let name = &self.description.model.link(link).name;
            Some(Shortcoming {
                is_in_layout: true,
                line,
                text: format!(
                    "link {name} hangs on joint {}, which nothing moves: if it is a finger, name it in the gripper's `fingers`, which the simulator's replace",
                    joint.name
                ),
            })
        });
        loose.collect()
    }

    /// The names of the joints that the layout moves.
    fn moved_joints(&self) -> impl Iterator<Item = &str> {
        let ids = self.articulation.layout.joint_ids();
        ids.filter_map(|joint| {
            let joint = self.articulation.joint(joint)?;
            Some(&*self.description.model.joint(joint).name)
        })
    }

    /// The joint that carries a body, if it could move and nothing moves it.
    fn free_joint(&self, body: &Body, moved: &BTreeSet<&str>) -> Option<&ModelJoint> {
        let model = &self.description.model;
        let mut link = self.link(&body.id);
        while let Some(joint) = link.and_then(|link| link.joint) {
            let joint = model.joint(joint);
            let is_moved = moved.contains(&*joint.name)
                || joint
                    .mimic
                    .is_some_and(|mimic| moved.contains(&*model.joint(mimic.leader).name));
            match joint.kind {
                JointType::Fixed => link = Some(model.link(joint.parent)),
                _ if is_moved => return None,
                JointType::Revolute | JointType::Continuous | JointType::Prismatic => {
                    return Some(joint);
                }
            }
        }
        None
    }

    /// Names in the `robot.ron` that are not in the URDF, where that is no error.
    fn unknown_names(&self) -> Vec<Shortcoming> {
        let Some(file) = &self.file else {
            return Vec::new();
        };
        let Description { layout, model, .. } = self.description;
        let fingers = layout
            .limbs
            .iter()
            .flat_map(|limb| limb.gripper.fingers.iter().flatten());
        let pairs = layout
            .may_touch
            .iter()
            .flat_map(|(one, other)| [one, other]);
        let links = pairs.filter(|link| model.find_link(link).is_err());
        let links = links
            .map(|link| ("may_touch", "link", link))
            .chain(
                fingers
                    .filter(|link| model.find_link(link).is_err())
                    .map(|link| ("fingers", "link", link)),
            )
            .chain(
                layout
                    .screen
                    .iter()
                    .filter(|link| model.find_link(link).is_err())
                    .map(|link| ("screen", "link", link)),
            );
        let joints = layout
            .limbs
            .iter()
            .flat_map(|limb| &limb.gripper.finger_joints);
        let joints = joints.filter(|joint| model.find_joint(joint).is_err());
        let neck = layout.neck.map(|neck| &layout.joint(neck).urdf_name);
        let neck = neck.filter(|neck| model.find_joint(neck).is_err());
        let unknown = links
            .chain(joints.map(|joint| ("finger_joints", "joint", joint)))
            .chain(neck.map(|neck| ("neck", "joint", neck)));
        unknown
            .map(|(field, what, name)| Shortcoming {
                is_in_layout: true,
                line: file.line_of(name).unwrap_or(1),
                text: format!(
                    "{field}: the URDF has no {what} {name}: correct the name or leave it out"
                ),
            })
            .collect()
    }

    fn write_limb(&self, f: &mut Formatter<'_>, id: LimbId) -> fmt::Result {
        let layout = &self.articulation.layout;
        let limb = layout.limb(id);
        let (chain, _) = self.articulation.chain(id);
        let end_effector = limb.end_effector.iter();
        let model = &self.description.model;
        let mut on = end_effector.filter(|frame| model.find_link(&frame.link).is_ok());
        writeln!(
            f,
            "limb {}: {} joints, end effector on link {}{}",
            limb.name,
            limb.joints.len(),
            on.next().map_or("?", |frame| &frame.link),
            match chain.has_every_rotation() {
                true => "",
                false => ", which turns as near to a pose as so few joints can",
            }
        )?;
        let width = limb
            .joints
            .iter()
            .map(|&joint| layout.joint(joint).urdf_name.chars().count());
        let width = width.max().unwrap_or(0);
        for &joint in &limb.joints {
            self.write_joint(f, joint, width)?;
        }
        let gripper = layout.joint(limb.gripper.joint);
        let [least, widest] = gripper.limits;
        let of = |side: &[String]| match side.is_empty() {
            true => "the simulator's".to_owned(),
            false => side.join(", "),
        };
        let [left, right] = &limb.gripper.fingers;
        writeln!(
            f,
            "  gripper {}: opens from {least} to {widest} units; left finger: {}; right finger: {}",
            gripper.name,
            of(left),
            of(right)
        )
    }

    fn write_joint(&self, f: &mut Formatter<'_>, joint: JointId, width: usize) -> fmt::Result {
        let described = self.articulation.joint(joint);
        let described = described.map(|joint| self.description.model.joint(joint));
        let joint = self.articulation.layout.joint(joint);
        let JointLayout {
            urdf_name,
            limits,
            home,
            effort,
            speed,
            slides,
            ..
        } = joint;
        // What the URDF says of the motor counts first, as with `--dynamic`.
        let first =
            |of_urdf: Option<f64>, of_file: f64| of_urdf.filter(|it| *it > 0.0).unwrap_or(of_file);
        let effort = first(described.map(|joint| joint.effort), *effort);
        let speed = first(described.map(|joint| joint.velocity), *speed);
        let [least, largest] = *limits;
        write!(f, "  {urdf_name:width$}  ")?;
        match slides {
            true => writeln!(
                f,
                "slides {least:.3} to {largest:.3} m, starts at {home:.3} m; {effort} N, {speed} m/s"
            ),
            false => writeln!(
                f,
                "turns {:.1}° to {:.1}°, starts at {:.1}°; {effort} N m, {:.0}°/s",
                least.to_degrees(),
                largest.to_degrees(),
                home.to_degrees(),
                speed.to_degrees()
            ),
        }
    }
}

impl Display for Surveyor<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Description { model, layout, .. } = self.description;
        let mass: f64 = model.links().iter().map(|link| link.inertial.mass).sum();
        writeln!(
            f,
            "{}: {} links of {mass:.1} kg in all, {} joints that move by themselves",
            layout.name,
            model.links().len(),
            model.movable().count()
        )?;
        writeln!(
            f,
            "its root, link {}, is {} units behind the table's edge and {} units above its top",
            model.link(model.root()).name,
            layout.base.behind_edge,
            layout.base.height
        )?;
        for limb in layout.limb_ids() {
            self.write_limb(f, limb)?;
        }
        match layout.neck {
            Some(neck) => {
                writeln!(f, "neck:")?;
                self.write_joint(f, neck, 0)?;
            }
            None => writeln!(f, "neck: none, so the head camera does not turn")?,
        }
        let cameras = layout.hand_cameras.iter().map(|camera| {
            let (columns, rows) = camera.size;
            format!("{} ({columns} x {rows})", camera.name)
        });
        let cameras: Vec<_> = cameras.collect();
        match cameras.is_empty() {
            true => writeln!(f, "cameras: the head camera"),
            false => writeln!(f, "cameras: the head camera, {}", cameras.join(", ")),
        }?;
        let moved: BTreeSet<_> = self.moved_joints().collect();
        let still = model.movable().map(|joint| &*model.joint(joint).name);
        let still: Vec<_> = still.filter(|joint| !moved.contains(joint)).collect();
        match still.is_empty() {
            true => Ok(()),
            false => writeln!(f, "joints that stay at 0: {}", still.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DescriptionSource;

    const PANDA: &str = include_str!("../../../../assets/panda/panda.urdf");
    const LAYOUT: &str = include_str!("../../../../assets/panda/robot.ron");

    fn survey(urdf: &str, layout: &str) -> Survey {
        let source = DescriptionSource {
            path: "panda.urdf".into(),
            urdf: urdf.to_owned(),
            layout: Some(layout.to_owned()),
            reach: None,
        };
        Description::read(source).unwrap().survey().unwrap()
    }

    fn cut(text: &str, from: &str, to: &str) -> String {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    }

    #[test]
    fn the_robots_inside_the_program_lack_nothing() {
        let baxter = Description::baxter().unwrap().survey().unwrap();
        assert_eq!(baxter.shortcomings, []);
        let said = baxter.to_string();
        for words in [
            "limb left: 7 joints",
            "head_pan",
            "left_hand_camera (200 x 125)",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
        let so101 = survey(
            include_str!("../../../../assets/so101/so101.urdf"),
            include_str!("../../../../assets/so101/robot.ron"),
        );
        assert_eq!(so101.shortcomings, []);
        let panda = survey(PANDA, LAYOUT);
        assert_eq!(panda.shortcomings, []);
        let said = panda.to_string();
        for words in [
            "Panda: 9 links of ",
            "  panda_joint1  turns -166.0° to 166.0°, starts at 0.0°; 87 N m, 125°/s\n",
            "opens from 0 to 0.8 units; left finger: the simulator's",
            "neck: none",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
    }

    #[test]
    fn shortcomings_name_their_line_and_what_to_write() {
        let third = PANDA.find("<link name=\"panda_link3\">").unwrap();
        let (before, after) = PANDA.split_at(third);
        let end = after.find("</link>").unwrap();
        let bare = without_collisions(&after[..end]);
        let finger = "<link name=\"pad\"><collision><geometry><sphere radius=\"0.01\"/></geometry></collision></link>\n\
            <joint name=\"pad_joint\" type=\"prismatic\"><parent link=\"panda_link7\"/><child link=\"pad\"/><axis xyz=\"0 1 0\"/>\
            <limit lower=\"0\" upper=\"0.04\" effort=\"1\" velocity=\"1\"/></joint>\n</robot>";
        let urdf = cut(
            &(before.to_owned() + &bare + &after[end..]),
            "</robot>",
            finger,
        );
        let urdf = cut(
            &urdf,
            "<cylinder radius=\"0.07\" length=\"0.14\"/>",
            "<mesh filename=\"base.stl\"/>",
        );
        let layout = cut(
            LAYOUT,
            "kind: Parallel,",
            "kind: Parallel, finger_joints: [\"thumb\"],",
        );
        let said = survey(&urdf, &layout);
        let said = said.shortcomings.iter().map(|it| {
            let file = if it.is_in_layout { "ron" } else { "urdf" };
            format!("{file} {}: {}", it.line, it.text)
        });
        let said: Vec<_> = said.collect();
        let said = said.join("\n");
        for words in [
            "urdf 5: panda_link0: shown by the collision shape: base.stl: there is no such file",
            "urdf 26: link panda_link3 is seen and passes through things: give it a <collision>",
            "ron 23: link pad hangs on joint pad_joint, which nothing moves: if it is a finger, name it in the gripper's `fingers`",
            "ron 24: finger_joints: the URDF has no joint thumb",
            "with --dynamic, link pad weighs nothing",
        ] {
            assert!(said.contains(words), "{words}\n\n{said}");
        }
    }

    /// A link without its collision shapes.
    fn without_collisions(link: &str) -> String {
        let mut parts = link.split("<collision>");
        let first = parts.next().unwrap_or_default().to_owned();
        let rest = parts.filter_map(|part| Some(part.split_once("</collision>")?.1));
        first + &rest.collect::<String>()
    }
}
