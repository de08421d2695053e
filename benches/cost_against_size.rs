//! What a scene costs, against the number of its objects.
//!
//! `cargo bench --bench cost_against_size` times towers of five unit blocks, 10 to 10,000 blocks in all: setting the scene, a
//! tick while all are awake, a tick at rest, a tick with a picture of the head camera, and a tick in which a hand grasps in a
//! recording, which is when the world is copied for undo. It prints the medians and draws them in
//! `cost_against_size.svg` in Cargo's folder for temporary files.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]
#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::{
    fmt::Write as _,
    fs,
    path::Path,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop::{
    core::PictureDemand,
    headless_app_with,
    physics::{PhysicsPlugin, PhysicsSettings},
    prelude::*,
    recorder::RecorderPlugin,
};

const SIZES: [usize; 7] = [10, 30, 100, 300, 1_000, 3_000, 10_000];
const SERIES: [(&str, &str); 5] = [
    ("scene set", "#888888"),
    ("tick, awake", "#cc3311"),
    ("tick, at rest", "#0077bb"),
    ("tick with a picture", "#009988"),
    ("tick with a grasp", "#ee7733"),
];

fn main() {
    let rows: Vec<_> = SIZES.map(|size| (size, costs(size))).into();
    let names = SERIES.map(|(name, _)| name);
    println!("objects  {} (ms)", names.join("  "));
    for (size, costs) in &rows {
        let numbers = costs.map(|cost| format!("{:12.3}", milliseconds(cost)));
        println!("{size:7}  {}", numbers.join("  "));
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cost_against_size.svg");
    fs::write(&path, plot(&rows)).unwrap();
    println!("{}", path.display());
}

/// The time that each of [`SERIES`] takes.
fn costs(size: usize) -> [Duration; 5] {
    let awake = PhysicsSettings {
        sleep: false,
        ..default()
    };
    let mut app = simulator(awake);
    let set = time(|| {
        app.world_mut().write_command(scene(size));
        app.step(1);
    });
    app.step(5);
    let awake = median(|| {
        app.step(1);
    });

    let mut app = simulator(PhysicsSettings::default());
    app.world_mut().write_command(scene(size));
    app.step(60);
    let rest = median(|| {
        app.step(1);
    });
    let picture = median(|| {
        app.world().resource::<PictureDemand>().ask();
        app.step(1);
    });
    app.world_mut().write_command(RecordingCommand::Start);
    app.step(1);
    let mut hands = [Hand::Left, Hand::Right].into_iter().cycle();
    let grasp = median(|| {
        if let Some(hand) = hands.next() {
            let object = "block4".to_owned();
            app.world_mut()
                .write_command(HandCommand::Grasp { hand, object });
        }
        app.step(1);
    });
    [set, awake, rest, picture, grasp]
}

fn simulator(settings: PhysicsSettings) -> App {
    let recorder = RecorderPlugin {
        folder: Path::new(env!("CARGO_TARGET_TMPDIR")).join("cost_against_size"),
        ..default()
    };
    let _not_there = fs::remove_dir_all(&recorder.folder);
    let plugins = TabletopSimPlugins.build().set(recorder);
    headless_app_with(plugins.set(PhysicsPlugin { settings }))
}

/// Towers of five on a table that is large enough.
fn scene(size: usize) -> SimCommand {
    let rows = (size.div_ceil(5) as f32).sqrt().ceil();
    let span = 2.0 * rows + 2.0;
    let items = (0..size).map(|block| {
        let (tower, storey) = (block / 5, block % 5);
        let place = Vec2::new((tower as f32 / rows).floor(), tower as f32 % rows);
        let location = (2.0 * place + 1.0 - rows).extend(storey as f32 + 0.5);
        let shape = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        };
        let id = format!("block{block}");
        SceneItem::Object(ObjectSpec::new(id, Pose::at(location), 1.0, shape))
    });
    SimCommand::Scene(SceneCommand::Set(Box::new(SceneSpec {
        table: Table {
            xspan: span,
            yspan: span,
        },
        items: items.collect(),
    })))
}

fn time(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

fn median(mut work: impl FnMut()) -> Duration {
    let mut times: Vec<_> = (0..15).map(|_| time(&mut work)).collect();
    times.sort();
    times[times.len() / 2]
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// The costs, both axes logarithmic.
fn plot(rows: &[(usize, [Duration; 5])]) -> String {
    const DECADE: f64 = 110.0;
    const LEFT: f64 = 70.0;
    const BOTTOM: f64 = 600.0;
    /// The decimal logarithms of the least number of objects and the least cost in ms that are shown.
    const LEAST: (f64, f64) = (1.0, -2.0);
    let x = |size: f64| LEFT + (size.log10() - LEAST.0) * DECADE;
    let y = |cost: f64| BOTTOM - (cost.log10() - LEAST.1) * DECADE;

    let mut svg = String::from(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="620" height="660" font-family="sans-serif" font-size="13">
<rect width="100%" height="100%" fill="white"/>
"#,
    );
    for decade in 1..=4 {
        let at = x(10f64.powi(decade));
        let number = 10u64.pow(decade as u32);
        let _ = writeln!(
            svg,
            r##"<path d="M{at} 40V{BOTTOM}" stroke="#dddddd"/><text x="{at}" y="620" text-anchor="middle">{number}</text>"##
        );
    }
    for decade in -2..=3 {
        let cost = 10f64.powi(decade);
        let at = y(cost);
        let _ = writeln!(
            svg,
            r##"<path d="M{LEFT} {at}H420" stroke="#dddddd"/><text x="62" y="{at}" text-anchor="end">{cost}</text>"##
        );
    }
    let _ = writeln!(
        svg,
        r#"<text x="235" y="645" text-anchor="middle">objects</text><text x="62" y="25" text-anchor="end">ms</text>"#
    );
    for (series, (name, color)) in SERIES.iter().enumerate() {
        let points = rows.iter().map(|(size, costs)| {
            let cost = milliseconds(costs[series]).max(0.01);
            format!("{:.1},{:.1}", x(*size as f64), y(cost))
        });
        let points: Vec<_> = points.collect();
        let label = 60 + 22 * series;
        let _ = writeln!(
            svg,
            r#"<polyline points="{}" fill="none" stroke="{color}" stroke-width="2"/><text x="440" y="{label}" fill="{color}">{name}</text>"#,
            points.join(" ")
        );
    }
    svg + "</svg>\n"
}
