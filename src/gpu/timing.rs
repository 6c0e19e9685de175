//! GPU timestamps: in each slot, one scope for each pass. The name of a scope is that of its pass, and also its debug
//! label. Results are read without waiting for the GPU.

use std::ffi::CStr;

use ash::vk;

use super::Gpu;
use super::access::Synchronization;
use super::graveyard::{Grave, Owned};
use crate::error::{Error, VkContext};

/// Max number of scopes per frame.
const MAX_SCOPES: u32 = 64;

/// Time of one pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Name of the pass.
    pub name: &'static str,
    /// Nanoseconds from the beginning of the first pass to that of this one.
    pub start: f64,
    /// Duration in nanoseconds.
    pub nanoseconds: f64,
}

/// One slot's timestamps.
pub struct Timer {
    /// `None` if the queue has no timestamps.
    pool: Option<Owned<vk::QueryPool>>,
    names: Vec<&'static str>,
    /// Whether the scopes of the last recorded frame have not been read yet.
    pending: bool,
    /// First timestamp of the frame that was read last. As long as it is in the pool, the GPU has not begun the next
    /// frame of the slot.
    stale: Option<u64>,
    results: Vec<Timing>,
}

impl Timer {
    /// Creates the query pool, if the queue has timestamps.
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        let mut pool = None;
        if gpu.timestamp_bits > 0 {
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(2 * MAX_SCOPES);
            // SAFETY: valid create info.
            let handle = unsafe { gpu.device.create_query_pool(&info, None) }
                .context(|| "vkCreateQueryPool slot/timestamps".into())?;
            gpu.name(handle, "slot/timestamps");
            pool = Some(gpu.own(handle, Grave::QueryPool));
        }
        Ok(Self {
            pool,
            names: Vec::with_capacity(MAX_SCOPES as usize),
            pending: false,
            stale: None,
            results: Vec::with_capacity(MAX_SCOPES as usize),
        })
    }

    /// Starts a frame: keeps the results of the previous frame and removes its scopes.
    pub fn reset(&mut self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        self.read(gpu);
        self.names.clear();
        self.pending = true;
        if let Some(pool) = &self.pool {
            // SAFETY: cmd is recording outside a render pass; the slot's earlier work is done.
            unsafe { gpu.device.cmd_reset_query_pool(cmd, pool.handle, 0, 2 * MAX_SCOPES) };
        }
    }

    /// Opens a scope and its label.
    pub fn begin(&mut self, gpu: &Gpu, cmd: vk::CommandBuffer, name: &'static CStr) -> Scope {
        gpu.begin_label(cmd, name);
        let index = self.names.len() as u32;
        if index < MAX_SCOPES {
            self.names.push(name.to_str().unwrap_or_default());
            self.write(gpu, cmd, 2 * index);
        }
        Scope(index)
    }

    /// Closes a scope.
    pub fn end(&mut self, gpu: &Gpu, cmd: vk::CommandBuffer, scope: Scope) {
        if scope.0 < MAX_SCOPES {
            self.write(gpu, cmd, 2 * scope.0 + 1);
        }
        gpu.end_label(cmd);
    }

    fn write(&self, gpu: &Gpu, cmd: vk::CommandBuffer, query: u32) {
        if let Some(pool) = &self.pool {
            // SAFETY: cmd is recording; the query was reset at the start of the frame.
            unsafe {
                match gpu.synchronization {
                    Synchronization::Second { timestamp, .. } => {
                        timestamp(cmd, vk::PipelineStageFlags2::ALL_COMMANDS, pool.handle, query);
                    }
                    Synchronization::First => {
                        let end = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
                        gpu.device.cmd_write_timestamp(cmd, end, pool.handle, query);
                    }
                }
            }
        }
    }

    fn read(&mut self, gpu: &Gpu) {
        let count = self.names.len();
        let Some(pool) = self.pool.as_ref().filter(|_| self.pending && count > 0) else { return };
        let mut raw = [0u64; 2 * MAX_SCOPES as usize];
        // SAFETY: the pool is alive; 64-bit results of the queries of this frame.
        let read = unsafe {
            gpu.device.get_query_pool_results(
                pool.handle,
                0,
                &mut raw[..2 * count],
                vk::QueryResultFlags::TYPE_64,
            )
        };
        if read.is_err() || self.stale == Some(raw[0]) {
            return;
        }
        self.pending = false;
        self.stale = Some(raw[0]);
        let mask = u64::MAX >> (64 - gpu.timestamp_bits.min(64));
        let period = f64::from(gpu.limits.timestamp_period);
        let span = |from: u64, to: u64| (to.wrapping_sub(from) & mask) as f64 * period;
        self.results.clear();
        for (index, name) in self.names.iter().enumerate() {
            let (begin, end) = (raw[2 * index], raw[2 * index + 1]);
            self.results.push(Timing {
                name,
                start: span(raw[0], begin),
                nanoseconds: span(begin, end),
            });
        }
    }

    /// Results of the last finished frame; empty before the first.
    pub fn timings(&mut self, gpu: &Gpu) -> &[Timing] {
        self.read(gpu);
        &self.results
    }

    /// Discards a frame that was recorded but never submitted.
    pub fn abandon(&mut self) {
        self.pending = false;
    }
}

/// An open scope.
#[must_use]
pub struct Scope(u32);
