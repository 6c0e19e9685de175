//! One-line errors, with an exit code for each kind.

use std::path::Path;

use whitewater::Error;
use whitewater::ash::vk;
use whitewater::io::particles::ReadError;
use whitewater::io::particles::sequence::SequenceError;
use whitewater::io::picture::PictureError;

use crate::folder;

/// Kind of a failure; its number is the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The program that reads standard output has closed it, as `| head` does: this program ends without a message.
    Closed = 0,
    /// Pictures differ, or some frames of a sequence failed.
    Partly = 1,
    /// The arguments are invalid or contradict each other.
    Usage = 2,
    /// An input file is missing or bad.
    Input = 3,
    /// No Vulkan, no such device, device lost, out of memory, validation messages.
    Device = 4,
    /// The output cannot be written.
    Output = 5,
}

/// A one-line message for the user, and its kind.
#[derive(Clone, Debug)]
pub struct Failure {
    pub kind: Kind,
    pub message: String,
}

/// The result type of this program.
pub type Outcome<T> = Result<T, Failure>;

impl Failure {
    pub fn new(kind: Kind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    pub fn usage(message: impl Into<String>) -> Self {
        Self::new(Kind::Usage, message)
    }

    pub fn input(message: impl Into<String>) -> Self {
        Self::new(Kind::Input, message)
    }

    /// A file that could not be read.
    pub fn reading(path: &Path, error: &std::io::Error) -> Self {
        let path = path.display();
        Self::input(format!("cannot read {path}: {error}; check the name and the permissions"))
    }

    /// A file that could not be written.
    pub fn writing(path: &Path, error: &std::io::Error) -> Self {
        let advice = match error.kind() {
            std::io::ErrorKind::StorageFull | std::io::ErrorKind::QuotaExceeded => {
                "free some space, or write to another disk"
            }
            std::io::ErrorKind::NotFound => "make the folder first",
            _ => "check that the folder may be written to and is not full",
        };
        Self::new(Kind::Output, format!("cannot write {}: {error}; {advice}", path.display()))
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::BadInput { field: "Config.extent", .. } => {
                Self::usage(format!("{error}; try a smaller --size"))
            }
            // Values that determine images and pipelines come from flags.
            Error::BadInput { field, .. } if field.starts_with("Config.") => {
                Self::usage(error.to_string())
            }
            // Other objects do not come from flags.
            Error::BadInput { field, why }
                if field.starts_with("SurfaceFoamStateConfig.")
                    || field.starts_with("GeneratorConfig.") =>
            {
                Self::input(format!("the particles: {why}"))
            }
            Error::BadInput { .. } => Self::input(error.to_string()),
            Error::Allocation { .. } => Self::new(
                Kind::Device,
                format!("{error}; try a smaller --size, or a device with more memory (--device)"),
            ),
            _ if error.is_device_lost() => Self::new(
                Kind::Device,
                format!("{error}; finished frames are kept: run again, perhaps with --device"),
            ),
            Error::Vulkan { result: vk::Result::ERROR_INCOMPATIBLE_DRIVER, .. } => Self::new(
                Kind::Device,
                format!(
                    "expected a Vulkan driver, found none ({error}); install one, such as \
                     mesa-vulkan-drivers, which also runs on the CPU"
                ),
            ),
            _ => Self::new(Kind::Device, error.to_string()),
        }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        let advice = match &error {
            // For a recognised format the error itself says what to do.
            ReadError::File { path, reason }
                if !matches!(**reason, ReadError::Unsupported { .. }) =>
            {
                folder::unread(&path.display().to_string())
            }
            _ => None,
        };
        let advice = advice.map_or(String::new(), |advice| format!("; {advice}"));
        Self::input(format!("{error}{advice}"))
    }
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        Self::input(error.to_string())
    }
}

impl From<SequenceError> for Failure {
    fn from(error: SequenceError) -> Self {
        match error {
            SequenceError::Pattern { .. } | SequenceError::NoInput => {
                Self::usage(error.to_string())
            }
            _ => Self::input(error.to_string()),
        }
    }
}

/// Makes the failure for an error. The drawn size is `--size` times `--supersample`, so if this size is too large,
/// the message names both.
pub fn too_large(error: Error, supersample: u32) -> Failure {
    let of_size = matches!(error, Error::BadInput { field: "Config.extent", .. });
    let failure = Failure::from(error);
    match supersample {
        2.. if of_size => Failure::new(
            failure.kind,
            format!("{}; or a smaller --supersample, which it is multiplied by", failure.message),
        ),
        _ => failure,
    }
}

/// Names the file of a picture that the device cannot hold.
pub fn bad_picture(error: Error, file: &str) -> Failure {
    match error {
        Error::BadInput { why, .. } => {
            Failure::input(format!("{file}: {why}; use a smaller picture"))
        }
        Error::Allocation { .. } => Failure::new(
            Kind::Device,
            format!("{file}: {error}; use a smaller picture, or a device with more memory"),
        ),
        error => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use whitewater::Config;
    use whitewater::headless::{COLOR_FORMAT, Headless};

    use super::*;

    #[test]
    fn trouble_with_the_device_is_code_4() {
        let vulkan =
            |result| Failure::from(Error::Vulkan { call: "vkQueueSubmit2 frame".into(), result });
        let lost = vulkan(vk::Result::ERROR_DEVICE_LOST);
        assert_eq!(lost.kind as u8, 4);
        assert!(lost.message.contains("vkQueueSubmit2 frame"), "{}", lost.message);
        assert!(lost.message.contains("finished frames are kept"), "{}", lost.message);
        let full = vulkan(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        assert_eq!(full.kind as u8, 4);
        assert!(!full.message.contains("finished"), "{}", full.message);
        let missing = Error::Missing { what: "a layer".into(), why: "install it".into() };
        assert_eq!(Failure::from(missing).kind as u8, 4);
    }

    #[test]
    fn an_environment_too_large_for_the_device_is_named() {
        let (_alone, device) = crate::testing::device();
        let extent = vk::Extent2D { width: 16, height: 16 };
        let config = Config::new(extent, COLOR_FORMAT, 1024).with(|it| it.environment_size = 16);
        let mut headless = Headless::new(device, &config).unwrap();
        // No device supports images of this width.
        let wide = vk::Extent2D { width: 100_000, height: 1 };
        let error = headless.equirectangular(wide, &vec![[1.0; 4]; 100_000], 1.0, 0.0).unwrap_err();
        let failure = bad_picture(error, "sky.png");
        assert_eq!(failure.kind, Kind::Input);
        for part in ["sky.png: ", "100000x1", "smaller picture"] {
            assert!(failure.message.contains(part), "{}", failure.message);
        }
        headless.finish().unwrap();
    }

    #[test]
    fn a_size_too_large_names_its_flags() {
        let error = || Error::BadInput { field: "Config.extent", why: "too large".into() };
        let message = |supersample| too_large(error(), supersample).message;
        assert!(message(2).contains("--size") && message(2).contains("--supersample"));
        assert!(message(1).contains("--size") && !message(1).contains("--supersample"));
    }
}
