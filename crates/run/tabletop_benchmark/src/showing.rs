//! Demonstrations of programs, as a person might give them.

use bevy::math::Vec3;
use tabletop_core::{Hand, Manipulator, Random, SimTick};
use tabletop_geometry::Pose;
use tabletop_program::{ProgramRun, TableScene, TaskProgram};
use tabletop_task::{ActDeed, Demonstration, ShownAct, Track};

/// Number of ticks that a step takes.
const STEP: u64 = 100;
/// Height to which an object is lifted, in units.
const LIFT: f32 = 2.5;

/// A demonstration of a program on a table, with a detour at random. `None` if it cannot be done there.
pub(crate) fn shown(
    program: &TaskProgram,
    scene: &TableScene,
    random: &mut Random,
) -> Option<Demonstration> {
    let (steps, _, failure) = ProgramRun::rehearsed(program, scene);
    if failure.is_some() {
        return None;
    }
    let mut hand = ShowingHand::new(scene);
    let detour = (random.bits() % (steps.len() as u64 + 1)) as usize;
    let mut now = scene.clone();
    for (i, step) in steps.iter().enumerate() {
        let before = now.clone();
        now = now.after(step);
        let is_free = step.pose.is_some()
            && before
                .joints
                .iter()
                .all(|joint| !joint.objects.contains(&step.object));
        if i == detour && is_free {
            // Up and down again in its place.
            let pose = before.object(&step.object)?.pose;
            hand.carries(&before, &before, &step.object, Some(pose));
        }
        hand.carries(&before, &now, &step.object, step.pose);
    }
    Some(hand.demonstration(scene))
}

/// A hand that moves objects.
struct ShowingHand {
    tracks: Vec<(String, Track)>,
    acts: Vec<ShownAct>,
    tick: u64,
    removed: Vec<(String, SimTick)>,
}

impl ShowingHand {
    fn new(scene: &TableScene) -> Self {
        let tracks = scene.objects.iter().map(|object| {
            let mut track = Track::default();
            track.push(SimTick(0), object.pose);
            (object.id.clone(), track)
        });
        Self {
            tracks: tracks.collect(),
            acts: Vec::new(),
            tick: 0,
            removed: Vec::new(),
        }
    }

    /// Takes an object to a place, or away, and everything that goes with it.
    fn carries(&mut self, before: &TableScene, after: &TableScene, id: &str, to: Option<Pose>) {
        let tick = self.tick;
        self.act(tick + 10, ActDeed::Grasp(id.to_owned()));
        let is_slid = before
            .joints
            .iter()
            .any(|joint| joint.objects.iter().any(|it| it == id));
        match to {
            None => {
                self.act(tick + 50, ActDeed::Destroy);
                self.removed.push((id.to_owned(), SimTick(tick + 50)));
            }
            Some(_) => {
                for (other, track) in &mut self.tracks {
                    let poses = (before.object(other), after.object(other));
                    let (Some(from), Some(to)) = poses else {
                        continue;
                    };
                    if from.pose == to.pose && other != id {
                        continue;
                    }
                    let up = if is_slid { 0.0 } else { LIFT };
                    let over = Pose::new(from.pose.location + Vec3::Z * up, from.pose.rotation);
                    track.push(SimTick(tick + 20), over);
                    track.push(SimTick(tick + 40), to.pose);
                }
                self.act(tick + 50, ActDeed::Release(None));
            }
        }
        self.tick += STEP;
    }

    fn act(&mut self, tick: u64, deed: ActDeed) {
        self.acts.push(ShownAct {
            tick: SimTick(tick),
            by: Manipulator::Hand(Hand::Right),
            deed,
        });
    }

    fn demonstration(self, scene: &TableScene) -> Demonstration {
        let tracks = self.tracks.into_iter().filter_map(|(id, track)| {
            let object = scene.object(&id)?.clone();
            Some((object, track))
        });
        let end = SimTick(self.tick + STEP);
        let mut shown = Demonstration::of_motions(
            scene.table,
            tracks.collect::<Vec<_>>(),
            scene.joints.clone(),
            end,
        );
        shown.acts = self.acts;
        shown.is_poses_only = false;
        for (id, tick) in self.removed {
            let gone = shown.objects.iter_mut().find(|object| object.spec.id == id);
            if let Some(gone) = gone {
                gone.deleted = Some(tick);
            }
        }
        shown
    }
}
