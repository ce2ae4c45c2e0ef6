//! Behavioural cloning: a network learns to answer as an expert did, image by image.
//!
//! All randomness comes from the recipe's seed: the first weights and the order of the lessons. The network learns on
//! the processor, because its result is then the same, bit for bit, in every run on a machine. No graphics card
//! promises this.

use crate::export::onnx;
use crate::model::planes;
use crate::network::{Network, SMALLEST};
use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams, ModuleOptimizer};
use burn::prelude::{Device, Tensor};
use burn::tensor::TensorData;
use paracosm_engine::sensor::Look;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64;

/// The observation and the control of an expert at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Lesson {
    /// The number of the run that the lesson is from. Lessons of held-out runs examine the network and do not teach it.
    pub run: usize,
    /// The image that the expert saw, with three bytes a pixel.
    pub rgb: Vec<u8>,
    /// The car's speed in m/s.
    pub speed: f32,
    /// The expert's steering and throttle.
    pub control: [f32; 2],
}

/// The settings of the training of a network.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// The width and the height of the images in pixels.
    pub resolution: [u32; 2],
    /// The look of the images.
    pub look: Look,
    /// The seed of all random numbers of the training.
    pub seed: u64,
    /// The number of lessons in a batch.
    pub batch: usize,
    /// The first and the last step size of Adam. The step size changes evenly from the first to the last.
    pub rates: [f64; 2],
    /// The weights of the squared errors of steering and throttle in the loss.
    pub weights: [f32; 2],
    /// The distance between held-out runs; 5 holds out every 5th run, and `None` holds out no run.
    pub held_out: Option<usize>,
}

/// The errors of a network after an epoch of its training.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The number of times that the network has seen all lessons.
    pub epoch: usize,
    /// The weighted mean square error during the epoch.
    pub loss: f64,
    /// The root mean square errors of steering and throttle on the held-out runs. `None` if no run is held out.
    pub held_out: Option<[f64; 2]>,
}

/// A network in training, with its optimiser and its source of randomness.
pub struct Learner {
    recipe: Recipe,
    device: Device,
    network: Network,
    optimiser: ModuleOptimizer,
    chance: Pcg64,
}

impl Learner {
    /// Makes a learner with a network of random weights.
    ///
    /// # Panics
    /// The images are smaller than 33 x 33, or the recipe holds out every 0th run or has batches of 0 lessons.
    pub fn new(recipe: Recipe) -> Self {
        assert!(
            recipe.resolution.iter().zip(SMALLEST).all(|(size, least)| *size >= least),
            "the images of a recipe need at least 33 x 33 pixels"
        );
        assert!(
            recipe.held_out != Some(0) && recipe.batch > 0,
            "a recipe needs a batch of at least 1 lesson, and a distance between held-out runs of at least 1"
        );
        let device = Device::flex().autodiff();
        let mut chance = Pcg64::seed_from_u64(recipe.seed);
        let network = Network::new(recipe.resolution, &mut chance, &device);
        Self { recipe, device, network, optimiser: AdamConfig::new().init(), chance }
    }

    /// Trains the network on all lessons, `epochs` times, and calls `show` after each epoch.
    ///
    /// # Panics
    /// There is no lesson to learn from, or an image has another size than the recipe says.
    pub fn learn(&mut self, lessons: &[Lesson], epochs: usize, mut show: impl FnMut(Progress)) {
        let (examined, learnt): (Vec<&Lesson>, Vec<&Lesson>) = lessons
            .iter()
            .partition(|lesson| self.recipe.held_out.is_some_and(|every| lesson.run % every == every - 1));
        assert!(!learnt.is_empty(), "there is no lesson to learn from: all runs are held out, or none was given");
        let mut order = learnt;
        let batches = order.len().div_ceil(self.recipe.batch);
        let [first, last] = self.recipe.rates;
        for epoch in 1..=epochs {
            order.shuffle(&mut self.chance);
            let mut sum = 0.0;
            for (i, batch) in order.chunks(self.recipe.batch).enumerate() {
                let done = ((epoch - 1) * batches + i) as f64 / (epochs * batches) as f64;
                sum += self.step(batch, first + (last - first) * done) * batch.len() as f64;
            }
            show(Progress { epoch, loss: sum / order.len() as f64, held_out: self.examine(&examined) });
        }
    }

    /// Makes one step of Adam (Kingma and Ba 2015) and returns the loss before it.
    fn step(&mut self, batch: &[&Lesson], rate: f64) -> f64 {
        let (images, speeds, controls) = tensors(batch, self.recipe.resolution, &self.device);
        let answers = self.network.forward(images, speeds);
        let weights = TensorData::new(self.recipe.weights.to_vec(), [1, 2]);
        let errors = (answers - controls).square() * Tensor::<2>::from_data(weights, &self.device);
        let loss = errors.mean();
        let gradients = GradientsParams::from_grads(loss.backward(), &self.network);
        self.network = self.optimiser.step(rate, self.network.clone(), gradients);
        f64::from(loss.into_scalar::<f32>())
    }

    /// Returns the root mean square errors of steering and throttle on some lessons. `None` if there are no lessons.
    fn examine(&self, lessons: &[&Lesson]) -> Option<[f64; 2]> {
        let network = self.network.valid();
        let device = Device::flex();
        let mut squares = [0.0; 2];
        for batch in lessons.chunks(self.recipe.batch) {
            let (images, speeds, controls) = tensors(batch, self.recipe.resolution, &device);
            let errors = (network.forward(images, speeds) - controls).square().sum_dim(0).into_data();
            let errors = errors.as_slice::<f32>().expect("they are floats");
            squares = [0, 1].map(|i| squares[i] + f64::from(errors[i]));
        }
        (!lessons.is_empty()).then(|| squares.map(|sum| (sum / lessons.len() as f64).sqrt()))
    }

    /// Returns the network as the contents of an ONNX file that [`Model`](crate::Model) reads. `story` describes the
    /// origin of the network.
    pub fn onnx(&self, story: &str) -> Vec<u8> {
        onnx(&self.network.valid(), (self.recipe.resolution, self.recipe.look), story)
    }
}

fn tensors(batch: &[&Lesson], [width, height]: [u32; 2], device: &Device) -> (Tensor<4>, Tensor<2>, Tensor<2>) {
    let count = batch.len();
    let images: Vec<f32> = batch.iter().flat_map(|lesson| planes(&lesson.rgb)).collect();
    let images = TensorData::new(images, [count, 3, height as usize, width as usize]);
    let speeds = TensorData::new(batch.iter().map(|lesson| lesson.speed).collect(), [count, 1]);
    let controls = TensorData::new(batch.iter().flat_map(|lesson| lesson.control).collect(), [count, 2]);
    (Tensor::from_data(images, device), Tensor::from_data(speeds, device), Tensor::from_data(controls, device))
}
