//! Policies of ours, served to others.

use tabletop_core::Picture;
use tabletop_wire::{Dtype, MappedActions, NumpyArray, Served, WireMap, WireValue};

use crate::{
    picture_policy::PicturePolicy,
    place_numbers::{OF_CAMERA, action_metadata, camera_of, numbers_of},
};

/// The keys of an observation: those of `assets/policies/tabletop.ron`.
const IMAGE: &str = "image";
const CAMERA: &str = "camera";

/// A policy that decides by pictures, as openpi's protocol serves it (`docs/policies.md`).
pub struct ServedPolicy(pub Box<dyn PicturePolicy>);

impl Served for ServedPolicy {
    fn metadata(&self) -> WireMap {
        let side = |side: Option<u32>| side.map_or(WireValue::Nil, |side| whole(side.into()));
        let size = self.0.picture_size();
        let sides = [
            side(size.map(|[_, rows]| rows)),
            side(size.map(|[columns, _]| columns)),
            whole(3),
        ];
        let camera = [whole(OF_CAMERA as i64)];
        let observation = [
            (IMAGE, array_of(&sides, Dtype::U8)),
            (CAMERA, array_of(&camera, Dtype::F32)),
        ];
        let observation = observation.map(|(key, array)| (key.to_owned(), array.into()));
        WireMap::from(
            [
                ("server", WireValue::from("tabletop")),
                ("observation", WireMap::from(observation).into()),
                ("action", action_metadata().into()),
                // An action is a whole move, as long as that takes.
                ("rate", WireValue::Nil),
                ("horizon", whole(1)),
            ]
            .map(|(key, value)| (key.to_owned(), value)),
        )
    }

    fn answer(&self, observation: &WireMap) -> Result<WireMap, String> {
        let picture = picture_of(observation)?;
        let size = [picture.width, picture.height];
        if let Some(wanted) = self.0.picture_size().filter(|wanted| *wanted != size) {
            let ([columns, rows], [wide, high]) = (size, wanted);
            return Err(format!(
                "{IMAGE:?}: it has {rows} rows of {columns} pixels, expected {high} of {wide}"
            ));
        }
        let numbers: Vec<f64> = array(observation, CAMERA)?.numbers().collect();
        let camera = camera_of(&numbers, size).map_err(|fault| format!("{CAMERA:?}: {fault}"))?;
        let decision = self.0.decide(&picture, &camera);
        let numbers = numbers_of(&decision.map_err(|error| error.to_string())?);
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(format!("{CAMERA:?}: from there, the table is not seen"));
        }
        let actions = NumpyArray::of_floats(&[1, MappedActions::OF_PLACES], &numbers);
        Ok(WireMap::from([("actions".to_owned(), actions.into())]))
    }
}

const fn whole(number: i64) -> WireValue {
    WireValue::Integer(number)
}

/// The description of an array.
fn array_of(shape: &[WireValue], dtype: Dtype) -> WireMap {
    let parts = [
        ("shape", WireValue::List(shape.to_vec())),
        ("dtype", dtype.name().into()),
    ];
    WireMap::from(parts.map(|(key, value)| (key.to_owned(), value)))
}

fn array<'o>(observation: &'o WireMap, key: &str) -> Result<&'o NumpyArray, String> {
    match observation.get(key) {
        Some(WireValue::Array(array)) => Ok(array),
        Some(other) => Err(format!("{key:?}: {}, expected an array", other.kind())),
        None => {
            let keys: Vec<_> = observation.keys().take(20).collect();
            Err(format!("{key:?} is missing; there are only {keys:?}"))
        }
    }
}

/// The picture of an observation.
fn picture_of(observation: &WireMap) -> Result<Picture, String> {
    let image = array(observation, IMAGE)?;
    let side = |side: usize| {
        let side = u32::try_from(side).ok();
        side.filter(|side| (1..=Picture::MOST_SIDE).contains(side))
    };
    let size = match *image.shape() {
        [rows, columns, 3] if image.dtype() == Dtype::U8 => side(columns).zip(side(rows)),
        _ => None,
    };
    let pixels = |(columns, rows): &(u32, u32)| u64::from(*columns) * u64::from(*rows);
    let size = size.filter(|size| pixels(size) <= Picture::MOST_PIXELS);
    let (columns, rows) = size.ok_or_else(|| {
        format!(
            "{IMAGE:?}: its shape is {:?} of {}, expected [rows, columns, 3] of |u1",
            image.shape(),
            image.dtype().name()
        )
    })?;
    let mut picture = Picture::default();
    picture.resize(columns, rows);
    picture.rgb.copy_from_slice(image.bytes());
    Ok(picture)
}
