//! Two demonstrations, side by side.

use crate::{
    demonstration::{Demonstration, ShownObject},
    rotation::angle_between,
};

/// An object in two demonstrations.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedObject {
    /// Its id.
    pub id: String,
    /// The length of its way in each, in units; `None` where it is not.
    pub ways: [Option<f32>; 2],
    /// How far apart it is in the end, in units, and by which angle it is turned, in rad; `None` if one of the two has no such object in the end.
    pub apart: Option<(f32, f32)>,
}

/// The objects of two demonstrations: those of the first, and those that only the second has.
///
/// ```
/// use bevy::math::Vec3;
/// use tabletop_core::{ObjectSpec, Shape, SimTick, Table};
/// use tabletop_geometry::{Pose, Rgb};
/// use tabletop_task::{Demonstration, Track, compare};
///
/// let ball = |x: f32| {
///     let shape = Shape::Sphere { radius: 0.5, color: Rgb::RED };
///     let mut track = Track::default();
///     track.push(SimTick(0), Pose::IDENTITY);
///     track.push(SimTick(9), Pose::at(Vec3::X * x));
///     let object = (ObjectSpec::new("ball", Pose::IDENTITY, 1.0, shape), track);
///     Demonstration::of_motions(Table::default(), [object], Vec::new(), SimTick(10))
/// };
/// let [compared] = &compare(&ball(2.0), &ball(3.0))[..] else { panic!() };
/// assert_eq!(compared.ways, [Some(2.0), Some(3.0)]);
/// assert_eq!(compared.apart, Some((1.0, 0.0)));
/// ```
pub fn compare(one: &Demonstration, other: &Demonstration) -> Vec<ComparedObject> {
    let find = |shown: &Demonstration, id: &str| {
        let mut objects = shown.objects.iter();
        objects.position(|object| object.spec.id == id)
    };
    let firsts = one.objects.iter().map(|object| object.spec.id.as_str());
    let seconds = other.objects.iter().map(|object| object.spec.id.as_str());
    let seconds = seconds.filter(|id| find(one, id).is_none());
    let compared = firsts.chain(seconds).map(|id| {
        let objects = [one, other].map(|shown| find(shown, id).map(|at| &shown.objects[at]));
        let last = |object: Option<&ShownObject>| {
            let object = object.filter(|object| object.deleted.is_none())?;
            object.track.entries().last().map(|(_, pose)| pose)
        };
        let [first, second] = objects.map(last);
        ComparedObject {
            id: id.to_owned(),
            ways: objects.map(|object| Some(object?.track.length())),
            apart: first.zip(second).map(|(first, second)| {
                let angle = angle_between(first.rotation, second.rotation);
                (first.location.distance(second.location), angle)
            }),
        }
    });
    compared.collect()
}
