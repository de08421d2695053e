//! `tabletop robot calibrate`: where the head camera is, by the edges of the table in its picture.

use std::{path::PathBuf, process::ExitCode};

use crate::{
    camera::Camera,
    core::{HeadCamera, Table},
    recorder::read_picture,
    shipped::read_faultless_task,
    storage::InnerFile,
    vision::calibrated,
};
use clap::Args;
use serde_json::json;

use crate::cli::{Failure, Output, allowed_paths::AllowedPaths, head_camera::taking};

#[derive(Args)]
pub(in crate::cli) struct CalibrateArgs {
    /// A picture of the head camera that shows edges of the table, as PNG
    #[arg(value_name = "PICTURE")]
    picture: PathBuf,
    /// The task file whose table is in it [default: 20 x 12 units]
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
}

/// Prints the camera's pose in the table's frame, in units, and how far it is from where it is thought to be.
pub(super) fn calibrate(args: &CalibrateArgs) -> Result<ExitCode, Failure> {
    let table = match &args.setup {
        Some(setup) => {
            let scene = read_faultless_task(setup, &args.allowed.folders);
            scene.map_err(Failure::input)?.table
        }
        None => Table::default(),
    };
    let picture = InnerFile::at(&args.picture)
        .map_err(|error| Failure::input(format!("{}: {error}", args.picture.display())))?;
    let picture = read_picture(&picture).map_err(Failure::input)?;
    let head = taking(&HeadCamera::default(), &picture);
    let thought = Camera::of_head(&head, &table);
    let found = calibrated(&picture, &thought, &table);
    let turn = found.pose.rotation * thought.pose.rotation.inverse();
    let answer = json!({
        "location": found.pose.location.to_array(),
        "quaternion_xyzw": found.pose.rotation.to_array(),
        "off": {
            "units": found.pose.location.distance(thought.pose.location),
            "degrees": turn.to_scaled_axis().length().to_degrees(),
        },
    });
    Output::Stdout.write(format!("{answer}\n").as_bytes())?;
    Ok(ExitCode::SUCCESS)
}
