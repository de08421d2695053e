//! Identities: which of several objects that look the same is which.

use tabletop_geometry::Pose;

use crate::known::KnownObject;

/// Exchanges what is seen of objects that look the same, so that each is as near as possible to where it was.
pub(crate) fn keep_identities<T>(
    objects: &[KnownObject],
    before: &[Option<Pose>],
    seen: &mut [T],
    pose: impl Fn(&T) -> Option<Pose>,
) {
    let distance = |seen: &T, before: Option<Pose>| {
        let way = before?.location.distance(pose(seen)?.location);
        Some(way)
    };
    let mut is_settled = vec![false; objects.len()];
    for i in 0..objects.len() {
        // The nearest pair of a former and a present place, among those that are left.
        let free = |j: &usize| !is_settled[*j] && objects[*j].looks_like(&objects[i]);
        let alike: Vec<_> = (0..objects.len()).filter(free).collect();
        let pairs = alike
            .iter()
            .flat_map(|&own| alike.iter().map(move |&other| (own, other)));
        let pairs = pairs.filter_map(|(own, other)| {
            let way = distance(&seen[other], before[own])?;
            Some((way, own, other))
        });
        let nearest = pairs.min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, own, other)) = nearest {
            seen.swap(own, other);
            is_settled[own] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::Shape;
    use tabletop_geometry::Rgb;

    use super::*;

    #[test]
    fn objects_that_look_the_same_stay_who_they_are() {
        let block = |color| {
            KnownObject::of(&Shape::Block {
                span: Vec3::ONE,
                color,
            })
        };
        let objects = [Rgb::RED, Rgb::RED, Rgb::GREEN, Rgb::RED].map(block);
        let at = |x: f32| Some(Pose::at(Vec3::X * x));
        let before = [at(0.0), at(2.0), at(9.0), at(4.0)];
        let mut seen = [at(4.0), at(0.1), at(2.0), at(7.0)];
        keep_identities(&objects, &before, &mut seen, |pose| *pose);
        let places = seen.map(|pose| pose.unwrap().location.x);
        assert_eq!(places, [0.1, 7.0, 2.0, 4.0]);
    }
}
