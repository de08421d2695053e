//! The program that the demonstrations mean, what else they may mean, and the questions that decide it.

use bevy_egui::egui::{CollapsingHeader, ScrollArea, Ui, WidgetInfo, WidgetType};
use tabletop_user::{OtherProgram, TaskOrder, TaughtProgram};

use crate::widgets::button::button;

/// The most height of the list of other programs, in points.
const OTHERS: f32 = 150.0;

/// Shows the program, and returns the user's request.
pub(super) fn show(ui: &mut Ui, taught: &TaughtProgram, is_busy: bool) -> Option<TaskOrder> {
    if taught.sentences.is_empty() && taught.fault.is_none() {
        return None;
    }
    let header = CollapsingHeader::new("What is meant").default_open(true);
    header
        .show(ui, |ui| meaning(ui, taught, is_busy))
        .body_returned
        .flatten()
}

fn meaning(ui: &mut Ui, taught: &TaughtProgram, is_busy: bool) -> Option<TaskOrder> {
    match &taught.fault {
        Some(fault) => {
            ui.label(fault);
        }
        None => {
            ui.strong(&taught.sentences);
            ui.weak(explained(taught));
        }
    }
    for sentence in &taught.untouched {
        ui.weak(sentence);
    }
    let mut order = None;
    ui.horizontal_wrapped(|ui| {
        let is_there = !is_busy && !taught.sentences.is_empty();
        let perform = "The robot does what the program says with all objects on the table";
        if button(ui, is_there, "Let the robot do this", perform).clicked() {
            order = Some(TaskOrder::Perform);
        }
        let again = "The next recording is one more demonstration of the same";
        if button(ui, !taught.is_awaiting, "Show it again", again).clicked() {
            order = Some(TaskOrder::ShowAgain);
        }
    });
    if taught.is_awaiting {
        ui.label("Show it once more: the next recording counts, too.");
    }
    ScrollArea::vertical()
        .id_salt("others")
        .max_height(OTHERS)
        .auto_shrink([false, true])
        .show(ui, |ui| {
            for (i, program) in taught.others.iter().enumerate() {
                order = order.take().or(other(ui, i + 1, program));
            }
        });
    order
}

fn other(ui: &mut Ui, number: usize, program: &OtherProgram) -> Option<TaskOrder> {
    let OtherProgram { sentences, differs } = program;
    let mut order = None;
    ui.label(format!("Or {number}: {sentences}"));
    ui.weak(format!("It differs {differs}."));
    ui.horizontal(|ui| {
        let ask = "The table on which both differ: show there what is meant";
        if named_button(ui, "Show it here", number, ask) {
            order = Some(TaskOrder::Ask(number));
        }
        if named_button(ui, "This is meant", number, "Nothing else is meant") {
            order = Some(TaskOrder::Answer(number));
        }
    });
    order
}

/// A button with words that tell it from those of other programs.
fn named_button(ui: &mut Ui, text: &str, number: usize, tooltip: &str) -> bool {
    let response = button(ui, true, text, tooltip);
    let name = format!("{text}: {number}");
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
    response.clicked()
}

fn explained(taught: &TaughtProgram) -> String {
    let number = match taught.demonstrations {
        1 => "one demonstration".to_owned(),
        number => format!("{number} demonstrations"),
    };
    match taught.others.is_empty() {
        true => format!("From {number}; nothing else may be meant."),
        false => format!("From {number}; what is open:"),
    }
}
