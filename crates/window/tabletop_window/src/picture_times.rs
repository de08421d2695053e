//! The times that pictures take: where they are slow, the room that makes them so is left out.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use tabletop_core::{Recording, Replaying};
use tabletop_gui::Unattended;
use tabletop_user::{Ambience, Notices, Tone};

/// A picture that takes longer is slow.
const SLOW: Duration = Duration::from_millis(50);

/// So many of the last 64 pictures are slow where pictures are slow: more than two seconds of them.
const MOST: u32 = 48;

const NOTICE: &str = "pictures take longer than 50 ms, so the room is left out; Room and shadows in Camera brings it back";

/// The last pictures.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PictureTimes {
    /// The time at which the renderer got the last one.
    begun: Option<Instant>,
    /// A bit for each of the last ones, the newest one lowest: 1 if it was slow.
    slow: u64,
}

impl PictureTimes {
    /// Notes that the renderer gets a picture, for which the program has been waiting until it was done with the one before.
    pub fn note(&mut self, waiting_since: Instant, now: Instant) {
        let Some(begun) = self.begun.replace(now) else {
            return;
        };
        let (took, waited) = (now - begun, now.saturating_duration_since(waiting_since));
        // Otherwise the program itself took the time, or there was nothing to be drawn.
        let is_of_renderer = 2 * waited > took;
        self.slow = (self.slow << 1) | u64::from(took > SLOW && is_of_renderer);
    }

    const fn are_slow(&self) -> bool {
        self.slow.count_ones() >= MOST
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<PictureTimes>().add_systems(
        Update,
        leave_room_out.run_if(not(resource_exists::<Unattended>)),
    );
}

/// Leaves the room out, unless the user has asked for it. While a recording is made or played, its own pictures may be what takes time.
fn leave_room_out(
    recording: Res<Recording>,
    replaying: Res<Replaying>,
    mut times: ResMut<PictureTimes>,
    mut ambience: ResMut<Ambience>,
    mut notices: ResMut<Notices>,
) {
    if recording.0 || replaying.0 {
        *times = PictureTimes::default();
    } else if *ambience == Ambience::Room && times.are_slow() {
        *ambience = Ambience::Plain;
        notices.append(Tone::Warning, NOTICE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// The times of this many pictures, for each of which the program has waited so long.
    fn times(count: u32, took: Duration, waited: Duration) -> PictureTimes {
        let mut times = PictureTimes::default();
        let mut now = Instant::now();
        for _ in 0..=count {
            now += took;
            times.note(now - waited, now);
        }
        times
    }

    #[test]
    fn pictures_are_slow_where_most_of_many_are() {
        let slow = |count, took: u32, waited: u32| times(count, took * MS, waited * MS).are_slow();
        assert!(slow(MOST, 60, 45));
        assert!(!slow(MOST - 1, 60, 45));
        assert!(!slow(100, 40, 35));
        assert!(!slow(100, 60, 5), "the program itself is slow");
        assert!(!slow(100, 5000, 5), "nothing was drawn");
    }

    fn app(ambience: Ambience) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, plugin))
            .init_resource::<Recording>()
            .init_resource::<Replaying>()
            .init_resource::<Notices>()
            .insert_resource(ambience);
        app
    }

    /// The ambience after many slow pictures, and the number of notices.
    fn after_slow_pictures(app: &mut App) -> (Ambience, usize) {
        app.insert_resource(times(100, 60 * MS, 45 * MS));
        app.update();
        let world = app.world();
        let notices = world.resource::<Notices>();
        (*world.resource::<Ambience>(), notices.iter().len())
    }

    #[test]
    fn a_slow_room_is_left_out_until_the_user_asks_for_it() {
        let mut app = app(Ambience::Room);
        assert_eq!(after_slow_pictures(&mut app), (Ambience::Plain, 1));
        let chosen = app.world().resource::<Ambience>().other();
        app.insert_resource(chosen);
        assert_eq!(after_slow_pictures(&mut app), (chosen, 1));
        assert!(chosen.is_room());
    }

    #[test]
    fn a_room_stays_while_a_recording_is_made_or_played_or_nobody_looks() {
        let room = (Ambience::Room, 0);
        let mut recording = app(Ambience::Room);
        recording.insert_resource(Recording(true));
        assert_eq!(after_slow_pictures(&mut recording), room);
        let mut replaying = app(Ambience::Room);
        replaying.insert_resource(Replaying(true));
        assert_eq!(after_slow_pictures(&mut replaying), room);
        let mut unattended = app(Ambience::Room);
        unattended.insert_resource(Unattended);
        assert_eq!(after_slow_pictures(&mut unattended), room);
    }
}
