//! What pictures show, against the formulas they are made by and against rays that are met with solids one by one.

mod colors;
mod edges;
mod figures;
mod geometry;
mod hostile;
mod scenes;
