//! The classic detector: histograms of oriented gradients (HOG) in windows, judged by a linear support vector machine
//! (Dalal and Triggs, "Histograms of Oriented Gradients for Human Detection", 2005).
//!
//! One window is for vehicles from behind or from the front, one for vehicles from the side. The windows slide over the
//! image in many sizes.

use super::Failure;
use image::imageops::{self, FilterType};
use image::{GrayImage, RgbImage};
use imageproc::hog::{HogOptions, hog};
use paracosm::perception::{Detection, Detector, Perceiver, PerceiverError, Percept, Picture, Rect, Task, suppress};
use serde::{Deserialize, Serialize};
use std::iter;

/// The side of a cell in pixels, the side of a block in cells, and the directions of gradients in a cell.
const CELL: usize = 8;
const BLOCK: usize = 2;
const DIRECTIONS: usize = 9;
/// The numbers that describe a block.
const NUMBERS: usize = BLOCK * BLOCK * DIRECTIONS;
/// The size of the largest image that the windows slide over, as a multiple of the given image, and the ratio of the sizes
/// of neighbouring images.
const LARGEST: f64 = 1.0;
const RATIO: f64 = 1.2;
/// The cells of a window that lie outside of the vehicle, on each side.
const MARGIN: f64 = 0.5;
/// The least margin of a window that is an answer.
const LEAST: f32 = -1.0;
/// The overlap (IoU) above which two answers mean the same vehicle.
const SAME: f64 = 0.4;

/// A window with its weights.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Window {
    /// The width and the height in cells.
    pub cells: [usize; 2],
    /// The weight of each number of the descriptor, block by block.
    pub weights: Vec<f32>,
    /// The margin of a descriptor of zeros.
    pub bias: f32,
}

/// A detector of vehicles by histograms of oriented gradients.
#[derive(Clone)]
pub struct Hog {
    windows: Vec<Window>,
    task: Task,
}

/// The descriptors of an image in one size.
pub struct Level {
    /// The pixels of the level for a pixel of the image, along x and y.
    factor: [f64; 2],
    /// The number of blocks along x and y.
    blocks: [usize; 2],
    descriptors: Vec<f32>,
}

/// A window in a place of an image.
pub struct Hit {
    /// The box of the vehicle that would fill the window, in pixels of the image.
    pub rect: Rect,
    /// The signed distance from the plane that parts vehicles from other things, in margins.
    pub margin: f32,
    /// The place of the level.
    pub level: usize,
    /// The place of the window in blocks.
    pub place: [usize; 2],
}

impl Window {
    /// Returns a window of this width and height in cells, without weights.
    pub fn new(cells: [usize; 2]) -> Self {
        Self { cells, weights: vec![0.0; (cells[0] - 1) * (cells[1] - 1) * NUMBERS], bias: 0.0 }
    }

    /// Returns the width and the height of the vehicle that fills the window, in pixels.
    fn filled(&self) -> [f64; 2] {
        self.cells.map(|cells| (cells as f64 - 2.0 * MARGIN) * CELL as f64)
    }

    /// Returns the descriptor of a box of an image, stretched to the window. `None` if the window does not lie within the
    /// image.
    pub fn descriptor(&self, image: &GrayImage, rect: &Rect) -> Option<Vec<f32>> {
        let [width, height] = self.filled();
        let sides = [MARGIN * CELL as f64 * rect.width / width, MARGIN * CELL as f64 * rect.height / height];
        let corner = [rect.left - sides[0], rect.top - sides[1]].map(f64::round);
        let size = [rect.width + 2.0 * sides[0], rect.height + 2.0 * sides[1]].map(f64::round);
        let within = |axis: usize, most: u32| corner[axis] >= 0.0 && corner[axis] + size[axis] <= f64::from(most);
        if !(within(0, image.width()) && within(1, image.height())) || size.iter().any(|size| *size < CELL as f64) {
            return None;
        }
        let part =
            imageops::crop_imm(image, corner[0] as u32, corner[1] as u32, size[0] as u32, size[1] as u32).to_image();
        let [width, height] = self.cells.map(|cells| (cells * CELL) as u32);
        Some(describe(&imageops::resize(&part, width, height, FilterType::Triangle)))
    }

    /// Returns the descriptor of the window in a place.
    pub fn descriptor_at(&self, level: &Level, [x, y]: [usize; 2]) -> Vec<f32> {
        self.rows(level, [x, y]).flatten().copied().collect()
    }

    /// Returns the rows of blocks of the window in a place.
    fn rows<'a>(&self, level: &'a Level, [x, y]: [usize; 2]) -> impl Iterator<Item = &'a [f32]> + use<'a> {
        let [across, down] = self.cells.map(|cells| cells - 1);
        (y..y + down).map(move |row| &level.descriptors[NUMBERS * (row * level.blocks[0] + x)..][..NUMBERS * across])
    }

    /// Returns the hits with at least a margin.
    pub fn hits(&self, levels: &[Level], least: f32) -> Vec<Hit> {
        let [across, down] = self.cells.map(|cells| cells - 1);
        let mut hits = Vec::new();
        for (number, level) in levels.iter().enumerate() {
            let places = |axis: usize, blocks: usize| (level.blocks[axis] + 1).saturating_sub(blocks);
            for y in 0..places(1, down) {
                for x in 0..places(0, across) {
                    let weights = self.weights.chunks_exact(NUMBERS * across);
                    let rows = self.rows(level, [x, y]).zip(weights);
                    let margin: f32 = self.bias + rows.map(|(row, weights)| dot(row, weights)).sum::<f32>();
                    if margin >= least {
                        hits.push(Hit { rect: self.rect(level, [x, y]), margin, level: number, place: [x, y] });
                    }
                }
            }
        }
        hits
    }

    /// Returns the box of the vehicle that would fill the window in a place.
    fn rect(&self, level: &Level, place: [usize; 2]) -> Rect {
        let corner = [0, 1].map(|axis| (place[axis] as f64 + MARGIN) * CELL as f64 / level.factor[axis]);
        let size = self.filled();
        Rect { left: corner[0], top: corner[1], width: size[0] / level.factor[0], height: size[1] / level.factor[1] }
    }
}

impl Hog {
    /// Makes a detector of windows.
    pub fn new(windows: Vec<Window>) -> Self {
        let detector = Detector { threshold: 0.5, overlap: SAME, ..Detector::of(vec!["vehicle".to_owned()]) };
        Self { windows, task: Task::Detection(detector) }
    }

    /// Reads the windows of a detector from JSON.
    pub fn read(text: &str) -> Result<Self, Failure> {
        Ok(Self::new(serde_json::from_str(text)?))
    }
}

impl Perceiver for Hog {
    fn task(&self) -> &Task {
        &self.task
    }

    fn perceive(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, PerceiverError> {
        let answer = |picture: &Picture<'_>| {
            let levels = levels(&grey(picture));
            let hits = self.windows.iter().flat_map(|window| window.hits(&levels, LEAST));
            // The logistic function makes a score from 0 to 1 of a margin; it changes no order.
            let score = |margin: f32| 1.0 / (1.0 + libm::exp(-f64::from(margin)));
            let boxes: Vec<Detection> =
                hits.map(|hit| Detection { class: 0, score: score(hit.margin), rect: hit.rect }).collect();
            // Many windows hit each vehicle; the best window alone is an answer.
            Percept::Boxes(suppress(&boxes, 0.0, SAME))
        };
        Ok(pictures.iter().map(answer).collect())
    }
}

/// Returns the greys of an image.
pub fn grey(picture: &Picture<'_>) -> GrayImage {
    let image = RgbImage::from_raw(picture.width, picture.height, picture.rgb.to_vec());
    imageops::grayscale(&image.expect("a picture has three bytes a pixel"))
}

/// Returns the descriptors of an image in all sizes in which a window of six cells finds its place.
pub fn levels(image: &GrayImage) -> Vec<Level> {
    let cells = |side: u32, factor: f64| (f64::from(side) * factor / CELL as f64).round() as usize;
    let sizes = iter::successors(Some(LARGEST), |factor| Some(factor / RATIO))
        .map(|factor| [cells(image.width(), factor), cells(image.height(), factor)]);
    sizes.take_while(|cells| cells.iter().all(|cells| *cells >= 6)).map(|cells| level(image, cells)).collect()
}

/// Returns the descriptors of an image that is stretched to this number of cells.
fn level(image: &GrayImage, cells: [usize; 2]) -> Level {
    let [width, height] = cells.map(|cells| (cells * CELL) as u32);
    let resized = imageops::resize(image, width, height, FilterType::Triangle);
    let factor = [f64::from(width) / f64::from(image.width()), f64::from(height) / f64::from(image.height())];
    Level { factor, blocks: cells.map(|cells| cells - 1), descriptors: describe(&resized) }
}

/// Returns the numbers of all blocks of an image, row by row.
fn describe(image: &GrayImage) -> Vec<f32> {
    let options = HogOptions::new(DIRECTIONS, false, CELL, BLOCK, 1);
    hog(image, options).expect("the sides of the image are whole numbers of cells, at least of a block")
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    // Eight sums at once, which the processor adds in parallel.
    let mut sums = [0.0f32; 8];
    let (a_parts, b_parts) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f32 = a_parts.remainder().iter().zip(b_parts.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_parts.zip(b_parts) {
        (0..8).for_each(|i| sums[i] += a[i] * b[i]);
    }
    sums.iter().sum::<f32>() + rest
}
