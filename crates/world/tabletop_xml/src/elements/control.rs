//! The elements of controls: switches, lights, and shapes with states.

use bevy::math::Vec3;
use tabletop_core::{
    Change, Control, ControlKind, CustomControl, CustomState, IndicatorLights, LightState,
    ObjectSpec, Shape, Side, ToggleSwitch,
};
use tabletop_geometry::Rgb;

use crate::{
    document::tree::Element,
    elements::{
        ElementReader,
        attributes::AttributeReader,
        names::{DESCRIPTION, DOWNSTREAM, LIGHT, SHAPES, STATE},
        role::ObjectRole,
        simple_shape::SPANS,
        value::{self, LIGHTS, STATES, SWITCH_ANGLES},
    },
};

const RECOLOR: &str = "recolor";
const SPAWN: &str = "spawn";
/// Changes to other objects by a state.
const CHANGES: [&str; 3] = ["remove", RECOLOR, SPAWN];

/// The content of a control's element.
pub(super) struct ControlContent {
    pub(super) downstream: Vec<String>,
    states: States,
}

/// The states of a control.
enum States {
    /// They are only numbers.
    Numbers,
    Lights(Vec<LightState>),
    Shapes(Vec<CustomState>),
}

impl ElementReader<'_, '_> {
    /// Reads the content of a control's element, and says whether no state is faulty.
    pub(super) fn control_content(
        &mut self,
        element: &Element,
        role: ObjectRole,
    ) -> (ControlContent, bool) {
        let mut allowed = vec![DOWNSTREAM];
        if role == ObjectRole::Whole {
            allowed.push(DESCRIPTION);
        }
        let mut content = ControlContent {
            downstream: Vec::new(),
            states: match element.name {
                "indicatorLights" => States::Lights(Vec::new()),
                "customControl" => States::Shapes(Vec::new()),
                _ => States::Numbers,
            },
        };
        if !matches!(content.states, States::Numbers) {
            allowed.push(STATE);
        }
        let mut is_sound = true;
        let mut states = 0;
        for child in &element.children {
            if !self.is_allowed(child, element.name, &allowed) || child.name == DESCRIPTION {
                continue;
            }
            if child.name == DOWNSTREAM {
                content.downstream.extend(self.downstream(child));
                continue;
            }
            states += 1;
            is_sound &= match &mut content.states {
                States::Numbers => true,
                States::Lights(states) => self.light_state(child).map(|s| states.push(s)).is_some(),
                States::Shapes(states) => {
                    self.custom_state(child).map(|s| states.push(s)).is_some()
                }
            };
        }
        let needs_states = !matches!(content.states, States::Numbers);
        if needs_states && states == 0 && !element.is_broken {
            self.faults
                .report(element.place(), "it has no states", "at least one <state>");
            is_sound = false;
        }
        (content, is_sound)
    }

    fn downstream(&mut self, element: &Element) -> Option<String> {
        self.forbid_children(element);
        let mut attributes = AttributeReader::of(element, self.faults);
        let id = attributes.require("id", String::new(), "id", value::name);
        attributes.finish(Some(id))
    }

    fn light_state(&mut self, element: &Element) -> Option<LightState> {
        let mut lights = Vec::new();
        let mut is_sound = true;
        for child in &element.children {
            if !self.is_allowed(child, element.name, &[LIGHT]) {
                continue;
            }
            self.forbid_children(child);
            let mut attributes = AttributeReader::of(child, self.faults);
            let number = attributes.require("id", 0, "0", |text| value::count(text, &LIGHTS));
            let color = attributes.read("color", Rgb::RED, value::color);
            let light = attributes.finish(Some((number, color)));
            is_sound &= light.is_some();
            lights.extend(light);
        }
        let mut attributes = AttributeReader::of(element, self.faults);
        let name = attributes.read("descriptionName", String::new(), value::id);
        let state = attributes.finish(Some(LightState { name, lights }));
        state.filter(|_| is_sound)
    }

    fn custom_state(&mut self, element: &Element) -> Option<CustomState> {
        let allowed = [&SHAPES[..], &CHANGES].concat();
        let mut state = CustomState::default();
        let mut is_sound = true;
        for child in &element.children {
            if !self.is_allowed(child, element.name, &allowed) {
                continue;
            }
            if CHANGES.contains(&child.name) {
                let change = self.change(child);
                is_sound &= change.is_some();
                state.changes.extend(change);
                continue;
            }
            let read = self.part(child, ObjectRole::InState);
            is_sound &= read.is_some();
            if let Some((part, next)) = read {
                state.parts.push(part);
                state.next.extend(next);
            }
        }
        let mut attributes = AttributeReader::of(element, self.faults);
        state.name = attributes.read("descriptionName", String::new(), value::id);
        attributes.finish(Some(state)).filter(|_| is_sound)
    }
}

impl ElementReader<'_, '_> {
    /// Reads a change to another object.
    fn change(&mut self, element: &Element) -> Option<Change> {
        let spawned = match element.name {
            SPAWN => self.spawned(element)?.into(),
            _ => {
                self.forbid_children(element);
                None
            }
        };
        let mut attributes = AttributeReader::of(element, self.faults);
        let change = match (element.name, spawned) {
            (_, Some(spawned)) => Change::Spawn(spawned),
            (RECOLOR, None) => Change::Recolor {
                object: attributes.require("id", String::new(), "id", value::name),
                color: attributes.require("color", Rgb::GRAY, "color", value::color),
            },
            (_, None) => Change::Remove {
                object: attributes.require("id", String::new(), "id", value::name),
            },
        };
        attributes.finish(Some(change))
    }

    /// The one object in an element.
    fn spawned(&mut self, element: &Element) -> Option<ObjectSpec> {
        let mut objects = Vec::new();
        for child in &element.children {
            if self.is_allowed(child, element.name, &SHAPES) {
                objects.push(self.object(child)?);
            }
        }
        if objects.len() != 1 && !element.is_broken {
            let problem = format_args!("it has {} objects", objects.len());
            self.faults.report(element.place(), problem, "one object");
            return None;
        }
        objects.pop()
    }
}

/// The control of an element that is one of [`CONTROLS`](super::names::CONTROLS).
pub(super) fn control(
    element: &Element,
    content: ControlContent,
    attributes: &mut AttributeReader,
) -> Shape {
    let mut state = attributes.read("initState", 0, |text| value::count(text, &STATES));
    let kind = match content.states {
        States::Numbers => {
            let states = attributes.read("numStates", 2, |text| value::count(text, &(1..=1000)));
            state = state.min(states - 1);
            let pressed = match attributes.read("leftPressed", true, value::boolean) {
                true => Side::Left,
                false => Side::Right,
            };
            ControlKind::ToggleSwitch(ToggleSwitch {
                span: attributes.spans(SPANS, Vec3::new(0.6, 0.3, 0.1)),
                angle: attributes.number("angle", 6.0, &SWITCH_ANGLES),
                color: attributes.read("color", Rgb::DARK_GRAY, value::color),
                pressed,
                states,
            })
        }
        States::Lights(states) => {
            let lights = attributes.read("numLights", 2, |text| value::count(text, &(1..=1000)));
            look_for_lights(element, lights, attributes);
            ControlKind::IndicatorLights(IndicatorLights {
                radius: attributes.span("lightRadius", 0.03),
                zspan: attributes.span("lightZspan", 0.005),
                lights,
                xspan: attributes.span("xspan", 0.15),
                states,
            })
        }
        States::Shapes(states) => ControlKind::Custom(CustomControl {
            name: attributes.read("name", element.name.to_owned(), |text| {
                Ok(value::trim(text).to_owned())
            }),
            states,
        }),
    };
    let control = Control {
        state,
        downstream: content.downstream,
        ..Control::new(kind)
    };
    let states = control.states();
    if attributes.is_sound() && states > 0 && state >= states {
        let problem = format_args!("there is no state {state}");
        attributes.fault("initState", problem, format_args!("at most {}", states - 1));
    }
    Shape::Control(control)
}

/// Notes a fault of every light in a state that the row does not have.
fn look_for_lights(element: &Element, lights: u32, attributes: &mut AttributeReader) {
    for light in element.children.iter().flat_map(|state| &state.children) {
        let number = light.attribute("id").and_then(|id| id.value.as_deref());
        let number = number.and_then(|number| value::count(number, &LIGHTS).ok());
        if let Some(unknown) = number.filter(|&number| number >= lights) {
            let problem = format_args!("there is no light {unknown}");
            attributes.fault_of(light, "id", problem, format_args!("at most {}", lights - 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::SceneItem;

    use super::*;
    use crate::test_support::{items_of, lines_of};

    fn only_control(content: &str) -> Control {
        match items_of(content).as_slice() {
            [
                SceneItem::Object(ObjectSpec {
                    shape: Shape::Control(control),
                    ..
                }),
            ] => control.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn controls_have_the_defaults_of_the_later_program() {
        let switch = only_control("<toggleSwitch location='(0,0,1)'/>");
        let expected = ToggleSwitch {
            span: Vec3::new(0.6, 0.3, 0.1),
            angle: 6.0,
            color: Rgb::DARK_GRAY,
            pressed: Side::Left,
            states: 2,
        };
        assert_eq!(switch, Control::new(ControlKind::ToggleSwitch(expected)));
        let lights =
            "<indicatorLights location='(0,0,1)'><state><light id='1'/></state></indicatorLights>";
        let expected = IndicatorLights {
            radius: 0.03,
            zspan: 0.005,
            lights: 2,
            xspan: 0.15,
            states: vec![LightState {
                name: String::new(),
                lights: vec![(1, Rgb::RED)],
            }],
        };
        assert_eq!(
            only_control(lights),
            Control::new(ControlKind::IndicatorLights(expected))
        );
        let custom = only_control("<customControl location='(0,0,1)'><state/></customControl>");
        assert_eq!(custom.type_name(), "customControl");
    }

    #[test]
    fn a_state_that_a_switch_does_not_have_is_its_last() {
        let switch = only_control("<toggleSwitch location='(0,0,1)' numStates='3' initState='9'/>");
        assert_eq!(switch.state, 2);
    }

    #[test]
    fn shapes_inherit_the_next_state_of_their_composite() {
        let control = only_control(
            "<customControl location='(0,0,1)'><state>\
             <composite location='(0,0,0)' nextStateWhenTriggered='1'><sphere location='(0,0,0)'/>\
             <box location='(0,0,0)' nextStateWhenTriggered='2'/>\
             <block location='(0,0,0)' nextStateWhenTriggered='-1'/></composite>\
             <block location='(0,0,0)'/></state></customControl>",
        );
        let next = [0, 1, 2, 3].map(|part| control.next_state(Some(part)));
        assert_eq!(next, [Some(1), Some(2), Some(1), None]);
    }

    #[test]
    fn faults_have_their_places() {
        for (content, fault) in [
            (
                "<indicatorLights location='(0,0,1)'/>",
                "indicatorLights: it has no states, expected at least one <state>",
            ),
            (
                "<indicatorLights location='(0,0,1)'><state><light id='2'/></state></indicatorLights>",
                "light, id: there is no light 2, expected at most 1",
            ),
            (
                "<customControl location='(0,0,1)' initState='1'><state/></customControl>",
                "customControl, initState: there is no state 1, expected at most 0",
            ),
            (
                "<toggleSwitch location='(0,0,1)'><downstream/></toggleSwitch>",
                "downstream, id: it is missing, expected id=\"id\"",
            ),
        ] {
            assert_eq!(lines_of(content), [fault], "{content}");
        }
    }
}
