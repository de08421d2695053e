//! A recording in the list.

use bevy_egui::egui::{
    Color32, Image, Label, Response, RichText, Sense, Ui, UiBuilder, Vec2, WidgetInfo, WidgetType,
    load::SizedTexture, vec2,
};
use tabletop_core::{SimTick, TICKS_PER_SECOND, TimelinePicture};
use tabletop_user::{RecordingDigest, ShelvedRecording};

use crate::pictures::Pictures;

/// Height of a row, and size of its picture, in points.
pub(super) const HEIGHT: f32 = 66.0;
const PICTURE: Vec2 = vec2(80.0, 60.0);

/// The colour in place of a picture that is not there.
const MISSING: Color32 = Color32::from_gray(30);

/// Shows a recording in a row that can be clicked.
pub(super) fn show(
    ui: &mut Ui,
    recording: &ShelvedRecording,
    is_selected: bool,
    pictures: &mut Pictures,
) -> Response {
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(
            WidgetType::SelectableLabel,
            true,
            is_selected,
            &recording.name,
        )
    });
    let visuals = ui.style().interact_selectable(&response, is_selected);
    if is_selected || response.hovered() {
        ui.painter().rect_filled(rect, 3.0, visuals.bg_fill);
    }
    let inside = UiBuilder::new().max_rect(rect.shrink(3.0));
    ui.scope_builder(inside, |ui| {
        ui.horizontal(|ui| {
            let digest = recording.digest.as_ref();
            let read = digest.and_then(|digest| digest.as_ref().ok());
            picture(ui, read, PICTURE, pictures);
            ui.vertical(|ui| {
                ui.spacing_mut().item_spacing.y = 1.0;
                for text in texts(recording) {
                    ui.add(Label::new(text).truncate().selectable(false));
                }
            });
        });
    });
    response
}

/// Shows the last picture of a recording.
pub(super) fn picture(
    ui: &mut Ui,
    digest: Option<&RecordingDigest>,
    size: Vec2,
    pictures: &mut Pictures,
) {
    let path = digest.and_then(|digest| digest.picture.clone());
    let picture = path.map(|path| TimelinePicture {
        tick: SimTick(0),
        path,
        serial: 0,
    });
    let context = ui.ctx().clone();
    match picture.and_then(|picture| pictures.texture(&context, &picture).cloned()) {
        Some(texture) => {
            ui.add(Image::new(SizedTexture::new(texture.id(), size)));
        }
        None => {
            let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
            ui.painter().rect_filled(rect, 0.0, MISSING);
        }
    }
}

/// Name and measures, sentences, and notes.
fn texts(recording: &ShelvedRecording) -> Vec<RichText> {
    let name = RichText::new(&recording.name).strong();
    match &recording.digest {
        None => vec![name, RichText::new("being read …").weak()],
        Some(Err(reason)) => vec![name, RichText::new(reason).weak()],
        Some(Ok(digest)) => {
            let title = format!("{}   {}", recording.name, measures(digest));
            let mut texts = vec![RichText::new(title).strong(), RichText::new(said(digest))];
            if !digest.notes.is_empty() {
                texts.push(
                    RichText::new(digest.notes.replace('\n', " "))
                        .weak()
                        .italics(),
                );
            }
            texts
        }
    }
}

/// Length, number of segments, and whether it was finished.
pub(super) fn measures(digest: &RecordingDigest) -> String {
    let seconds = digest.ticks as f64 / f64::from(TICKS_PER_SECOND);
    let segments = match digest.segments {
        1 => "1 segment".to_owned(),
        many => format!("{many} segments"),
    };
    let end = if digest.is_finished { "" } else { ", cut off" };
    format!("{seconds:.1} s, {segments}{end}")
}

/// The sentences of the task in a line.
fn said(digest: &RecordingDigest) -> String {
    match &digest.sentences[..] {
        [] => "Nothing is moved for good.".into(),
        sentences => sentences.join(" "),
    }
}
