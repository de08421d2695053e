//! Positions of joints as numbers with units.

use tabletop_core::JointLayout;

/// The unit of a joint's position.
pub(super) const fn unit(joint: &JointLayout) -> &'static str {
    match (joint.is_gripper(), joint.slides) {
        (true, _) => "",
        (false, true) => " m",
        (false, false) => " rad",
    }
}

/// The position of a joint: an angle in rad and degrees, a slide in m and cm, an opening in units.
pub(super) fn reading(joint: &JointLayout, position: f64) -> String {
    let value = number(position, 3);
    if joint.is_gripper() {
        format!("{value:>6}")
    } else if joint.slides {
        format!("{value:>6} {:>6} cm", number(position * 100.0, 1))
    } else {
        format!("{value:>6} {:>6}°", number(position.to_degrees(), 1))
    }
}

/// A number with this count of decimals; no zero has a sign.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(zero) if zero.chars().all(|c| matches!(c, '0' | '.')) => zero.to_owned(),
        _ => text,
    }
}
