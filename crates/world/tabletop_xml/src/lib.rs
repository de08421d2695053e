//! Task files: the table and its objects as XML (report section 6.2).
//!
//! [`parse()`] reads a file, [`write()`] writes one, and [`XmlPlugin`] loads files into the simulation. Reading never fails:
//! every [`Fault`] is reported with its place, only faulty elements are skipped, and there is always a table.
//! `docs/task-files.md` describes the language, `tablesetup/tabletop.xsd` is its schema.
//!
//! ```
//! use std::path::Path;
//! use tabletop_core::prelude::*;
//!
//! let text = br#"<?xml version="1.0" encoding="UTF-8"?>
//! <tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml" xspan="20" yspan="12">
//!   <block id="GreenBlock" xspan="2" yspan="2" zspan="2" location="(-2,0,1)" rotation="(0,0,45)" color="green"/>
//!   <chain color="magenta" start="(6,-2,4)" end="(-6,-2,4)" linkCount="12"/>
//! </tabletop>"#;
//! let task = tabletop_xml::parse(Path::new("task.xml"), text);
//! assert!(task.faults.is_empty());
//! let [SceneItem::Object(block), SceneItem::Chain(chain)] = task.scene.items.as_slice() else {
//!     panic!("a block and a chain were written");
//! };
//! assert_eq!(block.id, "GreenBlock");
//! assert_eq!(chain.links(), 12);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod document;
mod elements;
mod expansion;
mod fault;
mod files;
mod origin;
mod parse;
mod plugin;
mod reader;
mod write;

#[cfg(test)]
mod test_support;

pub use fault::{Fault, MAX_FAULTS, Position};
pub use files::MAX_FILE_BYTES;
pub use parse::{ExpandedTask, ParsedTask, expand, is_task, parse};
pub use plugin::{AllowedFolders, XmlPlugin};
pub use reader::{ReadError, TaskReader, read_task};
pub use write::write;

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Fault, ParsedTask, TaskReader, XmlPlugin, parse, read_task, write};
}

/// The XML namespace of task files.
pub const NAMESPACE: &str = "http://synapse.cs.umd.edu/tabletop-xml";
