//! `tabletop serve-policy`: a policy for others, by openpi's protocol.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    policy::{OraclePolicy, ServedPolicy},
    wire::PolicyServer,
};
use clap::Args;

use super::{Failure, Output, acting_policy::read_file, range::NumberRange};

const PORTS: NumberRange<u16> = NumberRange::whole(0, u16::MAX);

#[derive(Args)]
pub(super) struct ServePolicyArgs {
    /// The policy's file: one that `tabletop learn` has made, or an ONNX file (docs/learning.md)
    #[arg(value_name = "FILE", required_unless_present = "oracle")]
    policy: Option<PathBuf>,
    /// Serve the planner of task programs itself: it is told the sentences of the task and where everything is, and says what is to be put where
    #[arg(long, conflicts_with = "policy")]
    oracle: bool,
    /// The port, from 0 to 65535; 0 is any that is free
    #[arg(long, value_name = "N", default_value_t = 8000, value_parser = PORTS, allow_negative_numbers = true)]
    port: u16,
    /// The address of this machine at which others reach it: 0.0.0.0 for all of them [default: 127.0.0.1, for this machine alone]
    #[arg(
        long,
        value_name = "IP",
        default_value = "127.0.0.1",
        hide_default_value = true
    )]
    host: String,
}

/// Serves the policy until the program is ended.
pub(super) fn run(args: &ServePolicyArgs) -> Result<ExitCode, Failure> {
    let policy = args.policy.as_deref().map(read_file).transpose()?;
    let failure = |error| Failure::run(format!("{}:{}: {error}", args.host, args.port));
    let server = PolicyServer::bind(&args.host, args.port).map_err(failure)?;
    let address = server.address().map_err(failure)?;
    let name = args.policy.as_deref().unwrap_or(Path::new("The oracle"));
    let name = name.display();
    Output::tell(&format!("{name} is served at ws://{address}\n"))?;
    Err(failure(match policy {
        Some(policy) => server.serve(&ServedPolicy(policy)),
        None => server.serve(&OraclePolicy),
    }))
}
