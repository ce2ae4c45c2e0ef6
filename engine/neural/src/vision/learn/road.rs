//! A fully convolutional network that marks the road, after Long, Shelhamer and Darrell, "Fully Convolutional Networks
//! for Semantic Segmentation" (2015). Dilated convolutions see far (Yu and Koltun, "Multi-Scale Context Aggregation by
//! Dilated Convolutions", 2016), and each output gives the pixels of a square of 4 x 4 (Shi et al., "Real-Time Single
//! Image and Video Super-Resolution Using an Efficient Sub-Pixel Convolutional Neural Network", 2016).

use super::stack::Layer;
use super::{Answer, Form};
use crate::onnx_file::{File, attribute};
use burn::prelude::Tensor;
use burn::tensor::activation::relu;

/// The side of the square of pixels that an output gives.
const SIDE: usize = 4;

pub(super) const FORM: Form = Form {
    layers: &[
        Layer::new(16, 5, 2, 1),
        Layer::new(32, 3, 2, 1),
        Layer::new(32, 3, 1, 1),
        Layer::new(32, 3, 1, 2),
        Layer::new(32, 3, 1, 4),
        Layer::new(32, 3, 1, 8),
        Layer::new(SIDE * SIDE, 3, 1, 1),
    ],
    stride: SIDE,
    planes: |[width, height]| [1, width as usize, height as usize],
    loss,
    finish,
    task: "segmentation",
    output: "mask = \"road\"\nclasses = [\"road\"]\npositive = [\"road\"]\nthreshold = 0.5\n",
};

/// Returns the mean cross entropy of the pixels.
fn loss(outputs: Tensor<4>, truth: Tensor<4>) -> Tensor<1> {
    let scores = spread(outputs);
    // The logarithm of the logistic function, without overflow.
    let rest = scores.clone().abs().neg().exp().log1p();
    (relu(scores.clone()) - scores * truth + rest).mean()
}

fn finish(file: &mut File, last: &str, [width, height]: [u32; 2]) -> Vec<Answer> {
    let [side, across, down] = [SIDE, width as usize / SIDE, height as usize / SIDE].map(|size| size as i64);
    file.integers("squares shape", &[1, side, side, down, across]);
    file.integers("mask shape", &[1, 1, down * side, across * side]);
    file.node("Reshape", &[last, "squares shape"], "squares", vec![]);
    file.node("Transpose", &["squares"], "rows", vec![attribute("perm", vec![0, 3, 1, 4, 2])]);
    file.node("Reshape", &["rows", "mask shape"], "scores", vec![]);
    file.node("Sigmoid", &["scores"], "road", vec![]);
    vec![("road", vec![1, 1, down * side, across * side])]
}

/// Spreads the channels of each output over a square of pixels.
fn spread(outputs: Tensor<4>) -> Tensor<4> {
    let [count, _, down, across] = outputs.dims();
    let squares: Tensor<5> = outputs.reshape([count, SIDE, SIDE, down, across]);
    squares.permute([0, 3, 1, 4, 2]).reshape([count, 1, down * SIDE, across * SIDE])
}
