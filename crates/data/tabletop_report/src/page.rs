//! Whole pages.

use std::{collections::BTreeMap, fmt::Write as _, sync::Arc};

use serde_json::json;
use tabletop_geometry::{Pose, Rgb};
use tabletop_training::{FrameVectors, Image, ObjectTrack};

use crate::{
    chapter::Chapter,
    html::{escaped, picture_address, table},
    overview::{OverviewRow, overview},
    plot::{COLORS, Plot, PlotLine},
    timeline::timeline,
};

const STYLE: &str = include_str!("page.css");
const PLAYER: &str = include_str!("player.js");

/// Distance from which on an object has moved, in units.
const MOVED: f32 = 0.05;

/// Lines of a plot.
const LINES: usize = 12;

/// The page of a recording.
pub fn recording_page(chapter: &Chapter) -> String {
    let body = [
        header(chapter),
        player(chapter),
        deeds(chapter),
        format!("<h2>Timeline</h2>\n{}", timeline(chapter)),
        plots(chapter),
        objects(chapter),
        requirements(chapter),
        numbers(chapter),
    ];
    page(&chapter.name(), &body.concat(), Some(&player_data(chapter)))
}

/// The page of several recordings: a table with their first and last pictures.
pub fn overview_page(rows: &[OverviewRow]) -> String {
    let title = format!("{} recordings", rows.len());
    page(&title, &overview(rows), None)
}

/// The tag that tells a page of this program from others.
pub const GENERATOR: &str = "<meta name=\"generator\" content=\"tabletop\">";

/// A page without anything from elsewhere. `data` is what the player plays.
pub(crate) fn page(title: &str, body: &str, data: Option<&str>) -> String {
    let script = data.map_or_else(String::new, |data| {
        format!(
            "<script type=\"application/json\" id=\"frames\">{data}</script>\n<script>{PLAYER}</script>\n"
        )
    });
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{GENERATOR}\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <link rel=\"icon\" href=\"data:,\">\n\
         <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n{body}</main>\n{script}</body>\n</html>\n",
        escaped(title),
    )
}

fn header(chapter: &Chapter) -> String {
    let what = match chapter.episode.task.as_str() {
        "" => "The hands move nothing for good.",
        task => task,
    };
    let who = if chapter.has_robot() {
        "robot"
    } else {
        "hands"
    };
    format!(
        "<header><h1>{}</h1>\n<p class=\"task\">{}</p>\n<p class=\"facts\">{:.1} s · {} frames · {} objects · by the {who}</p></header>\n",
        escaped(&chapter.name()),
        escaped(what),
        chapter.length(),
        chapter.episode.len(),
        chapter.episode.objects.len(),
    )
}

/// The player, with the first picture in it.
fn player(chapter: &Chapter) -> String {
    let Some(camera) = chapter.episode.cameras.first() else {
        return String::new();
    };
    let Some(first) = camera.images.first() else {
        return String::new();
    };
    let last = chapter.episode.len().saturating_sub(1);
    let choices: String = chapter
        .episode
        .cameras
        .iter()
        .map(|camera| format!("<option>{}</option>", escaped(&camera.name)))
        .collect();
    let hidden = if chapter.episode.cameras.len() < 2 {
        " hidden"
    } else {
        ""
    };
    format!(
        "<section class=\"player\" aria-label=\"Player\">\n\
         <img id=\"picture\" alt=\"The camera's picture\" width=\"{}\" height=\"{}\" src=\"{}\">\n\
         <p id=\"part\" aria-live=\"polite\"></p>\n\
         <input id=\"slider\" type=\"range\" min=\"0\" max=\"{last}\" value=\"0\" aria-label=\"Frame\">\n\
         <div class=\"buttons\">\n\
         <button id=\"first\" type=\"button\" title=\"To the beginning (Home)\">|◀</button>\n\
         <button id=\"back\" type=\"button\" title=\"A frame back (←)\">◀</button>\n\
         <button id=\"play\" type=\"button\" title=\"Play or pause (Space)\">Play</button>\n\
         <button id=\"on\" type=\"button\" title=\"A frame on (→)\">▶</button>\n\
         <button id=\"last\" type=\"button\" title=\"To the end (End)\">▶|</button>\n\
         <output id=\"time\"></output>\n\
         <label>Speed <select id=\"speed\"><option value=\"0.25\">¼×</option><option value=\"0.5\">½×</option><option value=\"1\" selected>1×</option><option value=\"2\">2×</option><option value=\"4\">4×</option></select></label>\n\
         <label{hidden}>Camera <select id=\"camera\">{choices}</select></label>\n\
         </div>\n\
         <p class=\"keys\">Space plays and pauses, ← and → go a frame back and on, Home and End to the ends.</p>\n\
         </section>\n",
        first.width,
        first.height,
        picture_address(&first.png),
    )
}

/// Pictures, each once, and what is being done, for the player.
fn player_data(chapter: &Chapter) -> String {
    let mut pictures: Vec<String> = Vec::new();
    let cameras = chapter.episode.cameras.iter().map(|camera| {
        let mut places: BTreeMap<*const Image, usize> = BTreeMap::new();
        let frames = camera.images.iter().map(|image| {
            *places.entry(Arc::as_ptr(image)).or_insert_with(|| {
                pictures.push(picture_address(&image.png));
                pictures.len() - 1
            })
        });
        let frames: Vec<_> = frames.collect();
        json!({ "name": camera.name, "frames": frames })
    });
    let cameras: Vec<_> = cameras.collect();
    let parts = chapter.episode.subtasks.iter();
    let parts: Vec<_> = parts
        .map(|part| json!([part.frame, part.sentence]))
        .collect();
    let times = chapter
        .episode
        .ticks
        .iter()
        .map(|tick| chapter.seconds(*tick));
    let data = json!({
        "times": times.collect::<Vec<_>>(),
        "cameras": cameras,
        "pictures": pictures,
        "parts": parts,
    });
    // An id may contain the end of a script.
    data.to_string().replace('<', "\\u003c")
}

fn deeds(chapter: &Chapter) -> String {
    let deeds = chapter.deeds();
    if deeds.is_empty() {
        return String::new();
    }
    let mut html = String::from("<h2>What was done</h2>\n<ol class=\"deeds\">\n");
    for (from, to, sentence) in deeds {
        let _ = writeln!(
            html,
            "<li><button type=\"button\" data-time=\"{from:.3}\">{}</button> <span class=\"unit\">{from:.1} to {to:.1} s</span></li>",
            escaped(&sentence),
        );
    }
    html + "</ol>\n"
}

fn plots(chapter: &Chapter) -> String {
    let fps = chapter.episode.fps as f32;
    let mut plots = Vec::new();
    let moved: Vec<_> = chapter
        .episode
        .objects
        .iter()
        .filter(|object| span(object) > MOVED)
        .take(LINES)
        .collect();
    if !moved.is_empty() {
        let colors = line_colors(&moved);
        let axes: [(&str, fn(Pose) -> f32); 3] = [
            ("X: to the right", |pose| pose.location.x),
            ("Y: away from the robot", |pose| pose.location.y),
            ("Z: up", |pose| pose.location.z),
        ];
        for (title, of) in axes {
            let line = |(number, object): (usize, &&ObjectTrack)| PlotLine {
                name: object.spec.id.clone(),
                color: colors[number].clone(),
                values: object.poses.iter().map(|pose| pose.map(of)).collect(),
            };
            plots.push(Plot {
                title: title.into(),
                unit: "units of 10 cm",
                lines: moved.iter().enumerate().map(line).collect(),
            });
        }
    }
    if chapter.has_robot() {
        plots.extend(joint_plots(&chapter.episode.state));
    }
    if plots.is_empty() {
        return String::new();
    }
    let svgs: String = plots.iter().map(|plot| plot.svg(fps)).collect();
    format!("<h2>Motions</h2>\n<div class=\"plots\">\n{svgs}</div>\n")
}

/// A plot for each limb, and one for the openings of the grippers: joints are grouped by the first part of their names.
fn joint_plots(joints: &FrameVectors) -> Vec<Plot> {
    let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (column, name) in joints.names.iter().enumerate() {
        let limb = name.split('_').next().unwrap_or(name);
        let group = if name.contains("gripper") {
            "Grippers"
        } else {
            limb
        };
        groups.entry(group).or_default().push(column);
    }
    let is_moved = |column: &usize| {
        let mut values = joints.frames().map(|frame| frame[*column]);
        let first = values.next();
        values.any(|value| Some(value) != first)
    };
    let moved = groups
        .into_iter()
        .filter(|(_, columns)| columns.iter().any(is_moved));
    let plots = moved.map(|(group, columns)| Plot {
        title: match group {
            "Grippers" => "Openings of the grippers".into(),
            limb => format!("Joints: {limb}"),
        },
        unit: if group == "Grippers" {
            "units of 10 cm"
        } else {
            "rad"
        },
        lines: columns
            .iter()
            .take(LINES)
            .enumerate()
            .map(|(number, column)| PlotLine {
                name: joints.names[*column].clone(),
                color: COLORS[number % COLORS.len()].into(),
                values: joints.frames().map(|frame| Some(frame[*column])).collect(),
            })
            .collect(),
    });
    plots.collect()
}

/// A colour for each object's lines: its own, or another one if it can hardly be seen on paper or two have the same.
fn line_colors(objects: &[&ObjectTrack]) -> Vec<String> {
    let mut colors: Vec<String> = Vec::new();
    for (number, object) in objects.iter().enumerate() {
        let own = object.spec.shape.drawn().first().map(|solid| solid.color);
        let is_seen = |color: &Rgb| {
            let sum: u32 = color.to_bytes().into_iter().map(u32::from).sum();
            (60..600).contains(&sum)
        };
        let own = own.filter(is_seen).map(|color| color.to_string());
        let own = own.filter(|color| !colors.contains(color));
        colors.push(own.unwrap_or_else(|| COLORS[number % COLORS.len()].into()));
    }
    colors
}

/// The size of the box in which an object has been, in units.
fn span(object: &ObjectTrack) -> f32 {
    let mut places = object.poses.iter().flatten().map(|pose| pose.location);
    let Some(first) = places.next() else {
        return 0.0;
    };
    let (least, most) = places.fold((first, first), |(least, most), place| {
        (least.min(place), most.max(place))
    });
    (most - least).length()
}

fn objects(chapter: &Chapter) -> String {
    let place = |pose: Option<Pose>| {
        pose.map_or_else(
            || "–".to_owned(),
            |Pose { location, .. }| {
                // No -0.
                let [x, y, z] = location
                    .to_array()
                    .map(|it| (it * 100.0).round() / 100.0 + 0.0);
                format!("{x:.2}, {y:.2}, {z:.2}")
            },
        )
    };
    let rows = chapter.episode.objects.iter().map(|object| {
        let there = || object.poses.iter().flatten().copied();
        vec![
            escaped(&object.spec.id),
            escaped(object.spec.shape.name()),
            format!("{:.2}", object.spec.mass),
            place(there().next()),
            place(there().next_back()),
            match span(object) {
                moved if moved > MOVED => format!("{moved:.2}"),
                _ => "–".into(),
            },
        ]
    });
    let rows: Vec<_> = rows.collect();
    let headings = [
        "object",
        "shape",
        "mass (kg)",
        "from (X, Y, Z)",
        "to (X, Y, Z)",
        "moved by",
    ];
    format!("<h2>Objects</h2>\n{}", table(&headings, &rows))
}

fn requirements(chapter: &Chapter) -> String {
    let rows = chapter.requirements.roles.iter().map(|(role, properties)| {
        let words = properties
            .iter()
            .map(|(name, value)| format!("{name} is {value}"));
        let words: Vec<_> = words.collect();
        let words = match words.is_empty() {
            true => "any object".to_owned(),
            false => words.join(", "),
        };
        vec![escaped(role), escaped(&words)]
    });
    let rows: Vec<_> = rows.collect();
    match rows.is_empty() {
        true => String::new(),
        false => format!(
            "<h2>Requirements</h2>\n{}",
            table(&["role", "object"], &rows)
        ),
    }
}

fn numbers(chapter: &Chapter) -> String {
    let episode = &chapter.episode;
    let cameras: Vec<_> = episode
        .cameras
        .iter()
        .map(|camera| {
            let size = camera.images.first();
            let size = size.map_or_else(String::new, |it| format!(" {}×{}", it.width, it.height));
            format!("{}{size}", camera.name)
        })
        .collect();
    let rows = [
        ("Folder", chapter.folder.display().to_string()),
        ("Made by", format!("tabletop {}", chapter.program)),
        ("Length", format!("{:.2} s", chapter.length())),
        (
            "Frames",
            format!("{} at {} a second", episode.len(), episode.fps),
        ),
        ("Segments", chapter.segments.len().to_string()),
        ("Cameras", cameras.join(", ")),
        ("Joints", episode.state.names.len().to_string()),
    ];
    let rows: Vec<_> = rows
        .into_iter()
        .map(|(name, value)| vec![escaped(name), escaped(&value)])
        .collect();
    format!("<h2>Numbers</h2>\n{}", table(&["", ""], &rows))
}
