//! What went wrong, in one line, and the exit code that tells what kind it is.

use std::path::Path;

use whitewater::Error;
use whitewater::ash::vk;
use whitewater::io::particles::ReadError;
use whitewater::io::particles::sequence::SequenceError;
use whitewater::io::picture::PictureError;

/// Kind of a failure; its number is the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Who read the standard output has gone: nothing is wrong, and nobody is there to be told.
    Closed = 0,
    /// Pictures differ, or some frames of a sequence failed.
    Partly = 1,
    /// The command line asks for something that cannot be.
    Usage = 2,
    /// An input file is missing or bad.
    Input = 3,
    /// No Vulkan, no such device, device lost, out of memory, validation messages.
    Device = 4,
    /// The output cannot be written.
    Output = 5,
}

/// One line for the user, and its kind.
#[derive(Clone, Debug)]
pub struct Failure {
    pub kind: Kind,
    pub message: String,
}

/// Of everything here.
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
            // What fixes images and pipelines comes from flags.
            Error::BadInput { field, .. } if field.starts_with("Config.") => {
                Self::usage(error.to_string())
            }
            // Of objects that the flags say nothing of.
            Error::BadInput { field, why }
                if field.starts_with("StateConfig.") || field.starts_with("GenerateConfig.") =>
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
        Self::input(error.to_string())
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

#[cfg(test)]
mod tests {
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
}
