//! Why no window can be opened, and what to do about it.

use std::{
    any::Any,
    panic::{self, AssertUnwindSafe},
};

use thiserror::Error;

/// What a window needs and did not find.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NoWindow {
    /// No X server answers.
    #[error(
        "no window: there is no display (DISPLAY names none that answers); start the program in a graphical session, \
         or install one that needs no screen (Debian, Ubuntu: apt install xvfb) and start it with xvfb-run"
    )]
    Display,
    /// A library that windows need is not installed.
    #[error(
        "no window: a library of the X window system is missing ({0}); install it (Debian, Ubuntu: apt install \
         libx11-xcb1 libxcursor1 libxi6 libxrandr2 libxkbcommon-x11-0)"
    )]
    Library(String),
    /// No graphics driver is installed, neither for a graphics card nor one that draws on the processor.
    #[error(
        "no window: there is no graphics driver; install one (Debian, Ubuntu: apt install mesa-vulkan-drivers)"
    )]
    Graphics,
    /// Something else.
    #[error("no window: {0}")]
    Other(String),
}

impl NoWindow {
    /// Bevy reports what is missing only in the texts of its panics.
    fn from_panic(message: &str) -> Self {
        if message.contains("Unable to find a GPU") {
            Self::Graphics
        } else if let Some(library) = library_in(message) {
            Self::Library(library.to_owned())
        } else if message.contains("event loop") {
            Self::Display
        } else {
            Self::Other(message.lines().next().unwrap_or_default().to_owned())
        }
    }
}

/// Does some work that may find out by a panic that there can be no window.
pub(super) fn catch<T>(work: impl FnOnce() -> T) -> Result<T, NoWindow> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    panic::set_hook(hook);
    result.map_err(|payload| NoWindow::from_panic(message_of(&*payload)))
}

fn message_of(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| payload.downcast_ref::<&str>().copied())
        .unwrap_or("unknown reason")
}

/// The first shared library that a text names.
fn library_in(text: &str) -> Option<&str> {
    text.split(|c: char| c.is_whitespace() || "\"'(),:".contains(c))
        .find(|word| word.starts_with("lib") && word.contains(".so"))
}
