//! Quantities over time, as the user looks at them.

use std::{collections::BTreeMap, path::PathBuf};

use bevy::prelude::*;

/// A quantity that can be plotted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// The coordinates of objects, in units.
    #[default]
    Places,
    /// The angles of objects about the fixed X, then Y, then Z axis, in degrees.
    Angles,
    /// The speeds of objects, in units/s.
    Speeds,
    /// The positions of the robot's joints, in rad.
    Joints,
    /// The velocities of the robot's joints, in rad/s.
    JointVelocities,
    /// The torques of the robot's motors, in N m.
    Torques,
    /// The openings of the robot's grippers, in units.
    Grippers,
    /// The impulses of the robot's contacts with the table and each object, in kg units/s.
    Contacts,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 8] = [
        Self::Places,
        Self::Angles,
        Self::Speeds,
        Self::Joints,
        Self::JointVelocities,
        Self::Torques,
        Self::Grippers,
        Self::Contacts,
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Places => "Places of objects",
            Self::Angles => "Angles of objects",
            Self::Speeds => "Speeds of objects",
            Self::Joints => "Joints",
            Self::JointVelocities => "Velocities of joints",
            Self::Torques => "Torques of motors",
            Self::Grippers => "Openings of grippers",
            Self::Contacts => "Contacts of the robot",
        }
    }

    /// Its unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Places | Self::Grippers => "units of 10 cm",
            Self::Angles => "°",
            Self::Speeds => "units/s",
            Self::Joints => "rad",
            Self::JointVelocities => "rad/s",
            Self::Torques => "N m",
            Self::Contacts => "kg units/s",
        }
    }

    /// True if an object has it; else the robot has it.
    pub const fn is_of_object(self) -> bool {
        match self {
            Self::Places | Self::Angles | Self::Speeds => true,
            Self::Joints
            | Self::JointVelocities
            | Self::Torques
            | Self::Grippers
            | Self::Contacts => false,
        }
    }
}

/// The curves of all quantities. A name is that of an object or joint, with a coordinate if there are several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves(BTreeMap<Quantity, BTreeMap<String, Vec<[f64; 2]>>>);

impl Curves {
    /// The curves of a quantity, by name: pairs of seconds and value.
    pub fn of(&self, quantity: Quantity) -> impl Iterator<Item = (&str, &[[f64; 2]])> {
        let curves = self.0.get(&quantity).into_iter().flatten();
        curves.map(|(name, points)| (name.as_str(), points.as_slice()))
    }

    /// Adds a point to a curve. Since the one before it, the value was the same until `hold`, in seconds.
    pub fn add(&mut self, quantity: Quantity, name: &str, hold: f64, [seconds, value]: [f64; 2]) {
        let curves = self.0.entry(quantity).or_default();
        if !curves.contains_key(name) {
            curves.insert(name.to_owned(), Vec::new());
        }
        let Some(points) = curves.get_mut(name) else {
            return;
        };
        if let Some(&[last, before]) = points.last()
            && last < hold
            && before != value
        {
            points.push([hold, before]);
        }
        points.push([seconds, value]);
    }

    /// Lets every curve go on unchanged to a time, in seconds.
    pub fn extend_to(&mut self, seconds: f64) {
        for points in self.0.values_mut().flat_map(BTreeMap::values_mut) {
            if let Some(&[last, value]) = points.last()
                && last < seconds
            {
                points.push([seconds, value]);
            }
        }
    }

    /// Forgets what was before a time, in seconds, and curves of which nothing is left.
    pub fn forget_before(&mut self, seconds: f64) {
        for curves in self.0.values_mut() {
            for points in curves.values_mut() {
                let gone = points.partition_point(|[at, _]| *at < seconds);
                points.drain(..gone);
            }
            curves.retain(|_, points| !points.is_empty());
        }
    }

    /// The latest time, in seconds.
    pub fn end(&self) -> Option<f64> {
        let all = self.0.values().flat_map(BTreeMap::values);
        let ends = all.filter_map(|points| Some(points.last()?[0]));
        ends.reduce(f64::max)
    }

    /// Keeps at most so many points of each curve, evenly.
    pub fn thin(&mut self, most: usize) {
        for points in self.0.values_mut().flat_map(BTreeMap::values_mut) {
            let step = points.len().div_ceil(most.max(1));
            if step > 1 {
                let last = points.last().copied();
                let mut index = 0;
                points.retain(|_| {
                    index += 1;
                    (index - 1) % step == 0
                });
                points.extend(last);
            }
        }
    }
}

/// The curves of the recording that the timeline shows.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct RecordedCurves {
    /// The recording's folder.
    pub folder: PathBuf,
    /// The curves, over the seconds from its beginning; `None` while they are being read, the reason if they cannot be.
    pub curves: Option<Result<Curves, String>>,
}

/// The curves that the user looks at, for saving.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct ShownCurves {
    /// The quantity.
    pub quantity: Quantity,
    /// The name of each curve, and pairs of seconds and value.
    pub curves: Vec<(String, Vec<[f64; 2]>)>,
    /// The place of the plot in the window: left, top, right and bottom in pixels.
    pub place: [f32; 4],
}

impl ShownCurves {
    /// The curves as CSV, a row for each point.
    pub fn csv(&self) -> String {
        let mut text = format!("seconds,name,{}\n", self.quantity.unit());
        for (name, points) in &self.curves {
            let name = match name.contains([',', '"', '\n', '\r']) {
                true => format!("\"{}\"", name.replace('"', "\"\"")),
                false => name.clone(),
            };
            for [seconds, value] in points {
                text.push_str(&format!("{seconds},{name},{value}\n"));
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(curves: &Curves) -> Vec<[f64; 2]> {
        let (_, points) = curves.of(Quantity::Joints).next().unwrap();
        points.to_vec()
    }

    #[test]
    fn a_value_stays_until_it_changes() {
        let mut curves = Curves::default();
        let mut add = |hold, point| curves.add(Quantity::Joints, "w0", hold, point);
        add(0.0, [0.0, 1.0]);
        add(4.9, [5.0, 2.0]);
        add(5.0, [5.1, 3.0]);
        curves.extend_to(9.0);
        let expected = [[0.0, 1.0], [4.9, 1.0], [5.0, 2.0], [5.1, 3.0], [9.0, 3.0]];
        assert_eq!(points(&curves), expected);
        curves.forget_before(5.05);
        assert_eq!(points(&curves), expected[3..]);
        assert_eq!(curves.end(), Some(9.0));
        curves.forget_before(10.0);
        assert_eq!(curves.of(Quantity::Joints).count(), 0);
    }

    #[test]
    fn long_curves_are_thinned_and_keep_their_end() {
        let mut curves = Curves::default();
        for tick in 0..1000 {
            let at = f64::from(tick);
            curves.add(Quantity::Joints, "w0", at - 1.0, [at, at]);
        }
        curves.thin(100);
        let points = points(&curves);
        assert!((100..=102).contains(&points.len()), "{}", points.len());
        assert_eq!(points.last(), Some(&[999.0, 999.0]));
    }

    #[test]
    fn a_table_has_a_row_for_each_point() {
        let shown = ShownCurves {
            quantity: Quantity::Speeds,
            curves: vec![("a,b".into(), vec![[0.0, 1.5], [0.25, 2.0]])],
            ..default()
        };
        assert_eq!(
            shown.csv(),
            "seconds,name,units/s\n0,\"a,b\",1.5\n0.25,\"a,b\",2\n"
        );
    }
}
