//! The architecture of the network, which is the architecture of Bojarski et al., "End to End Learning for Self-Driving
//! Cars" (2016), with five convolutions and three hidden dense layers. Images may be smaller than the paper's 200 x 66.
//! The speed is a further input of the dense layers.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Linear, LinearConfig, PaddingConfig2d};
use burn::prelude::{Device, Tensor};
use burn::tensor::TensorData;
use burn::tensor::activation::{leaky_relu, tanh};
use rand::Rng;
use rand_pcg::Pcg64;

/// A convolution with its number of output channels, and its kernel's size, stride and padding in pixels. The padding
/// with zeros makes half of the paper's image size suffice; the paper pads nothing.
#[derive(Debug, Clone, Copy)]
pub struct Convolution {
    pub channels: usize,
    pub kernel: usize,
    pub stride: usize,
    pub padding: usize,
}

const fn convolution(channels: usize, kernel: usize, stride: usize, padding: usize) -> Convolution {
    Convolution { channels, kernel, stride, padding }
}

/// The five convolutions of the network.
pub const CONVOLUTIONS: [Convolution; 5] = [
    convolution(24, 5, 2, 0),
    convolution(36, 5, 2, 0),
    convolution(48, 5, 2, 2),
    convolution(64, 3, 1, 1),
    convolution(64, 3, 1, 0),
];
/// The numbers of outputs of the three hidden dense layers and of the last layer, which gives steering and throttle.
pub const DENSE: [usize; 4] = [100, 50, 10, 2];
/// The number that the network subtracts from every colour value, which lies between 0 and 1.
pub const MIDDLE: f32 = 0.5;
/// The factor by which the network multiplies the speed in m/s.
pub const SPEED_SCALE: f32 = 0.05;

/// The slope of the rectifiers below zero. With this slope no rectifier ever stops learning.
pub const LEAK: f32 = 0.1;
/// The factor by which the first weights of the last layer are multiplied, so that the first answers are near zero.
const TIMID: f32 = 0.1;

/// The width and height of the smallest image, in pixels, that leaves an output after the five convolutions.
pub const SMALLEST: [u32; 2] = [33, 33];

#[derive(Module, Debug)]
pub struct Network {
    pub convolutions: Vec<Conv2d>,
    pub dense: Vec<Linear>,
}

/// Returns the number of outputs of the convolutions for an image of the given resolution.
fn found([width, height]: [u32; 2]) -> usize {
    let size = |pixels: u32| {
        let after = |size: usize, layer: &Convolution| (size + 2 * layer.padding - layer.kernel) / layer.stride + 1;
        CONVOLUTIONS.iter().fold(pixels as usize, after)
    };
    CONVOLUTIONS[4].channels * size(width) * size(height)
}

impl Network {
    /// Makes a network for images of the given resolution, with random weights (He et al., "Delving Deep into
    /// Rectifiers", 2015).
    pub fn new(resolution: [u32; 2], chance: &mut Pcg64, device: &Device) -> Self {
        let mut weights = |count: usize, inputs: usize| -> Vec<f32> {
            let bound = (6.0 / inputs as f32).sqrt();
            (0..count).map(|_| chance.random_range(-bound..bound)).collect()
        };
        let mut channels = 3;
        let convolutions = CONVOLUTIONS.map(|layer| {
            let Convolution { channels: out, kernel, stride, padding } = layer;
            let config = Conv2dConfig::new([channels, out], [kernel, kernel]).with_stride([stride, stride]);
            let mut made =
                config.with_padding(PaddingConfig2d::Explicit(padding, padding, padding, padding)).init(device);
            let inputs = channels * kernel * kernel;
            let shape = [out, channels, kernel, kernel];
            made.weight = parameter(weights(out * inputs, inputs), shape, device);
            made.bias = Some(parameter(vec![0.0; out], [out], device));
            channels = out;
            made
        });
        // The speed is one more input.
        let mut inputs = found(resolution) + 1;
        let dense = DENSE.map(|out| {
            let mut made = LinearConfig::new(inputs, out).init(device);
            let mut first = weights(inputs * out, inputs);
            if out == DENSE[DENSE.len() - 1] {
                first.iter_mut().for_each(|weight| *weight *= TIMID);
            }
            made.weight = parameter(first, [inputs, out], device);
            made.bias = Some(parameter(vec![0.0; out], [out], device));
            inputs = out;
            made
        });
        Self { convolutions: convolutions.into(), dense: dense.into() }
    }

    /// Returns the network's steering and throttle, as one row for each image.
    pub fn forward(&self, images: Tensor<4>, speeds: Tensor<2>) -> Tensor<2> {
        let mut seen = images - MIDDLE;
        for layer in &self.convolutions {
            seen = leaky_relu(layer.forward(seen), LEAK.into());
        }
        let mut thought = Tensor::cat(vec![seen.flatten::<2>(1, 3), speeds * SPEED_SCALE], 1);
        let last = self.dense.len() - 1;
        for (i, layer) in self.dense.iter().enumerate() {
            thought = layer.forward(thought);
            thought = if i < last { leaky_relu(thought, LEAK.into()) } else { tanh(thought) };
        }
        thought
    }
}

fn parameter<const D: usize>(numbers: Vec<f32>, shape: [usize; D], device: &Device) -> burn::module::Param<Tensor<D>> {
    burn::module::Param::from_data(TensorData::new(numbers, shape), device)
}
