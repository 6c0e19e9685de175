//! The devices under test. Only one test uses a device at a time, so that a validation message
//! belongs to the running test; each test ends with the assertion that there was none. There are
//! several devices, so that tests run in parallel: compiling shaders is most of the work, on the
//! test's thread.

use std::ops::Deref;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, Once, OnceLock, PoisonError, TryLockError};
use std::thread::available_parallelism;

use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use whitewater::headless::{Device, DeviceOptions};
use whitewater::{Allocate, Context, Error, Host};

use super::turn::{self, Turn};
use super::watchdog::Watch;

const MOST_SHARED: usize = 4;

/// Number of tests that share a context. With the pipelines of all tests alive, Mesa 22.3 jumped to
/// freed code in one of three runs: it keeps a limited number of compiled variants and frees the
/// oldest.
const TESTS_OF_A_CONTEXT: u32 = 8;
static SHARED: [Shared; MOST_SHARED] = [const { Shared::new() }; MOST_SHARED];

/// A device that tests use one after another.
struct Shared {
    device: OnceLock<Device>,
    /// The context, and the number of tests that have used it.
    context: Mutex<(Option<Context>, u32)>,
    one_at_a_time: Mutex<()>,
}

/// A device for the time of one test.
pub struct Gpu {
    device: Option<Held>,
    /// Functions and allocator handed to the library; a spy replaces them.
    pub functions: ash::Device,
    pub allocator: Arc<Mutex<Allocator>>,
    /// The allocator that is handed to the library instead of the device's own.
    pub other_allocator: Option<Arc<dyn Allocate>>,
    /// Instance functions that are handed to the library instead of the instance's own.
    pub claims: Option<ash::Instance>,
    /// Whether the test leaks objects on purpose.
    pub leaks: bool,
    /// The context of a device of the test's own, if its renderers share one.
    own_context: Mutex<Option<Context>>,
    _lock: Option<MutexGuard<'static, ()>>,
    _watch: Arc<Watch>,
    _turn: Turn,
}

enum Held {
    Shared(&'static Device, &'static Shared),
    Own(Box<Device>),
}

/// Whether messages of the validation layer arrive.
pub fn validates() -> bool {
    static VALIDATES: OnceLock<bool> = OnceLock::new();
    *VALIDATES.get_or_init(|| {
        let _alone = turn::during();
        let device = Device::new(&DeviceOptions { validation: true, ..Default::default() });
        match device {
            Ok(_) => true,
            Err(Error::Missing { what, why }) if what.contains("validation") => {
                let required =
                    std::env::var_os("WHITEWATER_REQUIRE_VALIDATION").is_some_and(|v| v == "1");
                assert!(!required, "validation is required, but {what} is missing: {why}");
                eprintln!("gpu: NO VALIDATION: {what} is missing ({why})");
                false
            }
            Err(error) => panic!("no device: {error}"),
        }
    })
}

/// Version of the validation layer, from its manifest.
pub fn layer_version() -> u32 {
    // SAFETY: the loader stays loaded because the tests' devices hold it.
    let layers =
        unsafe { ash::Entry::load().expect("a loader").enumerate_instance_layer_properties() };
    let named = |layer: &vk::LayerProperties| {
        layer.layer_name_as_c_str().is_ok_and(|name| name == c"VK_LAYER_KHRONOS_validation")
    };
    layers.expect("layers").iter().find(|layer| named(layer)).map_or(0, |layer| layer.spec_version)
}

/// Whether the validation layer checks storage accesses of shaders. Since version 1.4 it does so
/// only if an environment variable is set, which tools/test does.
pub fn sees_storage() -> bool {
    let switch = std::env::var_os("VK_LAYER_SYNCVAL_SHADER_ACCESSES_HEURISTIC");
    validates()
        && (layer_version() < vk::make_api_version(0, 1, 4, 0) || switch.is_some_and(|v| v == "1"))
}

fn make(options: &DeviceOptions) -> Device {
    let options = DeviceOptions { validation: validates(), ..options.clone() };
    let device = Device::new(&options).unwrap_or_else(|error| panic!("no device: {error}"));
    if let Ok(expected) = std::env::var("WHITEWATER_EXPECT_ADAPTER") {
        let found = format!("{} ({})", device.adapter, device.driver);
        assert!(
            found.to_lowercase().contains(&expected.to_lowercase()),
            "expected the adapter {expected}, found {found}"
        );
    }
    device
}

impl Shared {
    const fn new() -> Self {
        Self {
            device: OnceLock::new(),
            context: Mutex::new((None, 0)),
            one_at_a_time: Mutex::new(()),
        }
    }

    /// Replaces the context after a number of tests.
    fn renew_context(&self) {
        let mut context = self.context.lock().unwrap_or_else(PoisonError::into_inner);
        context.1 += 1;
        if context.1 > TESTS_OF_A_CONTEXT {
            *context = (None, 1);
        }
    }

    /// All shared devices. They are made together, while no test calls Vulkan.
    fn all() -> &'static [Self] {
        static MADE: Once = Once::new();
        let all = &SHARED[..available_parallelism().map_or(1, |n| n.get().min(MOST_SHARED))];
        MADE.call_once(|| {
            validates();
            let _alone = turn::during();
            for shared in all {
                let device = shared.device.get_or_init(|| make(&DeviceOptions::default()));
                eprintln!("gpu: adapter {} ({})", device.adapter, device.driver);
            }
        });
        all
    }

    /// The first device that no test uses, or else the next one that becomes free.
    fn take() -> (Held, MutexGuard<'static, ()>) {
        let all = Self::all();
        let free = |shared: &'static Self| match shared.one_at_a_time.try_lock() {
            Ok(lock) => Some((shared, lock)),
            Err(TryLockError::Poisoned(lock)) => Some((shared, lock.into_inner())),
            Err(TryLockError::WouldBlock) => None,
        };
        let (shared, lock) = all.iter().find_map(free).unwrap_or_else(|| {
            let lock = all[0].one_at_a_time.lock();
            (&all[0], lock.unwrap_or_else(PoisonError::into_inner))
        });
        shared.renew_context();
        (Held::Shared(shared.device.get().expect("made"), shared), lock)
    }
}

fn messages_of(device: &Device) -> Vec<String> {
    device.take_messages()
}

static HALVES: AtomicBool = AtomicBool::new(false);

/// Whether the tests' device may filter 16-bit floats in half precision, which Vulkan leaves open:
/// an H200 does; CPU implementations filter in single precision. False before the first device.
pub fn filters_in_halves() -> bool {
    HALVES.load(Ordering::Relaxed)
}

impl Gpu {
    fn new(turn: Turn, lock: Option<MutexGuard<'static, ()>>, device: Held) -> Self {
        let (functions, allocator) = match &device {
            Held::Shared(device, _) => (device.device.clone(), device.allocator.clone()),
            Held::Own(device) => (device.device.clone(), device.allocator.clone()),
        };
        let gpu = Self {
            device: Some(device),
            functions,
            allocator,
            other_allocator: None,
            claims: None,
            leaks: false,
            own_context: Mutex::new(None),
            _lock: lock,
            _watch: Watch::begin(),
            _turn: turn,
        };
        // SAFETY: the physical device belongs to the instance.
        let properties = unsafe { gpu.instance.get_physical_device_properties(gpu.physical) };
        HALVES.store(properties.device_type != vk::PhysicalDeviceType::CPU, Ordering::Relaxed);
        gpu
    }

    /// One of the devices that most tests share.
    pub fn shared() -> Self {
        Shared::all();
        let turn = turn::beside();
        let (device, lock) = Shared::take();
        let gpu = Self::new(turn, Some(lock), device);
        drop(messages_of(&gpu));
        gpu
    }

    /// A device of the test's own. Everything made from it must be gone at the end.
    pub fn own() -> Self {
        Self::own_with(&DeviceOptions::default())
    }

    /// A device of the test's own, created with these options. The test must not hold a
    /// shared device.
    pub fn own_with(options: &DeviceOptions) -> Self {
        Shared::all();
        let turn = turn::alone();
        Self::new(turn, None, Held::Own(Box::new(make(options))))
    }

    /// Panics on a shared device: spies and claims are global to the process, so their test must run
    /// alone.
    pub fn assert_own(&self) {
        let own = matches!(self.device, Some(Held::Own(_)));
        assert!(own, "Gpu::own() is for spies and claims");
    }

    /// The host's side of the contract.
    pub fn host(&self, frames_in_flight: u32) -> Host<'_> {
        Device::host(self, frames_in_flight).with(|it| {
            it.instance = self.claims.as_ref().unwrap_or(&self.instance);
            it.device = &self.functions;
            it.allocator =
                Some(self.other_allocator.clone().unwrap_or_else(|| self.allocator.clone()));
        })
    }

    /// A host's context. Tests on a shared device share one; a test with its own device gets a new
    /// one unless it called [`share_context`](Self::share_context).
    pub fn context(&self, frames_in_flight: u32) -> Context {
        let shared =
            |context: &Context| context.with_frames_in_flight(frames_in_flight).expect("1 to 8");
        if let Some(Held::Shared(_, of_device)) = &self.device {
            let mut context = of_device.context.lock().unwrap_or_else(PoisonError::into_inner);
            return shared(context.0.get_or_insert_with(|| self.new_context(frames_in_flight)));
        }
        let own = self.own_context.lock().unwrap_or_else(PoisonError::into_inner);
        own.as_ref().map_or_else(|| self.new_context(frames_in_flight), shared)
    }

    fn new_context(&self, frames_in_flight: u32) -> Context {
        // SAFETY: tests keep their device until everything made from it has been destroyed.
        unsafe { Context::new(&self.host(frames_in_flight)) }.expect("a context")
    }

    /// On a device of the test's own: renderers share a new context from now on, and so do not
    /// compile pipelines again. It sees the spy, claims and allocator that are set now.
    pub fn share_context(&self) {
        let own = Some(self.new_context(1));
        *self.own_context.lock().unwrap_or_else(PoisonError::into_inner) = own;
    }

    /// On a device of the test's own: each renderer gets a context of its own from now on.
    pub fn drop_context(&self) {
        *self.own_context.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Moves the device out of the fixture, for tests with a device of their own.
    pub fn take_device(&mut self) -> Device {
        match self.device.take() {
            Some(Held::Own(device)) => *device,
            _ => panic!("a shared device stays"),
        }
    }

    /// Returns the messages so far. They no longer fail the test.
    pub fn expect_messages(&self) -> Vec<String> {
        messages_of(self)
    }

    /// Names of live allocations.
    pub fn allocations(&self) -> Vec<String> {
        let allocator = self.allocator.lock().unwrap_or_else(PoisonError::into_inner);
        allocator.generate_report().allocations.into_iter().map(|a| a.name).collect()
    }

    /// An allocator on a device's functions.
    pub fn make_allocator(&self, functions: &ash::Device) -> Allocator {
        Allocator::new(&AllocatorCreateDesc {
            instance: self.instance.clone(),
            device: functions.clone(),
            physical_device: self.physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        })
        .unwrap_or_else(|error| panic!("no allocator: {error}"))
    }

    /// Features of a format for optimal tiling.
    pub fn format_features(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        // SAFETY: live handles.
        unsafe { self.instance.get_physical_device_format_properties(self.physical, format) }
            .optimal_tiling_features
    }

    /// Max overhead of images of this extent, its half and its quarter, as a fraction of their
    /// bytes. Devices round rows and columns up to whole tiles: 720 rows take 768 if a tile is 128
    /// high.
    pub fn padding(&self, extent: vk::Extent2D) -> f64 {
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::STORAGE;
        let part = |(level, format, bytes): (u32, vk::Format, u64)| {
            let [width, height] = [extent.width, extent.height].map(|n| n.div_ceil(1 << level));
            let info = vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_2D)
                .format(format)
                .extent(vk::Extent3D { width, height, depth: 1 })
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::TYPE_1)
                .usage(usage);
            let asked = vk::DeviceImageMemoryRequirements::default().create_info(&info);
            let mut needs = vk::MemoryRequirements2::default();
            // SAFETY: valid create info for Vulkan 1.3.
            unsafe { self.functions.get_device_image_memory_requirements(&asked, &mut needs) };
            let needed = bytes * u64::from(width) * u64::from(height);
            needs.memory_requirements.size as f64 / needed as f64 - 1.0
        };
        let formats = [(vk::Format::R32_SFLOAT, 4), (vk::Format::R16G16B16A16_SFLOAT, 8)];
        (0..3)
            .flat_map(|level| formats.map(|(format, bytes)| part((level, format, bytes))))
            .fold(0.0, f64::max)
    }

    /// Limits of the device.
    pub fn limits(&self) -> vk::PhysicalDeviceLimits {
        // SAFETY: live handles.
        unsafe { self.instance.get_physical_device_properties(self.physical) }.limits
    }
}

impl Deref for Gpu {
    type Target = Device;

    fn deref(&self) -> &Device {
        match &self.device {
            Some(Held::Shared(device, _)) => device,
            Some(Held::Own(device)) => device,
            None => unreachable!("only drop takes the device"),
        }
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        let failed = std::thread::panicking();
        self.drop_context();
        if self.device.is_none() {
            return;
        }
        let left = self.allocations();
        let mut messages = messages_of(self);
        if let Some(Held::Own(device)) = self.device.take() {
            if !failed && !self.leaks {
                // The allocator's memory blocks must be freed before the device is destroyed.
                let spied = self.allocator.clone();
                let real = device.allocator.clone();
                for (allocator, functions) in [(spied, &self.functions), (real, &device.device)] {
                    let empty = Allocator::new(&AllocatorCreateDesc {
                        instance: device.instance.clone(),
                        device: functions.clone(),
                        physical_device: device.physical,
                        debug_settings: Default::default(),
                        buffer_device_address: false,
                        allocation_sizes: Default::default(),
                    });
                    if let Ok(empty) = empty {
                        *allocator.lock().unwrap_or_else(PoisonError::into_inner) = empty;
                    }
                }
                // SAFETY: the test is over and its renderers are gone; the layer reports anything
                // left as a leak.
                unsafe {
                    let _ = device.device.device_wait_idle();
                    device.device.destroy_device(None);
                }
                messages.extend(messages_of(&device));
            }
            std::mem::forget(device);
        }
        if failed {
            for message in messages.iter().take(5) {
                eprintln!("validation: {message}");
            }
            return;
        }
        assert!(messages.is_empty(), "validation messages:\n{}", messages.join("\n"));
        assert!(self.leaks || left.is_empty(), "memory that was not freed: {left:?}");
    }
}
