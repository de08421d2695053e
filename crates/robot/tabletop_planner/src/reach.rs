//! How far the parts of a limb are from its joints.

use tabletop_controller::Angles;
use tabletop_geometry::UNITS_PER_METER;

/// How far the points of each part that a limb carries can be from each of its joints' axes, in units; for joints that slide, units for each m. A part is the
/// joint that carries it, and its farthest point from that joint.
pub(crate) fn reaches(offsets: &[f64], turns: &[bool], carried: &[(usize, f64)]) -> Vec<Angles> {
    let reach = |carrier: usize, radius: f64| {
        let mut all = Angles::default();
        for joint in 0..=carrier {
            all[joint] = match turns[joint] {
                true => offsets[joint + 1..=carrier].iter().sum::<f64>() + radius,
                false => UNITS_PER_METER,
            };
        }
        all
    };
    let carried = carried.iter();
    carried
        .map(|(carrier, radius)| reach(*carrier, *radius))
        .collect()
}
