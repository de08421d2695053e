//! The plot of a training's loss.

use std::fmt::Write as _;

/// Width and height, and the margin for the numbers.
const SIZE: [f32; 2] = [640.0, 240.0];
const MARGIN: f32 = 40.0;
/// Points of the curve.
const POINTS: usize = 200;
/// Lines across.
const LINES: usize = 4;

/// The beginning of the plot, which tells it from other drawings.
pub const LOSS_CURVE: &str =
    "<svg xmlns=\"http://www.w3.org/2000/svg\" aria-label=\"loss of a training\"";

/// The loss of each batch as a plot, SVG; each point is the mean of some batches.
pub fn loss_curve(losses: &[f32]) -> String {
    let in_point = losses.len().div_ceil(POINTS).max(1);
    let means = losses.chunks(in_point);
    let means: Vec<f32> = means
        .map(|losses| losses.iter().sum::<f32>() / losses.len() as f32)
        .collect();
    let most = means.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    let [width, height] = SIZE;
    let x = |point: usize| {
        MARGIN + (width - 2.0 * MARGIN) * point as f32 / (means.len().max(2) - 1) as f32
    };
    let y = |loss: f32| height - MARGIN / 2.0 - (height - MARGIN) * loss / most;
    let mut svg = format!(
        "{LOSS_CURVE} viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"11\">\n"
    );
    for line in 0..=LINES {
        let loss = most * line as f32 / LINES as f32;
        let (left, right, at) = (MARGIN, width - MARGIN, y(loss));
        let _ = writeln!(
            svg,
            "<path d=\"M{left} {at:.1}H{right}\" stroke=\"#ddd\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{loss:.2}</text>",
            left - 5.0,
            at + 4.0,
        );
    }
    let points = means.iter().enumerate();
    let points: Vec<_> = points
        .map(|(point, loss)| format!("{:.1},{:.1}", x(point), y(*loss)))
        .collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#4269d0\" stroke-width=\"1.5\"/>\n<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">batch {}</text>\n</svg>",
        points.join(" "),
        width - MARGIN,
        height - 4.0,
        losses.len(),
    );
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_has_few_points_and_no_holes() {
        for count in [0, 1, 2, 199, 10_000] {
            let losses: Vec<f32> = (0..count).map(|i| 1.0 / (1 + i) as f32).collect();
            let svg = loss_curve(&losses);
            assert!(svg.ends_with("</svg>\n"), "{svg}");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
            assert!(svg.len() < 5_000, "{}", svg.len());
        }
    }
}
