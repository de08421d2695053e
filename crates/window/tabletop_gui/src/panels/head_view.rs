//! The robot's view at the lower right corner of the window (report section 5, figure 9b): the head camera's own picture.

mod beliefs;

use beliefs::Beliefs;
use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Color32, ColorImage, Rect, TextureHandle, TextureOptions, Vec2},
};
use tabletop_core::{
    HeadCamera, OrderSystems, Picture, PictureDemand, RestingSystems, SensorImage,
};

use tabletop_user::HeadView;
use tabletop_vision::{Perception, PerceptionDemand};

use crate::panels::{arrangement::Panels, window::free_desk};

/// Width of the inset, as a part of the window's.
const WIDTH: f32 = 0.4;

/// Thickness of its border in points.
const BORDER: f32 = 1.0;

const BORDER_COLOR: Color32 = Color32::GRAY;

/// The place of the button for the eyes in the inset, and its size, in points.
const MARGIN: Vec2 = Vec2::splat(4.0);
const EYES_BUTTON: Vec2 = Vec2::new(44.0, 20.0);

const EYES_HINT: &str = "Draws where the robot believes that the objects are, by this picture alone; red where it is not sure";

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<HeadCamera>()
        .init_resource::<PictureDemand>()
        .init_resource::<SensorImage>()
        .init_resource::<Perception>()
        .init_resource::<PerceptionDemand>()
        .add_systems(
            FixedUpdate,
            ask_for_picture
                .in_set(OrderSystems::User)
                .in_set(RestingSystems)
                .run_if(HeadView::is_on.and_then(is_last_tick_of_frame)),
        )
        .add_systems(EguiPrimaryContextPass, show_inset);
}

/// Only the last picture of a frame is seen.
fn is_last_tick_of_frame(time: Res<Time<Fixed>>) -> bool {
    time.overstep() < time.timestep()
}

fn ask_for_picture(
    view: Res<HeadView>,
    demand: Res<PictureDemand>,
    perception: Res<PerceptionDemand>,
) {
    demand.ask();
    if view.has_beliefs {
        perception.ask();
    }
}

/// A picture on the graphics card, and its pixels.
struct ShownPicture {
    texture: TextureHandle,
    width: u32,
    rgb: Vec<u8>,
}

impl ShownPicture {
    fn shows(&self, picture: &Picture) -> bool {
        self.width == picture.width && self.rgb == picture.rgb
    }
}

fn show_inset(
    mut shown: Local<Option<ShownPicture>>,
    mut contexts: EguiContexts,
    mut view: ResMut<HeadView>,
    camera: Res<HeadCamera>,
    image: Res<SensorImage>,
    panels: Res<Panels>,
    beliefs: Beliefs,
) {
    if !view.is_shown() {
        *shown = None;
        return;
    }
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    upload(&mut shown, context, &image.picture);
    let inset = inset(free_desk(context, &panels), aspect(&camera));
    egui::Area::new(egui::Id::new("head view"))
        .fixed_pos(inset.min)
        .movable(false)
        .constrain(false)
        .fade_in(false)
        .show(context, |ui| {
            // Opaque also for the mouse.
            ui.allocate_rect(inset, egui::Sense::click());
            ui.painter().rect_filled(inset, 0.0, BORDER_COLOR);
            let inside = inset.shrink(BORDER);
            ui.painter().rect_filled(inside, 0.0, Color32::BLACK);
            if let Some(shown) = &*shown {
                let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
                ui.painter()
                    .image(shown.texture.id(), inside, whole, Color32::WHITE);
            }
            if view.has_beliefs {
                beliefs.paint(ui.painter(), inside);
            }
            let corner = Rect::from_min_size(inside.min + MARGIN, EYES_BUTTON);
            let eyes = egui::Button::selectable(view.has_beliefs, "Eyes");
            if ui.put(corner, eyes).on_hover_text(EYES_HINT).clicked() {
                view.has_beliefs = !view.has_beliefs;
            }
        });
}

/// Brings a picture to the graphics card, unless it is there.
fn upload(shown: &mut Option<ShownPicture>, context: &egui::Context, picture: &Picture) {
    if picture.rgb.is_empty() {
        // A real camera has nothing to show any more.
        *shown = None;
        return;
    }
    if shown.as_ref().is_some_and(|shown| shown.shows(picture)) {
        return;
    }
    let most = context.input(|input| input.max_texture_side);
    let pixels = pixels(picture, most);
    match shown {
        Some(shown) => {
            shown.texture.set(pixels, TextureOptions::NEAREST);
            shown.width = picture.width;
            shown.rgb.clone_from(&picture.rgb);
        }
        None => {
            *shown = Some(ShownPicture {
                texture: context.load_texture("head view", pixels, TextureOptions::NEAREST),
                width: picture.width,
                rgb: picture.rgb.clone(),
            });
        }
    }
}

/// The pixels of a picture; of one with sides above `most` only every second, third …
fn pixels(picture: &Picture, most: usize) -> ColorImage {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let step = width.max(height).div_ceil(most.max(1));
    let (colors, _) = picture.rgb.as_chunks();
    let rows = colors.chunks(width).step_by(step);
    let pixels = rows.flat_map(|row| row.iter().step_by(step));
    ColorImage::new(
        [width.div_ceil(step), height.div_ceil(step)],
        pixels
            .map(|&[r, g, b]| Color32::from_rgb(r, g, b))
            .collect(),
    )
}

/// Width of the field of view for a height of 1, with pixels of any shape.
fn aspect(camera: &HeadCamera) -> f32 {
    if camera.square_fov {
        1.0
    } else {
        camera.width.max(1) as f32 / camera.height.max(1) as f32
    }
}

/// The lower right corner of the room that there is for it.
fn inset(room: Rect, aspect: f32) -> Rect {
    let width = (WIDTH * room.width()).min(room.height() * aspect).round();
    let size = Vec2::new(width, (width / aspect).round());
    Rect::from_min_max(room.max - size, room.max)
}

#[cfg(test)]
mod tests {
    use tabletop_user::UserPlugin;

    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use egui::pos2;
    use tabletop_core::{CorePlugin, SimSystems};

    #[test]
    fn the_inset_takes_two_fifths_of_the_width_in_the_lower_right_corner() {
        let room = Rect::from_min_max(pos2(0.0, 0.0), pos2(1000.0, 740.0));
        let expected = Rect::from_min_max(pos2(600.0, 440.0), room.max);
        assert_eq!(inset(room, 4.0 / 3.0), expected);
        assert_eq!(inset(room, 1.0).size(), Vec2::splat(400.0));
    }

    #[test]
    fn the_inset_keeps_its_shape_in_a_flat_window() {
        let room = Rect::from_min_max(pos2(0.0, 0.0), pos2(2000.0, 300.0));
        assert_eq!(inset(room, 4.0 / 3.0).size(), Vec2::new(400.0, 300.0));
    }

    #[test]
    fn the_aspect_is_that_of_the_field_of_view() {
        let mut camera = HeadCamera::default();
        assert_eq!(aspect(&camera), 4.0 / 3.0);
        camera.square_fov = true;
        assert_eq!(aspect(&camera), 1.0);
    }

    #[test]
    fn a_picture_that_is_too_large_is_thinned_out() {
        let mut picture = Picture::default();
        picture.resize(5, 3);
        for (i, value) in picture.rgb.iter_mut().enumerate() {
            *value = (i / 3) as u8;
        }
        let numbers = |image: ColorImage| image.pixels.iter().map(|c| c.r()).collect::<Vec<_>>();
        assert_eq!(pixels(&picture, 5).size, [5, 3]);
        assert_eq!(numbers(pixels(&picture, 5)), (0..15).collect::<Vec<_>>());
        assert_eq!(pixels(&picture, 4).size, [3, 2]);
        assert_eq!(numbers(pixels(&picture, 4)), [0, 2, 4, 10, 12, 14]);
    }

    #[test]
    fn a_picture_that_is_shown_is_not_uploaded_again() {
        let context = egui::Context::default();
        let mut picture = Picture::default();
        let mut shown = None;
        upload(&mut shown, &context, &picture);
        assert!(shown.is_none());
        picture.resize(2, 1);
        upload(&mut shown, &context, &picture);
        let uploads =
            |context: &egui::Context| context.tex_manager().write().take_delta().set.len();
        uploads(&context);
        upload(&mut shown, &context, &picture);
        assert_eq!(uploads(&context), 0);
        picture.rgb[0] = 9;
        upload(&mut shown, &context, &picture);
        assert_eq!(uploads(&context), 1);
    }

    #[derive(Resource, Default)]
    struct Taken(Vec<bool>);

    #[test]
    fn the_picture_of_the_last_tick_of_a_frame_is_asked_for_while_it_is_shown() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(3))
            .init_resource::<Taken>()
            .add_systems(
                FixedUpdate,
                (|mut demand: ResMut<PictureDemand>, mut taken: ResMut<Taken>| {
                    taken.0.push(demand.take());
                })
                .in_set(SimSystems::Sense),
            );
        app.finish();
        app.cleanup();
        app.update();
        app.world_mut().resource_mut::<Taken>().0.clear();
        app.update();
        assert_eq!(app.world().resource::<Taken>().0, [false; 3]);
        app.world_mut().resource_mut::<HeadView>().toggle();
        app.update();
        let taken = &app.world().resource::<Taken>().0[3..];
        assert_eq!(taken, [false, false, true]);
    }
}
