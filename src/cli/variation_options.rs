//! The options of variation from one demonstration to the next.

use clap::Args;

use super::range::NumberRange;
use crate::multiplication::Variation;

#[derive(Args)]
pub(super) struct VariationOptions {
    /// Give the objects other colours, as far as the requirements allow
    #[arg(long)]
    pub colors: bool,
    /// Make blocks and cylinders narrower by up to this part of their widths, from 0 to 0.5, as far as requirements allow
    #[arg(long, value_name = "PART", value_parser = PARTS, allow_negative_numbers = true, default_value_t = 0.0, hide_default_value = true)]
    pub sizes: f32,
    /// Put up to this number of other objects around, from 0 to 50
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, value_parser = DISTRACTORS, allow_negative_numbers = true)]
    pub distractors: u32,
    /// Move the head camera by up to this many units, from 0 to 10, and turn it by up to 2° per unit
    #[arg(long, value_name = "UNITS", value_parser = LENGTHS, allow_negative_numbers = true, default_value_t = 0.0, hide_default_value = true)]
    pub camera: f32,
    /// Let brightness, direction and colour of the light in the pictures differ by up to this part, from 0 to 0.5
    #[arg(long, value_name = "PART", value_parser = PARTS, allow_negative_numbers = true, default_value_t = 0.0, hide_default_value = true)]
    pub light: f32,
}

const PARTS: NumberRange<f32> = NumberRange::decimal(0.0, 0.5);
const DISTRACTORS: NumberRange<u32> = NumberRange::whole(0, 50);
const LENGTHS: NumberRange<f32> = NumberRange::decimal(0.0, 10.0).of("units");

impl VariationOptions {
    pub const fn variation(&self) -> Variation {
        Variation {
            colors: self.colors,
            sizes: self.sizes,
            distractors: self.distractors,
            camera: self.camera,
            light: self.light,
            in_view: false,
        }
    }
}
