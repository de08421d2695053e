//! Watching: a demonstration, from the pictures of the head camera alone.

mod doubt;

use bevy::math::Quat;
use tabletop_camera::Camera;
use tabletop_core::{JointSpec, ObjectSpec, Picture, SimTick, Table};
use tabletop_geometry::Pose;
use tabletop_task::{Demonstration, Track, angle_between};
use tabletop_vision::{Eyes, KnownObject, KnownScenery, ObjectPercept, with_guides};

pub use doubt::Doubt;
use doubt::{Certainty, doubts};

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
    /// The first picture and what is in it besides the objects, if it does not show all of them.
    beginning: Option<(Picture, KnownScenery)>,
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
    /// How certain it was in each picture.
    certainties: Vec<(SimTick, Certainty)>,
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
            certainties: Vec::new(),
        });
        Self {
            objects: watched.collect(),
            first: Some(Eyes::new(described, camera, table).adapting()),
            eyes: Eyes::new(known, camera, table).adapting(),
            table,
            joints,
            beginning: None,
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

    /// Watches the next picture, of this tick of the demonstration, in which something is besides the objects. Ticks must ascend.
    pub fn watch(&mut self, tick: SimTick, picture: &Picture, scenery: &KnownScenery) {
        let percept = match self.first.take() {
            Some(mut eyes) => {
                let mut percept = eyes.look(picture, scenery);
                let places = self.objects.iter().map(|object| Some(object.spec.pose));
                eyes.name_by_place(&places.collect::<Vec<_>>(), &mut percept);
                self.eyes.remember(eyes.remembered());
                self.eyes.adapt_like(&eyes);
                if percept.objects.iter().any(|seen| !seen.is_sure) {
                    self.beginning = Some((picture.clone(), scenery.clone()));
                }
                percept
            }
            None => self.eyes.look(picture, scenery),
        };
        let is_first = self.last.replace(tick).is_none();
        let mut found = Vec::new();
        for (i, seen) in percept.objects.into_iter().enumerate() {
            let object = &mut self.objects[i];
            let was_seen = object.pose.is_some();
            object.see(tick, &seen, self.still);
            if !is_first && !was_seen && object.pose.is_some() {
                found.push(i);
            }
        }
        self.look_back(&found);
    }

    /// Looks at the first picture again with the objects where they were seen first. It leaves no doubt about those that were hidden there then.
    fn look_back(&mut self, found: &[usize]) {
        let Some((picture, scenery)) = self.beginning.as_ref().filter(|_| !found.is_empty()) else {
            return;
        };
        let first = self.objects.iter().map(|it| it.track.at(SimTick(0)));
        let first: Vec<_> = first.collect();
        let mut eyes = self.eyes.clone();
        eyes.remember(first.iter().copied());
        let percept = eyes.look(picture, scenery);
        for &i in found {
            let seen = &percept.objects[i];
            let is_there = first[i]
                .zip(seen.pose)
                .is_some_and(|(first, pose)| pose.location.distance(first.location) < self.still.0);
            if is_there && seen.is_explained {
                for (_, certainty) in &mut self.objects[i].certainties {
                    if let Certainty::Unsure(_) = certainty {
                        *certainty = Certainty::Explained;
                    }
                }
            }
        }
    }

    /// The poses of the objects after the last picture, by id; `None` if an object was not seen yet.
    pub fn poses(&self) -> impl Iterator<Item = (&str, Option<Pose>)> {
        let objects = self.objects.iter();
        objects.map(|object| (object.spec.id.as_str(), object.pose))
    }

    /// The times in which it was not sure of an object, by object and time.
    pub fn doubts(&self) -> Vec<Doubt> {
        let objects = self.objects.iter();
        let doubts = objects.flat_map(|object| doubts(&object.spec.id, &object.certainties));
        doubts.collect()
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
    fn see(&mut self, tick: SimTick, seen: &ObjectPercept, still: (f32, f32)) {
        // What is hidden may be anywhere, but the eyes leave it where it was.
        let slack = |deviation: f32| match deviation.is_finite() {
            true => CERTAIN * deviation,
            false => 0.0,
        };
        let still = (
            still.0 + slack(seen.deviation.location.length()),
            still.1 + slack(seen.deviation.yaw),
        );
        let pose = seen.pose.map(|pose| match self.pose {
            Some(before) => self.known.turned_least(pose, before.rotation),
            None => pose,
        });
        let is_near = |one: Pose, other: Pose| {
            one.location.distance(other.location) < still.0
                && angle_between(one.rotation, other.rotation) < still.1
        };
        let is_still = pose
            .zip(self.pose)
            .is_some_and(|(pose, before)| is_near(pose, before));
        let certainty = match pose {
            Some(pose) if seen.is_sure => {
                if !is_still {
                    self.track.push(tick, pose);
                    self.pose = Some(pose);
                }
                Certainty::Sure {
                    pose,
                    has_moved: !is_still,
                }
            }
            Some(_) if seen.is_explained && is_still => Certainty::Explained,
            pose => Certainty::Unsure(pose),
        };
        self.certainties.push((tick, certainty));
    }
}
