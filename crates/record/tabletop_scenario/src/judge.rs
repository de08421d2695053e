//! Checks of a world outside a scenario: whether they hold, and how far the world is from them.

use bevy::prelude::*;
use tabletop_geometry::Bounds;

use crate::{Check, RobotCheck, rest::Stillness, seen::Seen, sight::ScenarioSight};

/// Judges checks of a world. Rest is a matter of time: it has to [observe](Self::observe) the world while that is stepped.
///
/// ```
/// use bevy::prelude::*;
/// use tabletop_core::prelude::*;
/// use tabletop_scenario::{Check, Judge};
///
/// let mut app = App::new();
/// app.add_plugins((MinimalPlugins, CorePlugin::default())).start();
/// let mut judge = Judge::default();
/// judge.observe(app.world_mut(), 1)?;
/// let checks = [Check::Gone("RedBlock".into()), Check::Exists("RedBlock".into())];
/// let verdicts = judge.judge(app.world_mut(), &checks)?;
/// assert_eq!(verdicts[0].failure, None);
/// assert_eq!(verdicts[1].failure.as_deref(), Some("expected an object `RedBlock`, found none of that id"));
/// # Ok::<_, BevyError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Judge {
    stillness: Stillness,
}

/// A check, compared with the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The expectation and the finding, if the check does not hold.
    pub failure: Option<String>,
    /// How far the world is from it.
    pub gap: Gap,
}

/// What a check compares: two points, in units, which are the same if it holds, but for its tolerance and for rest. A check of something that
/// is no place compares (1, 0, 0) with (1, 0, 0) if it holds and with the origin if not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gap {
    /// The place that there is.
    pub achieved: Vec3,
    /// The place that there should be.
    pub desired: Vec3,
}

impl Gap {
    /// The distance of the two.
    pub fn length(self) -> f32 {
        self.achieved.distance(self.desired)
    }

    fn between(achieved: Vec3, desired: Vec3) -> Self {
        Self { achieved, desired }
    }

    fn of(holds: bool) -> Self {
        Self::between(if holds { Vec3::X } else { Vec3::ZERO }, Vec3::X)
    }
}

impl Judge {
    /// Takes in the world after this many ticks.
    ///
    /// # Errors
    /// The world is no simulator's.
    pub fn observe(&mut self, world: &mut World, ticks: u64) -> Result {
        Ok(world.run_system_cached_with(observe, (&mut self.stillness, ticks))?)
    }

    /// Compares these checks with the world.
    ///
    /// # Errors
    /// The world is no simulator's.
    pub fn judge(&self, world: &mut World, checks: &[Check]) -> Result<Vec<Verdict>> {
        Ok(world.run_system_cached_with(judge, (&self.stillness, checks))?)
    }
}

fn observe((InMut(stillness), In(ticks)): (InMut<Stillness>, In<u64>), sight: ScenarioSight) {
    stillness.observe(&sight.seen());
    stillness.pass_over(ticks.saturating_sub(1));
}

fn judge(
    (InRef(stillness), InRef(checks)): (InRef<Stillness>, InRef<[Check]>),
    sight: ScenarioSight,
) -> Vec<Verdict> {
    let seen = sight.seen();
    let judged = checks.iter().map(|check| {
        let failure = check.judge(&seen, stillness).err();
        let gap = gap(check, &seen, failure.is_none());
        Verdict { failure, gap }
    });
    judged.collect()
}

/// How far the world is from a check that holds or not.
fn gap(check: &Check, seen: &Seen, holds: bool) -> Gap {
    let nothing = Gap::of(holds);
    let found = |id: &str| seen.object(id).ok();
    match check {
        Check::Location { object, at, .. } => {
            found(object).map_or(nothing, |object| Gap::between(object.pose.location, *at))
        }
        Check::OnTopOf { object, of, .. } => match (found(object), found(of)) {
            (Some(upper), Some(lower)) => {
                let (upper, lower) = (upper.bounds(), lower.bounds());
                Gap::between(
                    center(&upper).with_z(upper.low.z),
                    center(&lower).with_z(lower.high.z),
                )
            }
            (_, _) => nothing,
        },
        Check::OnTable { object, .. } => found(object).map_or(nothing, |object| {
            let low = object.pose.location.with_z(object.bounds().low.z);
            Gap::between(low, low.with_z(0.0))
        }),
        Check::Inside { object, of, .. } => match (found(object), found(of)) {
            (Some(inner), Some(outer)) => {
                let (inner, outer) = (inner.bounds(), outer.bounds());
                let play =
                    ((outer.high - outer.low) - (inner.high - inner.low)).max(Vec3::ZERO) / 2.0;
                let (inner, outer) = (center(&inner), center(&outer));
                Gap::between(inner, inner.clamp(outer - play, outer + play))
            }
            (_, _) => nothing,
        },
        Check::Robot(RobotCheck::EndEffector { arm, at, .. }) => {
            let limb = seen.layout.find_limb(*arm);
            limb.map_or(nothing, |limb| {
                Gap::between(seen.robot.limb(limb).end_effector.location, *at)
            })
        }
        Check::Rotation { .. }
        | Check::AtRest(_)
        | Check::AllAtRest
        | Check::Exists(_)
        | Check::Gone(_)
        | Check::HeldBy { .. }
        | Check::Free(_)
        | Check::State { .. }
        | Check::Fastened { .. }
        | Check::Robot(
            RobotCheck::Joint { .. }
            | RobotCheck::Holds { .. }
            | RobotCheck::HoldsNothing(_)
            | RobotCheck::BlockedBy { .. },
        ) => nothing,
    }
}

fn center(bounds: &Bounds) -> Vec3 {
    (bounds.low + bounds.high) / 2.0
}

#[cfg(test)]
mod tests {
    use tabletop_core::{CorePlugin, ObjectIndex, ObjectSpec, Shape, StepApp as _, Table};
    use tabletop_geometry::{Pose, Rgb};

    use super::*;

    fn world() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .start();
        app.world_mut().spawn(Table::default());
        for (id, x, z) in [("low", 0.0, 0.5), ("high", 3.0, 2.5)] {
            let shape = Shape::Block {
                span: Vec3::ONE,
                color: Rgb::GRAY,
            };
            let pose = Pose::at(Vec3::new(x, 0.0, z));
            let spec = ObjectSpec::new(id, pose, 1.0, shape);
            let world = app.world_mut();
            let object = world.spawn((spec, Transform::from(pose))).id();
            world.resource_mut::<ObjectIndex>().insert(id, object);
        }
        app
    }

    #[test]
    fn a_gap_leads_to_where_a_check_holds() {
        let mut app = world();
        let checks = [
            Check::OnTopOf {
                object: "high".into(),
                of: "low".into(),
                within: 0.05,
            },
            Check::OnTable {
                object: "high".into(),
                within: 0.05,
            },
            Check::Inside {
                object: "high".into(),
                of: "low".into(),
                within: 0.05,
            },
            Check::Gone("low".into()),
            Check::Exists("low".into()),
        ];
        let verdicts = Judge::default().judge(app.world_mut(), &checks).unwrap();
        let gaps: Vec<_> = verdicts
            .iter()
            .map(|verdict| verdict.gap.desired - verdict.gap.achieved)
            .collect();
        assert_eq!(
            gaps,
            [
                Vec3::new(-3.0, 0.0, -1.0),
                Vec3::new(0.0, 0.0, -2.0),
                Vec3::new(-3.0, 0.0, -2.0),
                Vec3::X,
                Vec3::ZERO
            ]
        );
    }

    #[test]
    fn an_object_is_at_rest_once_it_was_observed_for_half_a_second() {
        let mut app = world();
        let check = [Check::AtRest("low".into())];
        let mut judge = Judge::default();
        judge.observe(app.world_mut(), 1).unwrap();
        assert!(
            judge.judge(app.world_mut(), &check).unwrap()[0]
                .failure
                .is_some()
        );
        judge.observe(app.world_mut(), 30).unwrap();
        assert_eq!(
            judge.judge(app.world_mut(), &check).unwrap()[0].failure,
            None
        );
    }
}
