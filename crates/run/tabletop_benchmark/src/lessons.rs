//! The lessons, by their families.

use tabletop_geometry::Rgb;

use crate::{
    lesson::{BenchmarkLesson, Start},
    props::{Form, PieceSize, PieceSpec, Prop},
};

/// All lessons.
pub static LESSONS: [BenchmarkLesson; 41] = [
    BenchmarkLesson {
        family: "sort by colour",
        sentences: "Put every red block into the box.",
        props: &[Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "sort by colour",
        sentences: "Put every green object into the box.",
        props: &[Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "sort by colour",
        sentences: "Put every red block into the blue box.\nPut every green block into the gray box.",
        props: &[Prop::Box(Rgb::BLUE), Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "sort by colour",
        sentences: "Put every red block on the plate.",
        props: &[Prop::Plate(Rgb::WHITE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "sort by size and shape",
        sentences: "Put every ball into the box.",
        props: &[Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "sort by size and shape",
        sentences: "Put every large block into the box.",
        props: &[Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Large,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Small,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Large,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Small,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "sort by size and shape",
        sentences: "Put every small block on the plate.",
        props: &[Prop::Plate(Rgb::WHITE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Large,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Small,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Small,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Large,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "sort by size and shape",
        sentences: "Put every ball into the red box.\nPut every block into the blue box.",
        props: &[Prop::Box(Rgb::RED), Prop::Box(Rgb::BLUE)],
        pieces: &[
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "stack in an order",
        sentences: "Put all blocks on each other, the largest first.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Varied,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "stack in an order",
        sentences: "Put all red blocks on each other, the largest first.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "stack in an order",
        sentences: "Put all blocks on each other, the heaviest first.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "stack in an order",
        sentences: "Put all blocks on each other on the plate, the largest first.",
        props: &[Prop::Plate(Rgb::WHITE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Varied,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "pair",
        sentences: "Put each block into the box of its colour.",
        props: &[Prop::Box(Rgb::RED), Prop::Box(Rgb::GREEN)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "pair",
        sentences: "Put each object into the box of its colour.",
        props: &[Prop::Box(Rgb::RED), Prop::Box(Rgb::BLUE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "pair",
        sentences: "Put each block on the plate of its colour.",
        props: &[Prop::Plate(Rgb::RED), Prop::Plate(Rgb::GREEN)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "pair",
        sentences: "Put each ball into the box of its colour.",
        props: &[Prop::Box(Rgb::RED), Prop::Box(Rgb::GREEN)],
        pieces: &[
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "copy",
        sentences: "Copy every object that is on the left side of the table to the right side.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Twins,
        least: 2,
    },
    BenchmarkLesson {
        family: "copy",
        sentences: "Copy every block that is on the left side of the table to the right side.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Twins,
        least: 3,
    },
    BenchmarkLesson {
        family: "count and fill",
        sentences: "Put two red blocks into the box.",
        props: &[Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "count and fill",
        sentences: "Put three blocks on the plate.",
        props: &[Prop::Plate(Rgb::WHITE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "count and fill",
        sentences: "Put two balls into the box.",
        props: &[Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "count and fill",
        sentences: "Put any green block on the red block until it is three high.",
        props: &[Prop::Base(Rgb::RED)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "unstack and clear",
        sentences: "Put every block that is on the plate on the table.",
        props: &[Prop::Plate(Rgb::WHITE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::HalfThere,
        least: 4,
    },
    BenchmarkLesson {
        family: "unstack and clear",
        sentences: "Remove every block that is in the box.",
        props: &[Prop::Box(Rgb::GRAY)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::HalfThere,
        least: 4,
    },
    BenchmarkLesson {
        family: "unstack and clear",
        sentences: "Remove every red block.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "unstack and clear",
        sentences: "Put every object that is in the box on the plate.",
        props: &[Prop::Box(Rgb::GRAY), Prop::Plate(Rgb::WHITE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::HalfThere,
        least: 4,
    },
    BenchmarkLesson {
        family: "Hanoi",
        sentences: "Move the tower from PegA to PegC by way of PegB.",
        props: &[Prop::Pegs],
        pieces: &[],
        start: Start::Rings,
        least: 2,
    },
    BenchmarkLesson {
        family: "Hanoi",
        sentences: "Move the tower from PegA to PegB by way of PegC.",
        props: &[Prop::Pegs],
        pieces: &[],
        start: Start::Rings,
        least: 2,
    },
    BenchmarkLesson {
        family: "swap",
        sentences: "Swap the red block and the blue block.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "swap",
        sentences: "Swap the largest block and the smallest block.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::BLUE,
                size: PieceSize::Varied,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "swap",
        sentences: "Swap the red ball and the green block.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "swap",
        sentences: "Swap the leftmost block and the rightmost block.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "rows and grids",
        sentences: "Put all blocks in a row.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "rows and grids",
        sentences: "Put all red blocks in a row, the largest first.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "rows and grids",
        sentences: "Put all blocks in a column, the smallest first.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Varied,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Varied,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "rows and grids",
        sentences: "Put all balls in a grid of two columns.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Ball,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 4,
    },
    BenchmarkLesson {
        family: "rows and grids",
        sentences: "Put all blocks in a row on the right side of the table.",
        props: &[],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "conditions on lids",
        sentences: "Open the box.\nPut every red block into the box.\nClose the box.",
        props: &[Prop::Chest(Rgb::BLUE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
        ],
        start: Start::Scattered,
        least: 3,
    },
    BenchmarkLesson {
        family: "conditions on lids",
        sentences: "Close every box.",
        props: &[
            Prop::Chest(Rgb::BLUE),
            Prop::Chest(Rgb::GREEN),
            Prop::Chest(Rgb::GRAY),
        ],
        pieces: &[PieceSpec {
            form: Form::Block,
            color: Rgb::RED,
            size: PieceSize::Equal,
        }],
        start: Start::Scattered,
        least: 1,
    },
    BenchmarkLesson {
        family: "conditions on lids",
        sentences: "If the box is closed, open it, otherwise close it.",
        props: &[Prop::Chest(Rgb::BLUE)],
        pieces: &[PieceSpec {
            form: Form::Block,
            color: Rgb::RED,
            size: PieceSize::Equal,
        }],
        start: Start::Scattered,
        least: 1,
    },
    BenchmarkLesson {
        family: "conditions on lids",
        sentences: "If the red block is on the plate, put it on the table, otherwise put the red block on the plate.",
        props: &[Prop::Plate(Rgb::WHITE)],
        pieces: &[
            PieceSpec {
                form: Form::Block,
                color: Rgb::RED,
                size: PieceSize::Equal,
            },
            PieceSpec {
                form: Form::Block,
                color: Rgb::GREEN,
                size: PieceSize::Equal,
            },
        ],
        start: Start::SomeThere,
        least: 2,
    },
];
