//! Reasons why no window can be opened, and remedies.

use std::{
    any::Any,
    panic::{self, AssertUnwindSafe},
};

use thiserror::Error;

/// The reason why no window can be opened.
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
         libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0)"
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
    /// Bevy reports a missing display or driver only in the texts of its panics.
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

/// Runs code that may panic because there can be no window.
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
    text.split(|c: char| c.is_whitespace() || "/\"'(),:".contains(c))
        .find(|word| word.starts_with("lib") && word.contains(".so"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bevy's messages with winit 0.30 and wgpu 29.
    const NO_DISPLAY: &str = r#"Failed to build event loop: Os(OsError { line: 765, file: "/src/platform_impl/linux/mod.rs", error: Misc("neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set.") })"#;
    const DEAD_DISPLAY: &str = r#"Failed to build event loop: Os(OsError { line: 788, file: "/src/platform_impl/linux/mod.rs", error: XNotSupported(XOpenDisplayFailed) })"#;
    const NO_LIBRARY: &str = r#"Failed to build event loop: Os(OsError { line: 788, file: "/src/platform_impl/linux/mod.rs", error: XNotSupported(LibraryOpenError(OpenError { kind: Library, detail: "opening library failed (/lib/x86_64-linux-gnu/libXi.so.6: file too short)" })) })"#;
    const NO_KEYBOARD_LIBRARY: &str = "Library libxkbcommon-x11.so could not be loaded.";
    const NO_DRIVER: &str = "Unable to find a GPU! Make sure you have installed required drivers! For extra information, see: https://github.com/bevyengine/bevy";

    #[test]
    fn a_panic_names_the_missing_part() {
        let library = |name: &str| NoWindow::Library(name.into());
        for (message, expected) in [
            (NO_DISPLAY, NoWindow::Display),
            (DEAD_DISPLAY, NoWindow::Display),
            (NO_LIBRARY, library("libXi.so.6")),
            (NO_KEYBOARD_LIBRARY, library("libxkbcommon-x11.so")),
            (NO_DRIVER, NoWindow::Graphics),
            ("odd\nthing", NoWindow::Other("odd".into())),
        ] {
            let reason = NoWindow::from_panic(message);
            assert_eq!(reason, expected);
            assert!(!reason.to_string().contains('\n'), "{reason}");
        }
    }

    #[test]
    fn work_that_panics_is_a_reason_and_other_work_is_done() {
        assert_eq!(catch(|| 3), Ok(3));
        assert_eq!(
            catch(|| panic!("{NO_DRIVER}")),
            Err::<(), _>(NoWindow::Graphics)
        );
    }
}
