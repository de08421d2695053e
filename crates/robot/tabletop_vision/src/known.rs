//! Known objects: what they look like, and how they may stand.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use bevy::math::{Quat, Vec2, Vec3};
use tabletop_camera::{Camera, DrawnSolid};
use tabletop_core::{JointSpec, ObjectSpec, Shape};
use tabletop_geometry::{Bounds, PlacedSolid, Pose, Primitive, Rgb, turn_about};

use crate::{
    guide::Guide,
    symmetry::{SAME, YawSymmetry, fills_alike},
};

/// An object whose shape and colours are known, and whose pose is not.
///
/// ```
/// use bevy::math::Vec3;
/// use tabletop_core::Shape;
/// use tabletop_geometry::Rgb;
/// use tabletop_vision::{KnownObject, YawSymmetry};
///
/// let brick = Shape::Block {
///     span: Vec3::new(3.0, 1.0, 1.0),
///     color: Rgb::RED,
/// };
/// assert_eq!(KnownObject::of(&brick).symmetry(), YawSymmetry::Turns(2));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct KnownObject {
    drawn: Vec<Primitive>,
    touched: Vec<Primitive>,
    stances: Vec<Stance>,
    is_fixed: bool,
    guide: Option<Guide>,
}

/// One way in which an object stands: which of its sides is down.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stance {
    rotation: Quat,
    /// Its solids after this rotation, about the object's origin.
    drawn: Vec<Primitive>,
    touched: Vec<TouchedSolid>,
    pub symmetry: YawSymmetry,
    /// Lowest and highest Z relative to the origin, and the largest distance from the vertical through it.
    pub low: f32,
    pub high: f32,
    pub radius: f32,
}

/// A convex solid of a stance that others touch.
#[derive(Clone, Debug, PartialEq)]
struct TouchedSolid {
    solid: Primitive,
    center: Vec3,
    heights: [f32; 2],
    radius: f32,
}

/// A convex solid of an object in its place.
#[derive(Clone, Debug)]
pub(crate) struct StandingSolid {
    pub solid: PlacedSolid,
    /// Its lowest and highest Z.
    pub heights: [f32; 2],
    /// The centre of a ball that encloses it, and its radius.
    pub center: Vec3,
    pub radius: f32,
}

/// A place for an object: where it is, how it is turned about the vertical, and the number of its stance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StandingPose {
    pub location: Vec3,
    pub yaw: f32,
    pub stance: usize,
    /// The rotation before that by the yaw: none, unless a guide tilts it.
    pub tilt: Quat,
}

impl KnownObject {
    /// An object of this shape that stands as in its own frame.
    pub fn of(shape: &Shape) -> Self {
        let (drawn, touched) = (shape.drawn(), shape.colliding());
        let stances = vec![Stance::of(&drawn, &touched, Quat::IDENTITY)];
        Self {
            drawn,
            touched,
            stances,
            is_fixed: false,
            guide: None,
        }
    }

    /// An object of this description, fixed if nothing moves it, that stands as in its own frame.
    pub fn described_by(spec: &ObjectSpec) -> Self {
        let known = Self::of(&spec.shape);
        match spec.is_fixed() {
            true => known.fixed(),
            false => known,
        }
    }

    /// The same object, which may stand in each of these ways: rotations of the object, each of which may be turned about the vertical. Of those in
    /// which it looks the same, the first counts. Without any, it stands as in its own frame.
    #[must_use]
    pub fn standing(mut self, rotations: impl IntoIterator<Item = Quat>) -> Self {
        let mut stances: Vec<Stance> = Vec::new();
        for rotation in rotations {
            let stance = Stance::of(&self.drawn, &self.touched, rotation);
            if stances.iter().all(|known| stance.turn_to(known).is_none()) {
                stances.push(stance);
            }
        }
        if !stances.is_empty() {
            self.stances = stances;
        }
        self
    }

    /// The same object, which may stand on each of its sides, as it stands in one of them with this rotation.
    #[must_use]
    pub fn on_any_side(self, rotation: Quat) -> Self {
        self.standing(sides(rotation))
    }

    /// The same object, which stands on the table itself, and never on another object.
    #[must_use]
    pub const fn fixed(mut self) -> Self {
        self.is_fixed = true;
        self
    }

    /// The same object, which a joint fastens to another one, and leaves one motion: a lid that slides on its box, a door on its hinge. The other one is the
    /// first object of the joint, given by its number among those that the eyes know. A ball joint guides nothing.
    #[must_use]
    pub fn guided(mut self, by: usize, joint: &JointSpec) -> Self {
        self.guide = Guide::of(by, joint);
        self
    }

    /// Its symmetry about the vertical, as it stands first of all.
    pub fn symmetry(&self) -> YawSymmetry {
        self.stances[0].symmetry
    }

    /// The pose that looks the same as this one, and is turned about the vertical as little as possible from a rotation.
    pub fn turned_least(&self, pose: Pose, from: Quat) -> Pose {
        if self.guide.is_some() {
            return pose;
        }
        let turn = from * pose.rotation.inverse();
        let yaw = 2.0 * libm::atan2f(turn.z, turn.w);
        let symmetry = self.stance(&self.placement(pose)).symmetry;
        let turn = turn_about(Vec3::Z, yaw - symmetry.reduced(yaw));
        Pose::new(pose.location, (turn * pose.rotation).normalize())
    }

    /// True if no picture tells it from another: they differ at most in the directions in which they are described.
    pub(crate) fn looks_like(&self, other: &Self) -> bool {
        /// The largest difference between rotations that are the same.
        const SAME_TILT: f32 = 1e-4;
        let stances = self.stances.iter().zip(&other.stances);
        let stand_alike = |(own, other): (&Stance, &Stance)| {
            let [own, other] = [own, other].map(|stance| without_yaw(stance.rotation));
            1.0 - own.dot(other).abs() < SAME_TILT
        };
        self.drawn == other.drawn
            && self.touched == other.touched
            && self.is_fixed == other.is_fixed
            && self.guide == other.guide
            && self.stances.len() == other.stances.len()
            && stances.into_iter().all(stand_alike)
    }

    /// True if a good part of it, at this pose, is beside the picture of a camera.
    pub fn is_cut_off(&self, pose: Pose, camera: &Camera) -> bool {
        /// The part of the points around it that have to be in the picture.
        const INSIDE: f32 = 0.75;
        let placement = self.placement(pose);
        let stance = self.stance(&placement);
        let size = Vec2::new(camera.width as f32, camera.height as f32);
        let sides = (0..8).map(|side| turn_about(Vec3::Z, side as f32 * TAU / 8.0) * Vec3::X);
        let points = sides.flat_map(|side| {
            [stance.low, stance.high]
                .map(|z| placement.location + stance.radius * side + z * Vec3::Z)
        });
        let points: Vec<_> = points.collect();
        let is_inside = |point: &Vec3| {
            let pixel = camera.pixel_of(*point);
            pixel.is_some_and(|pixel| pixel.cmpge(Vec2::ZERO).all() && pixel.cmple(size).all())
        };
        let inside = points.iter().filter(|point| is_inside(point)).count();
        (inside as f32) < INSIDE * points.len() as f32
    }

    pub(crate) const fn is_fixed(&self) -> bool {
        self.is_fixed
    }

    pub(crate) const fn guide(&self) -> Option<&Guide> {
        self.guide.as_ref()
    }

    pub(crate) fn stances(&self) -> &[Stance] {
        &self.stances
    }

    pub(crate) fn stance(&self, placement: &StandingPose) -> &Stance {
        &self.stances[placement.stance]
    }

    /// The colour of its largest solid.
    pub(crate) fn color(&self) -> Rgb {
        let largest = self
            .drawn
            .iter()
            .max_by(|a, b| a.solid.volume().total_cmp(&b.solid.volume()));
        largest.map_or(Rgb::GRAY, |largest| largest.color)
    }

    /// The colours of its solids, each once.
    pub(crate) fn colors(&self) -> Vec<Rgb> {
        let mut colors: Vec<Rgb> = Vec::new();
        for solid in &self.drawn {
            if !colors.contains(&solid.color) {
                colors.push(solid.color);
            }
        }
        colors
    }

    /// The angle in rad, if there is one, by which this object has to be turned about the vertical to look like another, both in their
    /// first stance: a bar along X looks like one along Y after a quarter turn.
    pub fn turn_to(&self, other: &Self) -> Option<f32> {
        self.stances[0].turn_to(&other.stances[0])
    }

    /// The heights above its lowest point at which other objects may stand on it or in it, in its first stance.
    pub(crate) fn seats(&self) -> Vec<f32> {
        let stance = &self.stances[0];
        let mut seats: Vec<f32> = Vec::new();
        for solid in &stance.touched {
            let seat = solid.heights[1] - stance.low;
            if seats.iter().all(|known| (known - seat).abs() > SAME) {
                seats.push(seat);
            }
        }
        seats
    }

    /// The pose of a placement.
    pub(crate) fn pose(&self, placement: &StandingPose) -> Pose {
        let stance = self.stance(placement);
        let body = placement.body();
        Pose::new(body.location, (body.rotation * stance.rotation).normalize())
    }

    /// The placement nearest to a pose: of a guided object, the same pose.
    pub(crate) fn placement(&self, pose: Pose) -> StandingPose {
        if self.guide.is_some() {
            return StandingPose {
                tilt: (pose.rotation * self.stances[0].rotation.inverse()).normalize(),
                ..StandingPose::at(pose.location)
            };
        }
        let near = |(number, stance): (usize, &Stance)| {
            let turn = pose.rotation * stance.rotation.inverse();
            // The turn about the vertical that is nearest to it.
            let yaw = 2.0 * libm::atan2f(turn.z, turn.w);
            let upright = turn.z * turn.z + turn.w * turn.w;
            (
                upright,
                StandingPose {
                    yaw: stance.symmetry.reduced(yaw),
                    stance: number,
                    ..StandingPose::at(pose.location)
                },
            )
        };
        let nearest = self.stances.iter().enumerate().map(near);
        nearest
            .reduce(|best, next| if next.0 > best.0 + 1e-6 { next } else { best })
            .map_or(StandingPose::at(pose.location), |(_, placement)| placement)
    }

    /// Adds its solids at a placement to a list.
    pub(crate) fn draw(&self, placement: &StandingPose, object: u32, solids: &mut Vec<DrawnSolid>) {
        let body = placement.body();
        let stance = self.stance(placement);
        solids.extend((stance.drawn.iter()).map(|solid| DrawnSolid::of(body, solid, object)));
    }

    /// The convex solids that others touch, at a placement.
    pub(crate) fn touched(&self, placement: &StandingPose) -> Vec<StandingSolid> {
        let body = placement.body();
        let solids = self.stance(placement).touched.iter();
        let standing = solids.map(|touched| StandingSolid {
            solid: PlacedSolid::of(&touched.solid, body),
            center: body * touched.center,
            heights: match placement.tilt == Quat::IDENTITY {
                true => touched.heights.map(|z| z + placement.location.z),
                false => {
                    let Bounds { low, high } = Bounds::of_primitive(&touched.solid, body);
                    [low.z, high.z]
                }
            },
            radius: touched.radius,
        });
        standing.collect()
    }

    /// The object at a placement together with others, which move with it, in their poses.
    pub(crate) fn carrying<'k>(
        &self,
        placement: &StandingPose,
        parts: impl IntoIterator<Item = (&'k Self, Pose)>,
    ) -> Self {
        let to_body = placement.body().inverse();
        let mut whole = self.clone();
        for (part, pose) in parts {
            let drawn = part.drawn.iter().map(|solid| Primitive {
                pose: to_body * pose * solid.pose,
                ..solid.clone()
            });
            whole.stances[placement.stance].drawn.extend(drawn);
        }
        whole
    }
}

/// A rotation before any turn about the vertical.
fn without_yaw(rotation: Quat) -> Quat {
    let yaw = 2.0 * libm::atan2f(rotation.z, rotation.w);
    turn_about(Vec3::Z, -yaw) * rotation
}

/// The rotations of an object that stands on each of its sides, as it stands on one of them with this rotation.
fn sides(own: Quat) -> impl Iterator<Item = Quat> {
    let about_x = [0.0, FRAC_PI_2, -FRAC_PI_2, PI].map(|angle| (Vec3::X, angle));
    let about_y = [FRAC_PI_2, -FRAC_PI_2].map(|angle| (Vec3::Y, angle));
    let turns = about_x.into_iter().chain(about_y);
    turns.map(move |(axis, angle)| own * turn_about(axis, angle))
}

/// Objects by their ids, as eyes know them that also know the joints between them.
pub fn with_guides(objects: &[(String, KnownObject)], joints: &[JointSpec]) -> Vec<KnownObject> {
    let mut known: Vec<_> = objects.iter().map(|(_, known)| known.clone()).collect();
    let number = |id: &String| objects.iter().position(|(own, _)| own == id);
    for joint in joints {
        if let [Some(first), Some(second)] = joint.objects.each_ref().map(number) {
            known[second] = known[second].clone().guided(first, joint);
        }
    }
    known
}

impl StandingPose {
    /// At a location, not turned, in the first stance.
    pub const fn at(location: Vec3) -> Self {
        Self {
            location,
            yaw: 0.0,
            stance: 0,
            tilt: Quat::IDENTITY,
        }
    }

    /// The pose of the frame in which the solids of its stance are given.
    pub fn body(&self) -> Pose {
        Pose::new(self.location, turn_about(Vec3::Z, self.yaw) * self.tilt)
    }

    /// The same placement elsewhere on the ray from the eye, with its origin at this height.
    pub fn at_height(&self, z: f32, eye: Vec3) -> Self {
        let down = eye.z - self.location.z;
        let scale = if down.abs() > 1e-3 {
            (eye.z - z) / down
        } else {
            1.0
        };
        let location = eye + (self.location - eye) * scale;
        Self {
            location: location.truncate().extend(z),
            ..*self
        }
    }
}

impl TouchedSolid {
    fn of(solid: Primitive) -> Self {
        let Bounds { low, high } = Bounds::of_primitive(&solid, Pose::IDENTITY);
        Self {
            center: low.midpoint(high),
            heights: [low.z, high.z],
            radius: low.distance(high) / 2.0,
            solid,
        }
    }
}

impl Stance {
    /// The angle in rad, if there is one, by which this stance has to be turned about the vertical to look like another one.
    fn turn_to(&self, other: &Self) -> Option<f32> {
        let is_as_large = (self.radius - other.radius).abs() < SAME
            && (self.low - other.low).abs() < SAME
            && (self.high - other.high).abs() < SAME;
        let quarters = (0..4).map(|quarter| quarter as f32 * TAU / 4.0);
        let mut turns = quarters.filter(|_| is_as_large);
        turns.find(|&turn| fills_alike(&other.solids(), &self.solids(), turn_about(Vec3::Z, turn)))
    }

    /// The convex solids that others touch.
    fn solids(&self) -> Vec<Primitive> {
        self.touched.iter().map(|it| it.solid.clone()).collect()
    }

    fn of(drawn: &[Primitive], touched: &[Primitive], rotation: Quat) -> Self {
        let turn = Pose::new(Vec3::ZERO, rotation);
        let turned = |solids: &[Primitive]| -> Vec<Primitive> {
            let turned = solids.iter().map(|solid| Primitive {
                pose: turn * solid.pose,
                ..solid.clone()
            });
            turned.collect()
        };
        let (drawn, touched) = (turned(drawn), turned(touched));
        let placed: Vec<_> = drawn
            .iter()
            .map(|solid| PlacedSolid::of(solid, Pose::IDENTITY))
            .collect();
        let [low, high] = match placed.is_empty() {
            true => [0.0; 2],
            false => PlacedSolid::extent(&placed, Vec3::Z),
        };
        let sides = (0..16).map(|side| turn_about(Vec3::Z, side as f32 * TAU / 16.0) * Vec3::X);
        let reach = sides.flat_map(|way| placed.iter().map(move |it| it.farthest(way).dot(way)));
        Self {
            rotation,
            symmetry: YawSymmetry::of(&drawn, &touched),
            radius: reach.fold(0.05, f32::max),
            drawn,
            touched: touched.into_iter().map(TouchedSolid::of).collect(),
            low,
            high,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_in_different_directions_look_alike() {
        let bar = Shape::Block {
            span: Vec3::new(3.0, 1.0, 1.0),
            color: Rgb::RED,
        };
        let turned = |yaw| KnownObject::of(&bar).standing([turn_about(Vec3::Z, yaw)]);
        assert!(turned(0.3).looks_like(&turned(2.0)));
        assert!(turned(0.3).looks_like(&KnownObject::of(&bar)));
        let upright = KnownObject::of(&bar).standing([turn_about(Vec3::Y, FRAC_PI_2)]);
        assert!(!turned(0.3).looks_like(&upright));
    }

    #[test]
    fn a_turned_object_stands_on_a_side_of_its_own() {
        let own = turn_about(Vec3::Z, 0.3);
        let up = |side: Quat| side.inverse() * Vec3::Z;
        let ups: Vec<_> = sides(own).map(up).collect();
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            for way in [axis, -axis] {
                let down = ups.iter().filter(|up| up.distance(way) < 1e-6);
                assert_eq!(down.count(), 1, "{way}");
            }
        }
    }
}
