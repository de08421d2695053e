//! Benchmark of cost against size: the cost of a scene by the number of its objects.
//!
//! `cargo bench --bench cost_against_size` times towers of five unit blocks, 10 to 10,000 blocks in all: setting the scene, a
//! tick while all are awake, a tick at rest, a tick with a picture of the head camera, and a tick in which a hand grasps in a
//! recording, which is when the world is copied for undo. It prints the medians and plots them in
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
    app.step(120);
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

/// Location of a point in the plot, in pixels; both axes are logarithmic.
fn place(objects: f64, milliseconds: f64) -> (f64, f64) {
    let x = LEFT + (objects / OBJECTS[0].0).log10() * DECADES.0;
    let least = COSTS[0].0;
    let y = BOTTOM - (milliseconds.max(least) / least).log10() * DECADES.1;
    (x, y)
}

/// Marks of the axes.
const OBJECTS: [(f64, &str); 4] = [
    (10.0, "10"),
    (100.0, "100"),
    (1_000.0, "1,000"),
    (10_000.0, "10,000"),
];
const COSTS: [(f64, &str); 8] = [
    (1e-3, "1 µs"),
    (1e-2, "10 µs"),
    (1e-1, "100 µs"),
    (1.0, "1 ms"),
    (1e1, "10 ms"),
    (1e2, "100 ms"),
    (1e3, "1 s"),
    (1e4, "10 s"),
];

/// Pixels of a decade of objects and of costs.
const DECADES: (f64, f64) = (150.0, 65.0);
const LEFT: f64 = 80.0;
const BOTTOM: f64 = 530.0;

/// Pixels from one name to the next.
const LINE: f64 = 18.0;

fn plot(rows: &[(usize, [Duration; 5])]) -> String {
    let mut svg = String::from(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="720" height="590" font-family="sans-serif" font-size="14" fill="#333333">
<rect width="100%" height="100%" fill="white"/>
<text x="80" y="30" font-size="17">What a scene of towers costs, against the number of its objects</text>
<text x="305" y="575" text-anchor="middle">objects (logarithmic)</text>
<text transform="translate(18 302) rotate(-90)" text-anchor="middle">time (logarithmic)</text>
"##,
    );
    let (right, top) = place(OBJECTS[3].0, COSTS[7].0);
    for (objects, label) in OBJECTS {
        let (x, _) = place(objects, 1.0);
        let _ = writeln!(
            svg,
            r##"<path d="M{x} {top}V{BOTTOM}" stroke="#dddddd"/><text x="{x}" y="551" text-anchor="middle">{label}</text>"##
        );
    }
    for (cost, label) in COSTS {
        let (_, y) = place(1.0, cost);
        let _ = writeln!(
            svg,
            r##"<path d="M{LEFT} {y}H{right}" stroke="#dddddd"/><text x="74" y="{:.1}" text-anchor="end">{label}</text>"##,
            y + 5.0
        );
    }
    for (series, label) in labels(rows).into_iter().enumerate() {
        let (name, color) = SERIES[series];
        let points = rows
            .iter()
            .map(|(size, costs)| place(*size as f64, milliseconds(costs[series])));
        let points: Vec<_> = points.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            svg,
            r#"<polyline points="{}" fill="none" stroke="{color}" stroke-width="2"/><text x="{:.1}" y="{label:.1}" fill="{color}">{name}</text>"#,
            points.join(" "),
            right + 10.0
        );
    }
    svg + "</svg>\n"
}

/// Height of the name of each series: beside its last point, and not over another name.
fn labels(rows: &[(usize, [Duration; 5])]) -> [f64; 5] {
    let last = rows.last().unwrap().1;
    let mut heights = last.map(|cost| place(1.0, milliseconds(cost)).1 + 5.0);
    let mut order: Vec<_> = (0..heights.len()).collect();
    order.sort_by(|&a, &b| heights[a].total_cmp(&heights[b]));
    for pair in order.windows(2) {
        heights[pair[1]] = heights[pair[1]].max(heights[pair[0]] + LINE);
    }
    heights
}
