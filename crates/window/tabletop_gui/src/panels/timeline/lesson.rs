//! The lesson of the recording: its steps, its requirements on objects, and the robot that imitates.

use bevy_egui::egui::{
    CollapsingHeader, Response, RichText, ScrollArea, Ui, WidgetInfo, WidgetType,
};
use tabletop_core::{Required, ShownProperty, ShownRole};
use tabletop_user::{Action, Imitating, TaskOrder};

use super::{
    meaning,
    model::{Model, Request},
};
use crate::widgets::{button::button, style::ACCENT};

/// The most height of the list of steps and of that of objects, in points.
const STEPS: f32 = 110.0;
const ROLES: f32 = 170.0;

/// True if there is nothing to be shown of the lesson.
pub(super) fn is_empty(model: &Model) -> bool {
    model.task.fault.is_none() && model.task.steps.is_empty()
}

/// Shows the lesson, and returns the user's requests.
pub(super) fn show(ui: &mut Ui, model: &Model) -> Vec<Request> {
    let task = model.task;
    if let Some(fault) = &task.fault {
        ui.label(fault);
    }
    if task.steps.is_empty() {
        return Vec::new();
    }
    let mut orders: Vec<_> = acting(ui, model).into_iter().collect();
    steps(ui, model);
    orders.extend(meaning::show(ui, model.taught, model.imitating.is_on()));
    CollapsingHeader::new("What must be the same")
        .default_open(false)
        .show(ui, |ui| {
            ScrollArea::vertical()
                .id_salt("roles")
                .max_height(ROLES)
                .show(ui, |ui| {
                    for role in &task.roles {
                        orders.extend(requirements(ui, role));
                    }
                });
        })
        .header_response
        .on_hover_text(
            "Requirements on the objects of another table that take the places of the demonstrated ones",
        );
    orders.into_iter().map(Request::Task).collect()
}

fn acting(ui: &mut Ui, model: &Model) -> Option<TaskOrder> {
    let is_on = model.imitating.is_on();
    let imitate = model.keymap.tooltip(Action::Imitate);
    let row = |ui: &mut Ui| {
        let mut order = None;
        if button(ui, !is_on, "Let the robot do it", &imitate).clicked() {
            order = Some(TaskOrder::Imitate);
        }
        if button(ui, is_on, "Stop", "The robot stops where it is").clicked() {
            order = Some(TaskOrder::Stop);
        }
        let back = "Every object goes back where the recording began";
        if button(ui, !is_on, "Put everything back", back).clicked() {
            order = Some(TaskOrder::PutBack);
        }
        order
    };
    let order = ui.horizontal_wrapped(row).inner;
    ui.weak(model.task.folder.display().to_string());
    order
}

/// The sentences, of which that of the present step stands out.
fn steps(ui: &mut Ui, model: &Model) {
    let present = match model.imitating {
        Imitating::Step(step) => step.of.map(|_| step.number),
        Imitating::Idle | Imitating::Preparing => None,
    };
    ScrollArea::vertical()
        .id_salt("steps")
        .max_height(STEPS)
        .auto_shrink([false, true])
        .show(ui, |ui| {
            for (i, step) in model.task.steps.iter().enumerate() {
                let number = i + 1;
                let text = RichText::new(format!("{number}. {}", step.sentence));
                match present {
                    Some(present) if present == number => {
                        let line = ui.label(text.strong().color(ACCENT));
                        line.scroll_to_me(None);
                    }
                    Some(present) if number < present => {
                        ui.label(text.weak());
                    }
                    _ => {
                        ui.label(text);
                    }
                }
            }
        });
}

fn requirements(ui: &mut Ui, role: &ShownRole) -> Option<TaskOrder> {
    let mut order = None;
    ui.horizontal(|ui| {
        ui.strong(&role.id);
        ui.weak(match role.required {
            Required::AsShown => "most like the demonstrated one",
            Required::Nothing => "any object",
            Required::Some => "any object with",
        });
    });
    ui.horizontal_wrapped(|ui| {
        let is_free = role.required == Required::Nothing;
        let mut is_checked = is_free;
        let any = ui.checkbox(&mut is_checked, "any");
        let any = named(any, is_checked, &format!("{}: any", role.id));
        if any.on_hover_text("Any object may take its place").changed() {
            order = Some(TaskOrder::Free {
                role: role.id.clone(),
                is_free: is_checked,
            });
        }
        for property in &role.properties {
            order = order.take().or(requirement(ui, role, property));
        }
    });
    order
}

fn requirement(ui: &mut Ui, role: &ShownRole, property: &ShownProperty) -> Option<TaskOrder> {
    let ShownProperty {
        name,
        value,
        is_required,
    } = property;
    let mut is_checked = *is_required;
    let text = format!("{name} {value}");
    let response = ui.checkbox(&mut is_checked, &text);
    let response = named(response, is_checked, &format!("{}: {text}", role.id));
    let tooltip = format!("An object in its place must have {text}");
    response
        .on_hover_text(tooltip)
        .changed()
        .then(|| TaskOrder::Require {
            role: role.id.clone(),
            property: name.clone(),
            is_required: is_checked,
        })
}

/// A check box, with words that tell it from those of other objects.
fn named(response: Response, is_checked: bool, name: &str) -> Response {
    let is_enabled = response.enabled();
    response
        .widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, is_enabled, is_checked, name));
    response
}
