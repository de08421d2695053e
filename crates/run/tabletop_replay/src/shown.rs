//! Imported recordings, shown: their objects go where the recorded states say, and nothing is simulated.

use std::{collections::BTreeSet, path::Path};

use bevy::prelude::*;
use tabletop_core::{
    Actor, CommandSystems, ObjectIndex, ObjectSpec, Paused, RecordingCommand, RestingSystems,
    SceneCommand, SceneItem, SceneSpec, SimCommand, SimSystems, SimTick, TickSystems,
};
use tabletop_geometry::Pose;
use tabletop_recorder::{RecordingReader, Session, SessionCommand};
use tabletop_robot::RobotPlugin;
use tabletop_sim::settings::{RobotSettings, Settings};
use tabletop_task::Demonstration;

use crate::{Replay, ReplayError};

/// The motions of an imported recording that is shown.
#[derive(Resource, Clone, Debug)]
pub(crate) struct ShownMotions(Demonstration);

impl ShownMotions {
    /// Reads an imported recording: how its objects move, and commands that put them there and take them away.
    pub(crate) fn read(folder: &Path) -> Result<(Replay, Self), ReplayError> {
        let recording = RecordingReader::open(folder)?;
        let motions = Self(Demonstration::of(&recording)?);
        let begin = recording.first_tick();
        let session = motions.session(&recording);
        let replay = Replay {
            session,
            begin,
            settings: Settings {
                physics: default(),
                robot: RobotSettings::default(),
            },
            robot: RobotPlugin::default(),
            recording,
        };
        Ok((replay, motions))
    }

    /// The session of the recording, with a scene whenever objects come or go.
    fn session(&self, recording: &RecordingReader) -> Session {
        let mut session = recording.session().clone();
        let (first, last) = (recording.first_tick(), recording.last_tick());
        let objects = self.0.objects.iter();
        let changes = objects.flat_map(|object| [Some(object.created), object.deleted]);
        let changes: BTreeSet<_> = changes.flatten().chain([first]).collect();
        let given = |tick: SimTick, command: SimCommand| SessionCommand {
            tick: tick.0,
            actor: Actor::Replay,
            command,
            at_once: false,
        };
        session.earlier.clear();
        session.header.earlier_commands = 0;
        session.commands = changes
            .range(first..=last)
            .map(|&tick| {
                given(
                    tick,
                    SceneCommand::Set(Box::new(self.scene_at(tick))).into(),
                )
            })
            .collect();
        session
            .commands
            .push(given(last, RecordingCommand::Finish.into()));
        session
    }

    /// The objects in a tick, all immovable: only the recording moves them.
    fn scene_at(&self, tick: SimTick) -> SceneSpec {
        let there = self.poses_at(tick).map(|(object, pose)| {
            SceneItem::Object(ObjectSpec {
                pose,
                mass: 0.0,
                ..object.clone()
            })
        });
        SceneSpec {
            table: self.0.table,
            items: there.collect(),
        }
    }

    fn poses_at(&self, tick: SimTick) -> impl Iterator<Item = (&ObjectSpec, Pose)> {
        let there = self.0.objects.iter().filter(move |object| {
            object.created <= tick && object.deleted.is_none_or(|deleted| tick < deleted)
        });
        there.filter_map(move |object| Some((&object.spec, object.track.at(tick)?)))
    }
}

/// Lets the objects of an imported recording go where they were.
pub(crate) fn plugin(app: &mut App) {
    app.add_systems(
        FixedUpdate,
        move_shown
            .after(CommandSystems::Robot)
            .before(SimSystems::Actuate)
            .in_set(TickSystems)
            .in_set(RestingSystems)
            .run_if(resource_exists::<ShownMotions>),
    );
}

fn move_shown(
    motions: Res<ShownMotions>,
    tick: Res<SimTick>,
    paused: Res<Paused>,
    index: Res<ObjectIndex>,
    mut places: Query<&mut Transform, With<ObjectSpec>>,
) {
    if paused.0 {
        return;
    }
    for (spec, pose) in motions.poses_at(*tick) {
        if let Some(entity) = index.get(&spec.id)
            && let Ok(mut place) = places.get_mut(entity)
        {
            place.set_if_neq(Transform {
                translation: pose.location,
                rotation: pose.rotation,
                scale: place.scale,
            });
        }
    }
}
