//! The lines of a segment's text file (report section 4.1).

use tabletop_core::{Decimal, Hand, ObjectSpec, Pose};

use crate::files::properties::properties;

/// Something that a segment's text file tells, in one line.
///
/// ```
/// use bevy::math::Vec3;
/// use tabletop_core::{Hand, Pose};
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
        /// Where it is now.
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
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::{Quat, Vec3};
    use tabletop_core::{Rgb, Shape};

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
    fn what_hands_do_is_written_with_their_names() {
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
        ] {
            assert_eq!(line(event, 3), expected);
        }
    }
}
