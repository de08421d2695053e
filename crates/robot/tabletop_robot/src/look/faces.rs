//! Faces on the robot's screen: flat shapes, one in front of the other.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::math::{Vec2, Vec3, ops};
use tabletop_core::Face;
use tabletop_geometry::{Rgb, Triangles, UNITS_PER_METER};

/// Size of the picture in m: the display is 1024 x 600 pixels.
const PICTURE: Vec2 = Vec2::new(0.216, 0.127);

/// Distance, in m, of the picture in front of the display's frame; the glass is 2 mm in front of the frame.
const IN_FRONT: f32 = 0.0028;

/// From layer to layer, in m.
const LAYER: f32 = 0.0003;

const BACKGROUND: Rgb = Rgb::new(0.13, 0.27, 0.40);
const WHITE: Rgb = Rgb::new(1.00, 1.00, 1.00);
const IRIS: Rgb = Rgb::new(0.20, 0.60, 0.93);
const PUPIL: Rgb = Rgb::new(0.04, 0.07, 0.11);
const LINE: Rgb = Rgb::new(0.90, 0.97, 1.00);

/// Location of the right eye, in m from the middle of the picture; the left eye mirrors it.
const EYE: Vec2 = Vec2::new(0.047, 0.012);

/// A face on the robot's screen, in the frame of `screen.shape.json`, in units: flat shapes in front of its glass, seen
/// from x. A blank screen shows nothing.
pub fn face(face: Face) -> Triangles {
    let mut drawing = Drawing::default();
    if face == Face::Blank {
        return drawing.surface;
    }
    let half = PICTURE / 2.0;
    drawing.shape(0, BACKGROUND, rounded(half, 0.02));
    match face {
        Face::Neutral | Face::Blank => {
            drawing.eyes(Vec2::new(0.026, 0.027), 0.0);
            drawing.brows(0.049, 0.35);
            drawing.arc(Vec2::new(0.0, -0.012), 0.036, -FRAC_PI_2, 0.5);
        }
        Face::Happy => {
            drawing.eyes(Vec2::new(0.027, 0.027), 0.003);
            drawing.brows(0.053, 0.55);
            drawing.arc(Vec2::new(0.0, -0.006), 0.040, -FRAC_PI_2, 0.95);
        }
        Face::Surprised => {
            drawing.eyes(Vec2::new(0.031, 0.033), 0.001);
            drawing.brows(0.056, 0.45);
            let mouth = Vec2::new(0.0, -0.043);
            drawing.shape(1, LINE, ellipse(mouth, Vec2::new(0.012, 0.014)));
            drawing.shape(2, BACKGROUND, ellipse(mouth, Vec2::new(0.008, 0.010)));
        }
        Face::Asleep => {
            for side in [-1.0, 1.0] {
                drawing.arc(Vec2::new(side * EYE.x, 0.026), 0.030, -FRAC_PI_2, 0.8);
            }
            drawing.arc(Vec2::new(0.0, -0.018), 0.026, -FRAC_PI_2, 0.4);
        }
    }
    drawing.surface
}

/// Shapes in layers, of which a higher one hides a lower one. Points of shapes are in m, to the right and up as the
/// picture is seen.
#[derive(Default)]
struct Drawing {
    surface: Triangles,
}

impl Drawing {
    /// A convex shape, whose corners go round counterclockwise.
    fn shape(&mut self, layer: u8, color: Rgb, corners: Vec<Vec2>) {
        let first = self.surface.positions.len() as u32;
        let count = corners.len() as u32;
        for corner in corners {
            let out = IN_FRONT + f32::from(layer) * LAYER;
            let point = Vec3::new(out, corner.x, corner.y);
            self.surface.positions.push(point * UNITS_PER_METER as f32);
            self.surface.normals.push(Vec3::X);
            self.surface.colors.push(color);
        }
        let fan = (2..count).map(|i| [first, first + i - 1, first + i]);
        self.surface.indices.extend(fan);
    }

    /// Both eyes, wide open, with pupils raised by `up`.
    fn eyes(&mut self, white: Vec2, up: f32) {
        for side in [-1.0, 1.0] {
            let eye = Vec2::new(side * EYE.x, EYE.y);
            // A little towards the middle, at someone in front of the robot.
            let pupil = eye + Vec2::new(-side * 0.003, up);
            self.shape(1, WHITE, ellipse(eye, white));
            self.shape(2, IRIS, ellipse(pupil, Vec2::splat(0.0155)));
            self.shape(3, PUPIL, ellipse(pupil, Vec2::splat(0.0085)));
            let glint = pupil + Vec2::new(0.0055, 0.0055);
            self.shape(4, WHITE, ellipse(glint, Vec2::splat(0.0035)));
        }
    }

    /// Both brows, at this height, with this half angle.
    fn brows(&mut self, up: f32, half_angle: f32) {
        for side in [-1.0, 1.0] {
            let center = Vec2::new(side * EYE.x, up - 0.05);
            self.arc(center, 0.05, FRAC_PI_2, half_angle);
        }
    }

    /// A thick part of a circle with round ends, to both sides of a direction.
    fn arc(&mut self, center: Vec2, radius: f32, direction: f32, half_angle: f32) {
        const HALF_WIDTH: f32 = 0.0026;
        const STEPS: u16 = 16;
        let ray = |step: u16| {
            let turned = half_angle * (2.0 * f32::from(step) / f32::from(STEPS) - 1.0);
            Vec2::new(ops::cos(direction + turned), ops::sin(direction + turned))
        };
        for step in 0..STEPS {
            let [one, next] = [ray(step), ray(step + 1)];
            let at = |ray: Vec2, radius: f32| center + ray * radius;
            let (inner, outer) = (radius - HALF_WIDTH, radius + HALF_WIDTH);
            let corners = [
                at(one, inner),
                at(one, outer),
                at(next, outer),
                at(next, inner),
            ];
            self.shape(1, LINE, corners.to_vec());
        }
        for end in [ray(0), ray(STEPS)] {
            self.shape(
                1,
                LINE,
                ellipse(center + end * radius, Vec2::splat(HALF_WIDTH)),
            );
        }
    }
}

fn ellipse(center: Vec2, half: Vec2) -> Vec<Vec2> {
    const CORNERS: u16 = 32;
    let corner = |i: u16| {
        let turn = TAU * f32::from(i) / f32::from(CORNERS);
        center + half * Vec2::new(ops::cos(turn), ops::sin(turn))
    };
    (0..CORNERS).map(corner).collect()
}

/// A rectangle with round corners around the middle.
fn rounded(half: Vec2, radius: f32) -> Vec<Vec2> {
    const CORNERS: u16 = 32;
    let corner = |i: u16| {
        let turn = TAU * (f32::from(i) + 0.5) / f32::from(CORNERS);
        let ray = Vec2::new(ops::cos(turn), ops::sin(turn));
        (half - radius) * ray.signum() + ray * radius
    };
    (0..CORNERS).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_fit_on_the_screen_and_look_out_of_it() {
        for shown in Face::ALL {
            let surface = face(shown);
            assert_eq!(surface.indices.is_empty(), shown == Face::Blank);
            for point in &surface.positions {
                assert!(point.x > 0.02 && point.x < 0.05, "{shown:?}: {point}");
                let within = Vec2::new(point.y, point.z).abs().cmple(PICTURE * 5.001);
                assert!(within.all(), "{shown:?}: {point}");
            }
            for triangle in &surface.indices {
                let [a, b, c] = triangle.map(|i| surface.positions[i as usize]);
                assert!((b - a).cross(c - a).x > 0.0, "{shown:?}");
            }
        }
    }

    #[test]
    fn no_two_faces_are_the_same() {
        for (i, one) in Face::ALL.into_iter().enumerate() {
            for other in &Face::ALL[..i] {
                assert_ne!(face(one), face(*other));
            }
        }
    }
}
