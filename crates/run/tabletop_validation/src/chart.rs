//! A chart of errors against limits, as SVG.

use std::fmt::Write as _;

use crate::{measurement::Measurement, table::Peer};

/// Width of the names and of the bars, and height of a row, in pixels.
const NAMES: f64 = 330.0;
const BARS: f64 = 560.0;
const ROW: f64 = 15.0;
/// Height of the axis.
const AXIS: f64 = 34.0;

/// The powers of ten of an error as a multiple of its limit, from the left to the right.
const DECADES: [f64; 2] = [-3.0, 3.0];

const STYLE: &str = "text{font:11px sans-serif;fill:#333}.grid{stroke:#ddd}.limit{stroke:#333}.held{fill:#3ca951}.short{fill:#ff725c}.peer{fill:#4269d0}";

/// The errors as multiples of their limits, on a logarithmic scale: what goes beyond the line falls short. A peer's are dots.
pub fn chart(measurements: &[Measurement], peer: Option<&Peer>) -> String {
    let [width, height] = [
        NAMES + BARS + 20.0,
        AXIS + ROW * measurements.len() as f64 + 10.0,
    ];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" \
         aria-label=\"Errors as multiples of their limits\">\n<style>{STYLE}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for decade in DECADES[0] as i32..=DECADES[1] as i32 {
        let x = place(10_f64.powi(decade));
        let class = if decade == 0 { "limit" } else { "grid" };
        let mark = match decade {
            0 => "limit".to_owned(),
            1.. => format!("× {}", 10_i32.pow(decade.unsigned_abs())),
            _ => format!("/ {}", 10_i32.pow(decade.unsigned_abs())),
        };
        let _ = writeln!(
            svg,
            "<path class=\"{class}\" d=\"M{x:.1} {AXIS}V{:.1}\"/><text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{mark}</text>",
            height - 10.0,
            AXIS - 10.0,
        );
    }
    for (number, measurement) in measurements.iter().enumerate() {
        let y = AXIS + ROW * number as f64;
        let end = place(measurement.excess(measurement.error()));
        let class = if measurement.holds() { "held" } else { "short" };
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text><rect class=\"{class}\" x=\"{NAMES}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{}\"/>",
            NAMES - 8.0,
            y + 11.0,
            escaped(&measurement.name()),
            y + 2.0,
            end - NAMES,
            ROW - 4.0,
        );
        if let Some(value) = peer.and_then(|peer| peer.values.get(&measurement.name())) {
            let x = place(measurement.excess(measurement.error_of(*value)));
            let _ = writeln!(
                svg,
                "<circle class=\"peer\" cx=\"{x:.1}\" cy=\"{:.1}\" r=\"3\"/>",
                y + ROW / 2.0
            );
        }
    }
    svg + "</svg>\n"
}

/// Where a multiple of the limit is.
fn place(excess: f64) -> f64 {
    let [least, most] = DECADES;
    let decades = excess.max(1e-9).log10().clamp(least, most);
    NAMES + (decades - least) / (most - least) * BARS
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_ends_at_the_error() {
        let measurements = [
            Measurement::close("good", "", 1.0, 1.001, 0.01),
            Measurement::close("bad", "", 1.0, f64::NAN, 0.01),
        ];
        let svg = chart(&measurements, None);
        let widths: Vec<_> = svg
            .split("class=\"held\"")
            .chain(svg.split("class=\"short\""))
            .filter_map(|rest| rest.split("width=\"").nth(1)?.split('"').next())
            .collect();
        assert!(svg.matches("class=\"held\"").count() == 1, "{widths:?}");
        assert!((place(0.1) - NAMES - BARS / 3.0).abs() < 1e-6);
        assert!((place(f64::INFINITY) - NAMES - BARS).abs() < 1e-6);
    }
}
