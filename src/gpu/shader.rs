//! The compiled shaders, with the interfaces that `build.rs` read from their SPIR-V.

use ash::vk;

/// One SPIR-V module and its interface.
#[derive(Clone, Copy)]
pub struct Shader {
    /// File under `glsl/`.
    pub name: &'static str,
    /// SPIR-V, aligned to 4 bytes.
    pub code: &'static [u8],
    /// Size of its push constants in bytes.
    pub push_size: u32,
    /// Workgroup size (compute).
    pub local_size: [u32; 3],
    /// Size of a workgroup's shared memory in bytes (compute).
    pub shared: u32,
    /// Number of outputs (attachments of a fragment shader).
    pub outputs: u32,
    /// Bindings of set 0.
    pub bindings: &'static [(u32, vk::DescriptorType)],
    /// (block, member, byte offset) of every block member.
    pub members: &'static [(&'static str, &'static str, u32)],
}

/// Aligns embedded SPIR-V to its word size.
#[repr(C, align(4))]
pub struct Aligned<T: ?Sized>(pub T);

const fn equal(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len() != b.len() {
        return false;
    }
    let mut i = 0;
    while i < a.len() {
        if a[i] != b[i] {
            return false;
        }
        i += 1;
    }
    true
}

impl Shader {
    /// Byte offset of a block's member in the SPIR-V; compilation fails if there is no such member.
    pub const fn offset(&self, block: &str, member: &str) -> usize {
        let mut i = 0;
        while i < self.members.len() {
            if equal(self.members[i].0, block) && equal(self.members[i].1, member) {
                return self.members[i].2 as usize;
            }
            i += 1;
        }
        panic!("the shader has no such member")
    }
}

/// Asserts at compile time that the listed members of a `repr(C)` struct have the offsets that they have in the
/// block of the shader, or of each shader of a list.
macro_rules! assert_layout {
    ([$($shader:expr),+ $(,)?], $block:literal, $type:ident $members:tt) => {
        $($crate::gpu::shader::assert_layout!($shader, $block, $type $members);)+
    };
    ($shader:expr, $block:literal, $type:ty { $($member:ident),+ $(,)? }) => {
        $(const _: () = assert!(
            std::mem::offset_of!($type, $member) == $shader.offset($block, stringify!($member)),
            concat!("offset of ", stringify!($member), " differs from the shader's")
        );)+
    };
}
pub(crate) use assert_layout;

pub use compiled::*;

#[allow(dead_code)] // those of features that are off
mod compiled {
    use super::{Aligned, Shader};
    use ash::vk;

    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}
