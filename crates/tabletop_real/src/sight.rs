//! The pictures of the real robot's head camera, in place of drawn ones.

use bevy::prelude::*;
use tabletop_bridge::RobotPicture;
use tabletop_core::{HeadCamera, Picture, SensorImage, SimTick};

use crate::RealRobot;

/// Puts the newest real picture in the place of the one that was drawn in this tick. Before the first one there is none.
pub(crate) fn see(
    real: Res<RealRobot>,
    tick: Res<SimTick>,
    camera: Res<HeadCamera>,
    mut image: ResMut<SensorImage>,
) {
    if image.tick != *tick || image.picture.rgb.is_empty() {
        return;
    }
    match real.picture() {
        Some(picture) => scale(&picture, &camera, &mut image.picture),
        None => image.picture = Picture::default(),
    }
    image.shown.clear();
}

/// Cuts a picture to the camera's shape, and scales it to its size: each pixel is the mean of those that it covers.
fn scale(from: &RobotPicture, camera: &HeadCamera, to: &mut Picture) {
    to.resize(camera.width, camera.height);
    to.depth.fill(0.0);
    to.objects.fill(0);
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
    use std::time::Duration;

    use super::*;

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
