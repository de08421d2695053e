//! The lines of a segment's text file (report section 4.1).

use tabletop_core::{Bond, Decimal, Hand, LimbName, ObjectSpec, Operator, SimTick};
use tabletop_geometry::Pose;

use crate::files::properties::properties;

/// Something that a segment's text file tells, in one line.
///
/// ```
/// use bevy::math::Vec3;
/// use tabletop_core::Hand;
/// use tabletop_geometry::Pose;
/// use tabletop_recorder::Event;
///
/// let pose = Pose::from_degrees(Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 90.0));
/// let moved = Event::Move { id: "RedBlock", pose };
/// assert_eq!(moved.fields(0).join(","), "0,move,RedBlock,2.0,0.0,1.0,0.0,0.0,90.0");
///
/// let grasped = Event::Grasp { hand: Hand::Left, id: "RedBlock" };
/// assert_eq!(grasped.fields(12).join(","), "12,grasp,LeftHand,RedBlock");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event<'a> {
    /// An object is there for the first time.
    Create(&'a ObjectSpec),
    /// An object has gone.
    Delete {
        /// Its id.
        id: &'a str,
    },
    /// An object is somewhere else, or turned.
    Move {
        /// Its id.
        id: &'a str,
        /// Its present pose.
        pose: Pose,
    },
    /// A hand has taken an object.
    Grasp {
        /// The hand.
        hand: Hand,
        /// Id of the object.
        id: &'a str,
    },
    /// A hand has let go of what it held.
    Release {
        /// The hand.
        hand: Hand,
    },
    /// A hand has removed what it held; the object's [`Delete`](Self::Delete) has come before.
    Destroy {
        /// The hand.
        hand: Hand,
    },
    /// A gripper of the robot has closed on an object and holds it.
    Grip {
        /// The gripper's limb.
        limb: LimbName,
        /// Id of the object.
        id: &'a str,
        /// The tick in which it did.
        tick: SimTick,
    },
    /// A gripper of the robot no longer holds an object.
    LetGo {
        /// The gripper's limb.
        limb: LimbName,
        /// Id of the object.
        id: &'a str,
        /// The tick from which on it does not.
        tick: SimTick,
    },
    /// A control as it is when a recording starts or the control appears.
    InitializeControl {
        /// Its id.
        control: &'a str,
        /// The kind of control.
        kind: &'a str,
        /// Id of the object.
        object: &'a str,
        /// The name of its state.
        state: &'a str,
    },
    /// A control has another state.
    ChangeControlState {
        /// Its id.
        control: &'a str,
        /// The name of its state.
        state: &'a str,
    },
    /// Somebody has operated a control.
    Trigger {
        /// The operator.
        by: &'a Operator,
        /// Id of the control.
        control: &'a str,
    },
    /// A hand has pointed to something.
    PointTo {
        /// The hand.
        hand: Hand,
        /// Id of the part, or of the whole object.
        part: &'a str,
        /// Id of the object.
        object: &'a str,
    },
    /// A bond was made, or is tighter.
    Fasten {
        /// The operator.
        by: &'a Operator,
        /// The bond.
        bond: &'a Bond,
    },
    /// A bond is looser, or no more.
    Loosen {
        /// The operator.
        by: &'a Operator,
        /// The bond.
        bond: &'a Bond,
    },
    /// A link of a chain was cut; its [`Delete`](Self::Delete) comes after.
    Cut {
        /// Who has closed the scissors.
        by: &'a Operator,
        /// Id of the first blade.
        blade: &'a str,
        /// Id of the link.
        link: &'a str,
    },
}

impl Event<'_> {
    /// The fields of its line, beginning with the number of the frame.
    pub fn fields(&self, frame: u64) -> Vec<String> {
        let mut fields = vec![frame.to_string(), self.name().to_owned()];
        match *self {
            Self::Create(spec) => {
                fields.push(spec.id.clone());
                for (key, value) in properties(spec) {
                    fields.extend([key, value]);
                }
            }
            Self::Delete { id } => fields.push(id.to_owned()),
            Self::Move { id, pose } => {
                fields.push(id.to_owned());
                for number in [pose.location, pose.degrees()]
                    .map(|v| v.to_array())
                    .concat()
                {
                    fields.push(Decimal(number).to_string());
                }
            }
            Self::Grasp { hand, id } => fields.extend([hand.name().to_owned(), id.to_owned()]),
            Self::Release { hand } | Self::Destroy { hand } => fields.push(hand.name().to_owned()),
            Self::Grip { limb, id, tick } | Self::LetGo { limb, id, tick } => {
                fields.extend([limb.to_string(), id.to_owned(), tick.0.to_string()]);
            }
            Self::InitializeControl {
                control,
                kind,
                object,
                state,
            } => fields.extend([control, kind, object, state].map(str::to_owned)),
            Self::ChangeControlState { control, state } => {
                fields.extend([control, state].map(str::to_owned));
            }
            Self::Trigger { by, control } => fields.extend([by.to_string(), control.to_owned()]),
            Self::Cut { by, blade, link } => {
                fields.extend([by.to_string(), blade.to_owned(), link.to_owned()]);
            }
            Self::PointTo { hand, part, object } => {
                fields.extend([hand.name(), part, object].map(str::to_owned));
            }
            Self::Fasten { by, bond } | Self::Loosen { by, bond } => {
                fields.push(by.to_string());
                let ids = [&bond.host_point, &bond.host, &bond.guest_point, &bond.guest];
                fields.extend(ids.map(String::clone));
                fields.push(bond.tightness.to_string());
            }
        }
        fields
    }

    const fn name(&self) -> &'static str {
        match self {
            Self::Create(_) => "create",
            Self::Delete { .. } => "delete",
            Self::Move { .. } => "move",
            Self::Grasp { .. } => "grasp",
            Self::Release { .. } => "release",
            Self::Destroy { .. } => "destroy",
            Self::Grip { .. } => "grip",
            Self::LetGo { .. } => "letGo",
            Self::InitializeControl { .. } => "initializeControl",
            Self::ChangeControlState { .. } => "changeControlState",
            Self::Trigger { .. } => "trigger",
            Self::PointTo { .. } => "pointTo",
            Self::Fasten { .. } => "fasten",
            Self::Loosen { .. } => "loosen",
            Self::Cut { .. } => "cut",
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::{Quat, Vec3};
    use tabletop_core::Shape;
    use tabletop_geometry::Rgb;

    use super::*;

    fn line(event: Event, frame: u64) -> String {
        event.fields(frame).join(",")
    }

    #[test]
    fn a_block_is_created_as_the_original_program_wrote_it() {
        let block = ObjectSpec {
            id: "GreenBlock".into(),
            pose: Pose::IDENTITY,
            mass: 1.0,
            shape: Shape::Block {
                span: Vec3::splat(2.0),
                color: Rgb::new(0.0, 1.0, 0.0),
            },
            dynamics: Default::default(),
            descriptions: Vec::new(),
        };
        assert_eq!(
            line(Event::Create(&block), 0),
            "0,create,GreenBlock,shape,block,xspan,2.0,zspan,2.0,yspan,2.0,color,#00ff00,mass,1.0"
        );
    }

    #[test]
    fn poses_are_written_as_the_original_program_wrote_them() {
        let pose = Pose::from_degrees(Vec3::new(-2.0, -0.0, 1.0), Vec3::new(0.0, 0.0, 45.000_004));
        let id = "GreenBlock";
        assert_eq!(
            line(Event::Move { id, pose }, 0),
            "0,move,GreenBlock,-2.0,-0.0,1.0,0.0,0.0,45.000004"
        );
        let pose = Pose::new(Vec3::new(1e-4, -12_345_678.0, 0.5), Quat::IDENTITY);
        assert_eq!(
            line(Event::Move { id, pose }, 7),
            "7,move,GreenBlock,1.0E-4,-1.2345678E7,0.5,0.0,0.0,0.0"
        );
    }

    #[test]
    fn events_of_controls_and_bonds_are_written_as_in_the_original_program() {
        let by = &Operator::Hand(Hand::Right);
        let bond = &Bond {
            host_point: "nutHole".into(),
            host: "nut".into(),
            guest_point: "tip".into(),
            guest: "screw".into(),
            tightness: 2,
        };
        let (control, state) = ("s1", "0");
        for (event, expected) in [
            (
                Event::InitializeControl {
                    control,
                    kind: "toggleSwitch",
                    object: "panel",
                    state,
                },
                "0,initializeControl,s1,toggleSwitch,panel,0",
            ),
            (
                Event::ChangeControlState { control, state },
                "0,changeControlState,s1,0",
            ),
            (Event::Trigger { by, control }, "0,trigger,RightHand,s1"),
            (
                Event::Cut {
                    by,
                    blade: "lower",
                    link: "c-link1",
                },
                "0,cut,RightHand,lower,c-link1",
            ),
            (
                Event::Fasten { by, bond },
                "0,fasten,RightHand,nutHole,nut,tip,screw,2",
            ),
            (
                Event::Loosen { by, bond },
                "0,loosen,RightHand,nutHole,nut,tip,screw,2",
            ),
        ] {
            assert_eq!(line(event, 0), expected);
        }
    }

    #[test]
    fn events_of_hands_are_written_with_their_names() {
        let id = "a";
        for (event, expected) in [
            (Event::Delete { id }, "3,delete,a"),
            (
                Event::Grasp {
                    hand: Hand::Left,
                    id,
                },
                "3,grasp,LeftHand,a",
            ),
            (Event::Release { hand: Hand::Right }, "3,release,RightHand"),
            (Event::Release { hand: Hand::Any }, "3,release,AnyHand"),
            (Event::Destroy { hand: Hand::Both }, "3,destroy,BothHands"),
            (
                Event::PointTo {
                    hand: Hand::Left,
                    part: "slot",
                    object: "dock",
                },
                "3,pointTo,LeftHand,slot,dock",
            ),
        ] {
            assert_eq!(line(event, 3), expected);
        }
    }
}
