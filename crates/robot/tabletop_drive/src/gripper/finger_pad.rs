//! Finger pads: where a finger touches the objects between the fingers.

use bevy::prelude::*;
use bevy_rapier3d::parry::query::Ray;
use tabletop_geometry::Pose;
use tabletop_physics::{Convex, to_rapier};

/// Number of probe rays across and along the face.
const PROBE_RAYS: (u32, u32) = (9, 31);

/// Depth to which the face yields to pressure, in units: objects within this distance behind the foremost point touch, too.
const YIELD: f32 = 0.04;

/// Depth inside the finger at which the rays begin, in units, so that they meet objects that have entered it slightly.
const DEPTH: f32 = 0.1;

/// One of the rays of a face: its number across and along.
pub(crate) type ProbeRay = (u32, u32);

/// The opposite ray of the other finger: the faces are turned against each other about their z axes.
pub(crate) const fn opposite(ray: ProbeRay) -> ProbeRay {
    (PROBE_RAYS.0 - 1 - ray.0, ray.1)
}

/// A touch of a finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FingerTouch {
    /// Distance from the finger, in units; negative inside.
    pub distance: f32,
    /// Centre of the touched area once the finger arrives, in the table's frame.
    pub point: Vec3,
}

/// The inner face of a finger.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FingerPad {
    /// Its pose: origin in the centre of the face, x inwards, z along the finger.
    pub pose: Pose,
    /// Half its extents across and along the finger, in units.
    half: Vec2,
}

impl FingerPad {
    /// The faces of a gripper's left and right finger.
    pub fn pair(end_effector: Pose, opening: f32, finger: Vec3) -> [Self; 2] {
        let half = Vec2::new(finger.y, finger.z) / 2.0;
        let turned = Quat::from_rotation_z(std::f32::consts::PI);
        [(-1.0, Quat::IDENTITY), (1.0, turned)].map(|(side, rotation)| Self {
            pose: end_effector * Pose::new(Vec3::X * (side * opening / 2.0), rotation),
            half,
        })
    }

    /// Half the extents, in the frame of the end effector, of the space in which the rays of both faces are.
    pub fn space_between(opening: f32, finger: Vec3) -> Vec3 {
        Vec3::new(opening / 2.0 + DEPTH, finger.y / 2.0, finger.z / 2.0)
    }

    /// Length of each ray of the face to a body, at most `reach`.
    pub fn probe<'a>(
        &'a self,
        body: &'a [Convex],
        reach: f32,
    ) -> impl Iterator<Item = (ProbeRay, f32)> + 'a {
        let inwards = self.pose.rotation * Vec3::X;
        probe_rays(self.half).filter_map(move |(ray, at)| {
            let line = Ray::new(self.pose * (at - Vec3::X * DEPTH), inwards);
            let nearest = body
                .iter()
                .filter_map(|part| {
                    let place = to_rapier(part.pose);
                    part.shape.cast_ray(&place, &line, reach + DEPTH, true)
                })
                .min_by(f32::total_cmp)?;
            Some((ray, nearest - DEPTH))
        })
    }

    /// The first touch of a body when the finger moves inwards by at most `reach`.
    pub fn touch(&self, body: &[Convex], reach: f32) -> Option<FingerTouch> {
        let hits: Vec<_> = self.probe(body, reach).collect();
        let distance = hits
            .iter()
            .map(|(_, distance)| *distance)
            .min_by(f32::total_cmp)?;
        let area = hits.iter().filter(|(_, d)| *d <= distance + YIELD);
        let (sum, count) = area.fold((Vec3::ZERO, 0.0), |(sum, count), (ray, _)| {
            (sum + place_of(*ray, self.half), count + 1.0)
        });
        Some(FingerTouch {
            distance,
            point: self.pose * (sum / count + Vec3::X * distance),
        })
    }
}

fn probe_rays(half: Vec2) -> impl Iterator<Item = (ProbeRay, Vec3)> {
    let (across, along) = PROBE_RAYS;
    (0..across)
        .flat_map(move |x| (0..along).map(move |z| (x, z)))
        .map(move |ray| (ray, place_of(ray, half)))
}

/// Origin of a ray in the frame of the face.
fn place_of(ray: ProbeRay, half: Vec2) -> Vec3 {
    let from_middle = |i: u32, count: u32| 2.0 * i as f32 / (count - 1) as f32 - 1.0;
    Vec3::new(
        0.0,
        from_middle(ray.0, PROBE_RAYS.0) * half.x,
        from_middle(ray.1, PROBE_RAYS.1) * half.y,
    )
}

#[cfg(test)]
mod tests {
    use bevy_rapier3d::rapier::prelude as rapier;

    use super::*;

    const FINGER: Vec3 = Vec3::new(0.3, 0.4, 1.5);

    fn block(span: Vec3, pose: Pose) -> [Convex; 1] {
        let half = span / 2.0;
        [Convex {
            pose,
            shape: rapier::SharedShape::cuboid(half.x, half.y, half.z),
        }]
    }

    #[test]
    fn a_finger_measures_how_far_a_block_is_and_where_its_face_is() {
        let [left, right] = FingerPad::pair(Pose::IDENTITY, 2.0, FINGER);
        let block = block(Vec3::ONE, Pose::at(Vec3::new(0.2, 0.0, 0.25)));
        let (left, right) = (left.touch(&block, 2.0), right.touch(&block, 2.0));
        let (left, right) = (left.unwrap(), right.unwrap());
        assert!((left.distance - 0.7).abs() < 1e-4, "{left:?}");
        assert!((right.distance - 0.3).abs() < 1e-4, "{right:?}");
        assert!(
            (left.point - Vec3::new(-0.3, 0.0, 0.25)).length() < 0.03,
            "{left:?}"
        );
        assert!(
            (right.point - Vec3::new(0.7, 0.0, 0.25)).length() < 0.03,
            "{right:?}"
        );
    }

    #[test]
    fn objects_beside_the_fingers_are_not_touched() {
        let [left, _] = FingerPad::pair(Pose::IDENTITY, 2.0, FINGER);
        let beside = block(Vec3::ONE, Pose::at(Vec3::new(0.0, 0.71, 0.0)));
        assert_eq!(left.touch(&beside, 2.0), None);
        let far = block(Vec3::ONE, Pose::at(Vec3::new(5.0, 0.0, 0.0)));
        assert_eq!(left.touch(&far, 2.0), None);
    }

    #[test]
    fn an_object_inside_a_finger_has_a_negative_distance() {
        let [left, _] = FingerPad::pair(Pose::IDENTITY, 1.0, FINGER);
        let block = block(Vec3::ONE * 1.02, Pose::IDENTITY);
        let touch = left.touch(&block, 1.0).unwrap();
        assert!((touch.distance + 0.01).abs() < 1e-4, "{touch:?}");
    }
}
