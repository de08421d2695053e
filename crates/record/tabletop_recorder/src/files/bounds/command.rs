//! Bounds on commands.

use bevy::math::Vec3;
use tabletop_core::{
    ClockCommand, Drive, HandCommand, MechanismCommand, ObjectEdit, RecordingCommand, RobotCommand,
    SceneCommand, SimCommand,
};

use crate::files::bounds::{
    object::check_object,
    scene::check_scene_spec,
    values::{Checked, at, check_count, check_parts, finite, finite_pose},
};

pub(crate) fn check_command(command: &SimCommand) -> Checked {
    match command {
        SimCommand::Recording(RecordingCommand::Finish)
        | SimCommand::Clock(ClockCommand::SetPaused(_)) => Ok(()),
        SimCommand::Recording(RecordingCommand::Start) | SimCommand::History(_) => {
            Err("no recording holds this command".into())
        }
        SimCommand::Scene(command) => check_scene_command(command),
        SimCommand::Hand(command) => check_hand_command(command),
        SimCommand::Mechanism(command) => check_mechanism_command(command),
        SimCommand::Robot(command) => check_robot_command(command),
    }
}

fn check_scene_command(command: &SceneCommand) -> Checked {
    match command {
        SceneCommand::Load(_) => Err("a recording holds scenes, not names of task files".into()),
        SceneCommand::Set(scene) => check_scene_spec(scene),
        SceneCommand::Clear => Ok(()),
        SceneCommand::Make { preset, .. } => preset.fault().map_or(Ok(()), Err),
        SceneCommand::Edit(edits) => check_edits(edits),
    }
}

fn check_edits(edits: &[ObjectEdit]) -> Checked {
    let mut parts = 0;
    edits.iter().try_for_each(|edit| match edit {
        ObjectEdit::Add(spec) => check_object(spec, &mut parts).map_err(at(&spec.id)),
        ObjectEdit::Change { object, spec } => {
            check_count("letters", object.len())?;
            check_object(spec, &mut parts).map_err(at(object))
        }
        ObjectEdit::Remove(object) => {
            parts += 1;
            check_parts(parts)?;
            check_count("letters", object.len())
        }
    })
}

fn check_hand_command(command: &HandCommand) -> Checked {
    match command {
        HandCommand::Select(_) | HandCommand::Release(_) | HandCommand::Destroy(_) => Ok(()),
        HandCommand::Grasp { object, .. } => check_count("letters", object.len()),
        HandCommand::MoveTo { location, .. } => finite("location", *location),
        HandCommand::MoveBy { offset, .. } => finite("offset", *offset),
        HandCommand::Turn { axis, degrees, .. } => {
            finite("axis", *axis)?;
            finite("degrees", Vec3::splat(*degrees))
        }
    }
}

fn check_mechanism_command(command: &MechanismCommand) -> Checked {
    let id = match command {
        MechanismCommand::Trigger { control, .. } => control,
        MechanismCommand::PointTo { target, .. } => target,
        MechanismCommand::Fasten { guest, .. } | MechanismCommand::Loosen { guest, .. } => guest,
        MechanismCommand::Cut { blade, .. } => blade,
    };
    check_count("letters", id.len())
}

fn check_robot_command(command: &RobotCommand) -> Checked {
    match command {
        RobotCommand::Show(_) | RobotCommand::ShowFace(_) => Ok(()),
        RobotCommand::Drive(drives) => {
            check_count("drives", drives.len())?;
            let is_finite = drives.iter().all(|(_, drive)| match *drive {
                Drive::Velocity(value)
                | Drive::Position(value)
                | Drive::Toward(value)
                | Drive::Torque(value) => value.is_finite(),
            });
            match is_finite {
                true => Ok(()),
                false => Err("Drive: a number is not finite".into()),
            }
        }
        RobotCommand::Mirror(measured) => {
            check_count("measured joints", measured.len())?;
            match measured.iter().all(|(_, joint)| joint.is_finite()) {
                true => Ok(()),
                false => Err("Mirror: a number is not finite".into()),
            }
        }
        RobotCommand::ReachTo { pose, .. } => finite_pose(*pose),
        RobotCommand::ShowMarkers(markers) => {
            check_count("markers", markers.len())?;
            markers
                .iter()
                .try_for_each(|marker| finite("ShowMarkers", *marker))
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::prelude::default;
    use tabletop_core::{Hand, ObjectSpec, Part, Preset, SceneItem, SceneSpec, Shape};
    use tabletop_geometry::{Pose, Rgb};

    use super::*;
    use crate::files::bounds::values::MOST_VALUES;

    fn block() -> Shape {
        Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        }
    }

    fn nested(levels: usize) -> Shape {
        (0..levels).fold(block(), |shape, _| Shape::Composite {
            parts: vec![Part {
                pointable: false,
                id: String::new(),
                pose: Pose::IDENTITY,
                shape,
            }],
        })
    }

    fn set(shape: Shape) -> SimCommand {
        let object = ObjectSpec::new("it", Pose::IDENTITY, 1.0, shape);
        SceneCommand::Set(Box::new(SceneSpec {
            items: vec![SceneItem::Object(object)],
            ..default()
        }))
        .into()
    }

    #[test]
    fn invalid_commands_are_refused_with_place_and_limit() {
        let hand = Hand::Left;
        let location = Vec3::new(0.0, f32::INFINITY, 0.0);
        let ball = |radius| Shape::Sphere {
            radius,
            color: Rgb::GRAY,
        };
        let preset = Preset::Stack(u32::MAX);
        for (command, problem) in [
            (
                HandCommand::MoveTo { hand, location }.into(),
                "location: a number is not finite",
            ),
            (set(ball(0.0)), "it: radius: 0 is not from 0.001 to 1000"),
            (set(ball(f32::NAN)), "it: radius: NaN is not"),
            (
                set(Shape::Composite { parts: vec![] }),
                "it: a composite has no parts",
            ),
            (set(nested(101)), "nested more than 100 deep"),
            (
                SceneCommand::Load("/dev/zero".into()).into(),
                "not names of task files",
            ),
            (
                SceneCommand::Make { preset, seed: 1 }.into(),
                "a stack has 1 to 50 blocks",
            ),
            (
                SceneCommand::Edit(vec![ObjectEdit::Add(Box::new(ObjectSpec::new(
                    "it",
                    Pose::IDENTITY,
                    -1.0,
                    block(),
                )))])
                .into(),
                "it: mass: -1 is not from 0 to",
            ),
            (
                RobotCommand::ShowMarkers(vec![Vec3::ZERO; MOST_VALUES + 1]).into(),
                "1048577 markers, expected at most 1048576",
            ),
        ] {
            let found = check_command(&command).unwrap_err();
            assert!(found.contains(problem), "{found}");
        }
        assert_eq!(check_command(&set(nested(100))), Ok(()));
    }
}
