//! The scene at the beginning of a recording.

use tabletop_core::{ObjectSpec, SceneCommand, SceneItem, SceneSpec, SimCommand};
use tabletop_recorder::Session;
use tabletop_scene::{IdAllocator, assemble};

use crate::imitation::moved;

/// The scene at the beginning of a recording: the last one that was set before, with every object at its pose in the first tick, without
/// removed objects and with added ones. `None` if no scene was set.
pub fn scene_at_beginning(session: &Session) -> Option<SceneSpec> {
    let mut set = session.earlier.iter().rev().filter_map(|command| {
        let SimCommand::Scene(SceneCommand::Set(scene)) = &command.command else {
            return None;
        };
        Some(&**scene)
    });
    let scene = set.next()?;
    let there = &session.scene.objects;
    let mut ids = IdAllocator::default();
    let mut items = Vec::new();
    let mut known = Vec::new();
    for item in &scene.items {
        let alone = SceneSpec {
            table: scene.table,
            items: vec![item.clone()],
        };
        let parts = assemble(&alone, &mut ids).objects;
        let Some(first) = parts.first() else {
            continue;
        };
        let now = there.iter().find(|object| object.spec.id == first.id);
        if let Some(now) = now {
            items.push(moved(item, now.pose * first.pose.inverse()));
        }
        known.extend(parts.into_iter().map(|part| part.id));
    }
    let is_jointed = |id: &str| {
        let mut joints = session.scene.joints.iter();
        joints.any(|joint| joint.objects.iter().any(|object| object == id))
    };
    let new = there.iter().filter(|object| {
        let id = &object.spec.id;
        !known.contains(id) && !is_jointed(id)
    });
    items.extend(new.map(|object| {
        SceneItem::Object(ObjectSpec {
            pose: object.pose,
            ..object.spec.clone()
        })
    }));
    Some(SceneSpec {
        table: session.scene.table.unwrap_or(scene.table),
        items,
    })
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::{Actor, Shape, Table};
    use tabletop_geometry::{Pose, Rgb};
    use tabletop_recorder::{SessionCommand, SessionHeader, SessionObject, SessionScene};

    use super::*;

    fn block(id: &str, x: f32) -> ObjectSpec {
        let shape = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::RED,
        };
        ObjectSpec::new(id, Pose::at(Vec3::new(x, 0.0, 0.5)), 1.0, shape)
    }

    #[test]
    fn the_scene_includes_changes_before_the_recording() {
        let item = |spec| SceneItem::Object(spec);
        let set = SceneSpec {
            table: Table::default(),
            items: vec![item(block("moved", 0.0)), item(block("removed", 2.0))],
        };
        let now = |spec: ObjectSpec, x: f32| SessionObject {
            pose: Pose::at(Vec3::new(x, 1.0, 0.5)),
            spec,
        };
        let session = Session {
            header: SessionHeader {
                format: 4,
                program: String::new(),
                ticks_per_second: 60,
                ticks_per_frame: 15,
                begin_tick: Some(0),
                start_tick: 90,
                earlier_commands: 1,
                camera: None,
                hand_cameras: Vec::new(),
                settings: serde_json::Map::new(),
            },
            scene: SessionScene {
                table: Some(Table::default()),
                objects: vec![now(block("moved", 0.0), 4.0), now(block("made", 0.0), -4.0)],
                joints: Vec::new(),
            },
            earlier: vec![SessionCommand {
                tick: 0,
                actor: Actor::App,
                command: SceneCommand::Set(Box::new(set)).into(),
                at_once: false,
            }],
            commands: Vec::new(),
            segments: Vec::new(),
        };
        let scene = scene_at_beginning(&session).unwrap();
        let found: Vec<_> = scene
            .items
            .iter()
            .filter_map(|item| match item {
                SceneItem::Object(spec) => Some((spec.id.as_str(), spec.pose.location.x)),
                SceneItem::Chain(_) | SceneItem::LidBox(_) | SceneItem::Jointed(_) => None,
            })
            .collect();
        assert_eq!(found, [("moved", 4.0), ("made", -4.0)]);
    }
}
