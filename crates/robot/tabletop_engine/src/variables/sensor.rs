//! The script's `sensor` variable (report section 5.2): the robot's senses.

use crate::{
    protocol::{Array, Arrays, Data},
    variables::matrix::JointMatrix,
};

/// The senses of a script in a tick. For Baxter, rows are in the order left, right; joints in the order S0, S1, E0, E1, W0, W1,
/// W2.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensor {
    /// Simulation time since the last call, in s.
    pub time_elapsed: f64,
    /// Angles of the limbs' joints, in rad.
    pub joint_angles: JointMatrix,
    /// The location of each limb's end effector, in units of 10 cm.
    pub end_eff_pos: Vec<[f64; 3]>,
    /// The opening of each limb's gripper, in units.
    pub gripper_opening: Vec<f64>,
    /// The head camera's picture, if there is a fresh one.
    pub picture: Option<RgbImage>,
    /// Points on the arms by name, in units. A map costs Octave half a millisecond, so leave it out where nobody asks for it.
    pub tracker_loc: Option<Vec<(String, [f64; 3])>>,
    /// True if a demonstration is going on: one that is being recorded or replayed.
    pub demo_cue: bool,
    /// The head's angle, in rad, positive to the robot's left; a robot without a neck has none.
    pub head_angle: Option<f64>,
    /// The objects of the world, if the script may know them.
    pub objects: Option<Vec<SensedObject>>,
    /// The objects as the robot believes them to be, by the pictures of its head camera.
    pub seen: Option<Vec<SensedBelief>>,
    /// The contacts of the robot's bodies.
    pub contacts: Option<Vec<SensedContact>>,
    /// The limbs by their names, which are fields of the struct, with the ids of the objects that their grippers hold.
    pub held: Option<Vec<(String, Vec<String>)>>,
    /// The controls of the world: switches, lights, and others.
    pub controls: Option<Vec<SensedControl>>,
    /// Torques of the limbs' joints, in N m.
    pub joint_torques: Option<JointMatrix>,
    /// The steps of the task that was shown, if there is one.
    pub task: Option<Vec<SensedStep>>,
}

/// A picture: rows from the top, pixels from the left, red, green and blue of each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RgbImage {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl RgbImage {
    /// A picture of `width` × `height` pixels, or nothing if `rgb` has not three bytes for each.
    pub fn new(width: u32, height: u32, rgb: Vec<u8>) -> Option<Self> {
        let expected = (width as usize)
            .checked_mul(height as usize)?
            .checked_mul(3)?;
        (rgb.len() == expected).then_some(Self { width, height, rgb })
    }

    /// The picture as a script sees it: rows × columns × colours.
    fn array(&self) -> Array {
        let (width, height) = (self.width as usize, self.height as usize);
        let mut data = vec![0; self.rgb.len()];
        let (red, rest) = data.split_at_mut(width * height);
        let (green, blue) = rest.split_at_mut(width * height);
        // Column by column, as it is written: reading that way costs a third of writing all over the place.
        let red = red.chunks_exact_mut(height.max(1));
        let green = green.chunks_exact_mut(height.max(1));
        let blue = blue.chunks_exact_mut(height.max(1));
        for (column, ((red, green), blue)) in red.zip(green).zip(blue).enumerate() {
            let rows = self.rgb.chunks_exact((3 * width).max(1));
            let pixels = rows.map(|row| &row[3 * column..3 * column + 3]);
            for (((red, green), blue), pixel) in red.iter_mut().zip(green).zip(blue).zip(pixels) {
                *red = pixel[0];
                *green = pixel[1];
                *blue = pixel[2];
            }
        }
        Array {
            dims: vec![self.height, self.width, 3],
            data: Data::Picture(data),
        }
    }
}

/// An object as a script may know it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensedObject {
    /// Its name.
    pub id: String,
    /// Its centre, in units.
    pub position: [f64; 3],
    /// Its rotation about the fixed axes X, then Y, then Z, in rad.
    pub rotation: [f64; 3],
    /// Its mass, in kg; zero if nothing moves it.
    pub mass: f64,
    /// Its description in words.
    pub description: String,
}

/// An object as the robot believes it to be. Its numbers are NaN as long as it was never seen.
#[derive(Clone, Debug, PartialEq)]
pub struct SensedBelief {
    /// Its name.
    pub id: String,
    /// Its centre, in units.
    pub position: [f64; 3],
    /// Its rotation about the fixed axes X, then Y, then Z, in rad.
    pub rotation: [f64; 3],
    /// The standard deviations of its position, in units.
    pub deviation: [f64; 3],
    /// True if nothing else explains the picture as well.
    pub is_sure: bool,
}

/// A control as a script may know it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensedControl {
    /// Its name.
    pub id: String,
    /// The kind of control.
    pub kind: String,
    /// The object that it is, or is a part of.
    pub object: String,
    /// The number of the state that it shows.
    pub state: f64,
    /// The name of that state.
    pub state_name: String,
}

/// A step of a task.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensedStep {
    /// The step as a sentence.
    pub sentence: String,
    /// The object that it moves.
    pub object: String,
    /// The relation that the step achieves.
    pub relation: String,
    /// The other object of the relation.
    pub reference: String,
    /// Goal of the object in the frame of the reference: a location in units, and a rotation about the fixed axes X, then Y, then Z, in
    /// rad. Not a number if there is no goal.
    pub goal: [[f64; 3]; 2],
}

/// Two things that touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensedContact {
    /// The ids of the two.
    pub ids: [String; 2],
    /// The point of contact, in units.
    pub point: [f64; 3],
    /// The impulse with which they pushed each other in the last tick, in kg units/s.
    pub impulse: f64,
}

impl Sensor {
    /// The least that a robot of so many limbs with so many joints each senses, all of it 0.
    pub fn at_rest(size: [usize; 2]) -> Self {
        Self {
            joint_angles: JointMatrix::zeros(size),
            end_eff_pos: vec![[0.0; 3]; size[0]],
            gripper_opening: vec![0.0; size[0]],
            ..Self::default()
        }
    }

    /// The sensor as named arrays.
    pub fn arrays(&self) -> Arrays {
        let mut arrays = Arrays::default();
        let mut put = |name: &str, array| arrays.put(format!("sensor.{name}"), array);
        put("timeElapsed", Array::scalar(self.time_elapsed));
        put("jointAngles", self.joint_angles.array());
        put("endEffPos", Array::matrix(&self.end_eff_pos));
        put("gripperOpening", Array::row(self.gripper_opening.clone()));
        put("demoCue", Array::logical(self.demo_cue));
        if let Some(picture) = &self.picture {
            put("rgbVision", picture.array());
        }
        if let Some(points) = &self.tracker_loc {
            put("trackerLoc", Array::map(points.clone()));
        }
        if let Some(angle) = self.head_angle {
            put("headAngle", Array::scalar(angle));
        }
        if let Some(torques) = &self.joint_torques {
            put("jointTorques", torques.array());
        }
        for (limb, ids) in self.held.iter().flatten() {
            put(&format!("held.{limb}"), Array::texts(ids.clone()));
        }
        if let Some(controls) = &self.controls {
            let texts = |of: fn(&SensedControl) -> &String| {
                Array::texts(controls.iter().map(|control| of(control).clone()).collect())
            };
            put("controls.id", texts(|control| &control.id));
            put("controls.type", texts(|control| &control.kind));
            put("controls.object", texts(|control| &control.object));
            let states = controls.iter().map(|control| control.state);
            put("controls.state", Array::row(states.collect()));
            put("controls.stateName", texts(|control| &control.state_name));
        }
        if let Some(objects) = &self.objects {
            let texts = |of: fn(&SensedObject) -> &String| {
                Array::texts(objects.iter().map(|object| of(object).clone()).collect())
            };
            let points = |of: fn(&SensedObject) -> [f64; 3]| {
                Array::matrix(&objects.iter().map(of).collect::<Vec<_>>())
            };
            put("objects.id", texts(|object| &object.id));
            put("objects.position", points(|object| object.position));
            put("objects.rotation", points(|object| object.rotation));
            put(
                "objects.mass",
                Array::column(objects.iter().map(|object| object.mass).collect()),
            );
            put("objects.description", texts(|object| &object.description));
        }
        if let Some(seen) = &self.seen {
            let points = |of: fn(&SensedBelief) -> [f64; 3]| {
                Array::matrix(&seen.iter().map(of).collect::<Vec<_>>())
            };
            let ids = seen.iter().map(|belief| belief.id.clone());
            let sure = seen.iter().map(|belief| f64::from(belief.is_sure));
            put("seen.id", Array::texts(ids.collect()));
            put("seen.position", points(|belief| belief.position));
            put("seen.rotation", points(|belief| belief.rotation));
            put("seen.deviation", points(|belief| belief.deviation));
            put("seen.sure", Array::row(sure.collect()));
        }
        if let Some(steps) = &self.task {
            let texts = |of: fn(&SensedStep) -> &String| {
                Array::texts(steps.iter().map(|step| of(step).clone()).collect())
            };
            let goals = |part: usize| {
                Array::matrix(&steps.iter().map(|step| step.goal[part]).collect::<Vec<_>>())
            };
            put("task.sentence", texts(|step| &step.sentence));
            put("task.object", texts(|step| &step.object));
            put("task.relation", texts(|step| &step.relation));
            put("task.reference", texts(|step| &step.reference));
            put("task.goalPosition", goals(0));
            put("task.goalRotation", goals(1));
        }
        if let Some(contacts) = &self.contacts {
            let ids = |side: usize| {
                Array::texts(
                    contacts
                        .iter()
                        .map(|contact| contact.ids[side].clone())
                        .collect(),
                )
            };
            let points: Vec<_> = contacts.iter().map(|contact| contact.point).collect();
            put("contacts.first", ids(0));
            put("contacts.second", ids(1));
            put("contacts.point", Array::matrix(&points));
            put(
                "contacts.impulse",
                Array::column(contacts.iter().map(|contact| contact.impulse).collect()),
            );
        }
        arrays
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_turned_into_columns() {
        let picture = RgbImage::new(2, 1, vec![1, 2, 3, 4, 5, 6]).unwrap();
        let array = picture.array();
        assert_eq!(array.dims, [1, 2, 3]);
        assert_eq!(array.data, Data::Picture(vec![1, 4, 2, 5, 3, 6]));
        assert!(RgbImage::new(2, 2, vec![0; 6]).is_none());
        assert!(RgbImage::new(u32::MAX, u32::MAX, Vec::new()).is_none());
        assert_eq!(
            RgbImage::new(0, 3, Vec::new()).unwrap().array().dims,
            [3, 0, 3]
        );
    }

    #[test]
    fn fields_without_a_value_are_not_sent() {
        let names = |sensor: &Sensor| {
            sensor
                .arrays()
                .iter()
                .map(|(name, _)| name.to_owned())
                .collect::<Vec<_>>()
        };
        let bare = names(&Sensor::at_rest([2, 7]));
        assert_eq!(bare.len(), 5);
        let full = Sensor {
            objects: Some(vec![SensedObject::default()]),
            seen: Some(vec![SensedBelief {
                id: "a".into(),
                position: [f64::NAN; 3],
                rotation: [0.0; 3],
                deviation: [0.0; 3],
                is_sure: false,
            }]),
            contacts: Some(Vec::new()),
            controls: Some(vec![SensedControl::default()]),
            held: Some(vec![
                ("left".into(), vec!["a".into()]),
                ("right".into(), Vec::new()),
            ]),
            task: Some(vec![SensedStep::default(); 2]),
            ..Sensor::at_rest([2, 7])
        };
        assert!(full.arrays().encode().is_ok());
        for name in [
            "sensor.objects.position",
            "sensor.seen.deviation",
            "sensor.task.goalRotation",
        ] {
            assert!(names(&full).contains(&name.to_owned()), "{name}");
        }
    }
}
