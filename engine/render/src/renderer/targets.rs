//! The textures that a batch is drawn into, and the buffers from which it is read back.
//!
//! Every view has a layer of its own. Side by side on one sheet, views would take fewer passes, but an offset of the
//! viewport changes the edges in the last bit, and an image must not depend on the views that are drawn with it.

use super::adapter::Gpu;
use super::pipelines::Pipelines;
use super::raw::{RawInstance, RawView};
use crate::WantedImages;

use super::images::{DEPTH_FORMAT, Image};

/// The images that a batch has, and their size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Format {
    pub width: u32,
    pub height: u32,
    pub wanted: WantedImages,
}

impl Format {
    pub fn images(self) -> impl Iterator<Item = Image> {
        Image::ALL.into_iter().filter(move |image| image.is_wanted(self.wanted))
    }

    /// Returns the size in bytes of a row of an image in the readback buffer.
    pub fn pitch(self, image: Image) -> u64 {
        let align = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;
        (u64::from(self.width) * u64::from(image.bytes())).next_multiple_of(u64::from(align))
    }

    /// Returns the size in bytes of an image in the readback buffer.
    pub fn stride(self, image: Image) -> u64 {
        self.pitch(image) * u64::from(self.height)
    }

    /// Returns the size in bytes of all images of a view in the readback buffer.
    pub fn bytes(self) -> u64 {
        self.images().map(|image| self.stride(image)).sum()
    }

    /// Returns the size in bytes of `rows` rows of masks with `words` 32-bit words for each pixel.
    pub fn mask_bytes(self, words: u32, rows: u32) -> u64 {
        u64::from(self.width) * u64::from(rows) * u64::from(words) * 4
    }

    pub fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }
}

/// The layers that a batch is drawn into, and their buffers.
#[derive(Debug)]
pub(super) struct Targets {
    pub format: Format,
    /// The greatest number of views in a batch that uses the layers.
    pub layers: u32,
    textures: Vec<(Image, wgpu::Texture, Vec<wgpu::TextureView>)>,
    depth: wgpu::TextureView,
    /// The data of each view in the form that the shaders read.
    pub uniforms: wgpu::Buffer,
    pub view_group: wgpu::BindGroup,
    /// The data of the instances of all views in the form that the shaders read.
    pub instances: wgpu::Buffer,
    pub readback: wgpu::Buffer,
    pub masks: Option<Masks>,
}

/// The masks of objects without occlusion.
#[derive(Debug)]
pub(super) struct Masks {
    pub words: wgpu::Buffer,
    pub group: wgpu::BindGroup,
    pub readback: wgpu::Buffer,
}

/// Returns the distance from the uniforms of one view to those of the next, in bytes.
pub(super) fn view_stride(gpu: &Gpu) -> u64 {
    (size_of::<RawView>() as u64).next_multiple_of(u64::from(gpu.limits.min_uniform_buffer_offset_alignment))
}

impl Targets {
    pub fn new(gpu: &Gpu, pipelines: &Pipelines, format: Format, layers: u32) -> Self {
        let texture = |image: Image| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
            let texture = texture(gpu, format, image.format(), layers, usage);
            let view = |layer| {
                texture.create_view(&wgpu::TextureViewDescriptor {
                    dimension: Some(wgpu::TextureViewDimension::D2),
                    base_array_layer: layer,
                    array_layer_count: Some(1),
                    ..Default::default()
                })
            };
            let views = (0..layers).map(view).collect();
            (image, texture, views)
        };
        // One depth texture is enough: views are drawn one after the other, and each clears it first.
        let depth = texture_of_depth(gpu, format);
        let uniforms = buffer(gpu, view_stride(gpu) * u64::from(layers), wgpu::BufferUsages::UNIFORM);
        let view = wgpu::BufferBinding {
            buffer: &uniforms,
            offset: 0,
            size: std::num::NonZeroU64::new(size_of::<RawView>() as u64),
        };
        let view_group = group(gpu, &pipelines.views, wgpu::BindingResource::Buffer(view));
        Self {
            format,
            layers,
            textures: format.images().map(texture).collect(),
            depth,
            view_group,
            uniforms,
            instances: buffer(gpu, instance_bytes(64 * layers as usize), wgpu::BufferUsages::VERTEX),
            readback: readback(gpu, format.bytes() * u64::from(layers)),
            masks: None,
        }
    }

    /// Enlarges the buffers so that they hold the given numbers of instances and of 32-bit words of masks.
    pub fn reserve(&mut self, gpu: &Gpu, pipelines: &Pipelines, instances: usize, words: u64) {
        if instance_bytes(instances) > self.instances.size() {
            let room = instance_bytes(instances.next_power_of_two());
            self.instances = buffer(gpu, room, wgpu::BufferUsages::VERTEX);
        }
        if words > 0 && self.masks.as_ref().is_none_or(|masks| masks.words.size() < words * 4) {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            let buffer = buffer(gpu, words * 4, usage);
            let group = group(gpu, &pipelines.masks, buffer.as_entire_binding());
            self.masks = Some(Masks { words: buffer, group, readback: readback(gpu, words * 4) });
        }
    }

    /// Begins a render pass that draws the images of a view into a layer, or only its masks if `images` is false.
    pub fn begin<'a>(&self, encoder: &'a mut wgpu::CommandEncoder, layer: u32, images: bool) -> wgpu::RenderPass<'a> {
        let attachment = |image: Image| {
            let (_, _, views) = self.textures.iter().find(|(of, _, _)| *of == image)?;
            Some(wgpu::RenderPassColorAttachment {
                view: &views[layer as usize],
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(image.nothing()), store: wgpu::StoreOp::Store },
            })
        };
        let attachments = Image::ALL.map(attachment);
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: if images { &attachments } else { &[] },
            depth_stencil_attachment: Some(cleared(&self.depth, 0.0, wgpu::StoreOp::Discard)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }

    /// Copies the images of the first `layers` layers to the readback buffer.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, layers: u32) {
        let Format { width, height, .. } = self.format;
        let mut offset = 0;
        for (image, texture, _) in &self.textures {
            let layout = wgpu::TexelCopyBufferLayout {
                offset,
                bytes_per_row: Some(self.format.pitch(*image) as u32),
                rows_per_image: Some(height),
            };
            let size = wgpu::Extent3d { width, height, depth_or_array_layers: layers };
            let to = wgpu::TexelCopyBufferInfo { buffer: &self.readback, layout };
            encoder.copy_texture_to_buffer(texture.as_image_copy(), to, size);
            offset += self.format.stride(*image) * u64::from(layers);
        }
    }
}

/// Returns a depth attachment that begins with one value everywhere.
pub(super) fn cleared(
    view: &wgpu::TextureView,
    value: f32,
    store: wgpu::StoreOp,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(value), store }),
        stencil_ops: None,
    }
}

fn texture_of_depth(gpu: &Gpu, format: Format) -> wgpu::TextureView {
    let texture = texture(gpu, format, DEPTH_FORMAT, 1, wgpu::TextureUsages::RENDER_ATTACHMENT);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn texture(
    gpu: &Gpu,
    size: Format,
    format: wgpu::TextureFormat,
    layers: u32,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size.width, height: size.height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn instance_bytes(instances: usize) -> u64 {
    (instances * size_of::<RawInstance>()) as u64
}

fn buffer(gpu: &Gpu, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let usage = usage | wgpu::BufferUsages::COPY_DST;
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: size.max(4),
        usage,
        mapped_at_creation: false,
    })
}

fn readback(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    buffer(gpu, size, wgpu::BufferUsages::MAP_READ)
}

fn group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, resource: wgpu::BindingResource<'_>) -> wgpu::BindGroup {
    let entries = [wgpu::BindGroupEntry { binding: 0, resource }];
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}
