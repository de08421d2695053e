//! `tabletop compare`: two recordings side by side.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    recorder::RecordingReader,
    task::{ComparedObject, Demonstration, Furniture, compare},
};
use clap::Args;
use serde_json::json;

use super::{
    Failure,
    demonstration::read_demonstration,
    explain::{print, print_json, reported, understood},
    quiet::seconds_of,
    terminal::show_warnings,
};

#[derive(Args)]
pub(super) struct CompareArgs {
    /// A recording's folder
    #[arg(value_name = "A")]
    one: PathBuf,
    /// The folder of another
    #[arg(value_name = "B")]
    other: PathBuf,
    /// Print all as JSON
    #[arg(long)]
    json: bool,
}

/// One of the two.
struct Compared {
    lines: Vec<String>,
    seconds: f64,
    shown: Demonstration,
}

/// Prints what both show, how long they are, and where the objects go and end.
pub(super) fn run(args: &CompareArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let one = Compared::read(&args.one)?;
    let other = Compared::read(&args.other)?;
    let objects = compare(&one.shown, &other.shown);
    if args.json {
        let objects = objects.iter().map(|it| {
            let (distance, angle) = it.apart.unzip();
            json!({ "id": it.id, "ways": it.ways, "distance": distance, "angle": angle })
        });
        return print_json(&json!({
            "sentences": [one.lines, other.lines],
            "seconds": [one.seconds, other.seconds],
            "objects": objects.collect::<Vec<_>>(),
        }));
    }
    let mut text = String::new();
    if one.lines == other.lines {
        text += "Both show the same:\n";
        text += &listed(&one.lines);
    } else {
        for (folder, compared) in [(&args.one, &one), (&args.other, &other)] {
            let _infallible = writeln!(text, "{} shows:", folder.display());
            text += &listed(&compared.lines);
        }
    }
    let [first, second] = [one.seconds, other.seconds];
    let _infallible = writeln!(text, "\nThey take {first:.1} s and {second:.1} s.\n");
    text += &table(&objects);
    print(&text)
}

impl Compared {
    fn read(folder: &Path) -> Result<Self, Failure> {
        let shown = read_demonstration(folder, &Furniture::default()).map_err(Failure::input)?;
        let (task, _) = understood(&shown, folder)?;
        let recording = RecordingReader::open(folder).map_err(Failure::input)?;
        Ok(Self {
            lines: reported(&task),
            seconds: seconds_of(&recording),
            shown,
        })
    }
}

fn listed(lines: &[String]) -> String {
    match lines {
        [] => "  Nothing is moved for good.\n".into(),
        lines => lines.iter().map(|line| format!("  {line}\n")).collect(),
    }
}

/// A row for each object, in units and degrees.
fn table(objects: &[ComparedObject]) -> String {
    let width = objects
        .iter()
        .map(|it| it.id.len())
        .max()
        .unwrap_or(0)
        .max(6);
    let mut text = format!(
        "{:<width$}   way in A   way in B      apart     turned\n",
        "object"
    );
    for ComparedObject { id, ways, apart } in objects {
        let number = |number: Option<f32>, unit: &str| match number {
            Some(number) => format!("{number:.2}{unit}"),
            None => "-".into(),
        };
        let [first, second] = ways.map(|way| number(way, ""));
        let (apart, turned) = apart.unzip();
        let (apart, turned) = (number(apart, ""), number(turned.map(f32::to_degrees), "°"));
        let _infallible = writeln!(
            text,
            "{id:<width$} {first:>10} {second:>10} {apart:>10} {turned:>10}"
        );
    }
    text + "Ways and distances in units of 10 cm.\n"
}
