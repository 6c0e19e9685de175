//! Pictures on the CPU.

/// Texels row by row, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture<T> {
    /// Width in texels.
    pub width: usize,
    /// Height in texels.
    pub height: usize,
    /// width × height texels.
    pub data: Vec<T>,
}

impl<T> Picture<T> {
    /// Converts each texel.
    pub fn map<U>(&self, convert: impl FnMut(&T) -> U) -> Picture<U> {
        Picture {
            width: self.width,
            height: self.height,
            data: self.data.iter().map(convert).collect(),
        }
    }

    /// A texel, clamped to the edge.
    pub fn at(&self, x: usize, y: usize) -> &T {
        &self.data[y.min(self.height - 1) * self.width + x.min(self.width - 1)]
    }
}
