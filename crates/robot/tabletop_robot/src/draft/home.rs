//! A posture for the start: the hand in front of the shoulder, above the table, with its fingers down.

use bevy::math::{DAffine3, DMat3, DVec3};
use tabletop_kinematics::{ArmChain, Miss, Target};

/// Greatest height of the hand above the table, in m.
const HEIGHT: f64 = 0.15;

/// Its share of the reach of a short arm.
const HEIGHT_SHARE: f64 = 0.2;

/// Shares of an arm's reach that the hand is forward, the best first.
const SHARES: [f64; 4] = [0.6, 0.5, 0.7, 0.4];

/// Shares of the ranges of the second and third moving joint that searches begin at.
const STARTS: [f64; 5] = [0.5, 0.3, 0.7, 0.1, 0.9];

/// Angles of an arm, within its limits, that have its fingers down; else in the middle of the limits or at 0. `tool` is the end effector's frame on
/// the tip, `table` the height of the table's top in the arm's frame, in m.
pub(super) fn home(chain: &ArmChain, tool: DAffine3, table: f64) -> Vec<f64> {
    let zero = chain.clamp(&vec![0.0; chain.limits().len()]);
    let frames: Vec<_> = chain.frames(&zero).collect();
    let Some(shoulder) = frames.first().map(|frame| frame.translation) else {
        return zero;
    };
    let reach = reach(chain, tool, &zero);
    let targets = SHARES.iter().flat_map(|share| {
        let height = table + HEIGHT.min(HEIGHT_SHARE * reach);
        let place = DVec3::new(shoulder.x + share * reach, shoulder.y, height);
        [1.0, -1.0].map(|side| {
            let x = DVec3::Y * side;
            let axes = DMat3::from_cols(x, DVec3::Z.cross(x), DVec3::Z);
            Target::Pose(DAffine3::from_mat3_translation(axes, place) * tool.inverse())
        })
    });
    let found = targets.filter_map(|target| best(chain, &target, table));
    let best = found.take(1).next();
    best.unwrap_or(zero)
}

/// Of the angles that bring an arm to a target, those with the highest elbow, if no joint is below the table.
fn best(chain: &ArmChain, target: &Target, table: f64) -> Option<Vec<f64>> {
    let starts = STARTS.iter().flat_map(|a| STARTS.map(|b| (*a, b)));
    let found = starts.filter_map(|(second, third)| {
        let shares = [0.5, second, third];
        let start = chain.limits().iter().enumerate().map(|(i, limits)| {
            let [least, largest] = limits.map(|limit| limit.clamp(-3.2, 3.2));
            least + (largest - least) * shares.get(i).copied().unwrap_or(0.5)
        });
        let start: Vec<_> = start.collect();
        let found = chain.solve_from(target, &start, 1);
        found
            .or_else(|nearest| match is_near(&nearest.miss) {
                true => Ok(nearest.best),
                false => Err(()),
            })
            .ok()
    });
    let heights = |angles: &[f64]| -> Vec<f64> {
        let frames = chain.frames(angles);
        frames.map(|frame| frame.translation.z).collect()
    };
    let base = heights(&chain.clamp(&vec![0.0; chain.limits().len()]));
    let lowest = base.first().copied().unwrap_or(0.0).min(table);
    let above = found.filter(|angles| heights(angles).iter().all(|height| *height >= lowest));
    above.max_by(|a, b| {
        let sum = |angles: &[f64]| heights(angles).iter().sum::<f64>();
        sum(a).total_cmp(&sum(b))
    })
}

/// An arm of few joints, or with offsets, comes near the posture.
fn is_near(miss: &Miss) -> bool {
    miss.position < 0.03 && miss.rotation < 0.3
}

/// Length of an arm from its first joint to its end effector, in m.
fn reach(chain: &ArmChain, tool: DAffine3, angles: &[f64]) -> f64 {
    let tip = (chain.tip(angles) * tool).translation;
    let frames = chain.frames(angles).map(|frame| frame.translation);
    let mut places: Vec<_> = frames.collect();
    places.push(tip);
    places
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .sum()
}
