//! The textures of the look `textured`, and the pictures of users' models, on the adapter: as layers of arrays with
//! mipmaps.

use super::adapter::Gpu;
use crate::SurfaceKind;
use crate::mesh::picture::{Picture, SIDE};
use crate::texture::{ALL, TEXELS, levels};
use wgpu::{FilterMode, MipmapFilterMode};

/// The number of kinds of surfaces.
const KINDS: usize = 17;

/// Returns the constants of the shaders: for each kind of surface the repetitions of its texture in a metre.
pub(super) fn table() -> String {
    let of = |kind: usize| ALL.iter().find(|texture| texture.surface.is_some_and(|of| of as usize == kind));
    let rows: Vec<String> =
        (0..KINDS).map(|kind| format!("1.0 / {:?}", of(kind).map_or(1.0, |texture| texture.period))).collect();
    format!("const REPEATS = array<f32, {KINDS}>({});\n", rows.join(", "))
}

/// Returns the layer of the texture of a kind of surface; 0 without a texture.
pub(super) fn layer(surface: SurfaceKind) -> u8 {
    ALL.iter().position(|texture| texture.surface == Some(surface)).unwrap_or_default() as u8
}

/// Makes the textures, and returns them as an input of the programs that draw surfaces.
pub(super) fn textures(gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> wgpu::BindGroup {
    let layers: Vec<&[Vec<u8>]> = levels().iter().map(Vec::as_slice).collect();
    array(gpu, layout, &layers, TEXELS, wgpu::TextureFormat::Rgba8Unorm)
}

/// Makes the pictures of a mesh, and returns them as an input of the programs that draw surfaces.
pub(super) fn pictures(gpu: &Gpu, layout: &wgpu::BindGroupLayout, pictures: &[Picture]) -> wgpu::BindGroup {
    let layers: Vec<&[Vec<u8>]> = pictures.iter().map(|picture| picture.levels.as_slice()).collect();
    array(gpu, layout, &layers, SIDE, wgpu::TextureFormat::Rgba8UnormSrgb)
}

/// Makes an array of square textures, given by their levels, which repeats in both directions.
fn array(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    layers: &[&[Vec<u8>]],
    side: u32,
    format: wgpu::TextureFormat,
) -> wgpu::BindGroup {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("textures"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: layers.len() as u32 },
        mip_level_count: side.ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (layer, levels) in layers.iter().enumerate() {
        for (level, texels) in levels.iter().enumerate() {
            let wide = side >> level;
            let to = wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: level as u32,
                origin: wgpu::Origin3d { x: 0, y: 0, z: layer as u32 },
                aspect: wgpu::TextureAspect::All,
            };
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * wide), rows_per_image: Some(wide) };
            let part = wgpu::Extent3d { width: wide, height: wide, depth_or_array_layers: 1 };
            gpu.queue.write_texture(to, texels, layout, part);
        }
    }
    // Every array is seen as one of several layers, also that of a single picture.
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        mipmap_filter: MipmapFilterMode::Linear,
        ..Default::default()
    });
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
        ],
    })
}
