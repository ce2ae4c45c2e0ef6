//! The programs of the adapter: one for each set of images that is asked for.

use super::adapter::Gpu;
use super::images::{DEPTH_FORMAT, Image};
use super::meshes::Finish;
use super::prepare::Weather;
use super::raw::{RawCorner, RawInstance, RawView};
use super::shadow::TEXELS;
use super::textures::{table, textures};
use crate::{Look, WantedImages};
use std::collections::BTreeMap;
use std::num::NonZeroU64;
use wgpu::{BindingType, CompareFunction, ShaderStages};

/// The programs, and the resources that are bound to them.
#[derive(Debug)]
pub(super) struct Pipelines {
    modules: Modules,
    pub views: wgpu::BindGroupLayout,
    pub masks: wgpu::BindGroupLayout,
    /// The shadow maps, in the order of [`TEXELS`].
    pub suns: [Sun; TEXELS.len()],
    /// The layouts of the inputs of the programs that draw surfaces, in the order of [`Look::ALL`].
    shaded: [wgpu::PipelineLayout; 2],
    pub texture_layout: wgpu::BindGroupLayout,
    /// The textures as an input of the programs that draw surfaces; made when they are first needed.
    textures: Option<wgpu::BindGroup>,
    /// The programs that draw shadow maps, in the order of [`Look::ALL`].
    pub shadow: [wgpu::RenderPipeline; 2],
    pub alone: wgpu::RenderPipeline,
    drawing: BTreeMap<(WantedImages, Weather, Look), Drawing>,
    /// The programs that draw surfaces with pictures; made when they are first needed.
    pictured: BTreeMap<(WantedImages, Weather), wgpu::RenderPipeline>,
}

/// A shadow map: as an input of the programs that draw surfaces, and as the image into which it is drawn.
#[derive(Debug)]
pub(super) struct Sun {
    pub group: wgpu::BindGroup,
    pub depth: wgpu::TextureView,
}

/// The programs that draw a set of images.
#[derive(Debug, Clone)]
pub(super) struct Drawing {
    /// The programs that draw surfaces without pictures, in the order of [`PLAIN`].
    pub surfaces: [wgpu::RenderPipeline; 4],
    /// The program that draws the sky; `None` if no colours are wanted.
    pub sky: Option<wgpu::RenderPipeline>,
    /// The textures of surfaces; `None` if the programs read none.
    pub textures: Option<wgpu::BindGroup>,
}

#[derive(Debug)]
struct Modules {
    /// The programs that draw surfaces, in the order of [`Look::ALL`].
    surfaces: [wgpu::ShaderModule; 2],
    sky: wgpu::ShaderModule,
}

const CORNERS: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [Some(RawCorner::LAYOUT), Some(RawInstance::LAYOUT)];

/// The finishes of surfaces without pictures.
pub(super) const PLAIN: [Finish; 4] = [Finish::Dull, Finish::Glossy, Finish::Upright, Finish::Grained];

const VIEW: &str = include_str!("shaders/view.wgsl");

impl Pipelines {
    pub fn new(gpu: &Gpu) -> Self {
        let module = |source: &str| {
            let source = wgpu::ShaderSource::Wgsl(format!("{VIEW}{source}").into());
            gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
        };
        let view = BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: NonZeroU64::new(size_of::<RawView>() as u64),
        };
        let views = layout(gpu, &[(ShaderStages::VERTEX_FRAGMENT, view)]);
        let words = BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let masks = layout(gpu, &[(ShaderStages::FRAGMENT, words)]);
        let depth = BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let comparison = BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
        let sun_layout = layout(gpu, &[(ShaderStages::FRAGMENT, depth), (ShaderStages::FRAGMENT, comparison)]);
        let suns = TEXELS.map(|texels| Sun::new(gpu, &sun_layout, texels));
        let texture = BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let sampler = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let texture_layout = layout(gpu, &[(ShaderStages::FRAGMENT, texture), (ShaderStages::FRAGMENT, sampler)]);
        let shaded = [
            pipeline_layout(gpu, &[&views, &sun_layout]),
            pipeline_layout(gpu, &[&views, &sun_layout, &texture_layout]),
        ];
        let shadow = module(include_str!("shaders/shadow.wgsl"));
        let shadow = Look::ALL.map(|look| depth_only(gpu, &shadow, &pipeline_layout(gpu, &[&views]), look));
        let masked = pipeline_layout(gpu, &[&views, &masks]);
        let alone = alone(gpu, &module(include_str!("shaders/alone.wgsl")), &masked);
        let modules = Modules {
            surfaces: [
                module(concat!(include_str!("shaders/surface.wgsl"), include_str!("shaders/flat.wgsl"))),
                module(&format!(
                    "{}{}{}",
                    include_str!("shaders/surface.wgsl"),
                    table(),
                    include_str!("shaders/textured.wgsl")
                )),
            ],
            sky: module(include_str!("shaders/sky.wgsl")),
        };
        let (textures, drawing, pictured) = (None, BTreeMap::new(), BTreeMap::new());
        Self { modules, views, masks, suns, shaded, texture_layout, textures, shadow, alone, drawing, pictured }
    }

    /// Returns the programs that draw the wanted images in the given weather and look.
    pub fn drawing(&mut self, gpu: &Gpu, wanted: WantedImages, weather: Weather, look: Look) -> Drawing {
        // Without light, the weather and the look make no difference.
        let (weather, look) = if wanted.light() { (weather, look) } else { Default::default() };
        let Self { modules, shaded, texture_layout, textures, drawing, .. } = self;
        let make = || {
            let textures = (look == Look::Textured)
                .then(|| textures.get_or_insert_with(|| self::textures(gpu, texture_layout)).clone());
            Drawing::new(gpu, modules, &shaded[look as usize], wanted, (weather, look), textures)
        };
        drawing.entry((wanted, weather, look)).or_insert_with(make).clone()
    }

    /// Returns the program that draws surfaces with pictures, in the look `textured`.
    pub fn pictured(&mut self, gpu: &Gpu, wanted: WantedImages, weather: Weather) -> wgpu::RenderPipeline {
        let weather = if wanted.light() { weather } else { Weather::default() };
        let Self { modules, shaded, pictured, .. } = self;
        let look = Look::Textured;
        let make = || pipeline(gpu, modules, &shaded[look as usize], wanted, (weather, look), Some(Finish::Pictured));
        pictured.entry((wanted, weather)).or_insert_with(make).clone()
    }
}

impl Sun {
    fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, texels: u32) -> Self {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("sun"),
            size: wgpu::Extent3d { width: texels, height: texels, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let depth = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(CompareFunction::LessEqual),
            ..Default::default()
        });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&depth) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Self { group, depth }
    }
}

impl Drawing {
    fn new(
        gpu: &Gpu,
        modules: &Modules,
        layout: &wgpu::PipelineLayout,
        wanted: WantedImages,
        conditions: (Weather, Look),
        textures: Option<wgpu::BindGroup>,
    ) -> Self {
        let pipeline = |finish: Option<Finish>| pipeline(gpu, modules, layout, wanted, conditions, finish);
        let surfaces = PLAIN.map(|finish| pipeline(Some(finish)));
        Self { surfaces, sky: wanted.light().then(|| pipeline(None)), textures }
    }
}

/// Makes the program that draws surfaces of a finish, or the sky.
fn pipeline(
    gpu: &Gpu,
    modules: &Modules,
    layout: &wgpu::PipelineLayout,
    wanted: WantedImages,
    (weather, look): (Weather, Look),
    finish: Option<Finish>,
) -> wgpu::RenderPipeline {
    let sky = finish.is_none();
    let choices = [
        ("RGB", wanted.light()),
        ("SHADOWS", wanted.shadows),
        ("LAMPS", weather.lamps),
        ("FOG", weather.fog),
        ("GLOSSY", finish == Some(Finish::Glossy)),
        ("GRAINED", matches!(finish, Some(Finish::Grained | Finish::Upright))),
        ("UPRIGHT", finish == Some(Finish::Upright)),
        ("PICTURED", finish == Some(Finish::Pictured)),
    ];
    // The sky's program declares only one of the constants, and refuses others.
    let constants = choices.map(|(name, chosen)| (name, f64::from(chosen)));
    let constants = if sky { &constants[3..4] } else { &constants[..] };
    let module = if sky { &modules.sky } else { &modules.surfaces[look as usize] };
    // The sky has light, and no other image.
    let writes =
        |image: Image| if sky && !image.is_light() { wgpu::ColorWrites::empty() } else { wgpu::ColorWrites::ALL };
    let target = |image: Image| {
        let target = wgpu::ColorTargetState { format: image.format(), blend: None, write_mask: writes(image) };
        image.is_wanted(wanted).then_some(target)
    };
    let compilation_options = wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(if sky { "sky" } else { "surfaces" }),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: None,
            compilation_options: compilation_options.clone(),
            buffers: if sky { &[] } else { &CORNERS },
        },
        primitive: wgpu::PrimitiveState { cull_mode: (!sky).then_some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(depth(!sky, if sky { CompareFunction::Equal } else { CompareFunction::Greater })),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: None,
            compilation_options,
            targets: &Image::ALL.map(target),
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Returns a reversed depth state, in which nearer is greater, and 0 is infinitely far.
fn depth(write: bool, compare: CompareFunction) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(write),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

fn depth_only(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    look: Look,
) -> wgpu::RenderPipeline {
    // The faces that the sun shines on are enough for the shadow of a closed surface. The look `flat` draws all faces,
    // because its images never change.
    let cull_mode = (look == Look::Textured).then_some(wgpu::Face::Back);
    // Without a bias, surfaces at a slant to the sun shade themselves in stripes.
    let bias = wgpu::DepthBiasState { constant: 2, slope_scale: 2.0, clamp: 0.0 };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shadow"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &CORNERS,
        },
        primitive: wgpu::PrimitiveState { cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState { bias, ..depth(true, CompareFunction::Less) }),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}

fn alone(gpu: &Gpu, module: &wgpu::ShaderModule, layout: &wgpu::PipelineLayout) -> wgpu::RenderPipeline {
    let compilation_options = wgpu::PipelineCompilationOptions::default();
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("things alone"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: None,
            compilation_options: compilation_options.clone(),
            buffers: &CORNERS,
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(depth(false, CompareFunction::Always)),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState { module, entry_point: None, compilation_options, targets: &[] }),
        multiview_mask: None,
        cache: None,
    })
}

fn layout(gpu: &Gpu, bindings: &[(ShaderStages, BindingType)]) -> wgpu::BindGroupLayout {
    let entry = |(binding, (visibility, ty)): (u32, &(ShaderStages, BindingType))| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: *visibility,
        ty: *ty,
        count: None,
    };
    let entries: Vec<_> = (0..).zip(bindings).map(entry).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

fn pipeline_layout(gpu: &Gpu, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}
