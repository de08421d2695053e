//! The widgets that are on the screen, as a file: for programs that use the window as a person does.

use std::{collections::HashMap, path::PathBuf};

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiOutput, EguiPostUpdateSet, PrimaryEguiContext,
    egui::accesskit::{Affine, Node, NodeId, Point, Rect, TreeUpdate},
};
use tabletop_user::{Notices, Tone};

use crate::preferences::replace;

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

/// Lets the panels list their widgets.
fn enable(mut contexts: EguiContexts) {
    if let Ok(context) = contexts.ctx_mut() {
        context.enable_accesskit();
    }
}

fn write(
    outputs: Query<&EguiOutput, With<PrimaryEguiContext>>,
    mut list: ResMut<WidgetList>,
    mut notices: ResMut<Notices>,
) {
    let Some(tree) = outputs
        .iter()
        .find_map(|output| output.platform_output.accesskit_update.as_ref())
    else {
        return;
    };
    let lines = lines(tree);
    if lines == list.written {
        return;
    }
    let result = replace(&list.file, &lines);
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
        let nodes = tree.nodes.iter().map(|(id, node)| (*id, node)).collect();
        describe(&nodes, root.root, Affine::IDENTITY, &mut lines);
    }
    lines
}

fn describe(nodes: &HashMap<NodeId, &Node>, id: NodeId, outer: Affine, lines: &mut String) {
    let Some(node) = nodes.get(&id) else {
        return;
    };
    let to_pixels = node.transform().map_or(outer, |inner| outer * *inner);
    let name = node.label().or_else(|| {
        // A field has the name of the label beside it.
        let label = nodes.get(node.labelled_by().first()?)?;
        label.label().or(label.value())
    });
    let name = name.filter(|name| !name.is_empty());
    let value = node.value().filter(|value| !value.is_empty());
    if let Some(bounds) = node.bounds()
        && (name.is_some() || value.is_some())
    {
        lines.push_str(&line(node, name, value, to_pixels, bounds));
    }
    for child in node.children() {
        describe(nodes, *child, to_pixels, lines);
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
        let context = egui::Context::default();
        context.enable_accesskit();
        context.set_pixels_per_point(2.0);
        let draw = |ui: &mut egui::Ui| {
            let _ = ui.button("Start");
            let label = ui.label("Notes:").id;
            ui.text_edit_singleline(&mut String::new())
                .labelled_by(label);
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
        let field = rows.iter().find(|row| row[0] == "TextInput").unwrap();
        assert_eq!(field[1], "Notes:");
        let place: Vec<f32> = row("Start")[4..]
            .iter()
            .map(|number| number.parse().unwrap())
            .collect();
        assert!(place[2] - place[0] > 60.0, "{place:?}");
        assert!(row("Undo all")[5].parse::<f32>().unwrap() > place[1]);
    }
}
