//! A stack of convolutions with leaky rectifiers between them.

use crate::network::LEAK;
use crate::onnx_file::{File, attribute, number};
use burn::module::{Module, Param};
use burn::nn::PaddingConfig2d;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::prelude::{Device, Tensor};
use burn::tensor::TensorData;
use burn::tensor::activation::leaky_relu;
use rand::Rng;
use rand_pcg::Pcg64;

/// A convolution. Its padding keeps the size, apart from the stride.
#[derive(Debug, Clone, Copy)]
pub struct Layer {
    /// The number of output channels.
    pub channels: usize,
    /// The width and the height of the kernel, an odd number.
    pub kernel: usize,
    /// The distance of neighbouring outputs in pixels of the input.
    pub stride: usize,
    /// The distance of neighbouring weights in pixels of the input.
    pub dilation: usize,
}

impl Layer {
    pub(super) const fn new(channels: usize, kernel: usize, stride: usize, dilation: usize) -> Self {
        Self { channels, kernel, stride, dilation }
    }

    fn padding(&self) -> usize {
        self.dilation * (self.kernel / 2)
    }
}

#[derive(Module, Debug)]
pub(super) struct Stack {
    convolutions: Vec<Conv2d>,
}

impl Stack {
    /// Makes a stack with random weights (He et al., "Delving Deep into Rectifiers", 2015).
    pub fn new(layers: &[Layer], chance: &mut Pcg64, device: &Device) -> Self {
        let mut channels = 3;
        let mut convolution = |layer: &Layer| {
            let Layer { channels: out, kernel, stride, dilation } = *layer;
            let pad = layer.padding();
            let config = Conv2dConfig::new([channels, out], [kernel; 2]).with_stride([stride; 2]);
            let config = config.with_dilation([dilation; 2]);
            let mut made = config.with_padding(PaddingConfig2d::Explicit(pad, pad, pad, pad)).init(device);
            let inputs = channels * kernel * kernel;
            let bound = (6.0 / inputs as f32).sqrt();
            let weights: Vec<f32> = (0..out * inputs).map(|_| chance.random_range(-bound..bound)).collect();
            let weights = TensorData::new(weights, [out, channels, kernel, kernel]);
            made.weight = Param::from_data(weights, device);
            made.bias = Some(Param::from_data(TensorData::new(vec![0.0; out], [out]), device));
            channels = out;
            made
        };
        Self { convolutions: layers.iter().map(&mut convolution).collect() }
    }

    /// Returns the outputs of the last convolution, one for each image.
    pub fn forward(&self, images: Tensor<4>, layers: &[Layer]) -> Tensor<4> {
        let last = layers.len() - 1;
        self.convolutions.iter().enumerate().fold(images, |seen, (i, layer)| {
            let seen = layer.forward(seen);
            if i < last { leaky_relu(seen, LEAK.into()) } else { seen }
        })
    }

    /// Writes the stack to a file, and returns the name of the outputs.
    pub fn write(&self, file: &mut File, input: &str, layers: &[Layer]) -> String {
        let mut seen = input.to_owned();
        for (i, (layer, form)) in self.convolutions.iter().zip(layers).enumerate() {
            let name = format!("convolution {}", i + 1);
            let weights = file.tensor(&format!("{name} weights"), layer.weight.val());
            let bias = file.tensor(&format!("{name} bias"), layer.bias.as_ref().expect("it was made with one").val());
            let both = |name, size: usize| attribute(name, vec![size as i64; 2]);
            let attributes = vec![
                both("kernel_shape", form.kernel),
                both("strides", form.stride),
                both("dilations", form.dilation),
                attribute("pads", vec![form.padding() as i64; 4]),
            ];
            file.node("Conv", &[&seen, &weights, &bias], &name, attributes);
            seen = name;
            if i + 1 < layers.len() {
                let rectified = format!("{seen} rectified");
                file.node("LeakyRelu", &[&seen], &rectified, vec![number("alpha", LEAK)]);
                seen = rectified;
            }
        }
        seen
    }
}
