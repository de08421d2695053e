//! The script beside a simulation without a window.

use bevy::{ecs::message::MessageCursor, prelude::*};
use tabletop::{
    core::{AgentNews, AgentOrder, StepApp as _},
    script::{ScriptSettings, see_off},
};

use super::{
    Failure,
    robot_options::{EngineOptions, check_scripts},
    run::pass,
    terminal::{is_unheard, say},
};

/// The settings of the script bridge, if the script that is wanted is there. What becomes of it is said.
pub(super) fn headless_settings(
    options: &EngineOptions,
    script: Option<&str>,
) -> Result<ScriptSettings, Failure> {
    let mut settings = options.settings(script)?;
    if script.is_some() {
        check_scripts(&settings)?;
    }
    settings.overhear = Some(report);
    Ok(settings)
}

/// The script that drives the robot, if one was asked for.
pub(super) struct Script {
    is_wanted: bool,
    news: MessageCursor<AgentNews>,
    /// How it has ended, if it has.
    end: Option<Result<(), Failure>>,
}

impl Script {
    pub fn start(app: &mut App, is_wanted: bool) -> Self {
        if is_wanted {
            app.world_mut().write_message(AgentOrder::Start);
        }
        Self {
            is_wanted,
            news: MessageCursor::default(),
            end: None,
        }
    }

    /// Notes its end. The run ends if nobody hears what is said.
    pub fn listen(&mut self, app: &App) -> Result<(), Failure> {
        for news in self
            .news
            .read(app.world().resource::<Messages<AgentNews>>())
        {
            match news {
                AgentNews::Stopped => self.end = Some(Ok(())),
                AgentNews::Failed { .. } => self.end = Some(Err(Failure::silent())),
                AgentNews::Started { .. } | AgentNews::Printed { .. } | AgentNews::Noted { .. } => {
                }
            }
        }
        match is_unheard() {
            true => Err(Failure::silent()),
            false => Ok(()),
        }
    }

    /// Simulates so many ticks, or until the script has ended.
    pub fn run(self, app: &mut App, ticks: u64) -> Result<(), Failure> {
        if !self.is_wanted {
            pass(app, ticks);
            return Ok(());
        }
        // The first tick is that of the init script.
        self.act(app, ticks + 1)
    }

    /// Lets the script act for so many ticks, or until it has ended.
    pub fn act(mut self, app: &mut App, ticks: u64) -> Result<(), Failure> {
        let mut left = 0..ticks;
        self.run_while(app, |_| left.next().is_some())?;
        see_off(app.world_mut());
        self.result()
    }

    /// Simulates as long as this is so, or until the script has ended.
    pub fn run_while(
        &mut self,
        app: &mut App,
        mut is_so: impl FnMut(&App) -> bool,
    ) -> Result<(), Failure> {
        while self.end.is_none() && is_so(app) {
            app.step(1);
            self.listen(app)?;
        }
        Ok(())
    }

    pub fn result(self) -> Result<(), Failure> {
        self.end.unwrap_or(Ok(()))
    }
}

/// Says what becomes of the script when it does.
fn report(news: &AgentNews) {
    match news {
        AgentNews::Started { engine } => say(format_args!("tabletop: {engine}")),
        AgentNews::Printed { line, .. } => say(line),
        AgentNews::Noted { line } => say(format_args!("tabletop: {line}")),
        AgentNews::Failed { reason } => say(format_args!("tabletop: {reason}")),
        AgentNews::Stopped => {}
    }
}
