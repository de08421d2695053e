//! The page of a judgement, with films of what was recorded.

use std::{collections::BTreeMap, path::Path};

use crate::{
    Collection,
    benchmark::PolicyJudgement,
    camera::{CameraPlace, CameraSpec},
    core::TICKS_PER_SECOND,
    film::{Film, FilmFormat},
    geometry::Pose,
    replay::Replay,
    report::judgement_page,
};
use bevy::math::Vec3;

use crate::cli::{Failure, progress::ProgressLine};

/// Pictures of a film, in two rows.
const PICTURES: u32 = 6;
/// Columns and rows of a picture.
const SIZE: [u32; 2] = [320, 240];
/// The place across the table from which films are taken, to the right of the robot's work, and the point that they look at, in units.
const PLACE: [Vec3; 2] = [Vec3::new(2.0, 6.0, 7.5), Vec3::new(0.0, -2.0, 0.5)];

/// The page of a judgement, beside that of another file if one is named, with films from a folder of recordings.
pub(super) fn page_of(
    judgement: &PolicyJudgement,
    beside: Option<(&Path, &PolicyJudgement)>,
    recorded: Option<&Path>,
) -> Result<String, Failure> {
    let outcomes = beside.map(|(file, other)| {
        let outcomes = judgement.outcomes_beside(other).map_err(Failure::input)?;
        Ok::<_, Failure>((file.display().to_string(), outcomes))
    });
    let outcomes = outcomes.transpose()?;
    let films = recorded.map_or_else(|| Ok(BTreeMap::new()), |it| films_of(judgement, it))?;
    let beside = outcomes.as_ref();
    let beside = beside.map(|(name, outcomes)| (name.as_str(), &outcomes[..]));
    Ok(judgement_page(judgement, beside, &films))
}

/// Films of the episodes that are worth one, by their numbers. Of another machine's share there is none.
fn films_of(
    judgement: &PolicyJudgement,
    recorded: &Path,
) -> Result<BTreeMap<u64, Vec<u8>>, Failure> {
    let places = judgement.filmed().into_iter().map(|number| {
        let place = Collection::place_in(recorded, number);
        (number, place)
    });
    let there: Vec<_> = places.filter(|(_, place)| place.is_dir()).collect();
    let mut progress = ProgressLine::new(there.len() as u64, " films");
    let films = (1..).zip(there).map(|(done, (number, place))| {
        let film = contact_sheet(&place)?;
        progress.reach(done, "");
        Ok((number, film))
    });
    let films = films.collect();
    progress.end();
    films
}

/// Pictures of a recording from its beginning to its end, as PNG.
fn contact_sheet(recording: &Path) -> Result<Vec<u8>, Failure> {
    let failed = |reason: String| Failure::run(format!("{}: {reason}", recording.display()));
    let replay = Replay::read(recording).map_err(|error| failed(error.to_string()))?;
    let [first, last] = [
        replay.recording().first_tick(),
        replay.recording().last_tick(),
    ];
    let seconds = last.0.saturating_sub(first.0) as f64 / f64::from(TICKS_PER_SECOND);
    let [from, at] = PLACE;
    let camera = CameraSpec {
        name: "across".into(),
        viewpoint: CameraPlace::Standing(Pose::looking_at(from, at)),
        size: Some(SIZE),
        vertical_fov: None,
    };
    let film = Film {
        columns: PICTURES / 2,
        period: Some(seconds / f64::from(PICTURES - 1)),
        ..Film::of(camera)
    };
    let developed = film.develop(&replay, FilmFormat::Png, |_, _| {});
    developed.map_err(|error| failed(error.to_string()))
}
