//! Draws views in batches and reads their images back.
//!
//! A batch goes to the adapter in one submission and comes back in one copy, while the next batch is prepared: two sets
//! of layers take turns. The grouping of views into batches makes no difference to any image.

mod adapter;
mod bands;
mod deal;
mod images;
mod inside;
mod meshes;
mod pipelines;
mod prepare;
mod quiet;
mod raw;
mod read;
mod shadow;
mod targets;
#[cfg(test)]
mod tests;
mod textures;

pub use adapter::{Adapter, adapter};

use crate::{Camera, Frame, Look, RenderError, View, ViewError, WantedImages};
use adapter::Gpu;
use deal::{Hand, Layer, deal};
use meshes::{Finish, Meshes};
use pipelines::{PLAIN, Pipelines};
use prepare::{Draw, Prepared, prepare};
use raw::RawView;
use targets::{Format, Targets, cleared, view_stride};

/// A renderer that draws the images of many views on a graphics adapter.
///
/// An image depends on its view alone, and neither on the views drawn with it nor on those drawn before. It does depend
/// on the adapter and its driver.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    pipelines: Pipelines,
    meshes: Meshes,
    /// The sets of layers that no batch uses at present.
    idle: Vec<Targets>,
    /// The greatest size in bytes of a view's masks in one layer.
    most_masks: u64,
}

/// A batch that is being drawn.
struct Batch<'a> {
    targets: Targets,
    submission: wgpu::SubmissionIndex,
    layers: Vec<Layer<'a>>,
}

impl Renderer {
    /// Makes a renderer on the best graphics adapter of this machine, which may be a software adapter.
    ///
    /// # Errors
    /// There is no adapter, or it cannot be opened.
    pub fn new() -> Result<Self, RenderError> {
        let gpu = Gpu::open()?;
        let pipelines = Pipelines::new(&gpu);
        gpu.trouble.check()?;
        let wgpu::Limits { max_buffer_size, max_storage_buffer_binding_size, .. } = gpu.limits;
        let most_masks = bands::MOST_BYTES.min(max_buffer_size).min(max_storage_buffer_binding_size);
        let meshes = Meshes::new(pipelines.texture_layout.clone());
        Ok(Self { gpu, pipelines, meshes, idle: Vec::new(), most_masks })
    }

    /// Returns a description of the graphics adapter that the renderer draws with.
    pub fn adapter(&self) -> &Adapter {
        &self.gpu.adapter
    }

    /// Ends the graphics device for tests of the handling of a lost device.
    #[doc(hidden)]
    pub fn lose(&self) {
        self.gpu.device.destroy();
    }

    /// Draws the wanted images of all views, and returns a frame for each view in the same order. If one view cannot be
    /// drawn, the others still are.
    ///
    /// # Errors
    /// The device is lost, or it fails.
    pub fn render(
        &mut self,
        views: &[View<'_>],
        wanted: WantedImages,
    ) -> Result<Vec<Result<Frame, ViewError>>, RenderError> {
        self.gpu.trouble.check()?;
        self.meshes.evict();
        let mut frames: Vec<Option<Result<Frame, ViewError>>> = views.iter().map(|_| None).collect();
        let mut ready = Vec::with_capacity(views.len());
        for (index, view) in views.iter().enumerate() {
            match self.prepare(view, wanted) {
                Ok(prepared) => {
                    let format = format(view.camera, wanted);
                    ready.extend(bands::layers((index, view.camera), prepared, format, self.most_masks));
                }
                Err(error) => frames[index] = Some(Err(error)),
            }
        }
        let mut under_way = None;
        for hand in deal(ready, wanted, self.gpu.limits.max_texture_array_layers as usize) {
            let batch = self.submit(hand);
            if let Some(before) = under_way.replace(batch) {
                self.collect(before, &mut frames)?;
            }
        }
        if let Some(last) = under_way {
            self.collect(last, &mut frames)?;
        }
        self.gpu.trouble.check()?;
        Ok(frames.into_iter().map(|frame| frame.expect("every view was drawn or refused")).collect())
    }

    /// Checks that the graphics adapter can draw images of the camera's size.
    ///
    /// # Errors
    /// The images are too large.
    pub fn check_size(&self, camera: &Camera, wanted: WantedImages) -> Result<(), ViewError> {
        let (width, height) = (camera.width(), camera.height());
        let limits = &self.gpu.limits;
        let limit = limits.max_texture_dimension_2d;
        if width > limit || height > limit {
            return Err(ViewError::TooLarge { width, height, limit });
        }
        let (bytes, limit) = (format(camera, wanted).bytes(), limits.max_buffer_size);
        let what = "the buffer for the images of the view";
        if bytes > limit { Err(ViewError::TooMuch { what, bytes, limit }) } else { Ok(()) }
    }

    fn prepare(&mut self, view: &View<'_>, wanted: WantedImages) -> Result<Prepared, ViewError> {
        self.check_size(view.camera, wanted)?;
        let prepared = prepare(&self.gpu, &mut self.meshes, view, wanted)?;
        let (bytes, limit) = (format(view.camera, wanted).mask_bytes(prepared.words(), 1), self.most_masks);
        let what = "a row of pixels in the occlusion masks of all things";
        if bytes > limit { Err(ViewError::TooMuch { what, bytes, limit }) } else { Ok(prepared) }
    }

    /// Sends a batch to the adapter.
    fn submit<'a>(&mut self, hand: Hand<'a>) -> Batch<'a> {
        let Hand { format, mut layers, .. } = hand;
        let mut targets = self.targets(format, layers.len() as u32);
        let mut words = 0;
        let mut instances = Vec::new();
        let mut first_instances = Vec::new();
        let stride = view_stride(&self.gpu) as usize;
        let mut uniforms = vec![0; stride * layers.len()];
        for (layer, view) in layers.iter_mut().enumerate() {
            let masks = (view.mask_bytes(format) / 4) as u32;
            let Layer { prepared, rows, .. } = view;
            prepared.raw.counts = [words, prepared.words(), format.width, rows.start * format.width];
            words += masks;
            first_instances.push(instances.len() as u32);
            instances.append(&mut prepared.instances);
            uniforms[layer * stride..][..size_of::<RawView>()].copy_from_slice(bytemuck::bytes_of(&prepared.raw));
        }
        targets.reserve(&self.gpu, &self.pipelines, instances.len(), u64::from(words));
        self.gpu.queue.write_buffer(&targets.uniforms, 0, &uniforms);
        self.gpu.queue.write_buffer(&targets.instances, 0, bytemuck::cast_slice(&instances));

        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if let Some(masks) = &targets.masks {
            encoder.clear_buffer(&masks.words, 0, None);
        }
        for (layer, view) in layers.iter().enumerate() {
            let (place, first) = (layer as u32, first_instances[layer]);
            if view.has_images() {
                self.encode(&mut encoder, &targets, place, &view.prepared, first);
            }
            self.encode_masks(&mut encoder, &targets, place, view, first);
        }
        targets.copy(&mut encoder, layers.len() as u32);
        if let Some(masks) = &targets.masks {
            encoder.copy_buffer_to_buffer(&masks.words, 0, &masks.readback, 0, None);
        }
        let submission = self.gpu.queue.submit([encoder.finish()]);
        for readback in [Some(&targets.readback), targets.masks.as_ref().map(|masks| &masks.readback)] {
            // If a buffer could not be mapped, reading it reports the error again.
            readback.inspect(|readback| readback.map_async(wgpu::MapMode::Read, .., |_| {}));
        }
        Batch { targets, submission, layers }
    }

    /// Draws the images of one view.
    fn encode(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        layer: u32,
        prepared: &Prepared,
        first: u32,
    ) {
        let offset = layer * view_stride(&self.gpu) as u32;
        // If nothing throws a shadow, there is no shadow map to clear or to read.
        let wanted = WantedImages { shadows: !prepared.casters.is_empty(), ..targets.format.wanted };
        let drawing = self.pipelines.drawing(&self.gpu, wanted, prepared.weather(), prepared.look);
        let has_pictures = |draw: &Draw| self.meshes.get(draw.mesh).pictures.is_some();
        let pictured = prepared.draws.iter().any(has_pictures).then(|| match prepared.look {
            // Surfaces with pictures have no pictures in this look, and no gloss.
            Look::Flat => drawing.surfaces[0].clone(),
            Look::Textured => self.pipelines.pictured(&self.gpu, wanted, prepared.weather()),
        });
        if wanted.shadows {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                depth_stencil_attachment: Some(cleared(
                    &self.pipelines.suns[prepared.shadows].depth,
                    1.0,
                    wgpu::StoreOp::Store,
                )),
                ..Default::default()
            });
            pass.set_pipeline(&self.pipelines.shadow[prepared.look as usize]);
            pass.set_bind_group(0, &targets.view_group, &[offset]);
            self.draw(&mut pass, targets, prepared.casters.iter(), first, None);
        }
        {
            let mut pass = targets.begin(encoder, layer, true);
            pass.set_bind_group(0, &targets.view_group, &[offset]);
            pass.set_bind_group(1, &self.pipelines.suns[prepared.shadows].group, &[]);
            if let Some(pictured) = &pictured {
                pass.set_pipeline(pictured);
                self.draw(&mut pass, targets, prepared.draws.iter(), first, Some(Finish::Pictured));
            }
            if let Some(textures) = &drawing.textures {
                pass.set_bind_group(2, textures, &[]);
            }
            for (finish, surface) in PLAIN.into_iter().zip(&drawing.surfaces) {
                pass.set_pipeline(surface);
                self.draw(&mut pass, targets, prepared.draws.iter(), first, Some(finish));
            }
            if let Some(sky) = &drawing.sky {
                pass.set_pipeline(sky);
                pass.draw(0..3, 0..1);
            }
        }
    }

    /// Draws a view's masks of objects alone in the rows of the given layer.
    fn encode_masks(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        layer: u32,
        view: &Layer<'_>,
        first: u32,
    ) {
        if let (true, Some(masks)) = (targets.format.wanted.alone, &targets.masks) {
            let mut pass = targets.begin(encoder, layer, false);
            pass.set_scissor_rect(0, view.rows.start, targets.format.width, view.rows.len() as u32);
            pass.set_pipeline(&self.pipelines.alone);
            pass.set_bind_group(0, &targets.view_group, &[layer * view_stride(&self.gpu) as u32]);
            pass.set_bind_group(1, &masks.group, &[]);
            let with_ids = view.prepared.draws.iter().filter(|draw| draw.has_ids);
            self.draw(&mut pass, targets, with_ids, first, None);
        }
    }

    /// Draws all surfaces of the instances of the given meshes, or only the surfaces of one finish.
    fn draw<'a>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        targets: &Targets,
        draws: impl Iterator<Item = &'a Draw>,
        first: u32,
        finish: Option<Finish>,
    ) {
        pass.set_vertex_buffer(1, targets.instances.slice(..));
        for Draw { mesh, instances, .. } in draws {
            let mesh = self.meshes.get(*mesh);
            let part = finish.map_or(0..mesh.count(), |finish| mesh.parts[finish as usize].clone());
            if !part.is_empty() {
                if let (Some(Finish::Pictured), Some(pictures)) = (finish, &mesh.pictures) {
                    pass.set_bind_group(2, pictures, &[]);
                }
                pass.set_vertex_buffer(0, mesh.corners.slice(..));
                pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(part, 0, first + instances.start..first + instances.end);
            }
        }
    }

    /// Waits until a batch is drawn, and stores each frame at the index of its view.
    fn collect(
        &mut self,
        batch: Batch<'_>,
        frames: &mut [Option<Result<Frame, ViewError>>],
    ) -> Result<(), RenderError> {
        let Batch { targets, submission, layers } = batch;
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: None };
        self.gpu.wait(wait)?;
        let unread = |error: wgpu::MapRangeError| RenderError::Failed(std::sync::Arc::new(error));
        let format = targets.format;
        let cameras: Vec<_> = layers.iter().map(|layer| layer.camera).collect();
        let mut read = read::frames(format, &targets.readback.slice(..).get_mapped_range().map_err(unread)?, &cameras);
        targets.readback.unmap();
        if format.wanted.alone {
            read.iter_mut().for_each(|frame| frame.alone = Some(Vec::new()));
        }
        if let Some(masks) = &targets.masks {
            let words = masks.readback.slice(..).get_mapped_range().map_err(unread)?;
            for (frame, layer) in read.iter_mut().zip(&layers) {
                let Layer { prepared, rows, .. } = layer;
                let words = &words[prepared.raw.counts[0] as usize * 4..][..layer.mask_bytes(format) as usize];
                frame.alone = Some(read::alone(format, rows.start, words, &prepared.bits));
            }
            drop(words);
            masks.readback.unmap();
        }
        for (layer, frame) in layers.iter().zip(read) {
            frames[layer.index] = Some(Ok(match frames[layer.index].take() {
                Some(Ok(before)) => bands::joined(before, frame, layer.has_images()),
                _ => frame,
            }));
        }
        if self.idle.len() >= MOST_IDLE {
            self.idle.remove(0);
        }
        self.idle.push(targets);
        Ok(())
    }

    /// Returns a set of texture layers into which a batch of views can be drawn. They are idle layers of the same
    /// format, if there are any.
    fn targets(&mut self, format: Format, layers: u32) -> Targets {
        let fits = |idle: &Targets| idle.format == format && idle.layers >= layers;
        if let Some(index) = self.idle.iter().position(fits) {
            return self.idle.remove(index);
        }
        // Idle layers of the same format that are too small are dropped, because they may never fit again.
        self.idle.retain(|idle| idle.format != format);
        Targets::new(&self.gpu, &self.pipelines, format, layers)
    }
}

/// The most sets of layers that wait for another batch of their kind: two of each of two kinds.
const MOST_IDLE: usize = 4;

fn format(camera: &Camera, wanted: WantedImages) -> Format {
    Format { width: camera.width(), height: camera.height(), wanted }
}
