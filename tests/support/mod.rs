//! What the GPU tests stand on: a device with its messages, a host stub, a spy on the device's
//! function table, comparisons that leave pictures behind, rounding bounds and scenes.

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
pub mod watchdog;

/// Whether the long tests are asked for.
pub fn slow() -> bool {
    std::env::var_os("WHITEWATER_SLOW").is_some_and(|value| value == "1")
}
