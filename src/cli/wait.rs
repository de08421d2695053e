//! Other programs that write to the same place.

use clap::Args;

use crate::storage::{Patience, Storage};

use super::terminal::say;

#[derive(Args)]
pub(super) struct WaitOption {
    /// Refuse at once where another program writes, instead of waiting for its end
    #[arg(long)]
    no_wait: bool,
}

impl WaitOption {
    /// The file system, of which places are waited for or not.
    pub fn storage(&self) -> Storage {
        Storage::default().with_patience(match self.no_wait {
            true => Patience::None,
            false => Patience::Wait(|news| say(format_args!("tabletop: {news}"))),
        })
    }
}
