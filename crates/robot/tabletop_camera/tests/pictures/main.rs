//! Pictures, compared with the formulas behind them and with rays that are intersected with solids one by one.

mod colors;
mod edges;
mod figures;
mod geometry;
mod hostile;
mod light;
mod scenes;
