//! Rows of results as a table, CSV or JSON.

use clap::ValueEnum;
use serde::Serialize;
use whitewater::headless::Headless;

use crate::failure::Outcome;
use crate::out;

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For reading
    Table,
    /// Comma-separated, one row per pass
    Csv,
    /// One object with adapter, driver and rows
    Json,
}

/// One pass of one combination.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    pub particles: u32,
    pub width: u32,
    pub height: u32,
    pub path: String,
    pub pass: String,
    /// Milliseconds.
    pub median: f64,
    /// 10 % quantile.
    pub low: f64,
    /// 90 % quantile.
    pub high: f64,
    /// Minimum bytes that the pass moves.
    pub bytes: Option<u64>,
    /// Milliseconds of the calibration loop in the same run.
    pub calibration: f64,
    /// Max number of smoothing iterations of a pixel.
    pub most_iterations: u32,
    /// Nanoseconds per whitewater particle, for the pass that runs over the particles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_whitewater: Option<f64>,
    /// Memory of the renderer and of the whitewater particles, bytes.
    pub memory: u64,
    pub inputs: u64,
    /// Columns of a sea.
    #[serde(flatten)]
    pub sea: Option<SeaRow>,
    /// Columns of bubble foam.
    #[serde(flatten)]
    pub blobs: Option<BlobRow>,
    /// Columns of a shore.
    #[serde(flatten)]
    pub shore: Option<ShoreRow>,
}

/// Additional columns of a sea.
#[derive(Clone, Debug, Serialize)]
pub struct SeaRow {
    pub sea: &'static str,
    /// Whitewater particles.
    pub whitewater: u32,
    pub occlusion: &'static str,
}

/// Additional columns of bubble foam.
#[derive(Clone, Debug, Serialize)]
pub struct BlobRow {
    pub bubble_scene: String,
    pub blobs: u32,
    /// Number of bubbles of all blobs together.
    pub bubbles: u32,
    pub layers: u32,
    pub impostor: &'static str,
    pub map: u32,
    pub steps: u32,
}

/// Additional columns of a shore.
#[derive(Clone, Debug, Serialize)]
pub struct ShoreRow {
    pub shore: &'static str,
    /// Source of the shore coordinate.
    pub way: &'static str,
    pub edge: &'static str,
    /// Requested (`cover`) and actual (`covered`) share of the picture that shows water with a shore coordinate v
    /// from 0 to 2; `None` without shoreline foam.
    pub cover: Option<f64>,
    pub covered: Option<f64>,
    /// Share of the picture that has foam.
    pub foam: f64,
    /// Number of particles of the water in the same run.
    pub water: u32,
    /// Time of the foam over the frame time of that water.
    pub ratio: f64,
}

impl Row {
    /// A copy of this row with the name of one pass, and the median and the 10 % and 90 % quantiles of the pass'
    /// times.
    pub fn of_pass(&self, pass: &str, times: &mut [f64]) -> Self {
        Self {
            pass: pass.to_owned(),
            median: median(times),
            low: quantile(times, 0.1),
            high: quantile(times, 0.9),
            ..self.clone()
        }
    }

    /// A row with only the renderer's data.
    pub fn of(headless: &Headless) -> Self {
        let memory = headless.renderer().memory();
        Self {
            memory: memory.images + memory.buffers,
            inputs: headless.whitewater_memory(),
            ..Self::default()
        }
    }
}

/// The quantile of the samples at `share`.
pub fn quantile(samples: &mut [f64], share: f64) -> f64 {
    samples.sort_by(f64::total_cmp);
    let last = samples.len().saturating_sub(1);
    samples.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

/// The median.
pub fn median(samples: &mut [f64]) -> f64 {
    quantile(samples, 0.5)
}

/// Results on standard output: rows of tables and CSV are printed as soon as they are measured, JSON at the end.
pub struct Report {
    format: Format,
    adapter: String,
    driver: String,
    /// Rows that are not printed yet.
    rows: Vec<Row>,
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

impl Report {
    /// Prints what precedes the rows.
    pub fn new(format: Format, adapter: String, driver: String) -> Outcome<Self> {
        match format {
            Format::Table => out::print(format_args!("{adapter}, {driver}\n"))?,
            Format::Csv => out::print(format_args!(
                "adapter,driver,version,particles,width,height,path,pass,median_ms,p10_ms,p90_ms,\
                 bytes,calibration_ms,most_iterations,memory_bytes,sea,whitewater,occlusion,\
                 input_bytes,ns_per_whitewater,bubble_scene,blobs,bubbles,layers,impostor,map,steps,\
                 shore,way,edge,cover,covered,foam,water,ratio\n"
            ))?,
            Format::Json => {}
        }
        Ok(Self { format, adapter, driver, rows: Vec::new() })
    }

    /// Adds the rows of one combination.
    pub fn add(&mut self, rows: Vec<Row>) -> Outcome<()> {
        match self.format {
            Format::Table => out::print(format_args!("{}", table(&rows))),
            Format::Csv => {
                let (adapter, driver) = (&self.adapter, &self.driver);
                let lines = rows.iter().map(|row| csv(adapter, driver, row)).collect::<String>();
                out::print(format_args!("{lines}"))
            }
            Format::Json => {
                self.rows.extend(rows);
                Ok(())
            }
        }
    }

    /// Prints what follows the rows.
    pub fn finish(&self) -> Outcome<()> {
        if self.format != Format::Json {
            return Ok(());
        }
        let all = serde_json::json!({
            "adapter": self.adapter, "driver": self.driver, "version": VERSION, "rows": self.rows,
        });
        out::print(format_args!("{all:#}\n"))
    }
}

fn csv(adapter: &str, driver: &str, r: &Row) -> String {
    let bytes = r.bytes.map_or_else(String::new, |b| b.to_string());
    let each = r.ns_per_whitewater.map_or_else(String::new, |each| format!("{each:.3}"));
    let sea = match &r.sea {
        Some(sea) => {
            format!("{},{},{},{},{each}", sea.sea, sea.whitewater, sea.occlusion, r.inputs)
        }
        None => ",,,,".into(),
    };
    let blobs = r.blobs.as_ref().map_or_else(
        || ",,,,,,".into(),
        |b| {
            let BlobRow { bubble_scene, blobs, bubbles, layers, impostor, map, steps } = b;
            format!("{bubble_scene},{blobs},{bubbles},{layers},{impostor},{map},{steps}")
        },
    );
    let share = |share: Option<f64>| share.map_or_else(String::new, |share| format!("{share:.5}"));
    let shore = r.shore.as_ref().map_or_else(
        || ",,,,,,,".into(),
        |s| {
            let ShoreRow { shore, way, edge, cover, covered, foam, water, ratio } = s;
            let (cover, covered) = (share(*cover), share(*covered));
            format!("{shore},{way},{edge},{cover},{covered},{foam:.5},{water},{ratio:.5}")
        },
    );
    format!(
        "\"{adapter}\",\"{driver}\",{VERSION},{},{},{},{},{},{:.4},{:.4},{:.4},{bytes},{:.4},{},{},{sea},{blobs},{shore}\n",
        r.particles,
        r.width,
        r.height,
        r.path,
        r.pass,
        r.median,
        r.low,
        r.high,
        r.calibration,
        r.most_iterations,
        r.memory
    )
}

/// The table of one combination.
fn table(rows: &[Row]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let mb = |bytes: u64| bytes as f64 * 1e-6;
    let mut text = match (&first.sea, &first.blobs, &first.shore) {
        (Some(sea), ..) => format!(
            "\n{}, {} whitewater particles, {}x{}, {} occlusion; renderer {:.1} MB, particles {:.1} MB ({:.1} a million)",
            sea.sea,
            sea.whitewater,
            first.width,
            first.height,
            sea.occlusion,
            mb(first.memory),
            mb(first.inputs),
            first.inputs as f64 / f64::from(sea.whitewater.max(1))
        ),
        (None, Some(b), _) => format!(
            "\n{}, {} blobs of {} bubbles in all, {}x{}, {}, {} layers, {} of {} texels in {} steps; renderer {:.1} MB",
            b.bubble_scene,
            b.blobs,
            b.bubbles,
            first.width,
            first.height,
            first.path,
            b.layers,
            b.impostor,
            b.map,
            b.steps,
            mb(first.memory)
        ),
        (None, None, Some(s)) => shore(first, s),
        (None, None, None) => format!(
            "\n{} particles, {}x{}, {}, at most {} iterations",
            first.particles, first.width, first.height, first.path, first.most_iterations
        ),
    };
    text += &format!("; calibration loop {:.2} ms\n", first.calibration);
    let [a, b, c, d, e] = ["median ms", "p10", "p90", "MB at least", "GB/s"];
    let wide = rows.iter().map(|row| row.pass.len() + 1).fold(12, usize::max);
    text += &format!("{:<wide$}{a:>10}{b:>10}{c:>10}{d:>11}{e:>10}\n", "pass");
    for r in rows {
        let (moved, rate) = match r.bytes {
            Some(b) => (
                format!("{:.2}", b as f64 * 1e-6),
                format!("{:.2}", b as f64 * 1e-6 / r.median.max(1e-9)),
            ),
            None => ("-".into(), "-".into()),
        };
        text += &format!(
            "{:<wide$}{:>10.3}{:>10.3}{:>10.3}{moved:>11}{rate:>10}\n",
            r.pass, r.median, r.low, r.high
        );
        if let Some(each) = r.ns_per_whitewater {
            text += &format!("{:<wide$}{each:>10.2} ns a particle\n", "");
        }
        if r.pass == "frame" {
            text += &format!("{:<wide$}{:>10.2} calibration loops\n", "", r.median / r.calibration);
        }
    }
    if let (Some(s), Some(all)) = (&first.shore, rows.iter().find(|row| row.pass == FOAM)) {
        text += &format!(
            "{FOAM} {:.2} ms: {:.3} of the frame of {} particles\n",
            all.median, s.ratio, s.water
        );
    }
    text
}

/// Name of the row with the total cost of shore foam.
pub const FOAM: &str = "foam";

fn shore(row: &Row, s: &ShoreRow) -> String {
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let covered = s.covered.map_or_else(String::new, |covered| {
        let asked =
            s.cover.map_or_else(String::new, |asked| format!(" ({} asked)", percent(asked)));
        format!("v from 0 to 2 over {}{asked} of the picture, ", percent(covered))
    });
    let (ShoreRow { shore, way, edge, foam, .. }, Row { width, height, path, .. }) = (s, row);
    format!(
        "\n{shore}, {width}x{height}, {path}: v by {way}, {edge} edges; {covered}foam on {}",
        percent(*foam)
    )
}
