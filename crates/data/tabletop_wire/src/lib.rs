//! Policies by wire: openpi's protocol, a client and a server of it, and the mappings of its keys to a robot.
//!
//! A policy is served over a WebSocket. The server first sends its metadata; then each frame with an observation gets one with `actions`. A frame is a map in
//! MessagePack, in which NumPy's arrays are maps of their own; a text in place of an answer is the server's fault. There is no ECS and no simulator here, and
//! whatever comes over the wire is a stranger's: sizes, depths, shapes and times have bounds.
//!
//! ```no_run
//! use tabletop_wire::{ActionChunk, NumpyArray, PolicyClient, WireMap};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut client = PolicyClient::connect(&"ws://gpu:8000".parse()?)?;
//! println!("{:?}", client.metadata());
//! let mut observation = WireMap::new();
//! let angles = NumpyArray::of_floats(&[7], &[0.0; 7]);
//! observation.insert("observation/joint_position".into(), angles.into());
//! observation.insert("prompt".into(), "Put the red block on the blue block.".into());
//! let answer = client.ask(&observation)?;
//! let chunk = ActionChunk::of(&answer, 8, 10)?;
//! println!("{:?}", chunk.rows());
//! # Ok(())
//! # }
//! ```

mod address;
mod array;
mod chunk;
mod client;
mod decode;
mod dtype;
mod encode;
mod error;
mod exchange_file;
mod fit;
mod format_error;
mod mapping;
mod server;
mod stream;
mod value;

pub use address::{PolicyAddress, PolicyAddressError};
pub use array::NumpyArray;
pub use chunk::ActionChunk;
pub use client::{PolicyClient, PolicyPatience};
pub use decode::decode;
pub use dtype::Dtype;
pub use encode::encode;
pub use error::WireError;
pub use exchange_file::{ExchangeFile, RecordedExchanges};
pub use fit::{PictureFit, PixelLayout};
pub use format_error::FormatError;
pub use mapping::{
    ActionColumn, MappedActions, MappedCamera, MappedImage, MappedState, MappingError,
    PolicyMapping, PosePart, RobotNames, ScaledJoint, StateColumn,
};
pub use server::{PolicyServer, Served};
pub use value::{WireMap, WireValue};
