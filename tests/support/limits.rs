//! Lets a device claim stricter limits than it has, by replacing functions of the instance's
//! function table. Only one test at a time may use this module.

use std::sync::Mutex;

use ash::vk;

use super::device::Gpu;

/// Claimed limits. `None`: the real limit.
#[derive(Clone, Copy, Default)]
pub struct Claims {
    /// Offset alignment of storage and of uniform buffers.
    pub offset_alignment: Option<u64>,
    pub max_storage_buffer_range: Option<u32>,
    /// Timestamp bits of all queue families.
    pub timestamp_valid_bits: Option<u32>,
    pub timestamp_period: Option<f32>,
    /// A format that cannot be a blended colour attachment.
    pub unblended: Option<vk::Format>,
    /// All other limits.
    pub limits: Option<vk::PhysicalDeviceLimits>,
}

type Properties = unsafe extern "system" fn(vk::PhysicalDevice, *mut vk::PhysicalDeviceProperties);
type Families =
    unsafe extern "system" fn(vk::PhysicalDevice, *mut u32, *mut vk::QueueFamilyProperties);

type Formats = unsafe extern "system" fn(vk::PhysicalDevice, vk::Format, *mut vk::FormatProperties);

/// The driver's functions.
type Real = (Properties, Families, Formats);

static CLAIMED: Mutex<(Claims, Option<Real>)> = Mutex::new((
    Claims {
        offset_alignment: None,
        max_storage_buffer_range: None,
        timestamp_valid_bits: None,
        timestamp_period: None,
        unblended: None,
        limits: None,
    },
    None,
));

fn claimed() -> (Claims, Real) {
    let claimed = CLAIMED.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    (claimed.0, claimed.1.expect("install stores the real functions"))
}

unsafe extern "system" fn properties(
    physical: vk::PhysicalDevice,
    found: *mut vk::PhysicalDeviceProperties,
) {
    let (claims, (real, ..)) = claimed();
    // SAFETY: the driver's function; it fills what the caller gave.
    let limits = unsafe {
        real(physical, found);
        &mut (*found).limits
    };
    *limits = claims.limits.unwrap_or(*limits);
    // Claims are never less strict than the truth.
    let alignment = claims.offset_alignment.unwrap_or(1);
    let (storage, uniform) =
        (limits.min_storage_buffer_offset_alignment, limits.min_uniform_buffer_offset_alignment);
    limits.min_storage_buffer_offset_alignment = storage.max(alignment);
    limits.min_uniform_buffer_offset_alignment = uniform.max(alignment);
    let range = claims.max_storage_buffer_range.unwrap_or(u32::MAX);
    limits.max_storage_buffer_range = limits.max_storage_buffer_range.min(range);
    limits.timestamp_period = claims.timestamp_period.unwrap_or(limits.timestamp_period);
}

unsafe extern "system" fn families(
    physical: vk::PhysicalDevice,
    count: *mut u32,
    found: *mut vk::QueueFamilyProperties,
) {
    let (claims, (_, real, _)) = claimed();
    // SAFETY: the driver's function; it fills `count` records where there is room for them.
    let found = unsafe {
        real(physical, count, found);
        if found.is_null() {
            &mut []
        } else {
            std::slice::from_raw_parts_mut(found, *count as usize)
        }
    };
    for family in found {
        family.timestamp_valid_bits =
            claims.timestamp_valid_bits.unwrap_or(family.timestamp_valid_bits);
    }
}

unsafe extern "system" fn formats(
    physical: vk::PhysicalDevice,
    format: vk::Format,
    found: *mut vk::FormatProperties,
) {
    let (claims, (_, _, real)) = claimed();
    // SAFETY: the driver's function; it fills what the caller gave.
    let found = unsafe {
        real(physical, format, found);
        &mut *found
    };
    if claims.unblended == Some(format) {
        found.optimal_tiling_features &= !vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
    }
}

/// Makes the library see these claims.
pub fn claim(gpu: &mut Gpu, claims: Claims) {
    gpu.assert_own();
    let instance = &gpu.instance;
    let mut functions = instance.fp_v1_0().clone();
    let real = (
        functions.get_physical_device_properties,
        functions.get_physical_device_queue_family_properties,
        functions.get_physical_device_format_properties,
    );
    *CLAIMED.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = (claims, Some(real));
    functions.get_physical_device_properties = properties;
    functions.get_physical_device_queue_family_properties = families;
    functions.get_physical_device_format_properties = formats;
    gpu.claims = Some(ash::Instance::from_parts_1_3(
        instance.handle(),
        functions,
        instance.fp_v1_1().clone(),
        instance.fp_v1_3().clone(),
    ));
}
