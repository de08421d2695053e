//! The events of a running script.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::ScriptEvent;
use tabletop_engine::{EngineHandle, Stream};

use crate::settings::ScriptSettings;

/// Writes the script's events as messages and passes them to [`ScriptSettings::on_event`].
#[derive(SystemParam)]
pub(crate) struct ScriptEvents<'w> {
    messages: MessageWriter<'w, ScriptEvent>,
    settings: Res<'w, ScriptSettings>,
}

impl ScriptEvents<'_> {
    pub fn write(&mut self, event: ScriptEvent) {
        if let Some(on_event) = self.settings.on_event {
            on_event(&event);
        }
        self.messages.write(event);
    }

    /// Reports the lines that the engine has printed since the last call.
    pub fn print(&mut self, engine: &EngineHandle) {
        for line in engine.drain_console() {
            self.write(match line.stream {
                Stream::Note => ScriptEvent::Noted { line: line.text },
                Stream::Out | Stream::Error => ScriptEvent::Printed {
                    line: line.text,
                    is_error: line.stream == Stream::Error,
                },
            });
        }
    }

    /// Reports a remark of the program about the script.
    pub fn note(&mut self, line: &str) {
        self.write(ScriptEvent::Noted {
            line: line.to_owned(),
        });
    }
}
