//! Labels: what is to be done next, as marks in the view; how a network gives them, and how far it is off.

use bevy::math::Vec2;

use crate::{planes::Planes, unet::Response};

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Label {
    /// To take what is at one mark, and put it down at another.
    Move { pick: HeatMark, place: HeatMark },
    /// Nothing.
    Done,
}

/// Where the origin of an object is or shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeatMark {
    /// Its pixel in the view; the centre of the upper left one is (0, 0).
    pub at: Vec2,
    /// Its height: an index in the list of heights of the task.
    pub level: usize,
    /// Its orientation.
    pub heading: Heading,
}

/// An orientation about the vertical, for each fold n of [`FOLDS`](Self::FOLDS) as (cos, sin) of n times the yaw, averaged over all yaws in which the object
/// looks the same. So a pair is zero unless n is a multiple of the object's own fold; all are zero for what is round.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Heading(pub [Vec2; Heading::FOLDS.len()]);

impl Heading {
    pub const FOLDS: [usize; 3] = [1, 2, 4];
    /// Length from which a pair of a network is one.
    const CERTAIN: f32 = 0.5;

    /// The heading of an object that looks the same at all these yaws, in rad.
    pub fn of(yaws: &[f32]) -> Self {
        let mean = |fold: usize| {
            let turned = yaws.iter().map(|yaw| {
                let (sin, cos) = libm::sincosf(yaw * fold as f32);
                Vec2::new(cos, sin)
            });
            turned.sum::<Vec2>() / yaws.len().max(1) as f32
        };
        Self(Self::FOLDS.map(mean))
    }

    /// The yaw. `None` for what is round.
    pub fn yaw(&self) -> Option<Yaw> {
        let mut pairs = Self::FOLDS.into_iter().zip(self.0);
        let (fold, pair) = pairs.find(|(_, pair)| pair.length() > Self::CERTAIN)?;
        let angle = libm::atan2f(pair.y, pair.x) / fold as f32;
        Some(Yaw { angle, fold })
    }
}

/// A turn about the vertical, of an object that looks the same after each part of a whole turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yaw {
    /// The angle in rad, counterclockwise from above.
    pub angle: f32,
    /// The number of parts: 4 for a cube, 2 for a brick.
    pub fold: usize,
}

impl Yaw {
    /// The least turn, in rad, after which an object of this yaw looks as with another one.
    pub fn turn_to(self, wanted: Self) -> f32 {
        let period = std::f32::consts::TAU / self.fold.max(1) as f32;
        let turn = wanted.angle - self.angle;
        turn - (turn / period).round() * period
    }
}

/// The planes of a network's response: heat, levels and headings of pick and place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LabelPlanes {
    pub levels: usize,
}

/// Most heights at which a task takes and puts objects.
pub(crate) const MOST_LEVELS: usize = 9;
/// Pixels of the view that one of the response is wide.
const COARSENESS: f32 = 2.0;
/// Half the width of the window round a peak over which a mark is averaged.
const REACH: usize = 2;
/// Weight of the errors of headings beside those of places and levels.
const HEADING_WEIGHT: f32 = 4.0;

#[derive(Clone, Copy)]
enum MoveEnd {
    Pick,
    Place,
}

impl LabelPlanes {
    /// The number of planes, a multiple of [`BLOCK`](crate::convolution::BLOCK).
    pub fn planes(&self) -> usize {
        (2 * self.planes_of_mark()).next_multiple_of(crate::convolution::BLOCK)
    }

    fn planes_of_mark(&self) -> usize {
        1 + self.levels + 2 * Heading::FOLDS.len()
    }

    /// The first plane of a mark, which is its heat; then come its levels, then its heading.
    fn first(&self, part: MoveEnd) -> usize {
        match part {
            MoveEnd::Pick => 0,
            MoveEnd::Place => self.planes_of_mark(),
        }
    }

    /// The label that a response gives.
    pub fn label(&self, response: &Response) -> Label {
        let pick = self.first(MoveEnd::Pick);
        let most = peak(&response.planes, pick).2;
        let all: f32 = (response.planes.pixels(pick))
            .map(|heat| libm::expf(heat - most))
            .sum();
        // As likely as all places together.
        if response.whole > most + libm::logf(all) {
            return Label::Done;
        }
        let [pick, place] =
            [MoveEnd::Pick, MoveEnd::Place].map(|part| self.mark(&response.planes, part));
        Label::Move { pick, place }
    }

    /// The mark of a part: the mean over a window round the hottest pixel, weighted by heat.
    fn mark(&self, planes: &Planes, part: MoveEnd) -> HeatMark {
        let heat = self.first(part);
        let (column, row, most) = peak(planes, heat);
        let columns = column.saturating_sub(REACH)..=(column + REACH).min(planes.width() - 1);
        let rows = row.saturating_sub(REACH)..=(row + REACH).min(planes.height() - 1);
        let (mut at, mut weights) = (Vec2::ZERO, 0.0);
        let mut rest = vec![0.0; self.planes_of_mark() - 1];
        for (column, row) in rows.flat_map(|row| columns.clone().map(move |column| (column, row))) {
            let weight = libm::expf(planes.get(heat, column, row) - most);
            at += weight * Vec2::new(column as f32, row as f32);
            weights += weight;
            for (i, sum) in rest.iter_mut().enumerate() {
                *sum += weight * planes.get(heat + 1 + i, column, row);
            }
        }
        let (levels, heading) = rest.split_at(self.levels);
        let pairs = heading.as_chunks::<2>().0;
        let level = (0..levels.len()).max_by(|&a, &b| levels[a].total_cmp(&levels[b]));
        HeatMark {
            at: (at / weights) * COARSENESS + (COARSENESS - 1.0) / 2.0,
            level: level.unwrap_or(0),
            heading: Heading(std::array::from_fn(|i| Vec2::from(pairs[i]) / weights)),
        }
    }

    /// How far a response is off, and the gradients of its planes and of its number: the cross-entropies of places and levels, and the squared errors of
    /// headings.
    pub fn loss(&self, response: &Response, label: &Label) -> (f32, Planes, f32) {
        let planes = &response.planes;
        let mut gradient = planes.like(planes.width(), planes.height());
        let (pick, place) = match label {
            Label::Move { pick, place } => (Some(pick), Some(place)),
            Label::Done => (None, None),
        };
        let heat = self.first(MoveEnd::Pick);
        let (mut loss, whole) = heat_loss(planes, heat, Some(response.whole), pick, &mut gradient);
        if let Some(pick) = pick {
            loss += self.mark_loss(planes, heat, pick, &mut gradient);
        }
        if let Some(place) = place {
            let heat = self.first(MoveEnd::Place);
            loss += heat_loss(planes, heat, None, Some(place), &mut gradient).0;
            loss += self.mark_loss(planes, heat, place, &mut gradient);
        }
        (loss, gradient, whole)
    }

    /// The loss of a mark's level and heading at its place.
    fn mark_loss(
        &self,
        planes: &Planes,
        heat: usize,
        mark: &HeatMark,
        gradient: &mut Planes,
    ) -> f32 {
        let mut loss = 0.0;
        for (column, row, share) in neighbours(mark, planes) {
            let levels: Vec<_> = (0..self.levels)
                .map(|level| planes.get(heat + 1 + level, column, row))
                .collect();
            let most = levels.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            let all: f32 = levels.iter().map(|level| libm::expf(level - most)).sum();
            loss += share * (libm::logf(all) + most - levels[mark.level]);
            for (level, number) in levels.iter().enumerate() {
                let is = if level == mark.level { 1.0 } else { 0.0 };
                *gradient.get_mut(heat + 1 + level, column, row) +=
                    share * (libm::expf(number - most) / all - is);
            }
            let heading = mark.heading.0.iter().flat_map(|pair| pair.to_array());
            for (i, wanted) in heading.enumerate() {
                let plane = heat + 1 + self.levels + i;
                let error = planes.get(plane, column, row) - wanted;
                loss += share * HEADING_WEIGHT * error * error;
                *gradient.get_mut(plane, column, row) += share * HEADING_WEIGHT * 2.0 * error;
            }
        }
        loss
    }
}

/// The cross-entropy of a plane's softmax, with one more entry for the whole picture if there is a number for it. The target is the mark, or the whole
/// picture if there is none. Also the gradient of that number.
fn heat_loss(
    planes: &Planes,
    plane: usize,
    whole: Option<f32>,
    mark: Option<&HeatMark>,
    gradient: &mut Planes,
) -> (f32, f32) {
    let most = peak(planes, plane).2;
    let most = whole.map_or(most, |whole| whole.max(most));
    let mut all = 0.0;
    for row in 0..planes.height() {
        let heats = planes.row(plane, row).iter();
        for (part, heat) in gradient.row_mut(plane, row).iter_mut().zip(heats) {
            *part = libm::expf(heat - most);
            all += *part;
        }
    }
    let of_whole = whole.map_or(0.0, |whole| libm::expf(whole - most));
    all += of_whole;
    for row in 0..planes.height() {
        for part in gradient.row_mut(plane, row) {
            *part /= all;
        }
    }
    let log_all = libm::logf(all) + most;
    let Some(mark) = mark else {
        return (log_all - whole.unwrap_or(log_all), of_whole / all - 1.0);
    };
    let mut loss = 0.0;
    for (column, row, share) in neighbours(mark, planes) {
        loss += share * (log_all - planes.get(plane, column, row));
        *gradient.get_mut(plane, column, row) -= share;
    }
    (loss, of_whole / all)
}

/// The hottest pixel of a plane, the first among equals: column, row and heat.
fn peak(planes: &Planes, plane: usize) -> (usize, usize, f32) {
    let mut most = (0, 0, f32::NEG_INFINITY);
    for row in 0..planes.height() {
        for (column, heat) in planes.row(plane, row).iter().enumerate() {
            if *heat > most.2 {
                most = (column, row, *heat);
            }
        }
    }
    most
}

/// The four pixels around a mark, and their shares in bilinear interpolation.
fn neighbours(mark: &HeatMark, planes: &Planes) -> [(usize, usize, f32); 4] {
    let last = Vec2::new(planes.width() as f32, planes.height() as f32) - 1.0;
    let at = (mark.at - (COARSENESS - 1.0) / 2.0) / COARSENESS;
    let at = at.clamp(Vec2::ZERO, last);
    let whole = at.floor().min(last - 1.0);
    let part = at - whole;
    [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
        let share = |part: f32, of: usize| if of == 1 { part } else { 1.0 - part };
        (
            whole.x as usize + x,
            whole.y as usize + y,
            share(part.x, x) * share(part.y, y),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_knows_its_fold() {
        let quarter = std::f32::consts::FRAC_PI_2;
        let cube = Heading::of(&[0, 1, 2, 3].map(|turn| 0.2 + turn as f32 * quarter));
        let yaw = cube.yaw().unwrap();
        assert!((yaw.angle - 0.2).abs() < 1e-5 && yaw.fold == 4, "{yaw:?}");
        let arrow = Heading::of(&[-3.0]).yaw().unwrap();
        assert!(
            (arrow.angle + 3.0).abs() < 1e-5 && arrow.fold == 1,
            "{arrow:?}"
        );
        assert_eq!(Heading::of(&[]).yaw(), None);
    }

    #[test]
    fn a_mark_between_pixels_is_found_again() {
        let labels = LabelPlanes { levels: 2 };
        let mut planes = Planes::new(labels.planes(), 32, 32);
        let wanted = HeatMark {
            at: Vec2::new(20.4, 31.3),
            level: 1,
            heading: Heading::of(&[0.7]),
        };
        planes
            .each_mut()
            .take(1)
            .for_each(|plane| plane.fill(-30.0));
        for (column, row, share) in neighbours(&wanted, &planes) {
            *planes.get_mut(0, column, row) = share.ln();
            *planes.get_mut(2, column, row) = 1.0;
            for (i, part) in wanted
                .heading
                .0
                .iter()
                .flat_map(|pair| pair.to_array())
                .enumerate()
            {
                *planes.get_mut(3 + i, column, row) = part;
            }
        }
        let found = labels.mark(&planes, MoveEnd::Pick);
        assert!(found.at.distance(wanted.at) < 1e-3, "{found:?}");
        assert_eq!(found.level, 1);
        assert!((found.heading.yaw().unwrap().angle - 0.7).abs() < 1e-4);
    }
}
