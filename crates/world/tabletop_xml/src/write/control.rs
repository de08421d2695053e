//! Controls of a scene.

use tabletop_core::{Change, Control, ControlKind, PressMode, Side};

use crate::write::{
    Writer,
    text::{as_attribute, as_id, as_literal},
};

impl Writer {
    pub(super) fn content_of_control(&mut self, control: &Control) {
        for id in &control.downstream {
            self.open("downstream");
            self.attribute("id", &as_id(id));
            self.close();
        }
        match &control.kind {
            ControlKind::ToggleSwitch(_) | ControlKind::PushButton(_) => {}
            ControlKind::IndicatorLights(lights) => {
                for state in &lights.states {
                    self.open_state(&state.name);
                    for &(light, color) in &state.lights {
                        self.open("light");
                        self.attribute("id", &light.to_string());
                        self.color("color", color);
                        self.close();
                    }
                    self.close();
                }
            }
            ControlKind::Custom(custom) => {
                for state in &custom.states {
                    self.open_state(&state.name);
                    let mut next = state.next.iter().copied();
                    for part in &state.parts {
                        self.part_in_state(part, &mut next);
                    }
                    state.changes.iter().for_each(|change| self.change(change));
                    self.close();
                }
            }
        }
    }

    pub(super) fn change(&mut self, change: &Change) {
        match change {
            Change::Remove { object } => {
                self.open("remove");
                self.attribute("id", &as_id(object));
            }
            Change::Recolor { object, color } => {
                self.open("recolor");
                self.attribute("id", &as_id(object));
                self.color("color", *color);
            }
            Change::Spawn(object) => {
                self.open("spawn");
                self.object(object);
            }
        }
        self.close();
    }

    pub(super) fn open_state(&mut self, name: &str) {
        self.open("state");
        if !name.is_empty() {
            self.attribute("descriptionName", &as_id(name));
        }
    }

    pub(super) fn attributes_of_control(&mut self, control: &Control) {
        if control.push_button().is_none() {
            self.attribute("initState", &control.state.to_string());
        }
        match &control.kind {
            ControlKind::PushButton(button) => {
                self.number("radius", button.radius);
                self.number("zspan", button.zspan);
                self.number("travel", button.travel);
                self.number("force", button.force);
                self.color("color", button.color);
                let mode = match button.mode {
                    PressMode::Once => "once",
                    PressMode::Held => "held",
                };
                self.attribute("mode", mode);
                self.attribute("state", &button.state.to_string());
            }
            ControlKind::ToggleSwitch(switch) => {
                self.spans(["xspan", "yspan", "zspan"], switch.span);
                self.number("angle", switch.angle);
                self.color("color", switch.color);
                let is_left = switch.pressed == Side::Left;
                self.attribute("leftPressed", &is_left.to_string());
                self.attribute("numStates", &switch.states.to_string());
            }
            ControlKind::IndicatorLights(lights) => {
                self.number("lightRadius", lights.radius);
                self.number("lightZspan", lights.zspan);
                self.attribute("numLights", &lights.lights.to_string());
                self.number("xspan", lights.xspan);
            }
            ControlKind::Custom(custom) => {
                self.attribute("name", &as_attribute(&as_literal(&custom.name)));
            }
        }
    }
}
