//! `tabletop teach`: the program that a few demonstrations mean.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    program::{Example, Meaning, TaskProgram, Untouched},
    task::{Furniture, Task},
    xml::write,
};
use clap::Args;
use serde_json::{Value, json};

use super::{
    Failure, Output,
    demonstration::read_demonstration,
    meaning::{ASKED, HEADING, told},
    range::NumberRange,
    result_file::{ResultFile, ResultKind},
    terminal::show_warnings,
};

/// The numbers of the programs that may be meant, too.
const ANSWERS: NumberRange<usize> = NumberRange::whole(1, Meaning::MOST_ALTERNATIVES);

#[derive(Args)]
pub(super) struct TeachArgs {
    /// The folders of demonstrations, up to five, of one task
    #[arg(value_name = "DEMO", required = true, num_args = 1..=5)]
    demonstrations: Vec<PathBuf>,
    /// Write the program to this file, which `tabletop tell --program` reads; the other programs that may be meant are comments in it
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Answer what is open: the program that is meant is the one printed as `Or N`, from 1 to 8. `--out` then writes it alone
    #[arg(long, value_name = "N", value_parser = ANSWERS, allow_negative_numbers = true)]
    answer: Option<usize>,
    /// Write the table that decides between the program and `Or 1` to this task file, whose comment has both; exit code 1 if nothing is open
    #[arg(long, value_name = "FILE", conflicts_with = "answer")]
    ask: Option<PathBuf>,
    /// Print the program and everything else as JSON, with sentences and with the programs of `tabletop tell --check`
    #[arg(long)]
    json: bool,
}

/// Prints the program that demonstrations mean, and what else they may mean. Exit code 1 if no program explains them all.
pub(super) fn teach(args: &TeachArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let file = |path: &Option<PathBuf>, kind| {
        let path = path.as_ref();
        path.map(|path| ResultFile::replacing(path, kind))
            .transpose()
    };
    let (out, ask) = (
        file(&args.out, ResultKind::Program)?,
        file(&args.ask, ResultKind::Question)?,
    );
    let examples: Result<Vec<_>, _> = args.demonstrations.iter().map(|it| example(it)).collect();
    let meaning = Meaning::of(&examples?);
    let meaning = match args.answer {
        Some(number) => meaning
            .answered(number)
            .ok_or_else(|| unasked(number, meaning.alternatives.len()))?,
        None => meaning,
    };
    let Some(program) = &meaning.program else {
        return Err(Failure::run(
            "no program explains all of this; show the same task each time, or teach each part alone",
        ));
    };
    let told = told(&meaning);
    match args.json {
        true => Output::Stdout.write(format!("{:#}\n", json(program, &meaning)).as_bytes())?,
        false => Output::tell(&format!("{program}\n{}", listed(&told, "")))?,
    }
    if let Some(out) = out {
        let text = format!("{HEADING}\n{program}\n{}", listed(&told, "# "));
        out.write(text.as_bytes())?;
    }
    if let Some(ask) = ask {
        let question = question(program, &meaning);
        let question = question.ok_or_else(|| {
            Failure::run("nothing is open: there is no other program that may be meant")
        })?;
        ask.write(question.as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The task file of the table on which the first alternative acts differently.
fn question(program: &TaskProgram, meaning: &Meaning) -> Option<String> {
    let other = meaning.alternatives.first()?;
    let lines = [program, &other.program].map(TaskProgram::in_a_line);
    let [program, other_said] = lines.map(|line| line.replace("--", "- -"));
    let comment = format!("<!-- {ASKED} {program} Or: {other_said} -->");
    let scene = write(&other.decided_by.scene.items());
    Some(scene.replacen("?>", &format!("?>\n{comment}"), 1))
}

/// The fault of an answer to a question that was not asked.
fn unasked(number: usize, alternatives: usize) -> Failure {
    let expected = match alternatives {
        0 => "there is no other program that may be meant".to_owned(),
        1 => "there is one other program, 1".to_owned(),
        _ => format!("expected the number of an other program, from 1 to {alternatives}"),
    };
    Failure::input(format!("--answer {number}: {expected}"))
}

/// The example that a recording is.
fn example(recording: &Path) -> Result<Example, Failure> {
    let shown = read_demonstration(recording, &Furniture::default()).map_err(Failure::input)?;
    let task = Task::of(&shown);
    let place = recording.display();
    Example::of(&shown, &task).ok_or_else(|| {
        Failure::input(format!(
            "{place}: it has steps that no program says, such as turning, tipping, triggering or letting go; see `tabletop explain {place}`"
        ))
    })
}

fn json(program: &TaskProgram, meaning: &Meaning) -> Value {
    let said =
        |program: &TaskProgram| json!({ "sentences": program.to_string(), "program": program });
    let alternatives = meaning.alternatives.iter().map(|other| {
        let mut other_said = said(&other.program);
        other_said["differs"] = json!(other.decided_by.sentence);
        other_said
    });
    let mut all = said(program);
    all["alternatives"] = alternatives.collect();
    let untouched = meaning.untouched.iter();
    let untouched =
        untouched.map(|Untouched { of, objects }| json!({ "of": of, "objects": objects }));
    all["untouched"] = untouched.collect();
    all
}

fn listed(lines: &[String], before: &str) -> String {
    lines
        .iter()
        .map(|line| format!("{before}{line}\n"))
        .collect()
}
