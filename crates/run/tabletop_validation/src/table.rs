//! The table of measurements, as Markdown, which is readable as it stands.

use std::{collections::BTreeMap, fmt::Write as _};

use crate::measurement::Measurement;

/// Another simulator's values of the same measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Peer {
    /// Its name.
    pub name: String,
    /// Its measured values, by the names of the measurements.
    pub values: BTreeMap<String, f64>,
}

/// The measurements in rows, with those of a peer beside them.
pub fn table(measurements: &[Measurement], peer: Option<&Peer>) -> String {
    let mut head = vec![
        "experiment",
        "quantity",
        "formula",
        "expected",
        "measured",
        "error",
        "limit",
        "",
    ]
    .into_iter()
    .map(str::to_owned)
    .collect::<Vec<_>>();
    head.extend(peer.map(|peer| format!("{} error", peer.name)));
    let row = |measurement: &Measurement| {
        let mut cells = vec![
            measurement.experiment.to_owned(),
            measurement.quantity.to_owned(),
            measurement.formula.replace('|', "\\|"),
            number(measurement.expected),
            number(measurement.measured),
            measurement.tolerance.phrase(measurement.error()),
            measurement.tolerance.to_string(),
            if measurement.holds() { "" } else { "short" }.to_owned(),
        ];
        cells.extend(peer.map(|peer| {
            let value = peer.values.get(&measurement.name());
            value.map_or("–".to_owned(), |&value| {
                let error = measurement.error_of(value);
                measurement.tolerance.phrase(error)
            })
        }));
        cells
    };
    let rows: Vec<_> = std::iter::once(head)
        .chain(measurements.iter().map(row))
        .collect();
    let columns = rows[0].len();
    let widths: Vec<_> = (0..columns)
        .map(|column| {
            rows.iter()
                .map(|row| row[column].chars().count())
                .fold(3, usize::max)
        })
        .collect();
    let mut text = String::new();
    for (number, row) in rows.iter().enumerate() {
        for (cell, width) in row.iter().zip(&widths) {
            let _ = write!(text, "| {cell:width$} ");
        }
        text.push_str("|\n");
        if number == 0 {
            for width in &widths {
                let _ = write!(text, "|{}", "-".repeat(width + 2));
            }
            text.push_str("|\n");
        }
    }
    text
}

/// A number with five digits that count, but no more than four behind the point.
fn number(value: f64) -> String {
    let digits = match value.abs() {
        size if size >= 1000.0 => 1,
        size if size >= 100.0 => 2,
        size if size >= 10.0 => 3,
        _ => 4,
    };
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_says_what_falls_short_and_how_the_peer_does() {
        let measurements = [
            Measurement::close("way", "v²/2μg", 2.0, 2.1, 0.02),
            Measurement::none("drift", 0.001, 0.01),
        ];
        let peer = Peer {
            name: "MuJoCo".into(),
            values: [(": way".to_owned(), 1.98)].into(),
        };
        let table = table(&measurements, Some(&peer));
        let rows: Vec<Vec<_>> = table
            .lines()
            .map(|line| line.split('|').map(str::trim).collect())
            .collect();
        assert_eq!(rows[0][8..10], ["", "MuJoCo error"]);
        assert_eq!(
            rows[2][4..10],
            ["2.0000", "2.1000", "+5.00 %", "2 %", "short", "-1.00 %"]
        );
        assert_eq!(
            rows[3][4..10],
            ["0.0000", "0.0010", "+0.0010", "0.01", "", "–"]
        );
    }
}
