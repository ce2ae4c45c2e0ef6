//! The images of a view, and how their pixels are stored.

use crate::WantedImages;

pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// An image of a view; the variants are in the order of the outputs of the shaders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Image {
    Rgb,
    Depth,
    Semantic,
    Instance,
    Linear,
}

impl Image {
    pub const ALL: [Self; 5] = [Self::Rgb, Self::Depth, Self::Semantic, Self::Instance, Self::Linear];

    pub fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Rgb => wgpu::TextureFormat::Rgba8UnormSrgb,
            Self::Depth => wgpu::TextureFormat::R32Float,
            Self::Semantic => wgpu::TextureFormat::R8Uint,
            Self::Instance => wgpu::TextureFormat::R16Uint,
            Self::Linear => wgpu::TextureFormat::Rgba32Float,
        }
    }

    /// Returns the size in bytes of a pixel of the image.
    pub fn bytes(self) -> u32 {
        match self {
            Self::Semantic => 1,
            Self::Instance => 2,
            Self::Rgb | Self::Depth => 4,
            Self::Linear => 16,
        }
    }

    pub fn is_light(self) -> bool {
        matches!(self, Self::Rgb | Self::Linear)
    }

    pub fn is_wanted(self, wanted: WantedImages) -> bool {
        match self {
            Self::Rgb => wanted.rgb,
            Self::Depth => wanted.depth,
            Self::Semantic => wanted.semantic,
            Self::Instance => wanted.instance,
            Self::Linear => wanted.linear,
        }
    }

    /// Returns the value of a pixel that shows no object.
    pub fn nothing(self) -> wgpu::Color {
        let first = match self {
            Self::Rgb | Self::Linear | Self::Instance => 0.0,
            Self::Depth => f64::INFINITY,
            Self::Semantic => f64::from(crate::Semantic::Sky as u8),
        };
        wgpu::Color { r: first, ..wgpu::Color::TRANSPARENT }
    }
}
