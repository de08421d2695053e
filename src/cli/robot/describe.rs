//! Descriptions of robots: what they hold and lack, and a first one for a URDF.

use std::{
    fs,
    io::ErrorKind,
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    cli::{Failure, Output, WRONG_INPUT, robot_options::describe, terminal::say},
    core::Table,
    kinematics::ModelError,
    robot::{Description, DescriptionSource, RobotPlugin, Survey, draft},
    robot_body,
    shipped::{read_text, true_path},
    storage::{Storage, parent_of},
};
use clap::Args;

#[derive(Args)]
pub(super) struct SurveyArgs {
    /// The description, as after --robot
    #[arg(value_name = "FILE", conflicts_with = "robot")]
    pub file: Option<PathBuf>,
}

#[derive(Args)]
pub(super) struct DraftArgs {
    /// The URDF
    #[arg(value_name = "FILE.urdf")]
    urdf: PathBuf,
    /// The new file, in the folder of the URDF or above; an existing one is not overwritten [default: robot.ron beside the URDF]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Says what a description holds and lacks.
pub(super) fn check(file: Option<&Path>) -> Result<ExitCode, Failure> {
    let Some(file) = file else {
        let survey = survey(&Description::baxter().map_err(Failure::input)?)?;
        return print(&survey, "robot.ron", "baxter.urdf").map(|()| ExitCode::SUCCESS);
    };
    let name = file.display().to_string();
    let refusal = match describe(file) {
        Ok(robot) => {
            let source = robot.source.as_ref();
            let urdf = source.map_or_else(|| name.clone(), |it| it.path.display().to_string());
            print(&survey(&robot)?, &name, &urdf)?;
            require_body(robot).map_err(|error| Failure::input(format!("{name}: {error}")))?;
            Output::tell("it can be driven\n")?;
            return Ok(ExitCode::SUCCESS);
        }
        Err(refusal) => refusal,
    };
    let Some(robot) = first_robot(file) else {
        return Err(refusal);
    };
    print(&survey(&robot)?, "robot.ron", &name)?;
    say(format_args!(
        "{name}: it has no robot.ron and other joints than Baxter, so it cannot be driven yet: `tabletop robot new {name}` writes a first one, as shown above"
    ));
    Ok(ExitCode::from(WRONG_INPUT))
}

/// Makes sure that a robot has the body with which it imitates.
fn require_body(robot: Description) -> Result<(), ModelError> {
    let plugin = RobotPlugin {
        description: Some(robot),
        ..RobotPlugin::default()
    };
    robot_body(&plugin, &Table::default()).map(drop)
}

/// The robot of a bare URDF with the `robot.ron` that would be written first; `None` if it is none, or none can be written.
fn first_robot(file: &Path) -> Option<Description> {
    if file.extension().is_some_and(|extension| extension == "ron") {
        return None;
    }
    let source = bare(file, read_text(file).ok()?);
    let layout = Some(draft(&source, "robot.urdf").ok()?);
    Description::read(DescriptionSource { layout, ..source }).ok()
}

fn bare(file: &Path, urdf: String) -> DescriptionSource {
    DescriptionSource {
        path: true_path(file),
        urdf,
        layout: None,
        reach: None,
    }
}

fn survey(robot: &Description) -> Result<Survey, Failure> {
    robot.survey().map_err(Failure::input)
}

/// Prints what a description holds, and then each shortcoming with its file and line.
fn print(survey: &Survey, layout: &str, urdf: &str) -> Result<(), Failure> {
    let mut text = survey.to_string();
    for shortcoming in &survey.shortcomings {
        let file = match shortcoming.is_in_layout {
            true => layout,
            false => urdf,
        };
        text += &format!("{file}: line {}: {}\n", shortcoming.line, shortcoming.text);
    }
    Output::tell(&text)
}

/// Writes a first `robot.ron`.
pub(super) fn write_first(args: &DraftArgs) -> Result<ExitCode, Failure> {
    let DraftArgs { urdf, out } = args;
    let text =
        read_text(urdf).map_err(|error| Failure::input(format!("{}: {error}", urdf.display())))?;
    let out = out
        .clone()
        .unwrap_or_else(|| urdf.with_file_name("robot.ron"));
    let inside = seen_from(&out, urdf)?;
    let layout = draft(&bare(urdf, text), &inside)
        .map_err(|error| Failure::input(format!("{}: {error}", urdf.display())))?;
    let written = Storage::default().write_new(&out, layout.as_bytes());
    written.map_err(|error| match error.kind() == ErrorKind::AlreadyExists {
        true => Failure::input(format!(
            "{}: it exists already, and is not overwritten: name another file with --out",
            out.display()
        )),
        false => Failure::at(&out, error),
    })?;
    let line = format!(
        "{}: written; its comments ask what the URDF does not say\n",
        out.display()
    );
    Output::tell(&line)?;
    Ok(ExitCode::SUCCESS)
}

/// The URDF as a `robot.ron` at this place names it, with slashes.
fn seen_from(layout: &Path, urdf: &Path) -> Result<String, Failure> {
    let whole = |path: &Path| fs::canonicalize(path).map_err(|error| Failure::at(path, error));
    let folder = match parent_of(layout) {
        parent if parent == Path::new("") => Path::new("."),
        parent => parent,
    };
    let (folder, whole_urdf) = (whole(folder)?, whole(urdf)?);
    let inside = whole_urdf.strip_prefix(&folder).map_err(|_| {
        Failure::input(format!(
            "{}: the URDF {} is not in its folder or below: write it beside the URDF",
            layout.display(),
            urdf.display()
        ))
    })?;
    let parts: Option<Vec<_>> = inside.iter().map(|part| part.to_str()).collect();
    let parts = parts
        .ok_or_else(|| Failure::input(format!("{}: its name is no Unicode", urdf.display())))?;
    Ok(parts.join("/"))
}
