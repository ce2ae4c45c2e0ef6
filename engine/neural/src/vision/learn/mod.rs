//! Training of networks that see: stacks of convolutions, which learn to mark the road or to put boxes around vehicles.
//!
//! As in [`learn`](crate::learn), all randomness comes from the seed of the recipe, and the networks learn on the
//! processor, whose results are the same in every run on a machine.

mod road;
mod single_shot;
mod stack;
#[cfg(test)]
mod tests;

pub use single_shot::Target;

use crate::onnx_file::File;
use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams, ModuleOptimizer};
use burn::prelude::{Device, Tensor};
use burn::tensor::TensorData;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64;
use stack::{Layer, Stack};

/// The settings of the training.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// The width and the height of the images in pixels. Both are multiples of the goal's stride.
    pub resolution: [u32; 2],
    /// The seed of all random numbers of the training.
    pub seed: u64,
    /// The number of images in a batch.
    pub batch: usize,
    /// The number of times that the network sees each image.
    pub epochs: usize,
    /// The first and the last step size of Adam. The step size changes evenly from the first to the last.
    pub rates: [f64; 2],
}

/// An image with the numbers that the network should find in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// The image, with three bytes a pixel.
    rgb: Vec<u8>,
    /// The planes of the truth.
    truth: Vec<f32>,
}

impl Example {
    /// Makes an example from an image, with three bytes a pixel, and the pixels of the road.
    pub fn of_road(rgb: Vec<u8>, road: &[bool]) -> Self {
        Self { rgb, truth: road.iter().map(|is_road| f32::from(u8::from(*is_road))).collect() }
    }

    /// Makes an example from an image of this resolution, with three bytes a pixel, and the boxes of vehicles.
    pub fn of_vehicles(rgb: Vec<u8>, resolution: [u32; 2], targets: &[Target]) -> Self {
        Self { rgb, truth: single_shot::truth(resolution, targets) }
    }
}

/// The thing that a network learns to find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Goal {
    /// The pixels of the road, by a fully convolutional network.
    Road,
    /// Boxes around vehicles, by a single-shot detector.
    Vehicles,
}

/// The name and the shape of an output of a file.
type Answer = (&'static str, Vec<i64>);

/// The network of a goal.
struct Form {
    /// The layers of the network.
    layers: &'static [Layer],
    /// The number by which the width and the height of an image can be divided.
    stride: usize,
    /// The number of planes of the truth, and their width and height, for images of a resolution.
    planes: fn([u32; 2]) -> [usize; 3],
    /// The loss of the outputs of the network for a truth, a single number.
    loss: fn(Tensor<4>, Tensor<4>) -> Tensor<1>,
    /// Adds the operations from the last convolution to the outputs of a file. Returns the names and the shapes of the
    /// outputs.
    finish: fn(&mut File, &str, [u32; 2]) -> Vec<Answer>,
    /// The description of the task.
    task: &'static str,
    /// The description of the outputs.
    output: &'static str,
}

impl Goal {
    fn form(self) -> &'static Form {
        match self {
            Self::Road => &road::FORM,
            Self::Vehicles => &single_shot::FORM,
        }
    }

    /// Returns the text of the description of a network for images of this width and height in pixels.
    pub fn description(self, [width, height]: [u32; 2]) -> String {
        let Form { task, output, .. } = self.form();
        format!(
            "task = \"{task}\"\n\n[input]\nsize = [{width}, {height}]\nmean = [127.5, 127.5, 127.5]\n\
             scale = [0.00784314, 0.00784314, 0.00784314]\ncolours = \"rgb\"\nresize = \"stretch\"\n\n[output]\n{output}"
        )
    }
}

/// Trains a network on examples, and returns the contents of its ONNX file. `show` gets the mean loss of each epoch.
/// `story` describes the origin of the network.
///
/// # Panics
/// There is no example, a batch has no image, or an example has another size than the recipe says.
pub fn train(
    goal: Goal,
    recipe: &Recipe,
    examples: &[Example],
    story: &str,
    mut show: impl FnMut(usize, f64),
) -> Vec<u8> {
    let form = goal.form();
    assert!(!examples.is_empty() && recipe.batch > 0, "training needs examples, and batches of at least one");
    assert!(
        recipe.resolution.iter().all(|size| (*size as usize).is_multiple_of(form.stride)),
        "the stride divides the resolution"
    );
    let device = Device::flex().autodiff();
    let mut chance = Pcg64::seed_from_u64(recipe.seed);
    let mut stack = Stack::new(form.layers, &mut chance, &device);
    let mut optimiser: ModuleOptimizer = AdamConfig::new().init();
    let mut order: Vec<&Example> = examples.iter().collect();
    let steps = order.len().div_ceil(recipe.batch) * recipe.epochs;
    let ([first, last], mut done) = (recipe.rates, 0);
    for epoch in 1..=recipe.epochs {
        order.shuffle(&mut chance);
        let mut sum = 0.0;
        for batch in order.chunks(recipe.batch) {
            let (images, truth) = tensors(form, batch, recipe.resolution, &device);
            let loss = (form.loss)(stack.forward(images, form.layers), truth);
            let gradients = GradientsParams::from_grads(loss.backward(), &stack);
            let rate = first + (last - first) * f64::from(done) / steps as f64;
            stack = optimiser.step(rate, stack, gradients);
            sum += f64::from(loss.into_scalar::<f32>()) * batch.len() as f64;
            done += 1;
        }
        show(epoch, sum / order.len() as f64);
    }
    onnx(form, &stack.valid(), recipe.resolution, story)
}

/// Returns a batch of images, with numbers from -1 to 1, and the truth.
fn tensors(form: &Form, batch: &[&Example], resolution: [u32; 2], device: &Device) -> (Tensor<4>, Tensor<4>) {
    let [width, height] = resolution.map(|size| size as usize);
    let images: Vec<f32> = batch.iter().flat_map(|example| crate::model::planes(&example.rgb)).collect();
    let images = images.into_iter().map(|number| 2.0 * number - 1.0).collect();
    let [planes, across, down] = (form.planes)(resolution);
    let truth = batch.iter().flat_map(|example| example.truth.iter().copied()).collect();
    (
        Tensor::from_data(TensorData::new(images, [batch.len(), 3, height, width]), device),
        Tensor::from_data(TensorData::new(truth, [batch.len(), planes, down, across]), device),
    )
}

/// Returns the contents of the ONNX file of a network.
fn onnx(form: &Form, stack: &Stack, resolution: [u32; 2], story: &str) -> Vec<u8> {
    let mut file = File::default();
    let last = stack.write(&mut file, "image", form.layers);
    let outputs = (form.finish)(&mut file, &last, resolution);
    let outputs: Vec<(&str, &[i64])> = outputs.iter().map(|(name, shape)| (*name, shape.as_slice())).collect();
    let [width, height] = resolution.map(i64::from);
    file.finish("perceiver", &[("image", &[1, 3, height, width])], &outputs, story)
}
