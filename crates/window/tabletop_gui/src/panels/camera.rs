//! The Camera Navigation window (report section 3, figure 6): pads that move and turn the user's camera while they are dragged, and
//! views to which it goes at once.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{
        self, Align2, Button, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, WidgetType, vec2,
    },
};
use tabletop_user::{Action, Ambience, CameraMotion, CameraView, Keymap, RobotLook, Steering};

use crate::{
    files::FileRequest,
    kept::{Kept, keep},
    panels::{Panel, Panels},
    widgets::{button::switch, number::number_field, style::ACCENT},
};

/// Sides of a pad in points.
const PAD: f32 = 126.0;

/// Speed in units/s, and rad/s, after a drag of this length in points.
const FULL_DRAG: f32 = 140.0;
const TRAVEL: f32 = 18.0;
const TURN: f32 = 2.0;

/// Speed of the buttons in units/s.
const CLIMB: f32 = 9.0;

/// Largest number of a picture's columns, and of its rows.
const LARGEST: u32 = 4096;

/// Radius of the dot where a drag began, in points.
const DOT: f32 = 4.0;

/// A wish of the user to the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Request {
    /// The motion that the held buttons ask for.
    steering: Steering,
    /// The button that was pressed.
    view: Option<CameraView>,
    /// True if the robot is to be shown the other way.
    changes_robot: bool,
    /// True if the other ambience is to be shown.
    changes_ambience: bool,
    /// A picture of so many columns and rows is to be saved.
    picture: Option<[u32; 2]>,
}

/// The size of the next picture, in columns and rows.
#[derive(Clone, Copy, Debug)]
struct PictureSize([u32; 2]);

impl Default for PictureSize {
    fn default() -> Self {
        Self([1600, 1200])
    }
}

impl Kept for Ambience {
    const CONCERN: &'static str = "ambience";
}

pub(crate) fn plugin(app: &mut App) {
    keep::<Ambience>(app);
    app.add_message::<FileRequest>()
        .add_systems(EguiPrimaryContextPass, show_panel);
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    keymap: Res<Keymap>,
    mut steering: ResMut<Steering>,
    mut motions: MessageWriter<CameraMotion>,
    mut files: MessageWriter<FileRequest>,
    mut size: Local<PictureSize>,
    mut robot: ResMut<RobotLook>,
    mut ambience: ResMut<Ambience>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let shown = Panel::Camera.show(context, &mut panels, |ui| {
        show(ui, &keymap, *robot, *ambience, &mut size)
    });
    let request = shown.unwrap_or_default();
    steering.set_if_neq(request.steering);
    if let Some(view) = request.view {
        motions.write(CameraMotion::Look(view));
    }
    if request.changes_robot {
        robot.is_translucent = !robot.is_translucent;
    }
    if request.changes_ambience {
        *ambience = ambience.other();
    }
    if let Some(size) = request.picture {
        files.write(FileRequest::AskForPicture(size));
    }
}

fn show(
    ui: &mut Ui,
    keymap: &Keymap,
    robot: RobotLook,
    ambience: Ambience,
    size: &mut PictureSize,
) -> Request {
    let steering = ui.horizontal(|ui| steering(ui, keymap)).inner;
    if steering != Steering::default() {
        // It goes on moving while nothing else changes.
        ui.ctx().request_repaint();
    }
    let view = ui.horizontal_wrapped(|ui| views(ui, keymap)).inner;
    let tooltip = "Show what is behind the robot, and let the mouse reach it";
    let robot = switch(ui, robot.is_translucent, "See through the robot", tooltip);
    let tooltip = "Show a floor, and shadows that tell how high objects are";
    let room = switch(ui, ambience.is_room(), "Room and shadows", tooltip);
    let picture = ui.horizontal(|ui| picture(ui, size)).inner;
    Request {
        steering,
        view,
        changes_robot: robot.clicked(),
        changes_ambience: room.clicked(),
        picture,
    }
}

/// The button that saves a picture, and its size.
fn picture(ui: &mut Ui, PictureSize(size): &mut PictureSize) -> Option<[u32; 2]> {
    let button = ui.button("Save picture…");
    let is_asked = button
        .on_hover_text("Save the view without panels")
        .clicked();
    for (side, name) in size.iter_mut().zip(["Columns", "Rows"]) {
        let field = number_field(name, side, 1..=LARGEST, |field| field);
        let field = ui.add(field);
        field.on_hover_text(format!("{name} of the picture"));
    }
    is_asked.then_some(*size)
}

fn steering(ui: &mut Ui, keymap: &Keymap) -> Steering {
    let travel = pad(
        ui,
        "drag to move",
        &with_keys(
            "Drag up to go ahead, down to go back, sideways to go sideways: the farther, the faster",
            [
                Action::CameraForward,
                Action::CameraBack,
                Action::CameraLeft,
                Action::CameraRight,
            ],
            keymap,
        ),
    );
    let (ascends, descends) = ui
        .vertical(|ui| {
            ui.spacing_mut().button_padding.x = 2.0;
            let size = vec2(
                ui.spacing().interact_size.x,
                (PAD - ui.spacing().item_spacing.y) / 2.0,
            );
            let mut is_down = |text: &str, action| {
                // A widget that can only be clicked would be let go of after a second.
                let button = Button::new(text).sense(Sense::click_and_drag());
                let button = ui.add_sized(size, button);
                let button = button.on_hover_text(keymap.tooltip(action));
                button.is_pointer_button_down_on()
            };
            (
                is_down("Asc", Action::CameraUp),
                is_down("Dsc", Action::CameraDown),
            )
        })
        .inner;
    let turn = pad(
        ui,
        "look around",
        &with_keys(
            "Drag to where you want to look: the farther, the faster",
            [
                Action::LookUp,
                Action::LookDown,
                Action::LookLeft,
                Action::LookRight,
            ],
            keymap,
        ),
    );
    Steering {
        forward: TRAVEL * travel.y,
        right: TRAVEL * travel.x,
        up: CLIMB * (f32::from(u8::from(ascends)) - f32::from(u8::from(descends))),
        turn_left: -TURN * turn.x,
        turn_up: TURN * turn.y,
    }
}

/// The tooltip of a pad, with the keys that do the same.
fn with_keys(text: &str, actions: [Action; 4], keymap: &Keymap) -> String {
    let keys = actions.map(|action| keymap.hint(action));
    format!("{text} ({})", keys.join(", "))
}

/// An area that is dragged on; how far from where the drag began, to the right and upwards, as parts of its side.
fn pad(ui: &mut Ui, name: &str, tooltip: &str) -> Vec2 {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(PAD), Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, name));
    let drag = ends_of_drag(ui, &response);
    let widgets = &ui.visuals().widgets;
    let visuals = match response.hovered() || drag.is_some() {
        true => widgets.hovered,
        false => widgets.inactive,
    };
    let painter = ui.painter_at(rect);
    painter.rect(
        rect,
        visuals.corner_radius,
        visuals.weak_bg_fill,
        visuals.bg_stroke,
        StrokeKind::Inside,
    );
    if let Some([from, to]) = drag {
        painter.circle_filled(from, DOT, ACCENT);
        painter.arrow(from, to - from, Stroke::new(2.0, ACCENT));
    } else {
        let font = egui::TextStyle::Body.resolve(ui.style());
        let center = Align2::CENTER_CENTER;
        painter.text(rect.center(), center, name, font, visuals.text_color());
    }
    response.on_hover_text(tooltip);
    drag.map_or(Vec2::ZERO, |[from, to]| {
        let dragged = (to - from) / FULL_DRAG;
        Vec2::new(dragged.x, -dragged.y)
    })
}

/// The points at which the mouse was pressed and is now, while its button is down.
fn ends_of_drag(ui: &Ui, response: &Response) -> Option<[egui::Pos2; 2]> {
    if !response.is_pointer_button_down_on() {
        return None;
    }
    ui.input(|input| {
        let pointer = &input.pointer;
        Some([pointer.press_origin()?, pointer.latest_pos()?])
    })
}

fn views(ui: &mut Ui, keymap: &Keymap) -> Option<CameraView> {
    let mut pressed = None;
    for view in CameraView::ALL {
        let (text, tooltip) = words_for(view, keymap);
        if ui.button(text).on_hover_text(tooltip).clicked() {
            pressed = Some(view);
        }
    }
    pressed
}

/// The text of a view's button, and what it says while the mouse rests on it.
fn words_for(view: CameraView, keymap: &Keymap) -> (&'static str, String) {
    let with_key = |action| keymap.tooltip(action);
    match view {
        CameraView::Start => ("Start", with_key(Action::ViewStart)),
        CameraView::Top => ("Top", with_key(Action::ViewTop)),
        CameraView::Front => ("Front", with_key(Action::ViewFront)),
        CameraView::Across => (
            "Across",
            "Looks at the table from its other side, where the robot hides nothing".into(),
        ),
        CameraView::RobotEye => ("Robot's eye", with_key(Action::ViewRobotEye)),
        CameraView::Center => (
            "Centre",
            "Puts the held object, or the table's centre, into the middle of the picture".into(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;

    fn harness() -> Harness<'static, Request> {
        let keymap = Keymap::default();
        let frame = move |ui: &mut Ui, request: &mut Request| {
            *request = show(
                ui,
                &keymap,
                RobotLook::default(),
                Ambience::default(),
                &mut PictureSize::default(),
            )
        };
        let mut harness = Harness::new_ui_state(frame, Request::default());
        harness.set_size(vec2(400.0, 340.0));
        harness.run();
        harness
    }

    /// The button goes down in the middle of a widget; the mouse is dragged this far to the right and down.
    fn drag(harness: &mut Harness<Request>, label: &str, by: egui::Vec2) -> Steering {
        let middle = harness.get_by_label(label).rect().center();
        harness.drag_at(middle);
        harness.step();
        harness.hover_at(middle + by);
        harness.step();
        harness.step();
        harness.state().steering
    }

    #[test]
    fn a_picture_of_the_view_is_asked_for_in_its_size() {
        let mut harness = harness();
        harness.get_by_label("Save picture…").click();
        harness.step();
        assert_eq!(harness.state().picture, Some([1600, 1200]));
    }

    #[test]
    fn the_robot_is_made_translucent() {
        let mut harness = harness();
        harness.get_by_label("See through the robot").click();
        harness.step();
        assert!(harness.state().changes_robot);
    }

    #[test]
    fn the_room_and_its_shadows_are_switched() {
        let mut harness = harness();
        harness.get_by_label("Room and shadows").click();
        harness.step();
        assert!(harness.state().changes_ambience);
    }

    #[test]
    fn a_pad_moves_the_camera_as_it_is_dragged_and_faster_the_farther() {
        let mut harness = harness();
        let slow = drag(&mut harness, "drag to move", vec2(14.0, -28.0));
        assert!((slow.right - 1.8).abs() < 1e-4, "{slow:?}");
        assert!((slow.forward - 3.6).abs() < 1e-4, "{slow:?}");
        assert_eq!((slow.up, slow.turn_left, slow.turn_up), (0.0, 0.0, 0.0));
    }

    #[test]
    fn a_drag_goes_on_beside_the_pad_and_ends_with_the_button() {
        let mut harness = harness();
        let fast = drag(&mut harness, "drag to move", vec2(0.0, 140.0));
        assert!((fast.forward + 18.0).abs() < 1e-3, "{fast:?}");
        let pad = harness.get_by_label("drag to move").rect().center();
        harness.drop_at(pad + vec2(0.0, 140.0));
        harness.step();
        harness.step();
        assert_eq!(*harness.state(), Request::default());
    }

    #[test]
    fn the_other_pad_turns_the_camera_towards_where_it_is_dragged() {
        let mut harness = harness();
        let turn = drag(&mut harness, "look around", vec2(70.0, 35.0));
        assert!((turn.turn_left + 1.0).abs() < 1e-4, "{turn:?}");
        assert!((turn.turn_up + 0.5).abs() < 1e-4, "{turn:?}");
        assert_eq!((turn.right, turn.forward, turn.up), (0.0, 0.0, 0.0));
    }

    #[test]
    fn the_buttons_raise_and_lower_the_camera_while_they_are_held() {
        for (label, up) in [("Asc", 9.0), ("Dsc", -9.0)] {
            let mut harness = harness();
            let climb = drag(&mut harness, label, egui::Vec2::ZERO);
            assert_eq!(climb, Steering { up, ..default() });
        }
    }

    #[test]
    fn pads_and_buttons_tell_their_keys() {
        for (label, keys) in [
            ("drag to move", "(W, S, A, D)"),
            ("look around", "(↑, ↓, ←, →)"),
            ("Asc", "(Q)"),
            ("Robot's eye", "(6)"),
        ] {
            let mut harness = harness();
            harness.get_by_label(label).hover();
            let reported = (0..100).any(|_| {
                harness.step();
                harness.query_by_label_contains(keys).is_some()
            });
            assert!(reported, "{label} does not tell {keys}");
        }
    }

    #[test]
    fn each_view_has_a_button() {
        for (label, view) in [
            ("Start", CameraView::Start),
            ("Top", CameraView::Top),
            ("Front", CameraView::Front),
            ("Across", CameraView::Across),
            ("Robot's eye", CameraView::RobotEye),
            ("Centre", CameraView::Center),
        ] {
            let mut harness = harness();
            harness.get_by_label(label).click();
            let asked = (0..4).find_map(|_| {
                harness.step();
                harness.state().view
            });
            assert_eq!(asked, Some(view));
        }
    }
}
