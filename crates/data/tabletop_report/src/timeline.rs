//! The segments of a recording with its pictures, on an axis of time.

use std::fmt::Write as _;

use crate::{
    chapter::Chapter,
    html::{escaped, picture_address},
};

/// Most pictures on the timeline.
const PICTURES: usize = 12;

/// The timeline as HTML: places are in parts of its width.
pub(crate) fn timeline(chapter: &Chapter) -> String {
    let length = chapter.length().max(1e-3);
    let starts = chapter
        .segments
        .iter()
        .map(|segment| chapter.seconds(segment.start));
    let starts: Vec<_> = starts.collect();
    let mut html = String::from("<div class=\"timeline\">\n<div class=\"segments\">\n");
    for (number, segment) in chapter.segments.iter().enumerate() {
        let from = starts[number];
        let to = starts.get(number + 1).copied().unwrap_or(length);
        let act = segment
            .act
            .as_ref()
            .map_or_else(|| "start".to_owned(), ToString::to_string);
        let _ = writeln!(
            html,
            "<button type=\"button\" class=\"segment\" data-time=\"{from:.3}\" style=\"left:{:.3}%;width:{:.3}%\" title=\"{} at {from:.2} s\">{}</button>",
            from / length * 100.0,
            (to - from) / length * 100.0,
            escaped(&act),
            escaped(&act),
        );
    }
    html += "</div>\n<div class=\"thumbnails\">\n";
    let frames = chapter.episode.len();
    let count = frames.min(PICTURES);
    if let Some(camera) = chapter.episode.cameras.first() {
        for number in 0..count {
            let frame = number * (frames - 1) / count.saturating_sub(1).max(1);
            let time = chapter.seconds(chapter.episode.ticks[frame]);
            let _ = writeln!(
                html,
                "<button type=\"button\" class=\"thumbnail\" data-time=\"{time:.3}\"><img alt=\"At {time:.2} s\" src=\"{}\"></button>",
                picture_address(&camera.images[frame].png),
            );
        }
    }
    html + "</div>\n<div class=\"head\"></div>\n</div>\n"
}
