//! A list of replaced objects that frames in flight may still use. Each object waits until every slot that was in
//! flight when the object was replaced has finished, and is then dropped.

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

    /// Keeps the object until all slots that are now in flight have finished. If none is in flight the object is
    /// dropped at once.
    pub fn retire(&mut self, object: impl Send + Sync + 'static) {
        if self.out != 0 {
            self.waiting.push((self.out, Box::new(object)));
        }
    }

    /// Replaces an object and retires the old one.
    pub fn replace<T: Send + Sync + 'static>(&mut self, old: &mut T, new: T) {
        self.retire(std::mem::replace(old, new));
    }

    /// Call when a slot's work is complete, or was never submitted: drops the objects that waited for this slot
    /// alone.
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
