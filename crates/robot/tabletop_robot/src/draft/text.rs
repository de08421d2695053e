//! The text of a `robot.ron`.

use std::{
    f64::consts::PI,
    fmt::{self, Display, Formatter},
};

use bevy::math::DVec3;
use tabletop_geometry::UNITS_PER_METER;
use tabletop_kinematics::{ModelJoint, ModelJointId, RobotModel};

use super::{anatomy::Branch, hand::DraftHand};

/// Keys for the joints of up to two arms, from the base to the hand, then for opening and closing the gripper.
const KEYS: [[&str; 7]; 2] = [
    [
        "BracketLeft",
        "KeyP",
        "KeyO",
        "KeyI",
        "KeyU",
        "KeyY",
        "KeyT",
    ],
    ["Quote", "Semicolon", "KeyL", "KeyK", "KeyJ", "KeyH", "KeyG"],
];
const GRIPPER_KEYS: [[&str; 2]; 2] = [["Equal", "Minus"], ["Digit0", "Digit9"]];
const NECK_KEY: &str = "BracketRight";

/// Least and largest opening, in units, of a gripper whose fingers the URDF lacks or does not tell apart.
const PLAIN_OPENING: [f64; 2] = [0.0, 0.8];

/// Height, in units, of a camera without a head above the table.
const CAMERA_HEIGHT: f64 = 9.0;

/// What a `robot.ron` is to say.
pub(super) struct LayoutDraft<'a> {
    pub model: &'a RobotModel,
    /// The URDF, as the file names it.
    pub urdf: &'a str,
    pub limbs: Vec<DraftLimb<'a>>,
    pub neck: Option<ModelJointId>,
    /// Joints that stand still, and where.
    pub still: Vec<(String, f64)>,
    /// Joints that are left where they are.
    pub others: Vec<ModelJointId>,
    /// Height of the table's top in the robot's frame, in m.
    pub table: f64,
}

/// A limb, as a `robot.ron` has it.
pub(super) struct DraftLimb<'a> {
    pub branch: &'a Branch,
    pub hand: DraftHand,
    /// In rad (m).
    pub home: Vec<f64>,
}

impl Display for LayoutDraft<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { model, urdf, .. } = self;
        writeln!(
            f,
            "// Written by `tabletop robot new` from {}. What stands under a question is a guess: look at it with\n\
             // `tabletop --robot FILE --show-robot`, and change what is wrong. docs/robot.md explains every field.\n\
             Robot(\n    \
                 name: {:?},\n    \
                 urdf: {urdf:?},",
            in_a_comment(urdf),
            model.name()
        )?;
        writeln!(
            f,
            "    // Where does it stand? Its origin, in units of 10 cm, behind the table's near edge and above its top.\n    \
                 base: (behind_edge: 1, height: {}),",
            RoundNumber(-self.table * UNITS_PER_METER, 2)
        )?;
        self.write_camera(f)?;
        if !self.still.is_empty() {
            writeln!(
                f,
                "    // Several limbs hang on these joints. At which positions, in rad or m, do they stand still?"
            )?;
            let still = self.still.iter();
            let still = still.map(|(name, at)| format!("({name:?}, {})", RoundNumber(*at, 4)));
            let still: Vec<_> = still.collect();
            writeln!(f, "    still: [{}],", still.join(", "))?;
        }
        if !self.others.is_empty() {
            let others = self.others.iter();
            let others = others.map(|&joint| in_a_comment(&model.joint(joint).name));
            writeln!(
                f,
                "    // These joints are no limb's and stay where they are: {}.",
                others.collect::<Vec<_>>().join(", ")
            )?;
        }
        writeln!(f, "    limbs: [")?;
        for (place, limb) in self.limbs.iter().enumerate() {
            self.write_limb(f, place, limb)?;
        }
        writeln!(f, "    ],")?;
        if let Some(neck) = self.neck {
            let name = &model.joint(neck).name;
            writeln!(
                f,
                "    // Does this joint turn the camera to the sides?\n    \
                     neck: (name: {name:?}, label: \"Head\", home: {}, key: {NECK_KEY:?}),",
                clamped(0.0, model.joint(neck))
            )?;
        }
        let home = self.limbs.iter().flat_map(|limb| {
            let joints = limb.branch.joints.iter().zip(&limb.home);
            joints.map(|(&joint, at)| clamped(*at, model.joint(joint)).to_string())
        });
        writeln!(
            f,
            "    // In which postures has the real robot been? Links whose shapes overlap there never stop each other.\n    \
                 known_postures: [\n        \
                     [{}], // home\n    \
                 ],\n)",
            home.collect::<Vec<_>>().join(", ")
        )
    }
}

impl LayoutDraft<'_> {
    fn write_camera(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let model = self.model;
        let neck = self.neck.map(|neck| {
            let frames = model.frames(&model.zero());
            let at = frames[model.joint(neck).child].translation * UNITS_PER_METER;
            DVec3::new(-at.y, at.x, at.z)
        });
        let above = CAMERA_HEIGHT + self.table * UNITS_PER_METER;
        let place = neck.unwrap_or(DVec3::Z * above);
        writeln!(
            f,
            "    // Where is its camera? From the robot's origin, in units to the right, ahead and up; and how far it looks down, in rad.\n    \
                 camera: (neck: {}, at: (0, 0, 0), tilt: 0.97832),",
            RoundVector(place, 2)
        )?;
        let cameras = model.links().iter().filter(|link| {
            let name = link.name.to_lowercase();
            name.contains("optical") && (name.contains("rgb") || name.contains("color"))
        });
        let cameras: Vec<_> = cameras.map(|link| in_a_comment(&link.name)).collect();
        match cameras.is_empty() {
            true => Ok(()),
            false => writeln!(
                f,
                "    // Which of its cameras are to be recorded (`hand_cameras`)? It has these frames: {}.",
                cameras.join(", ")
            ),
        }
    }

    fn write_limb(&self, f: &mut Formatter<'_>, place: usize, limb: &DraftLimb) -> fmt::Result {
        let name = &limb.branch.name;
        // Of two arms, the one on the left side of the keyboard is the left one.
        let keys = match (self.limbs.len(), &**name) {
            (1, _) | (_, "right") => Some(0),
            (_, "left") => Some(1),
            _ => (place < KEYS.len()).then(|| KEYS.len() - 1 - place),
        };
        writeln!(
            f,
            "        (\n            \
                         name: {name:?},\n            \
                         label: {:?},\n            \
                         prefix: {:?},\n            \
                         // Where is it when the program starts (`home`, in rad or m)?\n            \
                         joints: [",
            label(name),
            self.prefix(name)
        )?;
        for (i, (&joint, home)) in limb.branch.joints.iter().zip(&limb.home).enumerate() {
            let joint = self.model.joint(joint);
            let key = keys.and_then(|keys| KEYS[keys].get(i));
            let key = key.filter(|_| limb.branch.joints.len() <= KEYS[0].len());
            let key = key.map(|key| format!(", key: {key:?}")).unwrap_or_default();
            writeln!(
                f,
                "                (name: {:?}, label: \"J{}\", home: {}{}{key}),",
                joint.name,
                i + 1,
                clamped(*home, joint),
                own_limits(joint),
            )?;
        }
        writeln!(f, "            ],")?;
        self.write_hand(f, limb, keys)?;
        writeln!(f, "        ),")
    }

    fn write_hand(
        &self,
        f: &mut Formatter<'_>,
        limb: &DraftLimb,
        keys: Option<usize>,
    ) -> fmt::Result {
        let DraftHand {
            link,
            at,
            axes,
            opening,
            finger,
            fingers,
            finger_joints,
        } = &limb.hand;
        let has_fingers = fingers.iter().any(|side| !side.is_empty());
        let question = match (has_fingers, opening) {
            (true, Some(_)) => {
                "// How far do the fingers close and open, and how large are they, in units of 10 cm?"
            }
            (true, None) => {
                "// How far do the fingers close and open, in units of 10 cm? The URDF does not tell."
            }
            (false, _) => {
                "// The URDF has no fingers: which ones does it carry, in units of 10 cm?"
            }
        };
        let [least, widest] = opening.unwrap_or(PLAIN_OPENING);
        let joints = self.limbs.iter().flat_map(|limb| &limb.branch.joints);
        let mut taken = joints.map(|&joint| self.model.joint(joint).name.to_lowercase());
        let name = match self.limbs.len() {
            1 => "gripper".to_owned(),
            _ => format!("{}_gripper", limb.branch.name),
        };
        let name = match taken.any(|taken| taken == name) {
            true => name + "_opening",
            false => name,
        };
        writeln!(
            f,
            "            {question}\n            \
                         gripper: (\n                \
                             name: {name:?},\n                \
                             kind: Parallel,\n                \
                             opening: ({}, {}),\n                \
                             finger: {},",
            RoundNumber(least, 2),
            RoundNumber(widest, 2),
            RoundVector(*finger, 2)
        )?;
        if has_fingers {
            writeln!(
                f,
                "                // These links are the left and the right finger, with all that hangs on them.\n                \
                                 fingers: ({}, {}),",
                list(&fingers[0]),
                list(&fingers[1])
            )?;
        }
        if !finger_joints.is_empty() {
            writeln!(f, "                finger_joints: {},", list(finger_joints))?;
        }
        if let Some(keys) = keys {
            let [open, close] = GRIPPER_KEYS[keys];
            writeln!(
                f,
                "                open_key: {open:?},\n                close_key: {close:?},"
            )?;
        }
        writeln!(
            f,
            "            ),\n            \
                         // Is this midway between the finger tips, in m, with x from the left to the right one and z back to the wrist?\n            \
                         end_effector: [\n                \
                             (link: {link:?}, at: {}, axes: ({}, {}, {})),\n            \
                         ],",
            RoundVector(*at, 5),
            RoundVector(axes.x_axis, 12),
            RoundVector(axes.y_axis, 12),
            RoundVector(axes.z_axis, 12)
        )
    }

    /// The shortest beginning of a limb's name that no other limb's has.
    fn prefix<'n>(&self, name: &'n str) -> &'n str {
        let ends = name
            .char_indices()
            .map(|(start, letter)| start + letter.len_utf8());
        let mut prefixes = ends.map(|end| &name[..end]);
        let is_own = |prefix: &&str| {
            let names = self.limbs.iter().map(|limb| &limb.branch.name);
            names.filter(|name| name.starts_with(prefix)).count() == 1
        };
        prefixes.find(is_own).unwrap_or(name)
    }
}

/// The limits that are to be written for a joint that the URDF does not let move.
fn own_limits(joint: &ModelJoint) -> String {
    let [least, largest] = joint.limits;
    match least == largest {
        true => {
            let ends = [least - PI, largest + PI].map(|end| RoundNumber(end, 4));
            format!(", limits: ({}, {})", ends[0], ends[1])
        }
        false => String::new(),
    }
}

/// A position as it is written, within the limits of its joint.
fn clamped(position: f64, joint: &ModelJoint) -> f64 {
    let [least, largest] = joint.limits;
    let written = RoundNumber(position, 4).value();
    match written < least || written > largest {
        true => written.max(least).min(largest),
        false => written,
    }
}

/// `left_arm` as a person writes it: `Left arm`.
fn label(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect::<String>().replace('_', " ")
}

fn list(names: &[String]) -> String {
    format!("{names:?}")
}

/// A stranger's text that stays in its comment.
fn in_a_comment(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// A number with at most so many digits after its point, unless it is closer to a limit than that.
struct RoundNumber(f64, i32);

impl RoundNumber {
    fn value(&self) -> f64 {
        let parts = 10_f64.powi(self.1);
        // Without the sign of 0.
        (self.0 * parts).round() / parts + 0.0
    }
}

impl Display for RoundNumber {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.value().fmt(f)
    }
}

/// Three such numbers.
struct RoundVector(DVec3, i32);

impl Display for RoundVector {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self(DVec3 { x, y, z }, digits) = *self;
        let [x, y, z] = [x, y, z].map(|number| RoundNumber(number, digits));
        write!(f, "({x}, {y}, {z})")
    }
}
