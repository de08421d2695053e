//! `tabletop init`: a working folder with the files inside the program, for changing them; and what starts the program from a desktop.

mod desktop;

use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    core::ShippedFile,
    shipped::{WORKING_FOLDERS, shipped_files},
    storage::{InnerPath, Storage, Symlinks, parent_of, read_regular_file},
};
use clap::Args;

use super::{Failure, Output, counted::counted, result_file::require_outside};

#[derive(Args)]
pub(super) struct InitArgs {
    /// The folder, which is made if it does not exist; `.` for the current one
    #[arg(value_name = "DIR", required_unless_present = "desktop")]
    folder: Option<PathBuf>,
    /// Also put the program, with its icon, among the desktop's applications, so that it is started from there
    #[arg(long)]
    desktop: bool,
}

/// The thing that exists at the place of a file.
enum Existing {
    Nothing,
    TheSame,
    SomethingElse,
}

pub(super) fn init(args: &InitArgs) -> Result<ExitCode, Failure> {
    if let Some(folder) = &args.folder {
        make_folder(folder)?;
    }
    if args.desktop {
        desktop::install(args.folder.as_deref())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes the missing files, each whole or not at all, unless an existing one differs.
fn make_folder(target: &Path) -> Result<(), Failure> {
    for folder in WORKING_FOLDERS {
        require_outside(&InnerPath::fixed(folder).below(target), &[])?;
    }
    let mut missing = Vec::new();
    let mut differing = Vec::new();
    for folder in WORKING_FOLDERS {
        for file in shipped_files().in_folder(folder) {
            let path = InnerPath::fixed(file.path).below(target);
            match look_at(&path, file)? {
                Existing::Nothing => missing.push((path, file)),
                Existing::TheSame => {}
                Existing::SomethingElse => differing.push(path),
            }
        }
    }
    if !differing.is_empty() {
        let lines = differing
            .iter()
            .map(|path| format!("\n  {}", path.display()));
        return Err(Failure::run(format!(
            "nothing was written, because these files exist and differ:{}",
            lines.collect::<String>()
        )));
    }
    let storage = Storage::default();
    for (path, file) in &missing {
        storage
            .create_folders(parent_of(path))
            .and_then(|()| storage.write_new(path, file.text.as_bytes()))
            .map_err(|error| Failure::at(path, error))?;
    }
    for folder in WORKING_FOLDERS {
        let written = missing.iter().filter(|(_, file)| is_in(folder, file));
        let written = written.count();
        let there = shipped_files().in_folder(folder).count() - written;
        let place = InnerPath::fixed(folder).below(target);
        let line = match (written, there) {
            (written, 0) => {
                format!(
                    "{}: {} written\n",
                    place.display(),
                    counted(written, "file")
                )
            }
            (0, there) => {
                format!(
                    "{}: {} there already\n",
                    place.display(),
                    counted(there, "file")
                )
            }
            (written, there) => format!(
                "{}: {} written, {there} there already\n",
                place.display(),
                counted(written, "file")
            ),
        };
        Output::tell(&line)?;
    }
    Ok(())
}

fn look_at(path: &Path, file: &ShippedFile) -> Result<Existing, Failure> {
    match read_regular_file(path, file.text.len() as u64, Symlinks::Followed) {
        Ok(bytes) if bytes == file.text.as_bytes() => Ok(Existing::TheSame),
        Ok(_) => Ok(Existing::SomethingElse),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Existing::Nothing),
        Err(error) if error.kind() == ErrorKind::FileTooLarge => Ok(Existing::SomethingElse),
        Err(_) if path.exists() && !path.is_file() => Ok(Existing::SomethingElse),
        Err(error) => Err(Failure::at(path, error)),
    }
}

fn is_in(folder: &str, file: &ShippedFile) -> bool {
    Path::new(file.path).starts_with(folder)
}
