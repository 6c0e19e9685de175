//! Calibration loop: a small fixed workload on one core. On shared and throttled machines, frame times in multiples
//! of the time that it takes can be compared, while times in milliseconds cannot.

use std::hint::black_box;
use std::time::Instant;

/// Milliseconds of 2^19 dependent multiply-adds in each of eight lanes.
pub fn milliseconds() -> f64 {
    let start = Instant::now();
    let mut lanes = [0.5f32; 8];
    for _ in 0..1 << 19 {
        for lane in &mut lanes {
            *lane = black_box(0.999_9f32).mul_add(*lane, 1.0e-4);
        }
    }
    black_box(lanes);
    start.elapsed().as_secs_f64() * 1e3
}
