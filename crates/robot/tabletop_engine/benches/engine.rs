//! Benchmark of a callback's call, beside the script's own time.

#![expect(clippy::print_stdout, reason = "a benchmark reports")]

use std::{
    env, fs,
    time::{Duration, Instant},
};

use tabletop_engine::{
    Aux, EngineChoice, EngineConfig, EngineError, EngineHandle, EngineKind, EngineLocator,
    JointMatrix, Reply, RgbImage, Sensor, Trigger,
};

const CALLS: usize = 600;
const WARM_UP: usize = 50;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = env::temp_dir().join(format!("tabletop-bench-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("benchInit.m"), "")?;
    fs::write(
        folder.join("benchCallback.m"),
        "motor.jointVelocities(1, 1) = sensor.timeElapsed;\n",
    )?;
    fs::write(
        folder.join("agent.py"),
        "def init(aux):\n    pass\n\ndef callback(sensor, motor, aux):\n    motor.jointVelocities[0][0] = sensor.timeElapsed\n",
    )?;
    println!("{:<34}{:>9}{:>9}{:>9}   ms", "", "p50", "p99", "max");
    for (kind, trigger) in [
        (EngineKind::Octave, Trigger::Stdin),
        (EngineKind::Octave, Trigger::Poll),
        (EngineKind::Python, Trigger::Stdin),
    ] {
        let mut config =
            EngineConfig::new(EngineLocator::system().find(&EngineChoice::Kind(kind))?);
        config.trigger = trigger;
        if kind == EngineKind::Python {
            config.agent = folder.join("agent.py");
        } else {
            config.agent = folder.clone();
            config.pair = Some(["benchInit".into(), "benchCallback".into()]);
        }
        let engine = EngineHandle::start(config)?;
        engine.init(Aux {
            min_joint_angles: JointMatrix::zeros([2, 7]),
            max_joint_angles: JointMatrix::zeros([2, 7]),
        });
        answer(&engine)?;
        answer(&engine)?;
        let bare = Sensor {
            time_elapsed: 1.0 / 60.0,
            ..Sensor::at_rest([2, 7])
        };
        let pixels = (0..90_000u32).map(|place| place as u8).collect();
        let picture = Sensor {
            picture: RgbImage::new(200, 150, pixels),
            ..bare.clone()
        };
        let names = [
            "l-S1", "l-E1", "l-W1", "r-S1", "r-E1", "r-W1", "lg-ln", "rg-rf",
        ];
        let points = names.map(|name| (name.to_owned(), [1.0, 2.0, 3.0]));
        let trackers = Sensor {
            tracker_loc: Some(points.into()),
            ..bare.clone()
        };
        for (what, sensor) in [
            ("state", bare),
            ("200x150 picture", picture),
            ("8 trackers", trackers),
        ] {
            report(&format!("{kind}, {trigger:?}, {what}"), &engine, &sensor)?;
        }
    }
    fs::remove_dir_all(folder)?;
    Ok(())
}

fn report(what: &str, engine: &EngineHandle, sensor: &Sensor) -> Result<(), EngineError> {
    let mut times = Vec::new();
    for _ in 0..WARM_UP + CALLS {
        let sensor = sensor.clone();
        let start = Instant::now();
        engine.step(sensor);
        answer(engine)?;
        times.push(start.elapsed());
    }
    let mut times = times.split_off(WARM_UP);
    times.sort();
    let at = |part: f64| {
        times
            .get((times.len() as f64 * part) as usize)
            .copied()
            .unwrap_or_default()
            .as_secs_f64()
            * 1e3
    };
    let worst = times.last().copied().unwrap_or_default().as_secs_f64() * 1e3;
    println!("{what:<34}{:>9.2}{:>9.2}{worst:>9.2}", at(0.5), at(0.99));
    Ok(())
}

fn answer(engine: &EngineHandle) -> Result<(), EngineError> {
    match engine.recv_timeout(Duration::from_secs(60)) {
        Some(Reply::Failed(error)) => Err(error),
        Some(_) => Ok(()),
        None => Err(EngineError::Stopped),
    }
}
