//! What is told of the script while it runs.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::AgentNews;
use tabletop_engine::{EngineHandle, Stream};

use crate::ScriptSettings;

/// Where news of the script go.
#[derive(SystemParam)]
pub(crate) struct News<'w> {
    messages: MessageWriter<'w, AgentNews>,
    settings: Res<'w, ScriptSettings>,
}

impl News<'_> {
    pub fn tell(&mut self, news: AgentNews) {
        if let Some(overhear) = self.settings.overhear {
            overhear(&news);
        }
        self.messages.write(news);
    }

    /// Tells what the engine has printed since the last time.
    pub fn print(&mut self, engine: &EngineHandle) {
        for line in engine.drain_console() {
            self.tell(match line.stream {
                Stream::Note => AgentNews::Noted { line: line.text },
                Stream::Out | Stream::Error => AgentNews::Printed {
                    line: line.text,
                    is_error: line.stream == Stream::Error,
                },
            });
        }
    }

    /// Tells what the user should know.
    pub fn note(&mut self, line: &str) {
        self.tell(AgentNews::Noted {
            line: line.to_owned(),
        });
    }
}
