//! Names of objects in sentences.

use std::collections::BTreeMap;

use tabletop_core::ObjectSpec;
use tabletop_geometry::{NAMED_COLORS, Rgb};

use crate::demonstration::Demonstration;

/// A name for every object of a demonstration: `the red block` if it is unique, `the small red block` if there are two sizes, otherwise its
/// id.
#[derive(Clone, Debug)]
pub struct Nouns(BTreeMap<String, String>);

impl Nouns {
    /// The names of all objects of a demonstration.
    pub fn of(shown: &Demonstration) -> Self {
        let specs: Vec<_> = shown.objects.iter().map(|object| &object.spec).collect();
        let mut alike = BTreeMap::<String, Vec<&ObjectSpec>>::new();
        for spec in &specs {
            if let Some(kind) = kind(spec) {
                alike.entry(kind).or_default().push(spec);
            }
        }
        let mut nouns = BTreeMap::new();
        for (kind, specs) in alike {
            match specs[..] {
                [one] => {
                    nouns.insert(one.id.clone(), format!("the {kind}"));
                }
                [a, b] if !is_as_large(a, b) => {
                    let (small, large) = if volume(a) < volume(b) {
                        (a, b)
                    } else {
                        (b, a)
                    };
                    nouns.insert(small.id.clone(), format!("the small {kind}"));
                    nouns.insert(large.id.clone(), format!("the large {kind}"));
                }
                _ => {}
            }
        }
        for joint in &shown.joints {
            let [holder, lid] = &joint.objects;
            let is_lid = specs
                .iter()
                .any(|spec| spec.id == *lid && spec.shape.name() == "lid");
            if is_lid {
                let holder = nouns.get(holder).unwrap_or(holder);
                nouns.insert(lid.clone(), format!("the lid of {holder}"));
            }
        }
        Self(nouns)
    }

    /// The name of an object.
    pub fn of_object(&self, id: &str) -> String {
        self.0.get(id).map_or_else(|| id.to_owned(), String::clone)
    }
}

/// Colour and shape of an object, such as `red block`, if it has just one of each.
fn kind(spec: &ObjectSpec) -> Option<String> {
    let [(_, shape), ..] = spec.all_descriptions()[..] else {
        return None;
    };
    let colors: Vec<_> = spec.shape.drawn().iter().map(|solid| solid.color).collect();
    let first = *colors.first()?;
    let shape = match shape {
        "composite" => return None,
        "sphere" => "ball",
        shape => shape,
    };
    match colors.iter().all(|color| *color == first) {
        true => Some(format!("{} {shape}", color_name(first))),
        false => Some(shape.to_owned()),
    }
}

/// The nearest named colour.
pub fn color_name(color: Rgb) -> &'static str {
    let distance = |other: Rgb| {
        let parts = [
            color.red - other.red,
            color.green - other.green,
            color.blue - other.blue,
        ];
        parts.iter().map(|part| part * part).sum::<f32>()
    };
    let nearest = NAMED_COLORS
        .iter()
        .min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    match nearest.map_or("", |(name, _)| *name) {
        "darkgray" => "dark gray",
        "lightgray" => "light gray",
        name => name,
    }
}

fn volume(spec: &ObjectSpec) -> f32 {
    let solids = spec.shape.colliding();
    solids.iter().map(|solid| solid.solid.volume()).sum()
}

fn is_as_large(a: &ObjectSpec, b: &ObjectSpec) -> bool {
    let [a, b] = [volume(a), volume(b)];
    (a - b).abs() < 0.05 * a.max(b)
}
