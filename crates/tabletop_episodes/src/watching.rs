//! Watching: a demonstration, from the pictures of the head camera alone.

use bevy::math::Quat;
use tabletop_camera::Camera;
use tabletop_core::{JointSpec, ObjectSpec, Picture, SimTick, Table};
use tabletop_geometry::Pose;
use tabletop_task::{Demonstration, Track, angle_between};
use tabletop_vision::{Eyes, KnownObject, KnownScenery, ObjectPercept, with_guides};

/// The largest displacement, in units, and the largest turn, in rad, of an object between two pictures that is an error of the eyes and no motion, besides
/// what is uncertain: if its shape is known, and if it was only described by what a picture shows of it.
const STILL: (f32, f32) = (0.02, 0.03);
const STILL_IF_DESCRIBED: (f32, f32) = (0.1, 0.06);
/// The number of standard deviations within which a pose is certain.
const CERTAIN: f32 = 3.0;

/// A watcher of a demonstration: knows the shapes and colours of the objects, and not where they are.
pub struct Watcher {
    table: Table,
    objects: Vec<Watched>,
    joints: Vec<JointSpec>,
    /// The eyes for the first picture, in which objects stand as they are described.
    first: Option<Eyes>,
    eyes: Eyes,
    /// The tick of the last picture.
    last: Option<SimTick>,
    /// The largest motion between two pictures that is none.
    still: (f32, f32),
}

/// An object that is watched.
struct Watched {
    spec: ObjectSpec,
    known: KnownObject,
    track: Track,
    pose: Option<Pose>,
}

impl Watcher {
    /// A watcher of these objects, each of which stands in the first picture as it does in its description, turned about the vertical by any angle. Its
    /// place in there only tells which of several objects that look the same has which id.
    pub fn new(
        objects: Vec<ObjectSpec>,
        joints: Vec<JointSpec>,
        table: Table,
        camera: Camera,
    ) -> Self {
        let described = known_objects(&objects, &joints, |known, own| known.standing([own]));
        let known = known_objects(&objects, &joints, KnownObject::on_any_side);
        let watched = objects.into_iter().zip(&known);
        let watched = watched.map(|(spec, known)| Watched {
            known: known.clone(),
            spec,
            track: Track::default(),
            pose: None,
        });
        Self {
            objects: watched.collect(),
            first: Some(Eyes::new(described, camera, table)),
            eyes: Eyes::new(known, camera, table),
            table,
            joints,
            last: None,
            still: STILL,
        }
    }

    /// The same watcher of objects whose shapes are only described by what a picture shows of them, and so not exact.
    #[must_use]
    pub const fn of_described(mut self) -> Self {
        self.still = STILL_IF_DESCRIBED;
        self
    }

    /// Watches the next picture, of this tick of the demonstration. Ticks must ascend.
    pub fn watch(&mut self, tick: SimTick, picture: &Picture) {
        let percept = match self.first.take() {
            Some(mut eyes) => {
                let mut percept = eyes.look(picture, &KnownScenery::default());
                let places = self.objects.iter().map(|object| Some(object.spec.pose));
                eyes.name_by_place(&places.collect::<Vec<_>>(), &mut percept);
                self.eyes.remember(eyes.remembered());
                percept
            }
            None => self.eyes.look(picture, &KnownScenery::default()),
        };
        self.last = Some(tick);
        for (object, seen) in self.objects.iter_mut().zip(percept.objects) {
            if let ObjectPercept {
                pose: Some(pose),
                deviation,
                is_sure: true,
                ..
            } = seen
            {
                let still = (
                    self.still.0 + CERTAIN * deviation.location.length(),
                    self.still.1 + CERTAIN * deviation.yaw,
                );
                object.see(tick, pose, still);
            }
        }
    }

    /// The poses of the objects after the last picture, by id; of those that were seen.
    pub fn poses(&self) -> impl Iterator<Item = (&str, Pose)> {
        let objects = self.objects.iter();
        objects.filter_map(|object| Some((object.spec.id.as_str(), object.pose?)))
    }

    /// The demonstration that was watched. Objects that were never seen are not part of it.
    pub fn demonstration(self) -> Demonstration {
        let objects = self.objects.into_iter().filter_map(|mut object| {
            object.spec.pose = object.track.at(SimTick(0))?;
            Some((object.spec, object.track))
        });
        Demonstration::of_motions(
            self.table,
            objects,
            self.joints,
            self.last.unwrap_or_default(),
        )
    }
}

/// What eyes know of objects that stand in some way, by their rotations.
fn known_objects(
    objects: &[ObjectSpec],
    joints: &[JointSpec],
    standing: impl Fn(KnownObject, Quat) -> KnownObject,
) -> Vec<KnownObject> {
    let known = objects.iter().map(|spec| {
        let known = standing(KnownObject::described_by(spec), spec.pose.rotation);
        (spec.id.clone(), known)
    });
    with_guides(&known.collect::<Vec<_>>(), joints)
}

impl Watched {
    fn see(&mut self, tick: SimTick, pose: Pose, still: (f32, f32)) {
        let pose = match self.pose {
            Some(before) => self.known.turned_least(pose, before.rotation),
            None => pose,
        };
        let is_still = |before: Pose| {
            before.location.distance(pose.location) < still.0
                && angle_between(before.rotation, pose.rotation) < still.1
        };
        if !self.pose.is_some_and(is_still) {
            self.track.push(tick, pose);
            self.pose = Some(pose);
        }
    }
}
