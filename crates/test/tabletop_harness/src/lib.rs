//! The harness of tests that need tools which not every machine has, such as GNU Octave.
//!
//! A test whose tool is missing is reported as ignored, with the reason. Where [`REQUIRE_ALL`] is 1, it fails.
//!
//! A test binary with this harness has `harness = false` in its manifest, and such a main file:
//!
//! ```
//! use tabletop_harness::test_with;
//!
//! #[test_with(Octave)]
//! fn the_engine_starts() {}
//!
//! fn main() -> std::process::ExitCode {
//!     tabletop_harness::run()
//! }
//! ```

mod prerequisite;
mod seeds;
mod trials;

pub use inventory;
pub use prerequisite::Prerequisite;
pub use seeds::seeds;
pub use tabletop_harness_macro::test_with;
pub use trials::{REQUIRE_ALL, RegisteredTest, run};
