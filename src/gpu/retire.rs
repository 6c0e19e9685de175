//! Objects that were replaced while frames that use them may still be in flight. Each waits until every slot
//! that was recorded before its replacement has come back, and is dropped then.

/// The retire list, with the slots that are in flight.
#[derive(Default)]
pub struct RetireList {
    /// One bit per slot: set while it is recorded and not yet finished.
    out: u32,
    waiting: Vec<(u32, Box<dyn Send + Sync>)>,
}

impl RetireList {
    /// Call after a slot was recorded.
    pub fn recorded(&mut self, slot: u32) {
        self.out |= 1 << slot;
    }

    /// Keeps the object until the slots in flight have come back; drops it at once if none is.
    pub fn retire(&mut self, object: impl Send + Sync + 'static) {
        if self.out != 0 {
            self.waiting.push((self.out, Box::new(object)));
        }
    }

    /// Replaces an object and retires the old one.
    pub fn replace<T: Send + Sync + 'static>(&mut self, old: &mut T, new: T) {
        self.retire(std::mem::replace(old, new));
    }

    /// Call when a slot has finished: its work is complete, or it was never submitted.
    pub fn collect(&mut self, slot: u32) {
        self.out &= !(1 << slot);
        for (mask, _) in &mut self.waiting {
            *mask &= !(1 << slot);
        }
        self.waiting.retain(|(mask, _)| *mask != 0);
    }

    /// Number of waiting objects.
    pub fn len(&self) -> usize {
        self.waiting.len()
    }
}
