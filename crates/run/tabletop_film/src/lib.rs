//! Recordings on film: the pictures of any camera at any rate, and videos, animations and contact sheets of them.
//!
//! [`Footage`] simulates a recording again and draws what its cameras see, to the bit as it was recorded where camera and size are the same.
//! A [`Film`] is footage in the order and at the pace in which it is shown, with captions from the task's sentences:
//!
//! ```no_run
//! use tabletop_camera::CameraSpec;
//! use tabletop_film::{Film, FilmFormat};
//! use tabletop_replay::Replay;
//!
//! let replay = Replay::read("demo")?;
//! let film = Film { has_captions: true, ..Film::of(CameraSpec::head(640, 480)) };
//! let bytes = film.develop(&replay, FilmFormat::Mp4, |_done, _all| {})?;
//! # Ok::<_, Box<dyn std::error::Error>>(())
//! ```

mod animation;
mod canvas;
mod contact_sheet;
mod error;
mod film;
mod footage;
mod mp4;
mod mp4_reader;
mod pace;
mod video;

pub use canvas::Canvas;
pub use error::FilmError;
pub use film::{Film, FilmFormat};
pub use footage::Footage;
pub use mp4::{Mp4Writer, VideoCoding};
pub use mp4_reader::Mp4Reader;
pub use pace::FilmPace;
pub use video::{VideoEncoder, VideoPacket, VideoTrack};
