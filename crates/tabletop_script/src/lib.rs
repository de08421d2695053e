//! The script bridge.
