//! The command line of `whitewater`: particle caches in, pictures out.
#![cfg_attr(test, allow(clippy::unwrap_used))] // a test may

mod air;
mod args;
mod arrays;
mod bench;

mod blur;
mod bounds;
mod bubbles;
mod camera;
mod cells;
mod compare;
mod demo;
mod environment;
mod extras;
mod failure;
mod film;
mod fluids;
mod folder;
mod frames;
mod generate;
mod info;
mod layers;
mod looks;
mod masonry;
mod odd;
mod out;
mod output;
mod pattern;
mod placing;
mod probes;
mod progress;
mod radii;
mod reader;
mod render;
mod session;
mod sets;
mod settings;
mod shore;
mod simulate;
mod smoothstep;
mod spouts;
mod spray;
mod stage;
mod summary;
mod surface_foam;
#[cfg(test)]
mod testing;
mod timings;
mod tracks;
mod turntable;
mod upright;
mod whitewater_source;
mod written;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Cli, Command};
use crate::failure::Kind;

fn main() -> ExitCode {
    let cli = Cli::parse();
    output::clean_up_on_interrupt();
    let outcome = match &cli.command {
        Command::Render(args) => render::run(args),
        Command::Demo(args) => demo::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Info(args) => info::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Pattern(args) => pattern::run(args),
        Command::Bench(args) => bench::run(args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if failure.kind != Kind::Closed {
                out::note(format_args!("{}", failure.message));
            }
            ExitCode::from(failure.kind as u8)
        }
    }
}
