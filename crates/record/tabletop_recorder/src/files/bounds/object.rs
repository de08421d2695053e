//! Bounds on objects.

use tabletop_core::{
    BondEnd, BondPoint, Change, Control, ControlKind, Dynamics, ObjectSpec, Part, Shape,
    limits::{MASSES, PADDINGS, PRESSING_FORCES, PROPORTIONS, SPANS, SWITCH_ANGLES, TRAVELS},
};
use tabletop_geometry::Rgb;

use crate::files::bounds::values::{
    Checked, FRICTIONS, VELOCITIES, check_count, check_parts, check_place, check_sides,
    finite_pose, spans, within,
};

/// Levels of composites in composites.
const MOST_LEVELS: usize = 100;

pub(super) fn check_object(object: &ObjectSpec, parts: &mut usize) -> Checked {
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
        ControlKind::PushButton(button) => {
            within("radius", button.radius, &SPANS)?;
            within("zspan", button.zspan, &SPANS)?;
            within("travel", button.travel, &TRAVELS)?;
            within("force", button.force, &PRESSING_FORCES)?;
            check_count("states", button.state as usize)
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
