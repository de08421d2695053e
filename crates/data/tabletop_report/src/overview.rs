//! Many recordings in a table.

use tabletop_training::Image;

use crate::{
    chapter::Chapter,
    html::{escaped, picture_address, table},
};

/// A recording in a table of many.
#[derive(Clone, Debug)]
pub struct OverviewRow {
    cells: Vec<String>,
    frames: usize,
    seconds: f64,
}

impl OverviewRow {
    /// A recording with its first and last picture.
    pub fn of(chapter: &Chapter) -> Self {
        let images = chapter.episode.cameras.first();
        let images = images.map_or(&[][..], |camera| &camera.images);
        let picture = |image: &Image, words: &str| {
            let address = picture_address(&image.png);
            format!("<img class=\"small\" alt=\"{words}\" src=\"{address}\">")
        };
        let [before, after] = [
            images
                .first()
                .map(|image| picture(image, "At the beginning")),
            images.last().map(|image| picture(image, "At the end")),
        ]
        .map(Option::unwrap_or_default);
        Self {
            cells: vec![
                escaped(&chapter.name()),
                before,
                after,
                escaped(&chapter.episode.task),
                chapter.deeds().len().to_string(),
                format!("{:.1}", chapter.length()),
                chapter.episode.len().to_string(),
            ],
            frames: chapter.episode.len(),
            seconds: chapter.length(),
        }
    }
}

/// A table of recordings.
pub(crate) fn overview(rows: &[OverviewRow]) -> String {
    let frames: usize = rows.iter().map(|row| row.frames).sum();
    let seconds: f64 = rows.iter().map(|row| row.seconds).sum();
    let headings = [
        "recording",
        "before",
        "after",
        "what was done",
        "steps",
        "s",
        "frames",
    ];
    let cells: Vec<_> = rows.iter().map(|row| row.cells.clone()).collect();
    format!(
        "<header><h1>{} recordings</h1>\n<p class=\"facts\">{frames} frames · {seconds:.0} s</p></header>\n{}",
        rows.len(),
        table(&headings, &cells),
    )
}
