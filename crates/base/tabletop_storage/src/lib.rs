//! The user's files and folders: each is read, created, replaced, moved and removed by one rule.
//!
//! Everything that changes the file system goes through a [`Storage`], of which tests let each call fail. No other crate renames or removes.
//! `SECURITY.md` lists the places and their rules.
//!
//! - A file is [replaced](Storage::replace) whole, or stays as it was.
//! - A folder appears whole: it is filled as a [`LockedFolder`] under a hidden name.
//! - A file in the folder of a stranger is an [`InnerFile`]: its path cannot leave the folder, and no link leads to it.
//! - A folder that is in the way is [moved aside](Storage::move_aside) to a free name.
//! - One program at a time writes to a place: it has its [`WriterLock`].
//! - Files that a killed program has left are removed only if a lock shows that they were the program's own.

mod calls;
mod fault;
mod inner_file;
mod inner_path;
mod locked_folder;
mod path;
mod patience;
mod regular_file;
mod storage;
mod stored_file;
mod temporary_folder;
mod whole_file;
mod writer_lock;

pub use fault::{CallFailure, Fate, StorageFault};
pub use inner_file::{InnerFile, require_no_links};
pub use inner_path::{InnerPath, StrayPath};
pub use locked_folder::LockedFolder;
pub use path::{canonical, is_taken, parent_of, require_folder};
pub use patience::Patience;
pub use regular_file::{
    Symlinks, open_regular_file, read_regular_file, read_regular_text, require_regular_file,
};
pub use storage::Storage;
pub use stored_file::StoredFile;
pub use temporary_folder::TemporaryFolder;
pub use writer_lock::{WriterLock, WritingProgram};
