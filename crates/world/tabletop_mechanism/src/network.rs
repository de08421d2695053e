//! Networks of controls that pass their states on.

use std::collections::BTreeMap;

use bevy::prelude::*;
use tabletop_core::{
    Cause, Change, Control, ControlKind, MechanismFact, ObjectIndex, ObjectSpec, PressMode, SimFact,
};
use tabletop_physics::{remove_object, reshape};

/// The controls on the table while they change.
pub(crate) struct Network {
    /// The objects with controls, in their new states, in the order of their creation.
    objects: Vec<(Entity, ObjectSpec)>,
    /// Index of each control's object among them.
    owners: BTreeMap<String, usize>,
    /// The changed controls, in order, with the names of their earlier states.
    changed: Vec<(String, String)>,
    /// Changes to other objects, in order.
    changes: Vec<Change>,
}

impl Network {
    pub fn of(world: &World) -> Self {
        let mut network = Self {
            objects: Vec::new(),
            owners: BTreeMap::new(),
            changed: Vec::new(),
            changes: Vec::new(),
        };
        for object in world.resource::<ObjectIndex>().iter() {
            let Some(spec) = world.get::<ObjectSpec>(object) else {
                continue;
            };
            let controls = spec.controls();
            for control in &controls {
                let id = control.id.to_owned();
                let place = network.objects.len();
                network.owners.entry(id).or_insert(place);
            }
            if !controls.is_empty() {
                network.objects.push((object, spec.clone()));
            }
        }
        network
    }

    /// The control with this id, or the reason why there is none.
    pub fn control(&self, id: &str) -> Result<&Control, String> {
        self.owners
            .get(id)
            .and_then(|owner| self.objects.get(*owner)?.1.control(id))
            .ok_or_else(|| format!("there is no control `{id}`"))
    }

    /// Presses the raised side of a switch.
    pub fn flip(&mut self, id: &str) {
        self.change(id, |control| {
            if let ControlKind::ToggleSwitch(switch) = &mut control.kind {
                switch.pressed = switch.pressed.other();
            }
        });
    }

    /// Notes that a push button is pressed or released, and passes its state on as its mode says.
    pub fn press(&mut self, id: &str, is_pressed: bool) {
        let Some(button) = self.control(id).ok().and_then(Control::push_button) else {
            return;
        };
        let state = if is_pressed { button.state } else { 0 };
        let is_handed_on = is_pressed || button.mode == PressMode::Held;
        self.change(id, |control| control.state = state);
        if is_handed_on {
            self.set_downstream(id, state);
        }
    }

    /// Gives a control a state, and passes it on downstream. A state that a control does not have, or has already, changes nothing, so
    /// circles come to an end. A push button takes no state: its cap alone decides.
    pub fn set_state(&mut self, id: &str, state: u32) {
        let mut due = vec![id.to_owned()];
        while let Some(id) = due.pop() {
            let is_news = |control: &Control| {
                control.push_button().is_none()
                    && control.state != state
                    && state < control.states()
            };
            if !self.control(&id).is_ok_and(is_news) {
                continue;
            }
            self.change(&id, |control| control.state = state);
            let changes = self.control(&id).map_or(&[][..], Control::changes);
            let changes = changes.to_vec();
            self.changes.extend(changes);
            due.extend(self.downstream(&id));
        }
    }

    /// Lets a control show and report a state other than its own, or its own again.
    pub fn set_override(&mut self, id: &str, state: Option<u32>) {
        self.change(id, |control| control.override_state = state);
    }

    /// Passes on the present state of a control; not of a button that does so only when it is pressed.
    pub fn hand_on(&mut self, id: &str) {
        let is_lasting = |control: &&Control| {
            let button = control.push_button();
            button.is_none_or(|button| button.mode == PressMode::Held)
        };
        if let Some(control) = self.control(id).ok().filter(is_lasting) {
            self.set_downstream(id, control.state);
        }
    }

    fn set_downstream(&mut self, id: &str, state: u32) {
        for id in self.downstream(id) {
            self.set_state(&id, state);
        }
    }

    /// The controls downstream, the last one first.
    fn downstream(&self, id: &str) -> Vec<String> {
        let control = self.control(id);
        control.map_or_else(
            |_| Vec::new(),
            |control| control.downstream.iter().rev().cloned().collect(),
        )
    }

    fn change(&mut self, id: &str, change: impl FnOnce(&mut Control)) {
        let Some(control) = self
            .owners
            .get(id)
            .and_then(|owner| self.objects.get_mut(*owner)?.1.control_mut(id))
        else {
            return;
        };
        if self.changed.iter().all(|(changed, _)| changed != id) {
            self.changed.push((id.to_owned(), control.state_name()));
        }
        change(control);
    }

    /// Writes the changes into the world, and reports them if `is_reported` is true.
    pub fn take_effect(self, world: &mut World, is_reported: bool) {
        let cause = world.resource::<Cause>().0;
        for (id, before) in &self.changed {
            let Ok(control) = self.control(id) else {
                continue;
            };
            let state = control.state_name();
            if is_reported && state != *before {
                world.write_message(SimFact::Mechanism(MechanismFact::ControlChanged {
                    cause,
                    control: id.clone(),
                    state,
                }));
            }
        }
        for (object, spec) in self.objects {
            let is_changed = world.get::<ObjectSpec>(object) != Some(&spec);
            if is_changed {
                reshape(world, object, spec);
            }
        }
        if is_reported {
            for change in self.changes {
                make(world, change);
            }
        }
    }
}

/// Makes a change to another object; a missing object is ignored.
fn make(world: &mut World, change: Change) {
    let named = |world: &World, id: &str| world.resource::<ObjectIndex>().get(id);
    match change {
        Change::Remove { object } => {
            if let Some(object) = named(world, &object) {
                remove_object(world, object);
            }
        }
        Change::Recolor { object, color } => {
            let object = named(world, &object);
            let spec = object.and_then(|object| world.get::<ObjectSpec>(object));
            if let (Some(object), Some(mut spec)) = (object, spec.cloned()) {
                spec.shape.paint(color);
                reshape(world, object, spec);
            }
        }
        Change::Spawn(mut spec) => {
            let wanted = if spec.id.is_empty() { "obj" } else { &spec.id };
            let tries = (0..).map(|number| format!("{wanted}#{number}"));
            let mut ids = std::iter::once(wanted.to_owned()).chain(tries);
            if let Some(id) = ids.find(|id| named(world, id).is_none()) {
                spec.id = id;
                world.spawn((Transform::from(spec.pose), spec));
            }
        }
    }
}
