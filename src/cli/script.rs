//! The script beside a simulation without a window.

use crate::{
    core::{ScriptCommand, ScriptEvent, StepApp as _},
    real::RealRobot,
    script::{ScriptSettings, shut_down},
};
use bevy::{ecs::message::MessageCursor, prelude::*};

use super::{
    Failure,
    duration::pass,
    real,
    robot_options::EngineOptions,
    terminal::{is_unheard, say},
};

/// The settings of the script bridge, if the requested script exists. Events of the script are printed.
pub(super) fn headless_settings(
    options: &EngineOptions,
    script: Option<&str>,
) -> Result<ScriptSettings, Failure> {
    let mut settings = options.settings(script)?;
    settings.on_event = Some(report);
    Ok(settings)
}

/// The script that drives the robot, if one was asked for.
pub(super) struct Script {
    is_wanted: bool,
    events: MessageCursor<ScriptEvent>,
    /// Its end, if it has ended.
    end: Option<Result<(), Failure>>,
}

impl Script {
    pub fn start(app: &mut App, is_wanted: bool) -> Self {
        if is_wanted {
            app.world_mut().write_message(ScriptCommand::Start);
        }
        Self {
            is_wanted,
            events: MessageCursor::default(),
            end: None,
        }
    }

    /// Notes its end. The run ends if nobody reads its output any more.
    pub fn listen(&mut self, app: &App) -> Result<(), Failure> {
        for event in self
            .events
            .read(app.world().resource::<Messages<ScriptEvent>>())
        {
            match event {
                ScriptEvent::Stopped => self.end = Some(Ok(())),
                ScriptEvent::Failed { .. } => self.end = Some(Err(Failure::silent())),
                ScriptEvent::Started { .. }
                | ScriptEvent::Printed { .. }
                | ScriptEvent::Noted { .. } => {}
            }
        }
        real::check(app)?;
        match is_unheard() {
            true => Err(Failure::silent()),
            false => Ok(()),
        }
    }

    /// Simulates this many ticks, or until the script has ended.
    pub fn run(mut self, app: &mut App, ticks: u64) -> Result<(), Failure> {
        if !self.is_wanted {
            if !app.world().contains_resource::<RealRobot>() {
                pass(app, ticks);
                return Ok(());
            }
            return self.run_for(app, ticks);
        }
        // The first tick is that of the init script.
        self.act(app, ticks + 1)
    }

    /// Lets the script act for this many ticks, or until it has ended.
    pub fn act(mut self, app: &mut App, ticks: u64) -> Result<(), Failure> {
        self.run_for(app, ticks)?;
        shut_down(app.world_mut());
        self.result()
    }

    /// Simulates this many ticks, or until the script has ended.
    pub fn run_for(&mut self, app: &mut App, ticks: u64) -> Result<(), Failure> {
        let mut left = 0..ticks;
        self.run_while(app, |_| left.next().is_some())
    }

    /// Simulates while this condition holds, or until the script has ended.
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

    /// True while it acts, or will act.
    pub const fn is_running(&self) -> bool {
        self.is_wanted && self.end.is_none()
    }

    pub fn result(self) -> Result<(), Failure> {
        self.end.unwrap_or(Ok(()))
    }
}

/// Prints an event of the script.
fn report(event: &ScriptEvent) {
    match event {
        ScriptEvent::Started { engine } => say(format_args!("tabletop: {engine}")),
        ScriptEvent::Printed { line, .. } => say(line),
        ScriptEvent::Noted { line } => say(format_args!("tabletop: {line}")),
        ScriptEvent::Failed { reason } => say(format_args!("tabletop: {reason}")),
        ScriptEvent::Stopped => {}
    }
}
