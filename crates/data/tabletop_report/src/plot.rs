//! Plots of numbers against time, as SVG.

use std::fmt::Write as _;

use crate::html::escaped;

/// Numbers against time.
pub(crate) struct Plot {
    pub title: String,
    /// The unit of the numbers.
    pub unit: &'static str,
    pub lines: Vec<PlotLine>,
}

/// A line of a plot.
pub(crate) struct PlotLine {
    pub name: String,
    /// A CSS colour.
    pub color: String,
    /// A number a frame; `None` where there is none.
    pub values: Vec<Option<f32>>,
}

/// Width and height of a plot.
const SIZE: [f32; 2] = [720.0, 180.0];
/// Margins on the left, at the bottom, and elsewhere.
const MARGINS: [f32; 3] = [46.0, 20.0, 8.0];
/// About so many marks on an axis.
const MARKS: f32 = 5.0;

/// The part of a step by which a mark at the end of an axis may be beyond it.
const ROUNDING: f32 = 1e-3;

/// Colours of lines that have none of their own.
pub(crate) const COLORS: [&str; 8] = [
    "#4269d0", "#efb118", "#ff725c", "#6cc5b0", "#3ca951", "#ff8ab7", "#a463f2", "#97bbf5",
];

impl Plot {
    /// The plot; `fps` frames are a second.
    pub fn svg(&self, fps: f32) -> String {
        let [width, height] = SIZE;
        let [left, bottom, margin] = MARGINS;
        let frames = self.lines.iter().map(|line| line.values.len()).max();
        let seconds = (frames.unwrap_or(1).max(2) - 1) as f32 / fps;
        let values = self
            .lines
            .iter()
            .flat_map(|line| line.values.iter().flatten());
        let (least, most) = values.fold(
            (f32::INFINITY, f32::NEG_INFINITY),
            |(least, most), value| (least.min(*value), most.max(*value)),
        );
        let (least, most) = match least < most {
            true => (least, most),
            false => (least - 0.5, least + 0.5),
        };
        let x = |time: f32| left + time / seconds * (width - left - margin);
        let y = |value: f32| margin + (most - value) / (most - least) * (height - bottom - margin);
        let mut svg = format!(
            "<figure class=\"plot\"><figcaption>{} <span class=\"unit\">{}</span></figcaption>\n\
             <svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\" data-left=\"{left}\" data-right=\"{}\" data-seconds=\"{seconds}\">\n",
            escaped(&self.title),
            escaped(self.unit),
            escaped(&self.title),
            width - margin,
        );
        for value in marks(least, most) {
            let _ = writeln!(
                svg,
                "<path class=\"grid\" d=\"M{left} {0:.1}H{1}\"/><text x=\"{2}\" y=\"{3:.1}\" text-anchor=\"end\">{value}</text>",
                y(value),
                width - margin,
                left - 5.0,
                y(value) + 3.5,
            );
        }
        for time in marks(0.0, seconds) {
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{time}</text>",
                x(time),
                height - 5.0,
            );
        }
        for line in &self.lines {
            let mut path = String::new();
            let mut is_down = false;
            for (frame, value) in line.values.iter().enumerate() {
                let Some(value) = value else {
                    is_down = false;
                    continue;
                };
                let pen = if is_down { 'L' } else { 'M' };
                let _ = write!(path, "{pen}{:.1} {:.1}", x(frame as f32 / fps), y(*value));
                is_down = true;
            }
            let _ = writeln!(
                svg,
                "<path class=\"line\" stroke=\"{}\" d=\"{path}\"><title>{}</title></path>",
                escaped(&line.color),
                escaped(&line.name),
            );
        }
        let _ = writeln!(
            svg,
            "<path class=\"playhead\" d=\"M{left} {margin}V{}\"/></svg>",
            height - bottom
        );
        let legend = self.lines.iter().map(|line| {
            format!(
                "<span><i style=\"background:{}\"></i>{}</span>",
                escaped(&line.color),
                escaped(&line.name)
            )
        });
        let legend: String = legend.collect();
        svg + &format!("<div class=\"legend\">{legend}</div></figure>\n")
    }
}

/// Round numbers in a range, about as many as fit on an axis.
fn marks(least: f32, most: f32) -> Vec<f32> {
    let rough = (most - least) / MARKS;
    let power = 10_f32.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| *step >= rough)
        .unwrap_or(10.0 * power);
    let first = (least / step - ROUNDING).ceil() as i64;
    let last = (most / step + ROUNDING).floor() as i64;
    let digits = (-power.log10().floor()).clamp(0.0, 6.0) as i32;
    let round = |value: f32| {
        let scale = 10_f32.powi(digits);
        (value * scale).round() / scale
    };
    (first..=last)
        .take(20)
        .map(|number| round(number as f32 * step))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_within_the_range() {
        assert_eq!(marks(0.0, 10.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(marks(-0.31, 0.2), [-0.2, 0.0, 0.2]);
        assert_eq!(marks(1.0, 1.05), [1.0, 1.01, 1.02, 1.03, 1.04, 1.05]);
    }

    #[test]
    fn lines_are_broken_where_there_is_no_number() {
        let plot = Plot {
            title: "x <1>".into(),
            unit: "units",
            lines: vec![PlotLine {
                name: "ball".into(),
                color: "#123456".into(),
                values: vec![Some(0.0), Some(1.0), None, Some(2.0)],
            }],
        };
        let svg = plot.svg(4.0);
        let path = svg.split("class=\"line\"").nth(1).unwrap();
        let path = path
            .split("d=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        assert_eq!(path.matches('M').count(), 2, "{path}");
        assert_eq!(path.matches('L').count(), 1, "{path}");
        assert!(svg.contains("x &lt;1&gt;"));
    }
}
