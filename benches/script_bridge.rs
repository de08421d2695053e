//! Benchmark of scripts: their cost in a tick without a window, beside their own time. Needs GNU Octave.
//!
//! `cargo bench --bench script_bridge` prints the median and the 99th percentile of the time of a tick of the whole simulator
//! with the default task, without and with the robot at the table: without a script; the same with a picture of the head
//! camera in every tick; with a script that does nothing; and with one that does nothing and gets a fresh picture in every
//! tick. It also prints the differences of the medians from those without a script. All run in turns in one process, so that
//! other loads on the machine affect all of them.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

use std::{
    env,
    error::Error,
    fs,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop::{
    core::{Agent, PictureDemand, ScriptCommand},
    prelude::*,
    script::{EngineChoice, ScriptPlugin, ScriptSettings},
    xml::read_task,
};

const TICKS_PER_TURN: usize = 60;
const TURNS: usize = 30;
const WARM_UP: u64 = 120;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = idle_scripts()?;
    let never = u64::MAX;
    let mut groups = Vec::new();
    for is_shown in [false, true] {
        groups.push([
            Case::new("without a script", is_shown, None)?,
            Case::new("a picture, no script", is_shown, None)?.with_pictures(),
            Case::new("with an idle script", is_shown, Some((&folder, never)))?,
            Case::new("and a picture every tick", is_shown, Some((&folder, 1)))?,
        ]);
    }
    for _ in 0..TURNS {
        groups.iter_mut().flatten().for_each(Case::take_turn);
    }
    for (mut cases, robot) in groups.into_iter().zip(["robot hidden", "robot shown"]) {
        println!("{robot:26}{:>9}{:>9}{:>9}   ms", "p50", "p99", "more");
        let bare = cases[0].percentile(50);
        for case in &mut cases {
            let (median, high) = (case.percentile(50), case.percentile(99));
            println!(
                "{:26}{median:9.3}{high:9.3}{:9.3}",
                case.name,
                median - bare
            );
        }
    }
    fs::remove_dir_all(folder)?;
    Ok(())
}

/// A folder with a pair of scripts that do nothing.
fn idle_scripts() -> Result<PathBuf, Box<dyn Error>> {
    let folder = env::temp_dir().join(format!("tabletop-idle-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let behavior = "function [i, c] = agentBehavior()\ni = @idleInit;\nc = @idleCallback;\nend\n";
    fs::write(folder.join("agentBehavior.m"), behavior)?;
    fs::write(folder.join("idleInit.m"), "")?;
    fs::write(folder.join("idleCallback.m"), "")?;
    Ok(folder)
}

struct Case {
    name: &'static str,
    app: App,
    times: Vec<Duration>,
}

impl Case {
    /// A simulator, and the script's folder with the ticks from picture to picture.
    fn new(
        name: &'static str,
        is_shown: bool,
        script: Option<(&Path, u64)>,
    ) -> Result<Self, Box<dyn Error>> {
        let mut settings = ScriptSettings::default();
        let Ok(octave) = "octave".parse::<EngineChoice>();
        settings.engine = octave;
        if let Some((folder, ticks)) = script {
            settings.agent = Some(folder.to_owned());
            settings.ticks_per_picture = ticks;
        }
        let plugins = TabletopSimPlugins.build().set(ScriptPlugin { settings });
        let mut app = headless_app_with(plugins);
        let scene = read_task(Path::new("tablesetup/default.xml"))?.scene;
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        app.world_mut().write_command(RobotCommand::Show(is_shown));
        if script.is_some() {
            app.world_mut().write_message(ScriptCommand::Start);
        }
        app.step(WARM_UP);
        let agent = app.world().resource::<Agent>();
        if script.is_some() && !matches!(agent, Agent::Online { .. }) {
            return Err(format!("the script does not run: {agent:?}").into());
        }
        Ok(Self {
            name,
            app,
            times: Vec::new(),
        })
    }

    /// Lets the head camera take a picture in every tick, for nobody.
    fn with_pictures(mut self) -> Self {
        let ask = |demand: Res<PictureDemand>| demand.ask();
        self.app.add_systems(FixedFirst, ask);
        self
    }

    fn take_turn(&mut self) {
        // The first tick of a turn finds cold caches.
        self.app.step(1);
        for _ in 0..TICKS_PER_TURN {
            let start = Instant::now();
            self.app.step(1);
            self.times.push(start.elapsed());
        }
    }

    /// The time, in ms, that this percentage of the ticks did not exceed.
    fn percentile(&mut self, percent: usize) -> f64 {
        self.times.sort();
        let place = (self.times.len() - 1) * percent / 100;
        self.times[place].as_secs_f64() * 1e3
    }
}
