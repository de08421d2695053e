//! The states, frames and pictures of an episode.

use bevy::prelude::{Entity, warn};
use tabletop_core::{IssuedCommand, Picture, SensorImage, SimTick, Timeline, TimelinePicture};
use tabletop_geometry::Pose;

use crate::{
    error::RecorderError,
    files::{
        event::Event,
        joints,
        picture::{color_png, depth_png, ids_png},
        segment_mark::SegmentMark,
        session::{SessionCommand, command_line},
    },
    recording::{episode::Episode, stage::RecordedWorld, tracked::Tracked},
};

impl Episode {
    /// Writes the end of a tick: a row for each object that has moved, and at a frame the moves and a picture.
    pub(crate) fn write_tick(
        &mut self,
        tick: SimTick,
        stage: &RecordedWorld,
        image: Option<&SensorImage>,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        timeline.end = tick;
        if self.clock.is_frame(tick) {
            self.write_frame(tick, Tracked::is_report_due, stage, image, timeline)?;
        }
        let rows = self.objects.moved_rows(tick, stage);
        self.files.states.append_records(&rows)?;
        let rows = joints::rows(
            tick,
            &stage.layout,
            self.last_joints.as_deref(),
            stage.joints(),
        );
        self.last_joints = Some(stage.joints().to_vec());
        self.files.joints.append_records(&rows)?;
        self.files.end_tick()
    }

    /// Writes a frame: a line for each object of which this is so, and a picture if there is such a line, or something else to be
    /// seen than at the frame before, such as another picture of a real camera.
    pub(super) fn write_frame(
        &mut self,
        tick: SimTick,
        is_due: impl Fn(&Tracked, Pose) -> bool,
        stage: &RecordedWorld,
        image: Option<&SensorImage>,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        self.files.require_in_place()?;
        let frame = self.clock.frame(tick);
        let mut moves = Vec::new();
        for object in self.objects.tracked_mut() {
            if let Some(state) = stage.state(&object.id)
                && is_due(object, state.pose)
            {
                object.report(state.pose);
                let (id, pose) = (&object.id, state.pose);
                moves.push(Event::Move { id, pose }.fields(frame));
            }
        }
        let received = image.and_then(|image| image.received);
        let sight = stage.sight(
            self.objects.tracked(),
            !self.hand_cameras.is_empty(),
            received,
        );
        let is_another = sight != self.sight;
        self.sight = sight;
        if (is_another || !moves.is_empty())
            && let Some(image) = image
        {
            self.write_picture(frame, None, &image.picture, &image.shown, stage)?;
            self.write_hand_pictures(tick, frame, stage)?;
            self.pictures += 1;
            let path = self.files.folder.picture(self.files.segment, frame);
            timeline.pictures.pop_if(|last| last.path == path);
            timeline.pictures.push(TimelinePicture {
                tick,
                path,
                serial: self.pictures,
            });
        }
        self.files.text.append_records(&moves)
    }

    /// Writes the pictures that the hand cameras have taken in this tick.
    fn write_hand_pictures(
        &self,
        tick: SimTick,
        frame: u64,
        stage: &RecordedWorld,
    ) -> Result<(), RecorderError> {
        let images = &stage.hand_images;
        if images.tick != tick {
            return Ok(());
        }
        let taken = self.hand_cameras.iter().zip(&images.pictures);
        for (camera, picture) in taken.filter(|(_, picture)| picture.width > 0) {
            self.write_picture(frame, Some(&camera.name), picture, &images.shown, stage)?;
        }
        Ok(())
    }

    /// Writes a picture of the head camera, or of the hand camera of this name.
    fn write_picture(
        &self,
        frame: u64,
        camera: Option<&str>,
        picture: &Picture,
        shown: &[Entity],
        stage: &RecordedWorld,
    ) -> Result<(), RecorderError> {
        let (folder, segment) = (&self.files.folder, self.files.segment);
        let (path, channel) = match camera {
            None => (folder.picture(segment, frame), String::new()),
            Some(camera) => {
                let picture = folder.channel(segment, frame, camera)?;
                (picture.path(), format!("{camera}."))
            }
        };
        let channel = |name| folder.channel(segment, frame, &format!("{channel}{name}"));
        self.files.write_picture(&path, color_png(picture))?;
        if self.channels.depth && !picture.depth.is_empty() {
            self.files
                .write_picture(&channel("depth")?.path(), depth_png(picture))?;
        }
        if self.channels.ids && !picture.objects.is_empty() {
            let numbers = shown
                .iter()
                .map(|&entity| self.objects.number_of(stage.shown(entity)));
            let encoded = ids_png(picture, &numbers.collect::<Vec<_>>());
            self.files.write_picture(&channel("ids")?.path(), encoded)?;
        }
        Ok(())
    }

    /// Ends the recording with a last frame, after which every object is where its last `move` line says. If that does not fit on the
    /// disk, nothing of it stays. Returns the lines of the commands that were logged since the recording began.
    pub(crate) fn finish(
        &mut self,
        tick: SimTick,
        finish: &IssuedCommand,
        stage: &RecordedWorld,
        image: Option<&SensorImage>,
        timeline: &mut Timeline,
    ) -> Result<Vec<u8>, RecorderError> {
        timeline.end = tick;
        let log = self.files.session.read_from(self.head)?;
        let frame = self.clock.frame(tick);
        // The picture of a frame that is at its tick anyway stays.
        let first_frame = frame + u64::from(self.clock.is_frame(tick));
        let line = command_line(&SessionCommand::of(tick, finish))?;
        let intent = self.files.begin_end(first_frame, &line)?;
        self.write_frame(tick, Tracked::is_elsewhere, stage, image, timeline)?;
        self.files.finish(&line, &intent)?;
        if let Err(error) = self.files.drop_undone() {
            warn!("undone segments could not be removed: {error}");
        }
        Ok(SegmentMark::without_marks(&log))
    }
}
