//! The graphics adapter: finds it, describes it, and records its errors.

use super::quiet::quietly;
use crate::{LossReason, RenderError};
use std::pin::pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};

/// A description of the graphics adapter that a renderer draws with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adapter {
    /// The name of the graphics adapter, for example of a graphics card.
    pub name: String,
    /// The name and the version of the graphics driver.
    pub driver: String,
    /// The name of the graphics interface, which is `vulkan`, `metal` or `dx12`.
    pub backend: String,
    /// The kind of graphics adapter, which is `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: String,
    /// The greatest width and the greatest height of an image, in pixels.
    pub max_image: u32,
    /// The greatest number of images that the adapter can draw in one batch.
    pub max_layers: u32,
    /// The greatest size of a buffer on the adapter, in bytes.
    pub max_buffer: u64,
}

/// The first error of a device, or the loss of the device.
#[derive(Debug, Default)]
pub(super) struct Trouble(Mutex<Option<RenderError>>);

impl Trouble {
    fn note(&self, error: RenderError) {
        let mut first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // The loss of the device says more than the errors that follow from it.
        if first.is_none() || matches!(error, RenderError::Lost { .. }) {
            *first = Some(error);
        }
    }

    /// Returns the error of the device, if the device had an error. The loss of a device is permanent; any other error
    /// is reported once.
    pub fn check(&self) -> Result<(), RenderError> {
        let mut first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &*first {
            None => Ok(()),
            Some(lost @ RenderError::Lost { .. }) => Err(lost.clone()),
            Some(_) => Err(first.take().expect("there is one")),
        }
    }
}

/// An adapter that is open.
#[derive(Debug)]
pub(super) struct Gpu {
    pub adapter: Adapter,
    pub limits: wgpu::Limits,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub trouble: Arc<Trouble>,
}

impl Gpu {
    /// Opens the best graphics adapter of this machine, which may be a software adapter.
    pub fn open() -> Result<Self, RenderError> {
        let adapter = best()?;
        let description = describe(&adapter);
        let limits = adapter.limits();
        let wanted = wgpu::DeviceDescriptor {
            label: Some("paracosm"),
            required_limits: limits.clone(),
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        };
        let (device, queue) = now(adapter.request_device(&wanted))
            .map_err(|error| RenderError::NotOpened { adapter: description.name.clone(), source: Arc::new(error) })?;
        let trouble = Arc::new(Trouble::default());
        let (lost, failed) = (Arc::clone(&trouble), Arc::clone(&trouble));
        device.set_device_lost_callback(move |reason, message| {
            let reason = match reason {
                wgpu::DeviceLostReason::Unknown => LossReason::Unknown,
                wgpu::DeviceLostReason::Destroyed => LossReason::Destroyed,
            };
            lost.note(RenderError::Lost { reason, message });
        });
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            failed.note(RenderError::Failed(Arc::new(error)));
        }));
        Ok(Self { adapter: description, limits, device, queue, trouble })
    }

    /// Waits until the adapter has completed a submission, and returns the device's error, if any.
    pub fn wait(&self, submission: wgpu::PollType) -> Result<(), RenderError> {
        let waited = self.device.poll(submission);
        if waited.is_err() {
            // A lost device first refuses to wait. The loss itself is reported only afterwards, if at all.
            let _ = self.device.poll(wgpu::PollType::Poll);
        }
        self.trouble.check()?;
        waited.map(|_| ()).map_err(|error| RenderError::Failed(Arc::new(error)))
    }
}

/// Returns a description of the best graphics adapter of this machine, without opening it.
///
/// # Errors
/// The machine has no adapter.
pub fn adapter() -> Result<Adapter, RenderError> {
    Ok(describe(&best()?))
}

fn best() -> Result<wgpu::Adapter, RenderError> {
    let wanted =
        wgpu::RequestAdapterOptions { power_preference: wgpu::PowerPreference::HighPerformance, ..Default::default() };
    let found = quietly(|| now(wgpu::Instance::default().request_adapter(&wanted)));
    found.map_err(|error| RenderError::NoAdapter(Arc::new(error)))
}

fn describe(adapter: &wgpu::Adapter) -> Adapter {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "discrete",
        wgpu::DeviceType::IntegratedGpu => "integrated",
        wgpu::DeviceType::VirtualGpu => "virtual",
        wgpu::DeviceType::Cpu => "software",
        wgpu::DeviceType::Other => "other",
    };
    Adapter {
        name: info.name,
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        backend: info.backend.to_str().to_owned(),
        kind: kind.to_owned(),
        max_image: limits.max_texture_dimension_2d,
        max_layers: limits.max_texture_array_layers,
        max_buffer: limits.max_buffer_size,
    }
}

/// Returns the result of a future that is ready immediately, except in browsers.
fn now<F: Future>(future: F) -> F::Output {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
            return output;
        }
        std::thread::yield_now();
    }
}
