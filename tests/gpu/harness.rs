//! Tests of the checks themselves: each must detect a planted fault.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::Command;
use std::sync::{Once, mpsc};
use std::time::{Duration, Instant};

use ash::vk;
use glam::DVec3;
use whitewater::Access;

use crate::depth::spheres;
use crate::reference::Image;
use crate::support::compare;
use crate::support::device::{Gpu, validates};
use crate::support::host::COLOR;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens};
use crate::support::skipped::skipped;
use crate::support::tolerance;
use crate::support::turn;
use crate::support::watchdog::{self, Watch};

/// Whether a check panics, without printing. The panic hook is shared by all threads and set once,
/// because other tests may panic at the same time.
pub fn fails(check: impl FnOnce()) -> bool {
    thread_local!(static QUIET: Cell<bool> = const { Cell::new(false) });
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let hook = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !QUIET.get() {
                hook(info);
            }
        }));
    });
    QUIET.set(true);
    let result = catch_unwind(AssertUnwindSafe(check));
    QUIET.set(false);
    result.is_err()
}

fn water(size: vk::Extent2D) -> Shot {
    let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    Shot::new(size, Lens::Standard, 0.2, &points)
}

#[test]
fn the_adapter_is_named_and_is_the_expected_one() {
    let gpu = Gpu::shared();
    assert!(!gpu.adapter.is_empty() && !gpu.driver.is_empty());
    eprintln!("gpu: {} ({}), validation: {}", gpu.adapter, gpu.driver, validates());
}

#[test]
fn a_changed_pixel_is_seen() {
    let image = Image::from_fn(9, 7, |x, y| [x as f32, y as f32, 0.5, 1.0]);
    compare::same_color("planted-same", &image, &image);
    let wide = image.map(|c| c.map(f64::from));
    for channel in 0..4 {
        let mut changed = image.clone();
        let pixel = &mut changed.at_mut(8, 6)[channel];
        *pixel = f32::from_bits(pixel.to_bits() + 1);
        assert!(fails(|| compare::same_color("planted-pixel", &changed, &image)));
        assert!(fails(|| {
            compare::close_color("planted-pixel", &changed, &wide, |_, _| [1e-9; 4]);
        }));
    }
    let mut nan = image.clone();
    nan.at_mut(0, 0)[2] = f32::NAN;
    assert!(fails(|| {
        compare::close_color("planted-nan", &nan, &wide, |_, _| [1e9; 4]);
    }));
    let floats = image.map(|c| c[0]);
    let mut empty = floats.clone();
    *empty.at_mut(3, 3) = 1e10;
    let expected = floats.map(|v| f64::from(*v));
    assert!(fails(|| {
        compare::close("planted-coverage", &empty, &expected, 0, |_, _, _| 1.0);
    }));
}

fn shifted(image: &Image<f32>, dx: isize, dy: isize) -> Image<f32> {
    Image::from_fn(image.width, image.height, |x, y| {
        image.clamped(x as isize + dx, y as isize + dy)
    })
}

#[test]
fn a_shifted_image_is_not_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let config = config(size).with(|it| {
        it.smoothing_level = 0;
        it.thickness_level = 0;
    });
    let mut rig = Rig::new(&gpu, &config);
    let shot = water(size);
    let drawn = rig.draw(&shot);
    let view = shot.view(size);
    let water = spheres(&shot);
    let depth = tolerance::depth(&water, &view);
    let thickness = tolerance::thickness(&shot.splats(&water, 0, tolerance::Sum::Fixed));
    compare::between("planted-depth", &drawn.depth, &depth);
    compare::between("planted-thickness", &drawn.thickness, &thickness);
    for (dx, dy) in [(1, 0), (0, 1), (-1, 0), (0, -1)] {
        let (d, t) = (shifted(&drawn.depth, dx, dy), shifted(&drawn.thickness, dx, dy));
        assert!(fails(|| compare::between("planted-depth", &d, &depth)));
        assert!(fails(|| compare::between("planted-thickness", &t, &thickness)));
    }
    // A centre or a radius that is off by a thousandth of the radius.
    for (move_x, grow) in [(2e-4, 0.0), (0.0, 2e-4)] {
        let mut other = spheres(&shot);
        for sphere in &mut other {
            sphere.center += DVec3::X * move_x;
            sphere.radius += grow;
        }
        let wrong = tolerance::depth(&other, &view);
        assert!(fails(|| compare::between("planted-depth", &drawn.depth, &wrong)));
    }
}

/// Access of a clear. ALL_TRANSFER, because older layers do not count clears as a stage of their
/// own.
const CLEARED: Access = Access::new(
    vk::PipelineStageFlags2::ALL_TRANSFER,
    vk::AccessFlags2::TRANSFER_WRITE,
    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
);
/// A wrong access that a host may declare for a clear.
const UNORDERED: Access = Access::new(
    vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
    CLEARED.layout,
);

/// Draws for a host that makes a mistake, and returns the validation layer's messages. The images
/// may have wrong contents; the frame is recorded and submitted, and the device stays usable.
fn mistaken(gpu: &Gpu, before: Access, write: bool, apart: bool) -> Vec<String> {
    let size = extent(32, 16);
    let mut rig = Rig::with_slots(gpu, &config(size), 2);
    let shot = water(size);
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let mut output = color.host_image();
    output.before = before;
    output.after = COLOR;
    let frame = shot.frame(output, depth.host_image(), cloud.particles());
    let clear = |rig: &Rig<'_>, cmd| {
        rig.stub.barrier(cmd, color.image, color.aspect, COLOR, CLEARED);
        let range = vk::ImageSubresourceRange {
            aspect_mask: color.aspect,
            level_count: 1,
            layer_count: 1,
            ..Default::default()
        };
        // SAFETY: the image is in the layout of the clear.
        unsafe {
            let value = vk::ClearColorValue { float32: [0.5; 4] };
            let image = color.image;
            rig.stub.functions().cmd_clear_color_image(
                cmd,
                image,
                CLEARED.layout,
                &value,
                &[range],
            );
        }
    };
    if write && apart {
        let cmd = rig.stub.begin(1);
        clear(&rig, cmd);
        rig.stub.end(1);
    }
    let cmd = rig.stub.begin(0);
    if write && !apart {
        clear(&rig, cmd);
    }
    // SAFETY: invalid on purpose, in ways that the layer reports and lavapipe survives.
    unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    rig.stub.end(0);
    rig.stub.wait(0);
    rig.stub.wait(1);
    drop(rig);
    gpu.expect_messages()
}

fn without_validation() -> bool {
    if !validates() {
        skipped("no validation layer");
    }
    !validates()
}

#[test]
fn a_wrong_layout_of_the_hosts_is_reported() {
    if without_validation() {
        return;
    }
    let gpu = Gpu::shared();
    assert_eq!(mistaken(&gpu, COLOR, false, false), Vec::<String>::new(), "no mistake, no message");
    let wrong = Access { layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL, ..COLOR };
    let messages = mistaken(&gpu, wrong, false, false);
    assert!(messages.iter().any(|m| m.contains("layout")), "{messages:?}");
}

#[test]
fn a_missing_barrier_of_the_hosts_is_reported() {
    if without_validation() {
        return;
    }
    let gpu = Gpu::shared();
    let messages = mistaken(&gpu, CLEARED, true, false);
    assert_eq!(messages, Vec::<String>::new(), "no mistake, no message");
    let messages = mistaken(&gpu, UNORDERED, true, false);
    assert!(messages.iter().any(|m| is_hazard(m)), "{messages:?}");
}

/// Old layers give the message's id, newer ones its text.
pub fn is_hazard(message: &str) -> bool {
    message.contains("SYNC-HAZARD") || message.contains("hazard detected")
}

/// Needs the layer's switch for hazards between submissions.
#[test]
fn a_missing_barrier_between_submissions_is_reported() {
    let switch = "SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT";
    let on = std::env::var("VK_LAYER_ENABLES").is_ok_and(|v| v.contains(switch));
    if without_validation() || !on {
        skipped(&format!("VK_LAYER_ENABLES is without {switch}, or there is no validation layer"));
        return;
    }
    let gpu = Gpu::shared();
    let messages = mistaken(&gpu, UNORDERED, true, true);
    assert!(messages.iter().any(|m| is_hazard(m)), "{messages:?}");
}

#[test]
fn a_core_error_is_reported_and_fails_the_test() {
    if without_validation() {
        return;
    }
    let spoil = |gpu: &Gpu| {
        // SAFETY: invalid on purpose: a buffer without size and usage.
        unsafe {
            let info = vk::BufferCreateInfo::default();
            if let Ok(buffer) = gpu.device.create_buffer(&info, None) {
                gpu.device.destroy_buffer(buffer, None);
            }
        }
    };
    let gpu = Gpu::shared();
    spoil(&gpu);
    assert!(gpu.expect_messages().iter().any(|m| m.contains("VkBufferCreateInfo")));
    drop(gpu);
    // A message makes the test fail at its end, when the Gpu is dropped.
    let failed = fails(|| {
        let gpu = Gpu::shared();
        spoil(&gpu);
        drop(gpu);
    });
    assert!(failed, "a message must fail the test");
}

/// A leak on a test's own device is reported at its end.
#[test]
fn a_leak_fails_the_test() {
    let failed = fails(|| {
        let gpu = Gpu::own();
        let size = extent(8, 8);
        Rig::new(&gpu, &config(size)).leak();
        drop(gpu);
    });
    assert!(failed, "a renderer that was not destroyed is a leak");
}

/// While a test has a device of its own, no other test calls Vulkan: the other one waits until the first one's thread
/// ends, and then goes on.
#[test]
fn a_test_with_its_own_device_runs_alone() {
    let (has, owns) = mpsc::channel();
    let (end, ends) = mpsc::channel::<()>();
    let first = std::thread::spawn(move || {
        drop(Gpu::own());
        let _ = has.send(());
        let _ = ends.recv();
    });
    // No limits of time here: both wait for the tests that already run. The watchdog ends a test that hangs.
    owns.recv().expect("the first test has a device");
    let (tell, told) = mpsc::channel();
    let second = std::thread::spawn(move || {
        let _ = tell.send("asks");
        let _turn = turn::beside();
        let _ = tell.send("runs");
    });
    assert_eq!(told.recv(), Ok("asks"));
    let waits = told.recv_timeout(Duration::from_millis(200));
    assert_eq!(waits, Err(mpsc::RecvTimeoutError::Timeout), "it ran beside the first one");
    drop(end);
    first.join().expect("the first test ends");
    assert_eq!(told.recv(), Ok("runs"));
    second.join().expect("the second test ends");
}

/// Runs in a child process, which the watchdog ends.
#[test]
fn the_watchdog_ends_a_test_that_hangs() {
    if std::env::var_os("WHITEWATER_HANG").is_some() {
        let _watch = Watch::begin();
        watchdog::waiting(|| std::thread::sleep(Duration::from_secs(30)));
        return;
    }
    let begun = Instant::now();
    // It aborts; the shell keeps it from leaving a core dump in the project.
    let hung = Command::new("sh")
        .args(["-c", "ulimit -c 0; exec \"$0\" \"$@\""])
        .arg(std::env::current_exe().expect("this program"))
        .args(["--exact", "harness::the_watchdog_ends_a_test_that_hangs"])
        .envs([("WHITEWATER_HANG", "1"), ("WHITEWATER_WATCHDOG", "1")])
        .output()
        .expect("runs");
    let says = String::from_utf8_lossy(&hung.stderr);
    assert!(!hung.status.success() && begun.elapsed() < Duration::from_secs(20), "{says}");
    let named = "watchdog: harness::the_watchdog_ends_a_test_that_hangs waits for the GPU";
    assert!(says.contains(named), "{says}");
}
