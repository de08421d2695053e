//! Numbers that the user types: one parser, which refuses in a sentence.

use std::ops::RangeInclusive;

use bevy_egui::egui::{Context, Id, emath::Numeric};

/// The numbers that a field takes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TypedRange<N>(pub RangeInclusive<N>);

impl<N: Numeric> TypedRange<N> {
    /// The number in a text; or why it is none of these.
    pub fn read(&self, text: &str) -> Result<f64, String> {
        // As they are written in the code, without the digits of 64 bits.
        let [low, high] = [self.0.start(), self.0.end()].map(|end| end.to_f64() as f32);
        let kind = match N::INTEGRAL {
            true => "a whole number",
            false => "a number",
        };
        // Copied texts have the minus sign of typography.
        let plain = text.trim().replace('\u{2212}', "-");
        let is_of_kind =
            |number: &f64| number.is_finite() && (!N::INTEGRAL || number.fract() == 0.0);
        let read = |text: &str| text.parse().ok().filter(is_of_kind);
        match read(&plain) {
            Some(number) if !self.0.contains(&N::from_f64(number)) => Err(format!(
                "{plain} is out of range, expected {kind} from {low} to {high}"
            )),
            Some(number) => Ok(number),
            None if plain.contains(',') && read(&plain.replacen(',', ".", 1)).is_some() => {
                let with_point = plain.replacen(',', ".", 1);
                Err(format!(
                    "`{plain}` is not {kind}, expected a decimal point: {with_point}"
                ))
            }
            None => Err(format!(
                "`{plain}` is not {kind}, expected one from {low} to {high}"
            )),
        }
    }

    /// The number that the user has typed into the field of this title; if it is none of these, [`take_refusals`] has the reason.
    pub fn take(&self, context: &Context, title: &str, text: &str) -> Option<f64> {
        self.read(text)
            .map_err(|reason| refuse(context, format!("{title}: {reason}")))
            .ok()
    }
}

/// What was refused, and the pass in which it was last.
#[derive(Clone, Debug, Default)]
struct Refusals {
    new: Vec<String>,
    last: Option<(String, u64)>,
}

fn refuse(context: &Context, reason: String) {
    let pass = context.cumulative_pass_nr();
    context.data_mut(|data| {
        let refusals: &mut Refusals = data.get_temp_mut_or_default(place());
        // egui reads a text in the pass in which its field is left, and again in the next one.
        let is_same = refusals
            .last
            .as_ref()
            .is_some_and(|(last, at)| *last == reason && at + 1 >= pass);
        if !is_same {
            refusals.new.push(reason.clone());
        }
        refusals.last = Some((reason, pass));
    });
    context.request_repaint();
}

fn place() -> Id {
    Id::new("refused numbers")
}

/// The reasons for which typed numbers were refused since the last call.
pub(crate) fn take_refusals(context: &Context) -> Vec<String> {
    context.data_mut(|data| {
        let refusals: &mut Refusals = data.get_temp_mut_or_default(place());
        std::mem::take(&mut refusals.new)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_of_the_range_is_refused_in_a_sentence() {
        let places = TypedRange(-200.0_f32..=200.0);
        let counts = TypedRange(1_u32..=100);
        let places = |text| places.read(text);
        let counts = |text| counts.read(text);
        for (read, expected) in [
            (places(" -2.25 "), Ok(-2.25)),
            (places("\u{2212}3e1"), Ok(-30.0)),
            (counts("7"), Ok(7.0)),
            (
                places("2,25"),
                Err("`2,25` is not a number, expected a decimal point: 2.25"),
            ),
            (
                places("nan"),
                Err("`nan` is not a number, expected one from -200 to 200"),
            ),
            (
                places("-inf"),
                Err("`-inf` is not a number, expected one from -200 to 200"),
            ),
            (
                places(""),
                Err("`` is not a number, expected one from -200 to 200"),
            ),
            (
                places("1,234.5"),
                Err("`1,234.5` is not a number, expected one from -200 to 200"),
            ),
            (
                places("500"),
                Err("500 is out of range, expected a number from -200 to 200"),
            ),
            (
                counts("2.5"),
                Err("`2.5` is not a whole number, expected one from 1 to 100"),
            ),
            (
                counts("0"),
                Err("0 is out of range, expected a whole number from 1 to 100"),
            ),
        ] {
            assert_eq!(read, expected.map_err(str::to_owned));
        }
    }

    #[test]
    fn the_ends_belong_to_the_range() {
        let sizes = TypedRange(0.001_f32..=1000.0);
        assert_eq!(
            (sizes.read("0.001"), sizes.read("1000")),
            (Ok(0.001), Ok(1000.0))
        );
        assert_eq!(
            sizes.read("0"),
            Err("0 is out of range, expected a number from 0.001 to 1000".to_owned())
        );
    }
}
