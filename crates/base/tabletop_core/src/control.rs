//! Controls: switches, buttons, lights, and shapes with their own states.

pub(crate) mod button;
pub(crate) mod lights;
pub(crate) mod switch;

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use tabletop_geometry::{Pose, Rgb};

use crate::{
    Change, Control, ControlKind, IndicatorLights, Part, PushButton, Shape, Side, ToggleSwitch,
};

impl Control {
    /// A control of this kind in its first state.
    pub const fn new(kind: ControlKind) -> Self {
        Self {
            kind,
            state: 0,
            override_state: None,
            downstream: Vec::new(),
        }
    }

    /// Number of states.
    pub fn states(&self) -> u32 {
        match &self.kind {
            ControlKind::ToggleSwitch(switch) => switch.states,
            ControlKind::PushButton(button) => button.state + 1,
            ControlKind::IndicatorLights(lights) => lights.states.len() as u32,
            ControlKind::Custom(custom) => custom.states.len() as u32,
        }
    }

    /// The state that is shown and reported.
    pub fn shown_state(&self) -> u32 {
        self.override_state
            .filter(|&state| state < self.states())
            .unwrap_or(self.state)
    }

    /// The kind of control in recordings: the name of its element, or of the custom control.
    pub fn type_name(&self) -> &str {
        match &self.kind {
            ControlKind::ToggleSwitch(_) => "toggleSwitch",
            ControlKind::PushButton(_) => "pushButton",
            ControlKind::IndicatorLights(_) => "indicatorLights",
            ControlKind::Custom(custom) => &custom.name,
        }
    }

    /// The name of the shown state in recordings: for a switch that of the pressed side (0 left, 1 right), otherwise the state's own
    /// name, or its number.
    pub fn state_name(&self) -> String {
        let state = self.shown_state();
        let name = match &self.kind {
            ControlKind::ToggleSwitch(switch) => return (switch.pressed as u32).to_string(),
            ControlKind::PushButton(_) => None,
            ControlKind::IndicatorLights(lights) => lights
                .states
                .get(state as usize)
                .map(|state| state.name.as_str()),
            ControlKind::Custom(custom) => custom
                .states
                .get(state as usize)
                .map(|state| state.name.as_str()),
        };
        match name {
            Some(name) if !name.is_empty() => name.to_owned(),
            _ => state.to_string(),
        }
    }

    /// The parts that can be touched, including lights that are off.
    pub(crate) fn touched(&self) -> Vec<Part> {
        match &self.kind {
            ControlKind::ToggleSwitch(switch) => switch.blocks().into(),
            ControlKind::PushButton(button) => vec![button.cap()],
            ControlKind::IndicatorLights(lights) => (0..lights.lights)
                .map(|light| lights.light(light, Rgb::BLACK))
                .collect(),
            ControlKind::Custom(custom) => custom
                .states
                .get(self.shown_state() as usize)
                .map_or_else(Vec::new, |state| state.parts.clone()),
        }
    }

    /// The parts that can be seen, without lights that are off.
    pub(crate) fn seen(&self) -> Vec<Part> {
        match &self.kind {
            ControlKind::IndicatorLights(lights) => lights
                .states
                .get(self.shown_state() as usize)
                .into_iter()
                .flat_map(|state| &state.lights)
                .map(|&(light, color)| lights.light(light, color))
                .collect(),
            ControlKind::ToggleSwitch(_) | ControlKind::PushButton(_) | ControlKind::Custom(_) => {
                self.touched()
            }
        }
    }

    /// Changes to other objects when it enters its present state.
    pub fn changes(&self) -> &[Change] {
        match &self.kind {
            ControlKind::Custom(custom) => custom
                .states
                .get(self.state as usize)
                .map_or(&[], |state| &state.changes),
            ControlKind::ToggleSwitch(_)
            | ControlKind::PushButton(_)
            | ControlKind::IndicatorLights(_) => &[],
        }
    }

    /// The push button that it is, if it is one.
    pub const fn push_button(&self) -> Option<&PushButton> {
        match &self.kind {
            ControlKind::PushButton(button) => Some(button),
            ControlKind::ToggleSwitch(_)
            | ControlKind::IndicatorLights(_)
            | ControlKind::Custom(_) => None,
        }
    }

    /// The state to which triggering a simple part leads; without a part, that of the first part that leads anywhere.
    pub fn next_state(&self, part: Option<u32>) -> Option<u32> {
        match &self.kind {
            ControlKind::ToggleSwitch(switch) => {
                let raised = switch.raised() as u32;
                (part.is_none_or(|part| part == raised)).then(|| (self.state + 1) % switch.states)
            }
            ControlKind::PushButton(button) => (self.state != button.state).then_some(button.state),
            ControlKind::IndicatorLights(_) => None,
            ControlKind::Custom(custom) => {
                let next = &custom.states.get(self.shown_state() as usize)?.next;
                match part {
                    Some(part) => *next.get(part as usize)?,
                    None => next.iter().find_map(|&next| next),
                }
            }
        }
    }
}

impl PushButton {
    /// The cap, about its centre.
    fn cap(&self) -> Part {
        let upright = Quat::from_rotation_x(FRAC_PI_2);
        let shape = Shape::Cylinder {
            radius: self.radius,
            yspan: self.length(),
            color: self.color,
        };
        Part::new("", Pose::new(Vec3::ZERO, upright), shape)
    }
}

impl ToggleSwitch {
    /// The side that can be pressed.
    pub const fn raised(&self) -> Side {
        self.pressed.other()
    }

    /// Its left and its right block.
    fn blocks(&self) -> [Part; 2] {
        let angle = self.angle.to_radians();
        let width = self.span.x / (1.0 + libm::cosf(angle));
        let shape = Shape::Block {
            span: Vec3::new(width, self.span.y, self.span.z),
            color: self.color,
        };
        let tilted = |side: Side| {
            let (outwards, turn) = match side {
                Side::Left => (Vec3::NEG_X, angle),
                Side::Right => (Vec3::X, -angle),
            };
            let turn = if side == self.pressed { 0.0 } else { turn };
            let turn = Quat::from_rotation_y(turn);
            let center = outwards * width / 2.0 + Vec3::Z * self.span.z / 2.0;
            Part::new("", Pose::new(turn * center, turn), shape.clone())
        };
        [tilted(Side::Left), tilted(Side::Right)]
    }
}

impl IndicatorLights {
    /// One of its lights. Several lights stand in a row on the origin's plane; half of a single light is below the plane.
    fn light(&self, light: u32, color: Rgb) -> Part {
        let center = match self.lights {
            0 | 1 => Vec3::ZERO,
            lights => {
                let first = self.radius - self.xspan / 2.0;
                let step = (self.xspan - 2.0 * self.radius) / (lights - 1) as f32;
                Vec3::new(first + step * light as f32, 0.0, self.zspan / 2.0)
            }
        };
        let upright = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
        let shape = Shape::Cylinder {
            radius: self.radius,
            yspan: self.zspan,
            color,
        };
        Part::new("", Pose::new(center, upright), shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CustomControl, CustomState, LightState, ObjectSpec};

    fn switch(pressed: Side, angle: f32) -> Control {
        Control::new(ControlKind::ToggleSwitch(ToggleSwitch {
            span: Vec3::new(0.6, 0.3, 0.1),
            angle,
            color: Rgb::GRAY,
            pressed,
            states: 4,
        }))
    }

    fn highest(control: &Control, side: Side) -> f32 {
        let part = &control.touched()[side as usize];
        let Shape::Block { span, .. } = part.shape else {
            panic!("{part:?}");
        };
        let corners = [-0.5, 0.5].map(|x| part.pose * Vec3::new(x * span.x, 0.0, span.z / 2.0));
        corners[0].z.max(corners[1].z)
    }

    #[test]
    fn the_side_that_is_not_pressed_is_raised() {
        for (pressed, raised) in [(Side::Left, Side::Right), (Side::Right, Side::Left)] {
            let switch = switch(pressed, 6.0);
            assert!((highest(&switch, pressed) - 0.1).abs() < 1e-6);
            assert!(highest(&switch, raised) > 0.12);
            assert_eq!(switch.next_state(Some(raised as u32)), Some(1));
            assert_eq!(switch.next_state(Some(pressed as u32)), None);
        }
    }

    #[test]
    fn a_switch_begins_again_after_its_last_state() {
        let last = Control {
            state: 3,
            ..switch(Side::Left, 6.0)
        };
        assert_eq!(last.next_state(None), Some(0));
    }

    #[test]
    fn lights_stand_in_a_row_and_only_those_that_are_on_are_seen() {
        let mut control = Control::new(ControlKind::IndicatorLights(IndicatorLights {
            radius: 0.03,
            zspan: 0.005,
            lights: 3,
            xspan: 0.15,
            states: vec![
                LightState::default(),
                LightState {
                    name: "on".into(),
                    lights: vec![(2, Rgb::GREEN)],
                },
            ],
        }));
        assert_eq!((control.seen().len(), control.touched().len()), (0, 3));
        assert_eq!(control.state_name(), "0");
        control.override_state = Some(1);
        assert_eq!(control.state_name(), "on");
        let [green] = &control.seen()[..] else {
            panic!("{:?}", control.seen());
        };
        assert!((green.pose.location - Vec3::new(0.045, 0.0, 0.0025)).length() < 1e-6);
        control.override_state = Some(2);
        assert_eq!(control.shown_state(), 0);
    }

    #[test]
    fn the_shapes_of_a_custom_control_are_those_of_its_state() {
        let ball = |radius| {
            let color = Rgb::RED;
            Part::new("", Pose::IDENTITY, Shape::Sphere { radius, color })
        };
        let state = |radius, next| CustomState {
            name: String::new(),
            parts: vec![ball(radius), ball(radius / 2.0)],
            next: vec![None, next],
            changes: Vec::new(),
        };
        let control = Control::new(ControlKind::Custom(CustomControl {
            name: "dial".into(),
            states: vec![state(1.0, Some(1)), state(2.0, None)],
        }));
        assert_eq!(control.next_state(None), Some(1));
        assert_eq!(control.next_state(Some(0)), None);
        let mut object = ObjectSpec::new("d", Pose::IDENTITY, 1.0, Shape::Control(control));
        assert_eq!(
            object.shape.colliding()[0].solid,
            tabletop_geometry::Solid::Ball(1.0)
        );
        let control = object.control_mut("d").unwrap();
        control.state = 1;
        assert_eq!(control.next_state(None), None);
        assert_eq!(
            object.shape.colliding()[0].solid,
            tabletop_geometry::Solid::Ball(2.0)
        );
    }
}
