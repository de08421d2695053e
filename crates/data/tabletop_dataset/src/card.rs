//! The card of a dataset: a README for a hub, with pictures.

use std::{
    collections::BTreeSet,
    fmt,
    path::{Path, PathBuf},
};

use tabletop_recorder::{RecordedFrame, RecordingReader};
use tabletop_storage::{InnerPath, Storage, WriterLock, is_taken};
use tabletop_training::Image;

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
/// Another program writes there and the storage is not to wait for it; there is a card already, or something cannot be read or written.
pub fn write_card(dataset: &DatasetFolder, storage: &Storage) -> Result<PathBuf, DatasetError> {
    let _alone =
        WriterLock::of_folder(&dataset.path, storage).map_err(DatasetError::io(&dataset.path))?;
    let card = dataset.path.join(CARD);
    let folder = dataset.path.join(PICTURES);
    if !is_taken(&card) && is_of_killed(&folder, storage) {
        let removed = storage.remove_folder(&folder);
        removed.map_err(DatasetError::io(&folder))?;
    }
    for path in [&card, &folder] {
        if is_taken(path) {
            let problem = "it is there already, and stays as it is; move it away first";
            return Err(DatasetError::unfit(path, problem));
        }
    }
    let summary = summarize(dataset)?;
    let shown = shown_episodes(dataset)?;
    let text = text_of(&name_of(&dataset.path), &summary, &shown);
    let write_text = || {
        let written = storage.write_new(&card, text.as_bytes());
        written.map_err(DatasetError::io(&card))
    };
    if shown.is_empty() {
        write_text()?;
        return Ok(card);
    }
    let made = storage.create_folder(&folder);
    made.map_err(DatasetError::io(&folder))?;
    let written = write_pictures(&folder, &shown, storage).and_then(|()| write_text());
    if written.is_err() {
        // The failure is reported; more cannot be done.
        let _stays = storage.remove_folder(&folder);
    }
    written.map(|()| card)
}

/// True for the pictures of a card that was not finished.
fn is_of_killed(folder: &Path, storage: &Storage) -> bool {
    let entries = storage.entries(folder);
    let names = entries.iter().flatten().map(|entry| name_of(entry));
    let mut names = names.filter(|name| !name.starts_with('.'));
    !folder.is_symlink()
        && entries.is_ok()
        && names.all(|name| {
            let number = name
                .split_once('-')
                .map(|(number, rest)| (number.parse::<usize>(), rest));
            matches!(number, Some((Ok(_), "first.png" | "last.png")))
        })
}

fn write_pictures(
    folder: &Path,
    shown: &[ShownEpisode],
    storage: &Storage,
) -> Result<(), DatasetError> {
    for (number, episode) in shown.iter().enumerate() {
        for (name, picture) in ["-first.png", "-last.png"]
            .into_iter()
            .zip(&episode.pictures)
        {
            let path = InnerPath::numbered("", number as u64, name).below(folder);
            let written = storage.write_new(&path, picture);
            written.map_err(DatasetError::io(&path))?;
        }
    }
    Ok(())
}

/// Episodes with pictures.
fn shown_episodes(dataset: &DatasetFolder) -> Result<Vec<ShownEpisode>, DatasetError> {
    let mut shown = Vec::new();
    match &dataset.content {
        DatasetContent::Recordings(recordings) => {
            for folder in recordings.iter().take(SHOWN_EPISODES) {
                let recording = RecordingReader::open(folder)?;
                let segments = recording.segments()?;
                let mut frames = segments.iter().flat_map(|segment| &segment.frames);
                let Some(first) = frames.next() else {
                    continue;
                };
                let last = frames.last().unwrap_or(first);
                let size = recording.picture_size("head");
                let picture = |frame: &RecordedFrame| {
                    Image::read_sized(&frame.picture, size).map(|image| image.png)
                };
                shown.push(ShownEpisode {
                    name: name_of(folder),
                    pictures: [picture(first)?, picture(last)?],
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
