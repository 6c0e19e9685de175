//! The one error type of the library.

use ash::vk;

/// Everything that can go wrong at the border between host and library. [`BadInput`](Self::BadInput) and
/// [`NotRecorded`](Self::NotRecorded) are found before the first command is recorded. After any other error the host
/// discards the command buffer that it handed in.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// A Vulkan call failed; `DEVICE_LOST` and the out-of-memory results arrive here.
    Vulkan {
        /// The call, with the object it was for.
        call: String,
        /// Its result.
        result: vk::Result,
    },
    /// Device memory could not be allocated.
    Allocation {
        /// Name of the image or buffer.
        name: String,
        /// The allocator's reason.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The device lacks, or the host did not enable, something that the configuration needs.
    Missing {
        /// The feature, extension, limit or format use.
        what: String,
        /// What it is needed for, and what to do.
        why: String,
    },
    /// A frame was recorded before something that it reads.
    NotRecorded {
        /// The call that has to come first, for example `Renderer::record_setup`.
        call: &'static str,
    },
    /// An input field is out of its range.
    BadInput {
        /// Name of the field, such as `Frame.camera.projection`.
        field: &'static str,
        /// What was expected and what was found.
        why: String,
    },
}

impl Error {
    pub(crate) fn bad(field: &'static str, why: impl Into<String>) -> Self {
        Self::BadInput { field, why: why.into() }
    }

    /// Whether the device is lost. In that case drop all objects.
    pub fn is_device_lost(&self) -> bool {
        matches!(self, Self::Vulkan { result, .. } if *result == vk::Result::ERROR_DEVICE_LOST)
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Vulkan { call, result } => write!(f, "{call}: {result}"),
            Self::Allocation { name, source } => write!(f, "no device memory for {name}: {source}"),
            Self::Missing { what, why } => write!(f, "{what} is missing: {why}"),
            Self::NotRecorded { call } => {
                write!(f, "{call} was not recorded yet: record it before the first frame")
            }
            Self::BadInput { field, why } => write!(f, "{field}: {why}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Vulkan { result, .. } => Some(result),
            Self::Allocation { source, .. } => Some(&**source),
            _ => None,
        }
    }
}

/// Adds context to a result: `result.context("vkCreateImage water/depth")`.
pub(crate) trait VkContext<T> {
    /// Names the failed call.
    fn context(self, call: impl FnOnce() -> String) -> Result<T, Error>;
}

impl<T> VkContext<T> for Result<T, vk::Result> {
    fn context(self, call: impl FnOnce() -> String) -> Result<T, Error> {
        self.map_err(|result| Error::Vulkan { call: call(), result })
    }
}
