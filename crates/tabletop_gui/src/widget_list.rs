//! The widgets that are on the screen, as a file: for programs that use the window as a person does.

use std::{fs, path::PathBuf};

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiOutput, EguiPostUpdateSet, PrimaryEguiContext,
    egui::{
        Context,
        accesskit::{Affine, Node, NodeId, Point, Rect, TreeUpdate},
    },
};

use crate::panels::messages::{Notices, Tone};

/// Writes which widgets are on the screen whenever that changes.
///
/// The file has a line for each, in the order of the screen's accessibility tree, with tabs between its fields: role, name,
/// value, `enabled` or `disabled`, and left, top, right and bottom in pixels of the window.
#[derive(Clone, Debug)]
pub struct WidgetListPlugin {
    /// The file.
    pub file: PathBuf,
}

impl Plugin for WidgetListPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(WidgetList {
            file: self.file.clone(),
            written: String::new(),
            has_failed: false,
        })
        .add_systems(Startup, enable)
        .add_systems(
            PostUpdate,
            (enable, write)
                .chain()
                .after(EguiPostUpdateSet::ProcessOutput),
        );
    }
}

#[derive(Resource)]
struct WidgetList {
    file: PathBuf,
    written: String,
    has_failed: bool,
}

/// Lets the panels say what they consist of.
fn enable(mut contexts: EguiContexts, mut is_enabled: Local<bool>) {
    if let Ok(context) = contexts.ctx_mut()
        && !*is_enabled
    {
        Context::enable_accesskit(context);
        *is_enabled = true;
    }
}

fn write(
    outputs: Query<&EguiOutput, With<PrimaryEguiContext>>,
    mut list: ResMut<WidgetList>,
    mut notices: ResMut<Notices>,
) {
    let updates = outputs.iter();
    let Some(tree) = updates
        .filter_map(|output| output.platform_output.accesskit_update.as_ref())
        .next()
    else {
        return;
    };
    let lines = lines(tree);
    if lines == list.written {
        return;
    }
    // A reader sees all of it or nothing.
    let new = list.file.with_extension("new");
    let result = fs::write(&new, &lines).and_then(|()| fs::rename(&new, &list.file));
    list.written = lines;
    if let Err(error) = result
        && !list.has_failed
    {
        list.has_failed = true;
        let text = format!("{}: {error}", list.file.display());
        notices.add(Tone::Fault, &text);
    }
}

fn lines(tree: &TreeUpdate) -> String {
    let mut lines = String::new();
    if let Some(root) = &tree.tree {
        describe(tree, root.root, Affine::IDENTITY, &mut lines);
    }
    lines
}

fn describe(tree: &TreeUpdate, id: NodeId, outer: Affine, lines: &mut String) {
    let Some((_, node)) = tree.nodes.iter().find(|(other, _)| *other == id) else {
        return;
    };
    let to_pixels = node.transform().map_or(outer, |inner| outer * *inner);
    let name = node.label().filter(|name| !name.is_empty());
    let value = node.value().filter(|value| !value.is_empty());
    if let Some(bounds) = node.bounds()
        && (name.is_some() || value.is_some())
    {
        lines.push_str(&line(node, name, value, to_pixels, bounds));
    }
    for child in node.children() {
        describe(tree, *child, to_pixels, lines);
    }
}

fn line(
    node: &Node,
    name: Option<&str>,
    value: Option<&str>,
    to_pixels: Affine,
    bounds: Rect,
) -> String {
    let one_line = |text: Option<&str>| text.unwrap_or_default().replace(['\t', '\n', '\r'], " ");
    let top_left = to_pixels * Point::new(bounds.x0, bounds.y0);
    let bottom_right = to_pixels * Point::new(bounds.x1, bounds.y1);
    let state = match node.is_disabled() {
        true => "disabled",
        false => "enabled",
    };
    format!(
        "{:?}\t{}\t{}\t{state}\t{:.0}\t{:.0}\t{:.0}\t{:.0}\n",
        node.role(),
        one_line(name),
        one_line(value),
        top_left.x,
        top_left.y,
        bottom_right.x,
        bottom_right.y
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui;

    #[test]
    fn each_widget_has_a_line_with_its_place_in_pixels() {
        let context = Context::default();
        context.enable_accesskit();
        context.set_pixels_per_point(2.0);
        let draw = |ui: &mut egui::Ui| {
            let _ = ui.button("Start");
            ui.add_enabled(false, egui::Button::new("Undo\tall"));
        };
        let mut output = egui::FullOutput::default();
        for _ in 0..2 {
            output = context.run_ui(egui::RawInput::default(), draw);
        }
        let tree = output.platform_output.accesskit_update.unwrap();
        let text = lines(&tree);
        let rows: Vec<Vec<&str>> = text
            .lines()
            .map(|line| line.split('\t').collect())
            .collect();
        let row = |name| rows.iter().find(|row| row[1] == name).unwrap();
        assert_eq!(row("Start")[..4], ["Button", "Start", "", "enabled"]);
        assert_eq!(row("Undo all")[3], "disabled");
        let place: Vec<f32> = row("Start")[4..]
            .iter()
            .map(|number| number.parse().unwrap())
            .collect();
        assert!(place[2] - place[0] > 60.0, "{place:?}");
        assert!(row("Undo all")[5].parse::<f32>().unwrap() > place[1]);
    }
}
