//! Push buttons on the table: a cap that a spring lifts out of a housing.

use bevy::prelude::*;
use tabletop_geometry::{Pose, Rgb};

use crate::{Control, ControlKind, JointMotion, JointedSpec, ObjectSpec, PushButton, Shape};

/// The mass of the cap for a newton of the spring, in kg: it weighs a fifth of the mass that presses it down.
const CAP_MASS: f32 = 0.02;

/// Width of the housing for a radius of the cap of 1.
const WIDTH: f32 = 3.0;

impl PushButton {
    /// The button on the table: its housing, of a mass in kg, stands with the centre of its bottom at the pose, and its cap is down by
    /// some way, in units.
    pub fn jointed(self, id: &str, pose: Pose, mass: f32, init: f32) -> JointedSpec {
        let width = WIDTH * self.radius;
        let block = Shape::Block {
            span: Vec3::new(width, width, self.zspan),
            color: Rgb::DARK_GRAY,
        };
        let housing = Pose::at(Vec3::Z * self.zspan / 2.0);
        let housing = ObjectSpec::new(format!("{id}_housing"), housing, mass, block);
        let (travel, height, cap_mass) = (self.travel, self.height(), CAP_MASS * self.force);
        let state = match self.is_pressed_at(init, false) {
            true => self.state,
            false => 0,
        };
        let control = Control {
            state,
            ..Control::new(ControlKind::PushButton(self))
        };
        let shape = Shape::Control(control);
        let cap = ObjectSpec::new(id, Pose::at(Vec3::Z * height), cap_mass, shape);
        JointedSpec {
            pose,
            objects: [housing, cap],
            motion: JointMotion::Press,
            limits: [0.0, travel],
            init,
            collides: false,
            damping: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PressMode;

    fn button() -> PushButton {
        PushButton {
            radius: 0.5,
            zspan: 0.4,
            travel: 0.2,
            force: 5.0,
            color: Rgb::RED,
            mode: PressMode::Held,
            state: 2,
        }
    }

    fn highest(spec: &ObjectSpec) -> f32 {
        spec.shape.bounds(spec.pose).high.z
    }

    #[test]
    fn the_cap_stands_out_of_the_housing_and_goes_down_by_its_travel() {
        let pose = Pose::from_degrees(Vec3::new(1.0, 2.0, 3.0), Vec3::Z * 30.0);
        for (init, out) in [(0.0, 0.25), (0.2, 0.05)] {
            let jointed = button().jointed("stop", pose, 1.0, init);
            let [housing, cap] = jointed.placed();
            assert_eq!((&*housing.id, &*cap.id), ("stop_housing", "stop"));
            assert!((highest(&housing) - 3.4).abs() < 1e-5);
            assert!((highest(&cap) - 3.4 - out).abs() < 1e-5);
            let found = jointed.displacement([housing.pose, cap.pose]);
            assert!((found - init).abs() < 1e-5, "{found}");
        }
    }

    #[test]
    fn it_is_pressed_from_half_its_travel_on_until_it_is_nearly_up() {
        let button = button();
        let pressed = [0.0, 0.08, 0.12].map(|at| button.is_pressed_at(at, false));
        assert_eq!(pressed, [false, false, true]);
        let still = [0.04, 0.08, 0.2].map(|at| button.is_pressed_at(at, true));
        assert_eq!(still, [false, true, true]);
        let state = |init| button.clone().jointed("b", Pose::IDENTITY, 1.0, init);
        let state = |init| state(init).push_button().unwrap().0.state;
        assert_eq!([0.0, 0.2].map(state), [0, 2]);
    }
}
