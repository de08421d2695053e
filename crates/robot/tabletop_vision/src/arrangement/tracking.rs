//! Tracking: what has moved since the last picture.

use tabletop_camera::PictureWindow;

use super::{BETTER, ObjectArrangement, STILL_SUPPORTED, THOROUGH};
use crate::{known::StandingPose, refine::TRACKING, support};

/// How an object may have moved, alone among the others.
struct TrackedMotion {
    /// The new placements: its own, and those of what it guides.
    placements: Vec<(usize, Option<StandingPose>)>,
    /// The loss that it saves.
    gain: f64,
    /// The part of the picture that changes.
    window: PictureWindow,
}

/// What is known of an object's motion.
#[derive(Default)]
struct TrackedObject {
    /// True if the object was looked at since something about it changed.
    is_looked_at: bool,
    /// The motion that is still to be made.
    motion: Option<TrackedMotion>,
    has_moved: bool,
}

impl ObjectArrangement<'_, '_> {
    /// Begins with objects where they were, follows those that have moved, and finds those that are elsewhere. What was in the air does not stay there, so
    /// it is looked at closely.
    pub(super) fn follow(&mut self, before: &[Option<StandingPose>]) {
        self.allowance = STILL_SUPPORTED;
        self.is_following = true;
        self.enough = THOROUGH;
        for (i, placement) in before.iter().enumerate() {
            self.place(i, *placement);
            self.is_anchored[i] = placement.is_some() && self.objects[i].is_fixed();
        }
        self.follow_motions();
        self.carry_along(before);
        if self.has_given_up() {
            return;
        }
        let mut is_sought = vec![false; self.objects.len()];
        while let Some(lost) = self.most_lost(&is_sought) {
            is_sought[lost] = true;
            self.place(lost, None);
            self.find_all(&mut || 1.0);
            self.follow_motions();
        }
        if self.placements.contains(&None) {
            self.arrange(&mut || 1.0);
        }
    }

    /// The object that is explained worst, of those that are explained badly and have not been sought. What covers it, or has covered it, may be why others are
    /// explained badly.
    fn most_lost(&mut self, is_sought: &[bool]) -> Option<usize> {
        let bad = self.explained_badly().into_iter();
        let bad: Vec<_> = bad
            .filter(|&i| !is_sought[i] && self.placements[i].is_some())
            .collect();
        let misfits = bad.into_iter().map(|i| {
            let fit = self.fit(i);
            match fit.pixels {
                0 => (i, f32::INFINITY),
                pixels => (i, fit.misfit / pixels as f32),
            }
        });
        let worst = misfits.max_by(|one, other| one.1.total_cmp(&other.1));
        worst.map(|(i, _)| i)
    }

    /// Moves what has moved. An object is explained badly where it was if it has moved, but also if what has moved hid it, or hides it now. So the motion that
    /// explains most comes first, and whatever that may have explained is looked at again.
    fn follow_motions(&mut self) {
        let mut tracked: Vec<TrackedObject> = Vec::new();
        tracked.resize_with(self.objects.len(), TrackedObject::default);
        loop {
            for (i, object) in tracked.iter_mut().enumerate() {
                if !object.is_looked_at {
                    object.is_looked_at = true;
                    let motion = self.motion(i);
                    object.motion =
                        motion.filter(|motion| !object.has_moved || motion.gain >= BETTER);
                }
            }
            let open = tracked.iter_mut().enumerate();
            let open =
                open.filter_map(|(i, object)| Some((i, object.motion.as_ref()?.gain, object)));
            let Some((moved, _, object)) = open.max_by(|one, other| one.1.total_cmp(&other.1))
            else {
                return;
            };
            let Some(motion) = object.motion.take() else {
                return;
            };
            object.has_moved = true;
            for &(i, placement) in &motion.placements {
                self.place(i, placement);
            }
            for (i, object) in tracked.iter_mut().enumerate() {
                let own = object.motion.as_ref().map(|motion| &motion.window);
                let mut seen = self.windows[i].iter().chain(own);
                if seen.any(|own| !own.intersection(&motion.window).is_empty()) {
                    object.is_looked_at = i == moved;
                }
            }
        }
    }

    /// True if an object is in the air, or explains its pixels badly.
    fn may_have_moved(&mut self, object: usize) -> bool {
        if self.is_anchored[object] {
            return false;
        }
        let fit = self.fit(object);
        self.hovers(object) || fit.misfit > self.good() * fit.pixels as f32
    }

    /// The motion of an object that explains the picture best. `None` if it is still where it was, or not in the picture.
    fn motion(&mut self, object: usize) -> Option<TrackedMotion> {
        if !self.may_have_moved(object) {
            return None;
        }
        let before = self.remember();
        let was_seen = self.windows.clone();
        self.settle(object, &TRACKING, true);
        let moved = (0..self.objects.len()).filter(|&i| self.placements[i] != before.placements[i]);
        let moved: Vec<_> = moved.chain([object]).collect();
        let windows = moved
            .iter()
            .flat_map(|&i| was_seen[i].iter().chain(&self.windows[i]));
        let window = windows.cloned().reduce(|one, other| one.joined(&other))?;
        let motion = TrackedMotion {
            placements: moved.iter().map(|&i| (i, self.placements[i])).collect(),
            gain: before.loss - self.loss(),
            window,
        };
        self.restore(&before);
        Some(motion)
    }

    /// True if an object stands on nothing, and no joint holds it.
    fn hovers(&self, object: usize) -> bool {
        let known = &self.objects[object];
        let others = self.objects.iter().zip(&self.placements).enumerate();
        let others = others.filter(|(i, _)| *i != object);
        let others = others.filter_map(|(_, (other, at))| Some((other, at.as_ref()?)));
        known.guide().is_none()
            && self.placements[object]
                .is_some_and(|placement| !support::stands(known, &placement, others))
    }
}
