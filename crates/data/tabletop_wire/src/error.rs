//! Why there is no answer.

use std::{io, path::PathBuf, time::Duration};

use thiserror::Error;

use crate::{address::PolicyAddress, format_error::FormatError};

/// Why there is no policy, or no answer of one.
#[derive(Debug, Error)]
pub enum WireError {
    /// There is nobody at the address.
    #[error("{address} cannot be reached: {source}; is the policy served there?")]
    Unreachable {
        /// The address.
        address: PolicyAddress,
        /// The system's reason.
        source: io::Error,
    },
    /// What answers does not speak the protocol.
    #[error("what answers at {address} serves no policy: {fault}")]
    Foreign {
        /// The address.
        address: PolicyAddress,
        /// What it did instead.
        fault: String,
    },
    /// Nothing came in time.
    #[error("{address} has not {deed} within {} s", .patience.as_secs_f64())]
    Silent {
        /// The address.
        address: PolicyAddress,
        /// What it should have done.
        deed: &'static str,
        /// How long it was waited for.
        patience: Duration,
    },
    /// The connection has ended.
    #[error("{address} has ended the connection: {reason}")]
    Closed {
        /// The address.
        address: PolicyAddress,
        /// Why, as far as that is known.
        reason: String,
    },
    /// The server says what is wrong with an observation, or with itself.
    #[error("{address} refuses: {reason}")]
    Refused {
        /// The address.
        address: PolicyAddress,
        /// The last line of what it says, which a traceback's reason is.
        reason: String,
    },
    /// A frame that makes no sense.
    #[error("{address} sends nonsense: {fault}")]
    Nonsense {
        /// The address.
        address: PolicyAddress,
        /// Where and what.
        fault: FormatError,
    },
    /// What a recorded policy was never asked.
    #[error("{}: the policy was never asked this, so the run is another one", .path.display())]
    Unrecorded {
        /// The file with its exchanges.
        path: PathBuf,
    },
    /// A file with exchanges cannot be read or written.
    #[error("{}: {source}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}
