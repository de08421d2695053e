//! The card of a dataset: a README for a hub, with pictures.

use std::{collections::BTreeSet, fmt, path::PathBuf};

use tabletop_export::Image;
use tabletop_recorder::RecordingReader;
use tabletop_storage::{Storage, is_taken};

use crate::{
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder, name_of},
    limits::SHOWN_EPISODES,
    summary::{DatasetSummary, summarize},
};

/// The file of the card.
const CARD: &str = "README.md";

/// The folder of its pictures.
const PICTURES: &str = "card";

/// First and last picture of an episode.
struct ShownEpisode {
    name: String,
    pictures: [Vec<u8>; 2],
}

/// Writes the card of a dataset into its folder: `README.md`, and pictures in `card`. Returns the card's path.
///
/// # Errors
/// There is a card already, or something cannot be read or written.
pub fn write_card(dataset: &DatasetFolder) -> Result<PathBuf, DatasetError> {
    let storage = Storage::default();
    let card = dataset.path.join(CARD);
    let folder = dataset.path.join(PICTURES);
    for path in [&card, &folder] {
        if is_taken(path) {
            let problem = "it is there already, and stays as it is; move it away first";
            return Err(DatasetError::unfit(path, problem));
        }
    }
    let summary = summarize(dataset)?;
    let shown = shown_episodes(dataset)?;
    if !shown.is_empty() {
        let made = storage.create_folder(&folder);
        made.map_err(DatasetError::io(&folder))?;
    }
    for (number, episode) in shown.iter().enumerate() {
        for (name, picture) in ["first", "last"].iter().zip(&episode.pictures) {
            let path = folder.join(format!("{number}-{name}.png"));
            let written = storage.write_new(&path, picture);
            written.map_err(DatasetError::io(&path))?;
        }
    }
    let text = text_of(&name_of(&dataset.path), &summary, &shown);
    let written = storage.write_new(&card, text.as_bytes());
    written.map_err(DatasetError::io(&card))?;
    Ok(card)
}

/// Episodes with pictures.
fn shown_episodes(dataset: &DatasetFolder) -> Result<Vec<ShownEpisode>, DatasetError> {
    let mut shown = Vec::new();
    match &dataset.content {
        DatasetContent::Recordings(recordings) => {
            for folder in recordings.iter().take(SHOWN_EPISODES) {
                let segments = RecordingReader::open(folder)?.segments()?;
                let mut frames = segments.iter().flat_map(|segment| &segment.frames);
                let Some(first) = frames.next() else {
                    continue;
                };
                let last = frames.last().unwrap_or(first);
                shown.push(ShownEpisode {
                    name: name_of(folder),
                    pictures: [
                        Image::read(&first.picture)?.png,
                        Image::read(&last.picture)?.png,
                    ],
                });
            }
        }
        DatasetContent::LeRobot(reader) => {
            reader.visit_tables(|number, episode| {
                let camera = episode.cameras.first().map(|camera| &camera.images);
                if let Some([first, .., last]) = camera.map(Vec::as_slice)
                    && shown.len() < SHOWN_EPISODES
                {
                    shown.push(ShownEpisode {
                        name: format!("episode {number}"),
                        pictures: [first.png.clone(), last.png.clone()],
                    });
                }
                Ok::<_, DatasetError>(())
            })?;
        }
    }
    Ok(shown)
}

fn text_of(name: &str, summary: &DatasetSummary, shown: &[ShownEpisode]) -> String {
    let is_lerobot = summary.kind.starts_with("LeRobot");
    let mut text = String::from("---\ntask_categories:\n- robotics\ntags:\n- tabletop\n");
    if is_lerobot {
        text += "- LeRobot\nconfigs:\n- config_name: default\n  data_files: data/*/*.parquet\n";
    }
    let mut line = |line: fmt::Arguments<'_>| text += &format!("{line}\n");
    line(format_args!("---\n\n# {name}\n"));
    line(format_args!(
        "Demonstrations on a simulated table, made with tabletop {}.\n",
        env!("CARGO_PKG_VERSION")
    ));
    line(format_args!("| | |\n|---|---|"));
    line(format_args!("| kind | {} |", summary.kind));
    line(format_args!("| episodes | {} |", summary.episodes));
    line(format_args!("| frames | {} |", summary.frames));
    line(format_args!(
        "| simulated time | {:.1} s |",
        summary.seconds
    ));
    let list = |items: &BTreeSet<String>| {
        let items: Vec<_> = items.iter().map(|item| escaped(item)).collect();
        items.join(", ")
    };
    line(format_args!("| objects | {} |", list(&summary.objects)));
    line(format_args!("| cameras | {} |", list(&summary.cameras)));
    line(format_args!("\n## Tasks\n"));
    for (task, episodes) in &summary.tasks {
        match episodes {
            Some(episodes) => line(format_args!("- {} ({episodes})", escaped(task))),
            None => line(format_args!("- {}", escaped(task))),
        }
    }
    if !shown.is_empty() {
        line(format_args!(
            "\n## Pictures\n\n| | first | last |\n|---|---|---|"
        ));
    }
    for (number, episode) in shown.iter().enumerate() {
        line(format_args!(
            "| {} | ![first]({PICTURES}/{number}-first.png) | ![last]({PICTURES}/{number}-last.png) |",
            escaped(&episode.name)
        ));
    }
    text
}

/// A text that means nothing else in Markdown.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        if matches!(letter, '|' | '*' | '_' | '`' | '<' | '[' | ']' | '\\') {
            escaped.push('\\');
        }
        escaped.push(if letter.is_control() { ' ' } else { letter });
    }
    escaped
}
