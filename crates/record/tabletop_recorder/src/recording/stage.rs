//! The world as recordings see it.

use std::time::Duration;

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    HandCamera, HandCameras, HandImages, HeadCamera, Joint, JointState, ObjectIndex, ObjectSpec,
    Paused, Robot, RobotLayout, Shape, Table,
};
use tabletop_geometry::Twist;

use crate::{
    files::{
        hand_pictures::HandPictures,
        session::{SessionObject, SessionScene, SessionSettings},
        states::ObjectState,
    },
    recording::tracked::Tracked,
};

/// The world as recordings see it.
#[derive(SystemParam)]
pub(crate) struct RecordedWorld<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<
        'w,
        's,
        (
            &'static ObjectSpec,
            &'static Transform,
            Option<&'static Twist>,
        ),
    >,
    tables: Query<'w, 's, &'static Table>,
    joints: Query<'w, 's, &'static Joint>,
    pub(crate) camera: Option<Res<'w, HeadCamera>>,
    hand_cameras: Res<'w, HandCameras>,
    pub(crate) hand_images: Res<'w, HandImages>,
    pub(crate) settings: Res<'w, SessionSettings>,
    robot: Res<'w, Robot>,
    pub(crate) paused: Res<'w, Paused>,
    pub(crate) layout: Res<'w, RobotLayout>,
}

impl RecordedWorld<'_, '_> {
    pub(crate) fn scene(&self) -> SessionScene {
        let place = |object| self.index.iter().position(|other| other == object);
        let mut joints: Vec<_> = self.joints.iter().collect();
        joints.sort_by_key(|joint| joint.objects.map(place));
        let objects = self.index.iter().filter_map(|object| {
            let (spec, transform, _) = self.objects.get(object).ok()?;
            Some(SessionObject {
                pose: transform.into(),
                spec: spec.clone(),
            })
        });
        SessionScene {
            table: self.tables.iter().next().copied(),
            objects: objects.collect(),
            joints: joints
                .into_iter()
                .filter_map(|joint| joint.spec(|object| self.id(object)))
                .collect(),
        }
    }

    fn id(&self, object: Entity) -> Option<String> {
        self.spec(object).map(|spec| spec.id.clone())
    }

    pub(crate) fn spec(&self, object: Entity) -> Option<&ObjectSpec> {
        self.objects.get(object).ok().map(|(spec, ..)| spec)
    }

    pub(crate) fn shown(&self, entity: Entity) -> PixelSubject<'_> {
        match self.spec(entity) {
            Some(spec) => PixelSubject::Object(spec),
            None if self.tables.contains(entity) => PixelSubject::Table,
            None => PixelSubject::Other,
        }
    }

    pub(crate) fn state(&self, id: &str) -> Option<ObjectState> {
        let (_, transform, twist) = self.objects.get(self.index.get(id)?).ok()?;
        Some(ObjectState {
            pose: transform.into(),
            twist: twist.copied().unwrap_or_default(),
        })
    }

    /// The robot's joints.
    pub(crate) fn joints(&self) -> &[JointState] {
        &self.robot.joints
    }

    /// The hand cameras whose pictures are to be recorded.
    pub(crate) fn hand_cameras(&self, pictures: &HandPictures) -> Vec<HandCamera> {
        match pictures {
            HandPictures::None => Vec::new(),
            HandPictures::OfAll => self.hand_cameras.0.to_vec(),
            HandPictures::Of(cameras) => cameras.clone(),
        }
    }

    /// The sight of these objects and the robot, wherever they are; and of the robot's posture, if hand cameras are to see it. A picture of a
    /// real camera was `received` at this time.
    pub(crate) fn sight(
        &self,
        objects: &[Tracked],
        hands_see: bool,
        received: Option<Duration>,
    ) -> FrameSight {
        let shape = |id: &str| Some(self.spec(self.index.get(id)?)?.shape.clone());
        let seen = objects
            .iter()
            .filter_map(|object| Some((object.number, shape(&object.id)?)));
        FrameSight {
            objects: seen.collect(),
            robot: self.robot.is_shown,
            posture: match hands_see {
                true => self
                    .robot
                    .joints
                    .iter()
                    .map(|joint| joint.position)
                    .collect(),
                false => Vec::new(),
            },
            received,
        }
    }
}

/// The subject of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PixelSubject<'w> {
    Table,
    Object(&'w ObjectSpec),
    Other,
}

/// The sight of a frame: everything that can be seen, wherever it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FrameSight {
    /// The number of each object's `create` line, and how it looks.
    objects: Vec<(usize, Shape)>,
    /// True if the robot stands at the table.
    robot: bool,
    /// The positions of its joints, where hand cameras see by them.
    posture: Vec<f64>,
    /// When the picture of a real camera arrived.
    received: Option<Duration>,
}
