//! `tabletop docs`: the documentation, in a browser.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{book::book, storage::Storage};
use clap::Args;
use directories::ProjectDirs;

use super::{
    Failure, Output,
    result_file::{ResultFile, ResultKind},
};

/// The name of the page among what the user's programs keep.
const NAME: &str = "docs.html";

#[derive(Args)]
pub(super) struct DocsArgs {
    /// Write the documentation to this file, such as docs.html, and open nothing
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
}

/// Writes the documentation, and opens it unless a file is named.
pub(super) fn docs(args: &DocsArgs) -> Result<ExitCode, Failure> {
    if let Some(file) = &args.file {
        ResultFile::replacing(file, ResultKind::Book)?.write(book().as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    let folders = ProjectDirs::from("", "", "tabletop").ok_or_else(|| {
        Failure::run("you have no folder for it: name a file, as in `tabletop docs docs.html`")
    })?;
    let (folder, storage) = (folders.cache_dir(), Storage::default());
    storage
        .create_folders(folder)
        .map_err(|error| Failure::at(folder, error))?;
    let file = folder.join(NAME);
    storage
        .replace(&file, book().as_bytes())
        .map_err(|error| Failure::at(&file, error))?;
    let said = match is_opened(&file) {
        true => "it is opened in your browser",
        false => "open it in a browser",
    };
    Output::tell(&format!("{}: {said}\n", file.display()))?;
    Ok(ExitCode::SUCCESS)
}

#[cfg(feature = "window")]
fn is_opened(file: &Path) -> bool {
    open::that_detached(file).is_ok()
}

#[cfg(not(feature = "window"))]
const fn is_opened(_file: &Path) -> bool {
    false
}
