//! Benchmark of reading a task with 10,000 instances: `cargo bench -p tabletop_xml`.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

use std::{fmt::Write as _, path::Path, time::Instant};

use tabletop_xml::{NAMESPACE, parse};

const INSTANCES: usize = 10_000;

fn main() {
    let mut text = format!(
        "<tabletop xmlns='{NAMESPACE}'><def name='cube'><var name='side' value='1'/><var name='half' value='$side/2$'/>\
         <block id='cube$n$' location='($x$,$y$,$half$)' xspan='$side$' yspan='$side$' zspan='$side$'/></def>"
    );
    for n in 0..INSTANCES {
        let (x, y) = (n % 100 * 2, n / 100 * 2);
        let _written = write!(
            text,
            "<instance def='cube'><var name='n' value='{n}'/><var name='x' value='{x}'/><var name='y' value='{y}'/></instance>"
        );
    }
    text += "</tabletop>";
    let mut times: Vec<_> = (0..9)
        .map(|_| {
            let start = Instant::now();
            let task = parse(Path::new("bench.xml"), text.as_bytes());
            assert_eq!((task.scene.items.len(), task.faults.len()), (INSTANCES, 0));
            start.elapsed()
        })
        .collect();
    times.sort();
    println!(
        "{INSTANCES} instances: {:.1} ms",
        times[times.len() / 2].as_secs_f64() * 1e3
    );
}
