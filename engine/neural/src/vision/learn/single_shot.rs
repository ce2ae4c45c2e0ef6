//! A single-shot detector: a fully convolutional network that gives each cell of a grid a score and the distances from
//! the middle of the cell to the sides of the box (Liu et al., "SSD: Single Shot MultiBox Detector", 2016; without
//! anchors as in Tian et al., "FCOS: Fully Convolutional One-Stage Object Detection", 2019).

use super::stack::Layer;
use super::{Answer, Form};
use crate::onnx_file::{File, attribute, integer};
use burn::prelude::Tensor;
use burn::tensor::activation::sigmoid;
use paracosm_perception::Rect;

/// A box of the ground truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// The box in pixels of the image.
    pub rect: Rect,
    /// True if it does not matter whether the network finds the object.
    pub crowd: bool,
}

/// The distance of neighbouring cells in pixels.
const CELL: usize = 8;
/// The share of a box, around its middle, whose cells belong to the box.
const CENTRAL: f64 = 0.5;
/// The weight of cells without an object, and the power by which easy cells count less (Lin et al., "Focal Loss for
/// Dense Object Detection", 2017).
const BALANCE: f32 = 0.75;
const FOCUS: f64 = 2.0;
/// The planes of the truth: the object, the weight of its score, and the logarithms of the distances to the left, upper,
/// right and lower side, in cells.
const PLANES: usize = 6;

pub(super) const FORM: Form = Form {
    layers: &[
        Layer::new(16, 5, 2, 1),
        Layer::new(32, 3, 2, 1),
        Layer::new(48, 3, 2, 1),
        Layer::new(48, 3, 1, 1),
        Layer::new(48, 3, 1, 2),
        Layer::new(48, 3, 1, 4),
        Layer::new(48, 3, 1, 2),
        Layer::new(5, 3, 1, 1),
    ],
    stride: CELL,
    planes,
    loss,
    finish,
    task: "detection",
    output: "boxes = \"boxes\"\nscores = \"scores\"\nform = \"xyxy\"\nunit = \"pixels\"\nclasses = [\"vehicle\"]\n\
             threshold = 0.5\noverlap = 0.5\nextent = \"visible\"\n",
};

fn planes([width, height]: [u32; 2]) -> [usize; 3] {
    [PLANES, width as usize / CELL, height as usize / CELL]
}

/// Returns the planes of the truth for an image of this resolution.
pub(super) fn truth(resolution: [u32; 2], targets: &[Target]) -> Vec<f32> {
    let [_, across, down] = planes(resolution);
    let (cells, mut truth) = (across * down, vec![0.0; PLANES * across * down]);
    truth[cells..2 * cells].fill(1.0);
    // Small boxes come last, so that they keep their cells.
    let mut targets = targets.to_vec();
    targets.sort_by(|a, b| b.crowd.cmp(&a.crowd).then(b.rect.area().total_cmp(&a.rect.area())));
    for Target { rect, crowd } in targets {
        let middle = [rect.left + 0.5 * rect.width, rect.top + 0.5 * rect.height];
        for cell in 0..cells {
            let at = [(cell % across) as f64, (cell / across) as f64].map(|place| (place + 0.5) * CELL as f64);
            let half = [rect.width, rect.height].map(|size| 0.5 * if crowd { size } else { CENTRAL * size });
            // The cell of the middle belongs even to the smallest box.
            let reach = half.map(|half| if crowd { half } else { half.max(0.5 * CELL as f64) });
            if (at[0] - middle[0]).abs() > reach[0] || (at[1] - middle[1]).abs() > reach[1] {
                continue;
            }
            if crowd {
                truth[cells + cell] = 0.0;
                continue;
            }
            truth[cell] = 1.0;
            truth[cells + cell] = 1.0;
            let sides = [at[0] - rect.left, at[1] - rect.top];
            let others = [rect.left + rect.width - at[0], rect.top + rect.height - at[1]];
            for (plane, side) in sides.into_iter().chain(others).enumerate() {
                truth[(2 + plane) * cells + cell] = (side.max(0.5) as f32 / CELL as f32).ln();
            }
        }
    }
    truth
}

/// The focal loss of the scores, and the absolute error of the logarithms of the distances, for each cell of an
/// object.
fn loss(outputs: Tensor<4>, truth: Tensor<4>) -> Tensor<1> {
    let is_object = truth.clone().narrow(1, 0, 1);
    let weight = truth.clone().narrow(1, 1, 1);
    let score = sigmoid(outputs.clone().narrow(1, 0, 1)).clamp(1e-6, 1.0 - 1e-6);
    let no_object = is_object.clone().neg() + 1.0;
    let found = score.clone().log() * (score.clone().neg() + 1.0).powf_scalar(FOCUS) * is_object.clone();
    let refused = (score.clone().neg() + 1.0).log() * score.powf_scalar(FOCUS) * no_object * BALANCE;
    let scores = ((found + refused) * weight).sum().neg();
    let errors = (outputs.narrow(1, 1, 4) - truth.narrow(1, 2, 4)).abs() * is_object.clone();
    let objects = is_object.sum() + 1.0;
    (scores + errors.sum() * 0.5) / objects
}

fn finish(file: &mut File, last: &str, resolution: [u32; 2]) -> Vec<Answer> {
    let [_, across, down] = planes(resolution);
    let cells = across * down;
    file.integers("columns shape", &[1, 5, cells as i64]);
    file.node("Reshape", &[last, "columns shape"], "columns", vec![]);
    file.node("Transpose", &["columns"], "cells", vec![attribute("perm", vec![0, 2, 1])]);
    for (name, from, to) in [("logits", 0, 1), ("before", 1, 3), ("after", 3, 5)] {
        let [begin, end, axis] = ["begin", "end", "axis"].map(|part| format!("{name} {part}"));
        file.integers(&begin, &[from]);
        file.integers(&end, &[to]);
        file.integers(&axis, &[2]);
        file.node("Slice", &["cells", &begin, &end, &axis], name, vec![]);
    }
    let middle = |cell: usize| [cell % across, cell / across].map(|place| (place as f32 + 0.5) * CELL as f32);
    file.constant("middles", &[1, cells, 2], (0..cells).flat_map(middle).collect());
    file.constant("cell", &[], vec![CELL as f32]);
    for (name, operation) in [("before", "Sub"), ("after", "Add")] {
        let [shares, pixels, corner] = ["shares", "pixels", "corner"].map(|part| format!("{name} {part}"));
        file.node("Exp", &[name], &shares, vec![]);
        file.node("Mul", &[&shares, "cell"], &pixels, vec![]);
        file.node(operation, &["middles", &pixels], &corner, vec![]);
    }
    file.node("Concat", &["before corner", "after corner"], "boxes", vec![integer("axis", 2)]);
    file.node("Sigmoid", &["logits"], "scores", vec![]);
    vec![("boxes", vec![1, cells as i64, 4]), ("scores", vec![1, cells as i64, 1])]
}
