//! Runs the built program as a user runs it, on small particle files. Needs a Vulkan 1.3 device; lavapipe is enough.
#![allow(clippy::unwrap_used)] // a test may

#[path = "tool/support.rs"]
mod support;

#[path = "tool/bench.rs"]
mod bench;
#[path = "tool/failures.rs"]
mod failures;
#[path = "tool/info_compare.rs"]
mod info_compare;
#[path = "tool/mp4.rs"]
mod mp4;
#[path = "tool/pattern.rs"]
mod pattern;
#[path = "tool/pictures.rs"]
mod pictures;
#[path = "tool/real_files.rs"]
mod real_files;
#[path = "tool/scenes.rs"]
mod scenes;
#[path = "tool/sequences.rs"]
mod sequences;
#[path = "tool/shore.rs"]
mod shore;
#[path = "../../../tests/support/skipped.rs"]
mod skipped;
#[path = "tool/temporal.rs"]
mod temporal;
#[path = "tool/whitewater.rs"]
mod whitewater;
