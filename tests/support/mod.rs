//! Foundations of the GPU tests: a device that collects validation messages, a host stub, a spy in
//! the device's function table, comparisons that write pictures, rounding bounds, and scenes.

pub mod compare;
pub mod device;
pub mod host;
pub mod limits;
pub mod rig;
pub mod rounded;
pub mod scenes;
pub mod shaded;
pub mod skipped;
pub mod spy;
pub mod tolerance;
pub mod turn;
pub mod watchdog;

/// Whether long tests are enabled.
pub fn slow() -> bool {
    std::env::var_os("WHITEWATER_SLOW").is_some_and(|value| value == "1")
}
