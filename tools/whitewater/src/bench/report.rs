//! Rows of the result as a table, CSV or JSON.

use clap::ValueEnum;
use serde::Serialize;

/// How to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For reading
    Table,
    /// Comma-separated, one row a pass
    Csv,
    /// One object with adapter, driver and rows
    Json,
}

/// One pass of one combination.
#[derive(Clone, Debug, Serialize)]
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
    /// Bytes it has to move at least.
    pub bytes: Option<u64>,
    /// Milliseconds of the calibration loop in this run.
    pub calibration: f64,
    /// Most smoothing iterations of a pixel.
    pub most_iterations: u32,
}

/// The value below which a share of the samples lies.
pub fn quantile(samples: &mut [f64], share: f64) -> f64 {
    samples.sort_by(f64::total_cmp);
    let last = samples.len().saturating_sub(1);
    samples.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

/// The middle sample.
pub fn median(samples: &mut [f64]) -> f64 {
    quantile(samples, 0.5)
}

/// Prints all rows to the standard output.
pub fn print(format: Format, adapter: &str, driver: &str, rows: &[Row]) {
    let version = env!("CARGO_PKG_VERSION");
    match format {
        Format::Table => table(adapter, driver, rows),
        Format::Csv => {
            println!(
                "adapter,driver,version,particles,width,height,path,pass,median_ms,p10_ms,p90_ms,\
                 bytes,calibration_ms,most_iterations"
            );
            for r in rows {
                let bytes = r.bytes.map_or_else(String::new, |b| b.to_string());
                println!(
                    "\"{adapter}\",\"{driver}\",{version},{},{},{},{},{},{:.4},{:.4},{:.4},{bytes},\
                     {:.4},{}",
                    r.particles,
                    r.width,
                    r.height,
                    r.path,
                    r.pass,
                    r.median,
                    r.low,
                    r.high,
                    r.calibration,
                    r.most_iterations
                );
            }
        }
        Format::Json => {
            let all = serde_json::json!({
                "adapter": adapter, "driver": driver, "version": version, "rows": rows,
            });
            println!("{all:#}");
        }
    }
}

fn table(adapter: &str, driver: &str, rows: &[Row]) {
    println!("{adapter}, {driver}");
    let mut head = None;
    for r in rows {
        let this = (r.particles, r.width, r.height, &r.path);
        if head != Some(this) {
            head = Some(this);
            println!(
                "\n{} particles, {}x{}, {}, at most {} iterations; calibration loop {:.2} ms",
                r.particles, r.width, r.height, r.path, r.most_iterations, r.calibration
            );
            println!(
                "{:<12}{:>10}{:>10}{:>10}{:>11}{:>10}",
                "pass", "median ms", "p10", "p90", "MB at least", "GB/s"
            );
        }
        let (moved, rate) = match r.bytes {
            Some(b) => (
                format!("{:.2}", b as f64 * 1e-6),
                format!("{:.2}", b as f64 * 1e-6 / r.median.max(1e-9)),
            ),
            None => ("-".into(), "-".into()),
        };
        println!(
            "{:<12}{:>10.3}{:>10.3}{:>10.3}{moved:>11}{rate:>10}",
            r.pass, r.median, r.low, r.high
        );
        if r.pass == "frame" {
            println!("{:<12}{:>10.2} calibration loops", "", r.median / r.calibration);
        }
    }
}
