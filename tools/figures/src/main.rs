//! The figures of `docs/layered-water.md`, `docs/whitewater.md`, `docs/bubble-foam.md` and `docs/shore-foam.md`: those
//! of the sources (F. Bagar, 2010; Akinci et al., 2013; Huszár, Szécsi; a blog; D. Lettier), drawn with `whitewater`.
//!
//! ```sh
//! cargo build --release -p whitewater-cli -p whitewater-figures -p whitewater-raycast
//! target/release/whitewater-figures --caches DIR            # all of them, into docs/
//! target/release/whitewater-figures --caches DIR --only thresholds
//! target/release/whitewater-figures --caches DIR --gallery --public CACHES   # docs/gallery.md
//! ```
//!
//! Scenes that are missing in DIR are simulated first, which takes some minutes each. The command-line tool draws the
//! figures; this program only arranges them.

mod bubbles;
mod curves;
mod figures;
mod gallery;
mod panels;
mod shore;
mod tool;
mod whitewater_figures;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

use crate::tool::Tool;

/// Result of everything here: an error is a line for the user.
type Outcome<T> = Result<T, String>;

/// Draws the figures of the documents.
#[derive(Parser)]
struct Args {
    /// Folder of the simulated scenes; missing scenes are simulated
    #[arg(long)]
    caches: PathBuf,
    /// Folder of the documents
    #[arg(long, default_value = "docs")]
    docs: PathBuf,
    /// Draw only this figure, or this picture of the gallery
    #[arg(long)]
    only: Option<String>,
    /// Draw the gallery's pictures and page instead of the figures
    #[arg(long, requires = "public")]
    gallery: bool,
    /// Folder of the public caches for the gallery, under the names that its page shows
    #[arg(long, requires = "gallery")]
    public: Option<PathBuf>,
    /// Program that draws [default: `whitewater` beside this one]
    #[arg(long)]
    tool: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("figures: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Outcome<()> {
    let tool = Tool::new(args.tool.as_deref(), &args.caches)?;
    if let Some(public) = args.public.as_deref().filter(|_| args.gallery) {
        return gallery::draw(&tool, &args.docs, public, args.only.as_deref());
    }
    let wanted = |name: &str| args.only.as_deref().is_none_or(|only| only == name);
    let all: Vec<_> = figures::ALL.iter().filter(|(name, _)| wanted(name)).collect();
    if all.is_empty() {
        let names: Vec<_> = figures::ALL.iter().map(|(name, _)| *name).collect();
        return Err(format!("there is no such figure; there are {}", names.join(", ")));
    }
    let mut failed = Vec::new();
    for (name, draw) in all {
        eprintln!("figures: {name}");
        if let Err(message) = draw(&tool, &args.docs) {
            eprintln!("figures: {name}: {message}");
            failed.push(*name);
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("not drawn: {}", failed.join(", "))) }
}
