//! The world as scenarios see it: its state at the end of the last tick.

use bevy::prelude::*;
use tabletop_core::{Bonds, Hand, Joint, ObjectSpec, Robot, RobotLayout, Table};
use tabletop_geometry::{Bounds, Pose};
use tabletop_program::TableScene;

/// The world as a scenario sees it.
#[derive(Clone, Debug)]
pub(crate) struct Seen<'a> {
    /// The objects in the order of their creation.
    pub objects: Vec<ScenarioObject<'a>>,
    /// The table.
    pub table: Option<Table>,
    /// The joints between objects.
    pub joints: Vec<Joint>,
    /// The selected hand.
    pub selected: Hand,
    /// True if the simulation is paused.
    pub paused: bool,
    /// The bonds on the table.
    pub bonds: &'a Bonds,
    /// The robot.
    pub robot: &'a Robot,
    /// Its limbs and joints.
    pub layout: &'a RobotLayout,
}

/// An object as a scenario sees it.
#[derive(Clone, Debug)]
pub(crate) struct ScenarioObject<'a> {
    /// Its entity.
    pub entity: Entity,
    /// Its description.
    pub spec: &'a ObjectSpec,
    /// Its place.
    pub pose: Pose,
    /// The hand that holds it.
    pub holder: Option<Hand>,
}

impl ScenarioObject<'_> {
    /// The upright cuboid around it.
    pub fn bounds(&self) -> Bounds {
        self.spec.shape.bounds(self.pose)
    }
}

impl<'a> Seen<'a> {
    /// The object with this id, or the reason why there is none.
    pub fn object(&self, id: &str) -> Result<&ScenarioObject<'a>, String> {
        self.objects
            .iter()
            .find(|object| object.spec.id == id)
            .ok_or_else(|| format!("expected an object `{id}`, found none of that id"))
    }

    /// The table as programs of tasks see it.
    pub fn table_scene(&self) -> TableScene {
        let objects = self.objects.iter().map(|object| ObjectSpec {
            pose: object.pose,
            ..object.spec.clone()
        });
        let id = |entity: Entity| {
            let mut objects = self.objects.iter();
            let object = objects.find(|object| object.entity == entity)?;
            Some(object.spec.id.clone())
        };
        let joints = self.joints.iter().filter_map(|joint| joint.spec(id));
        TableScene {
            table: self.table.unwrap_or_default(),
            objects: objects.collect(),
            joints: joints.collect(),
        }
    }

    /// The object in a hand, or the reason why there is none.
    pub fn held_by(&self, hand: Hand) -> Result<&ScenarioObject<'a>, String> {
        self.objects
            .iter()
            .find(|object| object.holder == Some(hand))
            .ok_or_else(|| format!("expected something in {hand}, found nothing"))
    }
}
