//! The Plots window: quantities over time, of the world as it goes on or of the recording that the Timeline shows.

mod legend;
mod live;

use std::collections::BTreeSet;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{ComboBox, Rangef, Rect, Ui, Vec2b, WidgetInfo, WidgetType},
};
use egui_plot::{AxisHints, Line, Plot, PlotPoints, Points, VLine};
use tabletop_core::{
    Idle, Playback, PlaybackOrder, SimTick, TICKS_PER_SECOND, Timeline, TimelineStage,
};
use tabletop_user::{Curves, Quantity, RecordedCurves, ShownCurves};

use self::live::LiveCurves;
use crate::{
    files::FileRequest,
    panels::{Panel, Panels},
    widgets::{button::button, name::name},
};

/// Height of the plot in points.
const HEIGHT: f32 = 260.0;

/// The most curves that are drawn.
const MOST_CURVES: usize = 60;

/// The least distances of numbers along the axes, in points. Least and best ones that differ would make numbers pale.
const NUMBERS_X: f32 = 40.0;
const NUMBERS_Y: f32 = 16.0;

/// The radius of a curve that is a single point, in points.
const POINT: f32 = 3.0;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<PlotView>()
        .init_resource::<LiveCurves>()
        .init_resource::<Idle>()
        .init_resource::<RecordedCurves>()
        .init_resource::<ShownCurves>()
        .add_message::<FileRequest>()
        .add_systems(Update, live::sample)
        .add_systems(EguiPrimaryContextPass, show_panel);
}

/// What the user looks at.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
struct PlotView {
    quantity: Quantity,
    /// The object whose curves are shown; all if there is none.
    object: Option<String>,
    /// True if the world as it goes on is shown though there is a recording.
    is_live: bool,
    /// The names of curves that are not drawn.
    hidden: BTreeSet<String>,
}

/// The content of the window.
struct Model<'a> {
    /// The curves; none while they are read.
    curves: Option<&'a Curves>,
    problem: Option<&'a str>,
    /// True if a recording can be shown.
    has_recording: bool,
    /// The playhead, in seconds from the beginning of the recording.
    playhead: Option<f64>,
}

/// A wish of the user.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Request {
    SaveTable,
    SavePicture,
    /// Go to this moment of the open recording, in seconds.
    GoTo(f64),
}

/// The resources from which the model is made.
#[derive(SystemParam)]
struct Sources<'w> {
    live: Res<'w, LiveCurves>,
    recorded: Res<'w, RecordedCurves>,
    timeline: Res<'w, Timeline>,
    tick: Res<'w, SimTick>,
    playback: Res<'w, Playback>,
}

impl Sources<'_> {
    fn has_recording(&self) -> bool {
        match self.timeline.stage {
            TimelineStage::Finished | TimelineStage::Open => {
                self.recorded.folder == self.timeline.folder
            }
            TimelineStage::Absent | TimelineStage::Running => false,
        }
    }

    fn model(&self, is_live: bool) -> Model<'_> {
        let has_recording = self.has_recording();
        if is_live || !has_recording {
            return Model {
                curves: Some(self.live.curves()),
                problem: None,
                has_recording,
                playhead: None,
            };
        }
        let read = self.recorded.curves.as_ref();
        let shown = self
            .playback
            .goal
            .unwrap_or(SimTick(self.tick.0.saturating_sub(1)));
        // After the end of a recording, the world goes on.
        let ticks = shown.min(self.timeline.end).0;
        let ticks = ticks.saturating_sub(self.timeline.start.0);
        Model {
            curves: read.and_then(|read| read.as_ref().ok()),
            problem: read
                .and_then(|read| read.as_ref().err())
                .map(String::as_str),
            has_recording,
            playhead: (self.timeline.stage == TimelineStage::Open)
                .then(|| ticks as f64 / f64::from(TICKS_PER_SECOND)),
        }
    }
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    mut view: ResMut<PlotView>,
    mut shown: ResMut<ShownCurves>,
    mut files: MessageWriter<FileRequest>,
    mut orders: MessageWriter<PlaybackOrder>,
    sources: Sources,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let model = sources.model(view.is_live);
    let view = view.bypass_change_detection();
    let scale = context.pixels_per_point();
    let result = Panel::Plots.show(context, &mut panels, |ui| show(ui, &model, view));
    let Some((request, place)) = result else {
        return;
    };
    match request {
        Some(save @ (Request::SaveTable | Request::SavePicture)) => {
            *shown = shown_curves(&model, view, place, scale);
            files.write(match save {
                Request::SaveTable => FileRequest::AskForTable,
                Request::SavePicture | Request::GoTo(_) => FileRequest::AskForPlot,
            });
        }
        Some(Request::GoTo(seconds)) => {
            let ticks = (seconds.max(0.0) * f64::from(TICKS_PER_SECOND)).round() as u64;
            let tick = SimTick(sources.timeline.start.0 + ticks);
            orders.write(PlaybackOrder::StopAt(tick.min(sources.timeline.end)));
        }
        None => {}
    }
}

fn shown_curves(model: &Model, view: &PlotView, place: Rect, scale: f32) -> ShownCurves {
    let curves = model
        .curves
        .into_iter()
        .flat_map(|curves| chosen(curves, view));
    ShownCurves {
        quantity: view.quantity,
        curves: curves
            .map(|(name, points)| (name.to_owned(), points.to_vec()))
            .collect(),
        place: [place.min.x, place.min.y, place.max.x, place.max.y].map(|side| side * scale),
    }
}

/// The curves of the quantity and object that the user looks at.
fn chosen<'a>(
    curves: &'a Curves,
    view: &'a PlotView,
) -> impl Iterator<Item = (&'a str, &'a [[f64; 2]])> {
    let object = view
        .object
        .as_deref()
        .filter(|_| view.quantity.is_of_object());
    curves
        .of(view.quantity)
        .filter(move |(name, _)| object.is_none_or(|object| object_of(name) == object))
}

/// The object of a curve, whose name may end with a coordinate.
fn object_of(name: &str) -> &str {
    match name.rsplit_once(' ') {
        Some((object, "X" | "Y" | "Z")) => object,
        _ => name,
    }
}

/// Shows the window's contents, and returns the user's request and the place of the plot.
fn show(ui: &mut Ui, model: &Model, view: &mut PlotView) -> (Option<Request>, Rect) {
    let mut request = ui
        .horizontal_wrapped(|ui| {
            choices(ui, model, view);
            let has_some = model
                .curves
                .is_some_and(|curves| chosen(curves, view).next().is_some());
            let table = "Saves these curves as a table (.csv): seconds, name, value";
            let table = button(ui, has_some, "Save CSV…", table);
            let picture = button(
                ui,
                has_some,
                "Save plot…",
                "Saves a picture of the plot (.png)",
            );
            match (table.clicked(), picture.clicked()) {
                (true, _) => Some(Request::SaveTable),
                (_, true) => Some(Request::SavePicture),
                _ => None,
            }
        })
        .inner;
    match (model.problem, model.curves) {
        (Some(problem), _) => {
            ui.colored_label(ui.visuals().error_fg_color, problem);
        }
        (None, None) => {
            ui.weak("The recording is being read …");
        }
        (None, Some(_)) => {}
    }
    let drawn = ui.vertical(|ui| draw(ui, model, view));
    let (clicked, toggled) = drawn.inner;
    if let Some(name) = toggled
        && !view.hidden.remove(&name)
    {
        view.hidden.insert(name);
    }
    if model.playhead.is_some() {
        request = request.or(clicked.map(Request::GoTo));
    }
    (request, drawn.response.rect)
}

/// Draws the plot and its legend. Returns the time that is clicked, and the curve that is clicked in the legend.
fn draw(ui: &mut Ui, model: &Model, view: &PlotView) -> (Option<f64>, Option<String>) {
    let curves: Vec<_> = model
        .curves
        .into_iter()
        .flat_map(|curves| chosen(curves, view))
        .take(MOST_CURVES)
        .collect();
    let time = AxisHints::new_x()
        .label("s")
        .label_spacing(Rangef::point(NUMBERS_X));
    let value = AxisHints::new_y()
        .label(view.quantity.unit())
        .label_spacing(Rangef::point(NUMBERS_Y));
    let mut plot = Plot::new("plot")
        .height(HEIGHT)
        .custom_x_axes(vec![time])
        .custom_y_axes(vec![value])
        .auto_bounds(Vec2b::TRUE)
        .allow_scroll(false);
    // A range of one time or value alone has no size, and egui shows another one.
    if let Some(time) = only_number(&curves, 0) {
        plot = plot.include_x(time - 0.5).include_x(time + 0.5);
    }
    if let Some(value) = only_number(&curves, 1) {
        plot = plot.include_y(value - 0.5).include_y(value + 0.5);
    }
    let playhead = ui.visuals().strong_text_color();
    let shown = plot.show(ui, |plot| {
        for (number, (name, points)) in curves.iter().enumerate() {
            if view.hidden.contains(*name) {
                continue;
            }
            let (color, series) = (legend::color(number), PlotPoints::from(points.to_vec()));
            match points {
                [_] => plot.points(Points::new(*name, series).color(color).radius(POINT)),
                _ => plot.line(Line::new(*name, series).color(color)),
            }
        }
        if let Some(seconds) = model.playhead {
            plot.vline(VLine::new("", seconds).color(playhead));
        }
        plot.response()
            .clicked()
            .then(|| plot.pointer_coordinate())
            .flatten()
    });
    shown
        .response
        .widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, "Plot"));
    let names: Vec<_> = curves.iter().map(|(name, _)| *name).collect();
    let toggled = legend::show(ui, &names, &view.hidden);
    (shown.inner.map(|point| point.x), toggled)
}

/// The time, or value, of all points, if they have the same.
fn only_number(curves: &[(&str, &[[f64; 2]])], side: usize) -> Option<f64> {
    let points = curves.iter().flat_map(|(_, points)| *points);
    let mut numbers = points.map(|point| point[side]);
    let first = numbers.next()?;
    numbers.all(|number| number == first).then_some(first)
}

/// The lists of quantities and objects.
fn choices(ui: &mut Ui, model: &Model, view: &mut PlotView) {
    let list = ComboBox::from_id_salt("quantity")
        .width(150.0)
        .selected_text(view.quantity.name())
        .show_ui(ui, |ui| {
            for quantity in Quantity::ALL {
                ui.selectable_value(&mut view.quantity, quantity, quantity.name());
            }
        });
    name(&list.response, WidgetType::ComboBox, "Quantity");
    if view.quantity.is_of_object() {
        let all = "all objects";
        let list = ComboBox::from_id_salt("object")
            .width(110.0)
            .truncate()
            .selected_text(view.object.as_deref().unwrap_or(all))
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut view.object, None, all);
                let mut last = None;
                for (name, _) in model.curves.into_iter().flat_map(|it| it.of(view.quantity)) {
                    let object = object_of(name);
                    if last != Some(object) {
                        ui.selectable_value(&mut view.object, Some(object.to_owned()), object);
                    }
                    last = Some(object);
                }
            });
        name(&list.response, WidgetType::ComboBox, "Object");
    }
    if model.has_recording {
        let live = "Shows the world as it goes on instead of the recording in Timeline";
        ui.checkbox(&mut view.is_live, "Live").on_hover_text(live);
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Color32, Shape, Theme, epaint::ColorMode};
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;

    struct Stage {
        curves: Curves,
        view: PlotView,
        requests: Vec<Request>,
        place: Rect,
    }

    fn harness() -> Harness<'static, Stage> {
        let mut curves = Curves::default();
        for object in ["ball", "red block"] {
            for axis in ["X", "Y", "Z"] {
                let name = format!("{object} {axis}");
                curves.add(Quantity::Places, &name, 0.0, [0.0, 1.0]);
                curves.add(Quantity::Places, &name, 0.9, [1.0, 3.0]);
            }
        }
        curves.add(Quantity::Joints, "left_w0", 0.0, [0.0, 0.5]);
        showing(curves, Quantity::Places)
    }

    fn showing(curves: Curves, quantity: Quantity) -> Harness<'static, Stage> {
        let stage = Stage {
            curves,
            view: PlotView {
                quantity,
                ..PlotView::default()
            },
            requests: Vec::new(),
            place: Rect::NOTHING,
        };
        let frame = |ui: &mut Ui, stage: &mut Stage| {
            let model = Model {
                curves: Some(&stage.curves),
                problem: None,
                has_recording: true,
                playhead: Some(0.5),
            };
            let (request, place) = show(ui, &model, &mut stage.view);
            stage.requests.extend(request);
            stage.place = place;
        };
        Harness::builder()
            .with_size([Panel::Plots.width(), 400.0])
            .build_ui_state(frame, stage)
    }

    /// The colours of lines.
    fn lines(harness: &Harness<Stage>) -> Vec<Color32> {
        let shapes = harness.output().shapes.iter();
        let colors = shapes.filter_map(|clipped| {
            let Shape::Path(path) = &clipped.shape else {
                return None;
            };
            match path.stroke.color {
                ColorMode::Solid(color) => Some(color),
                ColorMode::UV(_) => None,
            }
        });
        colors.collect()
    }

    fn click(harness: &mut Harness<Stage>, names: &[&str]) {
        for name in names {
            harness.get_by_label(name).click();
            harness.run();
        }
    }

    fn names(stage: &Stage) -> Vec<&str> {
        chosen(&stage.curves, &stage.view)
            .map(|(name, _)| name)
            .collect()
    }

    #[test]
    fn a_quantity_and_an_object_are_chosen() {
        let mut harness = harness();
        assert_eq!(names(harness.state()).len(), 6);
        click(&mut harness, &["Object", "red block"]);
        let expected = ["red block X", "red block Y", "red block Z"];
        assert_eq!(names(harness.state()), expected);
        click(&mut harness, &["Quantity", "Joints"]);
        assert_eq!(names(harness.state()), ["left_w0"]);
        assert!(harness.query_by_label("Object").is_none());
    }

    #[test]
    fn what_is_shown_can_be_saved() {
        let mut harness = harness();
        click(&mut harness, &["Save CSV…", "Save plot…", "Live"]);
        let requests = &harness.state().requests;
        assert_eq!(requests[..], [Request::SaveTable, Request::SavePicture]);
        assert!(harness.state().view.is_live);
    }

    #[test]
    fn a_click_goes_to_its_moment_of_the_recording() {
        let mut harness = harness();
        harness.run();
        click(&mut harness, &["Plot"]);
        let [Request::GoTo(seconds)] = harness.state().requests[..] else {
            panic!("{:?}", harness.state().requests);
        };
        assert!((0.2..0.8).contains(&seconds), "{seconds}");
    }

    #[test]
    fn the_playhead_is_seen_in_each_theme() {
        for theme in [Theme::Dark, Theme::Light] {
            let mut harness = harness();
            harness.ctx.set_theme(theme);
            harness.run();
            let ink = harness.ctx.global_style().visuals.strong_text_color();
            assert!(lines(&harness).contains(&ink), "{theme:?}");
        }
    }

    #[test]
    fn the_saved_picture_has_the_axes_and_the_whole_legend() {
        let mut curves = Curves::default();
        let names: Vec<_> = (0..20).map(|joint| format!("left_w{joint}")).collect();
        for name in &names {
            curves.add(Quantity::Joints, name, 0.0, [0.0, 0.5]);
        }
        let mut harness = showing(curves, Quantity::Joints);
        harness.run();
        let place = harness.state().place;
        let plot = harness.get_by_label("Plot").rect();
        assert!(place.left() < plot.left() - 10.0 && plot.bottom() + 10.0 < place.bottom());
        for name in &names {
            let shown = harness.get_by_label(name).rect();
            assert!(place.contains_rect(shown), "{name}: {shown} in {place}");
        }
    }

    #[test]
    fn a_single_sample_and_a_constant_are_seen() {
        for seconds in [vec![37.0], vec![37.0, 38.0]] {
            let mut curves = Curves::default();
            for at in seconds {
                curves.add(Quantity::Joints, "left_w0", at, [at, 5.0]);
            }
            let mut harness = showing(curves, Quantity::Joints);
            harness.run();
            let plot = harness.get_by_label("Plot").rect();
            let is_at_half_height = |y: f32| (y - plot.center().y).abs() < 2.0;
            let mut shapes = harness.output().shapes.iter();
            let is_seen = shapes.any(|clipped| {
                if let Shape::Circle(point) = &clipped.shape {
                    return is_at_half_height(point.center.y) && point.radius >= 2.0;
                }
                let Shape::Path(line) = &clipped.shape else {
                    return false;
                };
                line.points.iter().all(|at| is_at_half_height(at.y))
            });
            assert!(is_seen, "{:?}", harness.state().curves);
        }
    }
}
