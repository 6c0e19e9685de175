//! What unit tests share.

use std::sync::{Mutex, MutexGuard, PoisonError};

use whitewater::headless::{Device, DeviceOptions};

/// Debian's validation layer can crash if a thread makes a device while another one draws, so tests with a device
/// run one after the other.
static ALONE: Mutex<()> = Mutex::new(());

/// A device, and what keeps other tests from having one.
pub fn device() -> (MutexGuard<'static, ()>, Device) {
    let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let validation = std::env::var_os("WHITEWATER_REQUIRE_VALIDATION").is_some_and(|v| v == "1");
    let options = DeviceOptions { validation, ..DeviceOptions::default() };
    (alone, Device::new(&options).unwrap())
}
