//! Sliding: a part is moved along its joint, after what is in its way is put aside.

use bevy::math::Vec3;
use tabletop_controller::Sight;
use tabletop_geometry::Pose;

use super::{Imitator, clearing::MOST_CLEARED, slider::Slider};
use crate::{failure::PlanFailure, sight::Arranged as _, stage::PlanningStage};

/// Distance between the places of a sliding part at which obstacles are looked for, in units.
const SWEEP_STEP: f32 = 0.2;

impl Imitator<'_> {
    /// Slides a part by so much, after what is in its way is put aside.
    pub(super) fn slide(
        &mut self,
        stage: &mut dyn PlanningStage,
        id: &str,
        by: Vec3,
        i: usize,
    ) -> Result<(), PlanFailure> {
        for _ in 0..MOST_CLEARED {
            let Some(obstacle) = in_the_way(stage.sight(), id, by)? else {
                break;
            };
            self.clear(stage, &obstacle, i)?;
        }
        self.slide_past(stage, id, by)
    }

    /// Slides a part by so much, whatever is in its way.
    pub(super) fn slide_past(
        &self,
        stage: &mut dyn PlanningStage,
        id: &str,
        by: Vec3,
    ) -> Result<(), PlanFailure> {
        let object = stage.sight().objects.get(id);
        let from = object.map_or(Vec3::ZERO, |object| object.pose.location);
        self.by_some_limb(stage, id, from, |transfer, stage| transfer.slide(stage, by))
    }
}

/// An object in the way of a part that slides by so much. Neither what it slides along is in its way, nor what stands on or in it.
///
/// # Errors
/// Nothing moves the object in the way.
fn in_the_way(sight: &Sight, id: &str, by: Vec3) -> Result<Option<String>, PlanFailure> {
    let (Some(slider), Some(object)) = (Slider::of(sight, id), sight.objects.get(id)) else {
        return Ok(None);
    };
    let riders = sight.stack_above(id);
    let riders = riders.iter().map(String::as_str);
    let except: Vec<_> = riders.chain([slider.holder]).collect();
    let steps = (by.length() / SWEEP_STEP).ceil().max(1.0) as u16;
    let mut poses = (1..=steps).map(|step| {
        let way = by * (f32::from(step) / f32::from(steps));
        Pose::new(object.pose.location + way, object.pose.rotation)
    });
    let obstacle = poses.find_map(|pose| sight.occupant(id, pose, &except));
    match obstacle {
        Some(by) if sight.objects.get(&by).is_some_and(|other| other.is_fixed) => {
            let object = id.to_owned();
            Err(PlanFailure::Barred { object, by })
        }
        obstacle => Ok(obstacle),
    }
}
