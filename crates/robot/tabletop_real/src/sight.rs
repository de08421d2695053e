//! The pictures of the real robot's head camera, in the place of drawn ones.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop_bridge::{OLDEST_REPORT, PictureFeed, RobotPicture};
use tabletop_core::{HandImages, HeadCamera, Picture, PictureDemand, SensorImage, SimTick};

use crate::RealRobot;

/// How long the first picture may take.
const FIRST: Duration = Duration::from_secs(5);

/// Whether the real camera sends pictures.
#[derive(Default)]
pub(crate) struct CameraWatch {
    /// The first look.
    since: Option<Instant>,
    is_missed: bool,
}

impl CameraWatch {
    /// The newest picture, unless it is too old. Says once when there is none any more, and once when there is one again.
    fn fresh(&mut self, feed: &PictureFeed) -> Option<Arc<RobotPicture>> {
        let since = *self.since.get_or_insert_with(Instant::now);
        let (age, most) = match feed.age() {
            Some(age) => (age, OLDEST_REPORT),
            None => (since.elapsed(), FIRST),
        };
        let is_missed = age > most;
        if is_missed != self.is_missed {
            self.is_missed = is_missed;
            warn!("{}", news(is_missed, most, feed.fault().as_deref()));
        }
        feed.latest().filter(|_| !is_missed)
    }
}

fn news(is_missed: bool, silent: Duration, fault: Option<&str>) -> String {
    let camera = "the real robot's head camera";
    if !is_missed {
        return format!("{camera} sends pictures again");
    }
    let seconds = silent.as_secs();
    let why = fault.map_or(String::new(), |fault| format!(" ({fault})"));
    format!("{camera} has sent nothing for {seconds} s{why}: until it does, there are no pictures")
}

/// Gives whoever asks for a picture the newest one of the real camera, and nothing that is drawn. Before the first one, and if that is too
/// old, there is none.
pub(crate) fn see(
    real: Res<RealRobot>,
    tick: Res<SimTick>,
    camera: Res<HeadCamera>,
    mut demand: ResMut<PictureDemand>,
    mut hands: ResMut<HandImages>,
    mut image: ResMut<SensorImage>,
    mut watch: Local<CameraWatch>,
) {
    if real.is_added() {
        *watch = CameraWatch::default();
    }
    let picture = real.feed().and_then(|feed| watch.fresh(feed));
    drop(hands.take());
    if !demand.take() {
        return;
    }
    match picture {
        Some(picture) => {
            scale(&picture, &camera, &mut image.picture);
            image.tick = *tick;
            image.received = Some(picture.at);
            image.shown.clear();
        }
        None if image.picture.rgb.is_empty() => {}
        None => *image = SensorImage::default(),
    }
}

/// Cuts a picture to the camera's shape, and scales it to its size: each pixel is the mean of those that it covers.
fn scale(from: &RobotPicture, camera: &HeadCamera, to: &mut Picture) {
    to.resize(camera.width, camera.height);
    // It shows neither how far anything is nor what it is.
    to.depth.clear();
    to.objects.clear();
    let (width, height) = (to.width as usize, to.height as usize);
    if width == 0 || height == 0 || from.width == 0 || from.height == 0 {
        return;
    }
    // The largest part in the middle that has the shape.
    let part_wide = (from.height * width / height).clamp(1, from.width);
    let part_high = (from.width * height / width).clamp(1, from.height);
    let left = (from.width - part_wide) / 2;
    let top = (from.height - part_high) / 2;
    let span = |at: usize, count: usize, part: usize| {
        let first = at * part / count;
        first..((at + 1) * part / count).max(first + 1)
    };
    for row in 0..height {
        for column in 0..width {
            let (mut sum, mut count) = ([0_u32; 3], 0);
            for y in span(row, height, part_high) {
                for x in span(column, width, part_wide) {
                    let pixel = 3 * ((top + y) * from.width + left + x);
                    for (sum, part) in sum.iter_mut().zip(&from.rgb[pixel..]) {
                        *sum += u32::from(*part);
                    }
                    count += 1;
                }
            }
            let pixel = 3 * (row * width + column);
            for (part, sum) in to.rgb[pixel..].iter_mut().zip(sum) {
                *part = (sum / count) as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_names_the_reason() {
        let said = news(true, OLDEST_REPORT, Some("the connection has ended"));
        assert_eq!(
            said,
            "the real robot's head camera has sent nothing for 1 s (the connection has ended): until it does, there are no pictures"
        );
    }

    #[test]
    fn a_wide_picture_is_cut_and_made_smaller() {
        let (width, height) = (1280, 600);
        let pixel = |at: usize| [(at % width / 8) as u8, (at / width / 4) as u8, 7];
        let real = RobotPicture {
            at: Duration::ZERO,
            width,
            height,
            rgb: (0..width * height).flat_map(pixel).collect(),
        };
        let mut picture = Picture::default();
        scale(&real, &HeadCamera::default(), &mut picture);
        assert_eq!([picture.width, picture.height], [200, 150]);
        // 800 of 1280 columns are left, from 240 on; four by four make one.
        assert_eq!(picture.color(0, 0), Some([30, 0, 7]));
        assert_eq!(picture.color(199, 149), Some([129, 149, 7]));
    }
}
