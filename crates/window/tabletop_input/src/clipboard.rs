//! The clipboard of the desktop.

use std::{
    sync::{Arc, Mutex, PoisonError},
    thread,
};

use bevy::prelude::*;

/// Reads the clipboard, and puts texts there, in the background: the desktop may take its time, and asks for the text whenever it
/// is pasted.
#[derive(Resource, Clone, Debug, Default)]
pub struct Clipboard {
    problem: Arc<Mutex<Option<String>>>,
}

impl Clipboard {
    /// Puts a text there.
    pub fn copy(&self, text: String) {
        self.copy_by(text, keep_on_clipboard);
    }

    /// The text there, if there is one.
    pub fn paste(&self) -> Option<String> {
        let text = arboard::Clipboard::new().and_then(|mut clipboard| clipboard.get_text());
        match text {
            Ok(text) => Some(text),
            Err(arboard::Error::ContentNotAvailable) => None,
            Err(error) => {
                self.note(format!("nothing was pasted: {error}"));
                None
            }
        }
    }

    fn copy_by(
        &self,
        text: String,
        keep: impl FnOnce(String) -> Result<(), String> + Send + 'static,
    ) {
        let clipboard = self.clone();
        let work = move || {
            if let Err(problem) = keep(text) {
                clipboard.note(format!("nothing was copied: {problem}"));
            }
        };
        let thread = thread::Builder::new().name("clipboard".into());
        if let Err(error) = thread.spawn(work) {
            self.note(format!("nothing was copied: {error}"));
        }
    }

    /// The reason why a text could not be put or read there, reported once.
    pub fn take_problem(&self) -> Option<String> {
        self.problem().take()
    }

    fn note(&self, problem: String) {
        *self.problem() = Some(problem);
    }

    fn problem(&self) -> impl std::ops::DerefMut<Target = Option<String>> {
        self.problem.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Offers a text until something else is copied.
fn keep_on_clipboard(text: String) -> Result<(), String> {
    let keep = || {
        let mut clipboard = arboard::Clipboard::new()?;
        #[cfg(target_os = "linux")]
        {
            use arboard::SetExtLinux as _;
            clipboard.set().wait().text(text)
        }
        #[cfg(not(target_os = "linux"))]
        clipboard.set_text(text)
    };
    keep().map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    #[test]
    fn a_failed_copy_is_reported_once() {
        let clipboard = Clipboard::default();
        let (sender, receiver) = mpsc::channel();
        clipboard.copy_by("text".into(), move |text| {
            sender.send(text).unwrap_or_default();
            Err("there is none".into())
        });
        assert_eq!(receiver.recv(), Ok("text".into()));
        let problem = (0..1000).find_map(|_| {
            thread::sleep(std::time::Duration::from_millis(1));
            clipboard.take_problem()
        });
        assert_eq!(
            problem.as_deref(),
            Some("nothing was copied: there is none")
        );
        assert_eq!(clipboard.take_problem(), None);
    }
}
