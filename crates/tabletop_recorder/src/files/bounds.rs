//! What a session log may hold: what task files may, and of everything else what makes sense. A stranger's log is checked when it is
//! read.

use std::ops::RangeInclusive;

use bevy::math::{Quat, Vec3};
use tabletop_core::{
    BondEnd, BondPoint, ChainSpec, Change, ClockCommand, Control, ControlKind, Drive, Dynamics,
    HandCommand, HeadCamera, JointKind, JointSpec, JointedSpec, LidBoxSpec, MechanismCommand,
    ObjectSpec, Part, Pose, RecordingCommand, Rgb, RobotCommand, SceneCommand, SceneItem,
    SceneSpec, Shape, SimCommand, Table,
    limits::{DISPLACEMENTS, MASSES, MOST_LINKS, PADDINGS, PROPORTIONS, SPANS, SWITCH_ANGLES},
};

/// Ticks from the first command of a log to its end: 30 days.
pub(crate) const MOST_TICKS: u64 = 30 * 24 * 3600 * 60;

/// No tick is later.
const LAST_TICK: u64 = 1 << 53;

/// Objects and other elements of a scene, with the parts of composites.
const MOST_PARTS: usize = 100_000;

/// Levels of composites in composites.
const MOST_LEVELS: usize = 100;

/// Values in a command: markers, drives, letters of an id.
const MOST_VALUES: usize = 1 << 20;

/// How far a joint turns, in radians: half a turn to each side, and what is rounded.
const ANGLES: RangeInclusive<f32> = -3.15..=3.15;
const FRICTIONS: RangeInclusive<f32> = 0.0..=1000.0;
const VELOCITIES: RangeInclusive<f32> = -1000.0..=1000.0;
const SIDES: RangeInclusive<u32> = 3..=u32::MAX;
const LINKS: RangeInclusive<u32> = 1..=MOST_LINKS;
const PLACES: RangeInclusive<f32> = -1e6..=1e6;

type Checked = Result<(), String>;

/// The first command of a recording, its start, and its camera.
pub(crate) fn check_begin(
    begin_tick: Option<u64>,
    start_tick: u64,
    camera: Option<&HeadCamera>,
) -> Checked {
    let begin = begin_tick.unwrap_or(start_tick);
    if start_tick > LAST_TICK {
        return Err(format!("start_tick: {start_tick} is over {LAST_TICK}"));
    }
    if begin > start_tick {
        return Err(format!(
            "begin_tick: {begin} is after the start in tick {start_tick}"
        ));
    }
    check_ticks(begin, start_tick).map_err(at("start_tick"))?;
    match camera.and_then(HeadCamera::fault) {
        Some(fault) => Err(format!("camera: {fault}")),
        None => Ok(()),
    }
}

/// Checks that a recording can last from one tick to another.
pub(crate) fn check_ticks(begin: u64, end: u64) -> Checked {
    match end.saturating_sub(begin) > MOST_TICKS {
        true => Err(format!(
            "tick {end} is more than {MOST_TICKS} ticks (30 days) after the first command in tick {begin}"
        )),
        false => Ok(()),
    }
}

/// An object may be anywhere when a recording starts.
pub(crate) fn check_present(pose: Pose, object: &ObjectSpec, parts: &mut usize) -> Checked {
    finite_pose(pose)
        .and_then(|()| check_object(object, parts))
        .map_err(at(&object.id))
}

pub(crate) fn check_joint(joint: &JointSpec) -> Checked {
    for frame in joint.frames {
        finite_pose(frame).map_err(at("joints"))?;
    }
    match joint.kind {
        JointKind::Ball | JointKind::Fixed => Ok(()),
        JointKind::Slider {
            min,
            max,
            friction,
            damping,
        } => {
            within("min", min, &DISPLACEMENTS)?;
            within("max", max, &DISPLACEMENTS)?;
            within("friction", friction, &MASSES)?;
            within("damping", damping, &PROPORTIONS)
        }
        JointKind::Shears { min, max } => {
            within("min", min, &ANGLES)?;
            within("max", max, &ANGLES)
        }
        JointKind::Hinge { min, max, damping } => {
            within("min", min, &ANGLES)?;
            within("max", max, &ANGLES)?;
            within("damping", damping, &PROPORTIONS)
        }
    }
}

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
        SceneCommand::Load(_) => Err("a recording holds scenes, and no names of task files".into()),
        SceneCommand::Set(scene) => check_scene_spec(scene),
        SceneCommand::Clear => Ok(()),
        SceneCommand::Make { preset, .. } => preset.fault().map_or(Ok(()), Err),
    }
}

fn check_hand_command(command: &HandCommand) -> Checked {
    match command {
        HandCommand::Select(_)
        | HandCommand::Release(_)
        | HandCommand::Cut(_)
        | HandCommand::Destroy(_) => Ok(()),
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
        RobotCommand::ReachTo { pose, .. } => finite_pose(*pose),
        RobotCommand::ShowMarkers(markers) => {
            check_count("markers", markers.len())?;
            markers
                .iter()
                .try_for_each(|marker| finite("ShowMarkers", *marker))
        }
    }
}

fn check_scene_spec(scene: &SceneSpec) -> Checked {
    let SceneSpec { table, items } = scene;
    check_table(table)?;
    let mut parts = 0;
    for item in items {
        match item {
            SceneItem::Object(object) => {
                check_place(object.pose)
                    .and_then(|()| check_object(object, &mut parts))
                    .map_err(at(&object.id))?;
            }
            SceneItem::Chain(chain) => {
                check_chain(chain).map_err(at(&chain.id))?;
                parts += chain.links() as usize;
            }
            SceneItem::LidBox(lid_box) => {
                check_lid_box(lid_box).map_err(at(&lid_box.id))?;
                parts += 2;
            }
            SceneItem::Jointed(jointed) => check_jointed(jointed, &mut parts)?,
        }
        check_parts(parts)?;
    }
    Ok(())
}

fn check_jointed(jointed: &JointedSpec, parts: &mut usize) -> Checked {
    let JointedSpec {
        pose,
        objects,
        motion: _,
        limits: [min, max],
        init,
        collides: _,
        damping,
    } = jointed;
    check_place(*pose).map_err(at("joint"))?;
    for displacement in [*min, *max, *init] {
        within("displacement", displacement, &DISPLACEMENTS)?;
    }
    within("damping", *damping, &PROPORTIONS)?;
    for object in objects {
        check_place(object.pose)
            .and_then(|()| check_object(object, parts))
            .map_err(at(&object.id))?;
    }
    Ok(())
}

pub(crate) fn check_table(table: &Table) -> Checked {
    within("table", table.xspan, &SPANS)?;
    within("table", table.yspan, &SPANS)
}

fn check_object(object: &ObjectSpec, parts: &mut usize) -> Checked {
    check_count("letters", object.id.len())?;
    finite_pose(object.pose)?;
    within("mass", object.mass, &MASSES)?;
    check_dynamics(object.dynamics)?;
    check_shape(&object.shape, 1, parts)
}

fn check_dynamics(dynamics: Dynamics) -> Checked {
    let Dynamics {
        friction,
        restitution,
        velocity,
    } = dynamics;
    within("friction", friction.unwrap_or(0.0), &FRICTIONS)?;
    within("restitution", restitution.unwrap_or(0.0), &PROPORTIONS)?;
    let [x, y, z] = velocity.to_array();
    [x, y, z]
        .into_iter()
        .try_for_each(|part| within("velocity", part, &VELOCITIES))
}

fn check_shape(shape: &Shape, level: usize, count: &mut usize) -> Checked {
    *count += 1;
    check_parts(*count)?;
    match shape {
        Shape::Block { span, .. } => spans("span", *span),
        Shape::Cylinder { radius, yspan, .. } => {
            within("radius", *radius, &SPANS)?;
            within("yspan", *yspan, &SPANS)
        }
        Shape::Sphere { radius, .. } => within("radius", *radius, &SPANS),
        Shape::Prism {
            radius,
            yspan,
            sides,
            ..
        } => {
            within("radius", *radius, &SPANS)?;
            within("yspan", *yspan, &SPANS)?;
            check_sides(*sides)
        }
        Shape::Frustum {
            radius_top,
            radius_bottom,
            zspan,
            sides,
            ..
        } => {
            within("radius_top", *radius_top, &SPANS)?;
            within("radius_bottom", *radius_bottom, &SPANS)?;
            within("zspan", *zspan, &SPANS)?;
            check_sides(*sides)
        }
        Shape::Ring {
            radius_outer,
            radius_inner,
            zspan,
            sides,
            ..
        } => {
            within("radius_outer", *radius_outer, &SPANS)?;
            within("radius_inner", *radius_inner, &SPANS)?;
            within("zspan", *zspan, &SPANS)?;
            if radius_inner >= radius_outer {
                return Err(format!(
                    "radius_inner: {radius_inner} is not less than radius_outer, {radius_outer}"
                ));
            }
            check_sides(*sides)
        }
        // It was checked when it was read.
        Shape::Mesh { mesh, .. } => {
            *count += mesh.solids().len();
            check_parts(*count)
        }
        Shape::Box {
            span, thickness, ..
        } => {
            spans("span", *span)?;
            within("thickness", *thickness, &SPANS)
        }
        Shape::Link { span, padding, .. } => {
            spans("span", *span)?;
            within("padding", *padding, &PADDINGS)
        }
        Shape::Lid {
            span,
            handle_span,
            handle_thickness,
            ..
        } => {
            spans("span", *span)?;
            spans("handle_span", *handle_span)?;
            within("handle_thickness", *handle_thickness, &SPANS)
        }
        Shape::Composite { parts } => {
            if parts.is_empty() {
                return Err("a composite has no parts".into());
            }
            if level > MOST_LEVELS {
                return Err(format!(
                    "composites are nested more than {MOST_LEVELS} deep"
                ));
            }
            check_parts_of(parts, level, count)
        }
        Shape::Control(control) => check_control(control, level, count),
        Shape::BondPoint(point) => check_bond_point(point),
    }
}

fn check_parts_of(parts: &[Part], level: usize, count: &mut usize) -> Checked {
    parts.iter().try_for_each(|part| {
        check_count("letters", part.id.len())?;
        check_place(part.pose)?;
        check_shape(&part.shape, level + 1, count)
    })
}

fn check_control(control: &Control, level: usize, count: &mut usize) -> Checked {
    if control.state >= control.states() {
        return Err(format!(
            "a control of {} states is in state {}",
            control.states(),
            control.state
        ));
    }
    check_count("downstream controls", control.downstream.len())?;
    for id in &control.downstream {
        check_count("letters", id.len())?;
    }
    match &control.kind {
        ControlKind::ToggleSwitch(switch) => {
            spans("span", switch.span)?;
            within("angle", switch.angle, &SWITCH_ANGLES)
        }
        ControlKind::IndicatorLights(lights) => {
            within("radius", lights.radius, &SPANS)?;
            within("zspan", lights.zspan, &SPANS)?;
            within("xspan", lights.xspan, &SPANS)?;
            check_count("lights", lights.lights as usize)?;
            *count += lights.lights as usize;
            check_parts(*count)?;
            for state in &lights.states {
                let is_known = |&(light, _): &(u32, Rgb)| light < lights.lights;
                if !state.lights.iter().all(is_known) {
                    return Err(format!("there are only {} lights", lights.lights));
                }
                check_count("lights", state.lights.len())?;
            }
            Ok(())
        }
        ControlKind::Custom(custom) => {
            check_count("letters", custom.name.len())?;
            custom.states.iter().try_for_each(|state| {
                check_count("letters", state.name.len())?;
                state.changes.iter().try_for_each(|change| match change {
                    Change::Remove { object } | Change::Recolor { object, .. } => {
                        check_count("letters", object.len())
                    }
                    Change::Spawn(object) => {
                        check_place(object.pose).and_then(|()| check_object(object, count))
                    }
                })?;
                check_parts_of(&state.parts, level, count)
            })
        }
    }
}

fn check_bond_point(point: &BondPoint) -> Checked {
    check_count("letters", point.fit.len())?;
    match &point.end {
        BondEnd::Guest(guest) => check_count("letters", guest.host.len()),
        BondEnd::Host(host) => {
            for id in [
                &host.downstream,
                &host.downstream_override,
                &host.downstream_lock,
            ] {
                check_count("letters", id.len())?;
            }
            check_count("steps", host.steps.len())?;
            host.steps
                .iter()
                .try_for_each(|step| check_place(step.pose))
        }
    }
}

fn check_chain(chain: &ChainSpec) -> Checked {
    place("start", chain.start)?;
    place("end", chain.end)?;
    spans("link_span", chain.link_span)?;
    within("link_padding", chain.link_padding, &PADDINGS)?;
    within("link_mass", chain.link_mass, &MASSES)?;
    match LINKS.contains(&chain.links()) {
        true => Ok(()),
        false => Err(format!(
            "a chain has {} to {} links, not {}",
            LINKS.start(),
            LINKS.end(),
            chain.links()
        )),
    }
}

fn check_lid_box(lid_box: &LidBoxSpec) -> Checked {
    check_place(lid_box.pose)?;
    spans("span", lid_box.span)?;
    spans("handle_span", lid_box.handle_span)?;
    within("thickness", lid_box.thickness, &SPANS)?;
    within("handle_thickness", lid_box.handle_thickness, &SPANS)?;
    within("box_mass", lid_box.box_mass, &MASSES)?;
    within("lid_mass", lid_box.lid_mass, &MASSES)
}

fn check_sides(sides: u32) -> Checked {
    match SIDES.contains(&sides) {
        true => Ok(()),
        false => Err(format!(
            "{sides} sides, expected at least {}",
            SIDES.start()
        )),
    }
}

fn check_parts(count: usize) -> Checked {
    match count > MOST_PARTS {
        true => Err(format!(
            "a scene has more than {MOST_PARTS} objects and parts"
        )),
        false => Ok(()),
    }
}

fn check_count(name: &str, count: usize) -> Checked {
    match count > MOST_VALUES {
        true => Err(format!("{count} {name}, expected at most {MOST_VALUES}")),
        false => Ok(()),
    }
}

fn at(place: &str) -> impl Fn(String) -> String {
    move |problem| format!("{place}: {problem}")
}

fn within(name: &str, value: f32, range: &RangeInclusive<f32>) -> Checked {
    match range.contains(&value) {
        true => Ok(()),
        false => Err(format!(
            "{name}: {value} is not from {} to {}",
            range.start(),
            range.end()
        )),
    }
}

fn spans(name: &str, span: Vec3) -> Checked {
    span.to_array()
        .into_iter()
        .try_for_each(|value| within(name, value, &SPANS))
}

fn place(name: &str, location: Vec3) -> Checked {
    location
        .to_array()
        .into_iter()
        .try_for_each(|value| within(name, value, &PLACES))
}

fn check_place(pose: Pose) -> Checked {
    place("location", pose.location)?;
    rotation(pose.rotation)
}

fn finite(name: &str, value: Vec3) -> Checked {
    match value.is_finite() {
        true => Ok(()),
        false => Err(format!("{name}: a number is not finite")),
    }
}

fn finite_pose(pose: Pose) -> Checked {
    finite("location", pose.location)?;
    rotation(pose.rotation)
}

fn rotation(rotation: Quat) -> Checked {
    match (rotation.length_squared() - 1.0).abs() < 0.01 {
        true => Ok(()),
        false => Err("rotation: it is no unit quaternion".into()),
    }
}

#[cfg(test)]
mod tests {
    use bevy::prelude::default;
    use tabletop_core::{Hand, Part, Preset, Rgb};

    use super::*;

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
    fn what_makes_no_sense_is_refused_with_its_place_and_limit() {
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
                "no names of task files",
            ),
            (
                SceneCommand::Make { preset, seed: 1 }.into(),
                "a stack has 1 to 50 blocks",
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

    #[test]
    fn cameras_and_ticks_are_bounded() {
        let large = HeadCamera {
            width: 20_000,
            height: 20_000,
            ..default()
        };
        assert_eq!(check_begin(Some(5), 9, Some(&default())), Ok(()));
        for (begin, start, camera, problem) in [
            (Some(5), 9, Some(&large), "camera: 20000x20000"),
            (
                Some(10),
                9,
                None,
                "begin_tick: 10 is after the start in tick 9",
            ),
            (
                None,
                u64::MAX,
                None,
                "start_tick: 18446744073709551615 is over",
            ),
            (
                Some(5),
                1 << 40,
                None,
                "more than 155520000 ticks (30 days)",
            ),
        ] {
            let found = check_begin(begin, start, camera).unwrap_err();
            assert!(found.contains(problem), "{found}");
        }
    }
}
