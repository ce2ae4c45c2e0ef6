//! The file that describes a perception network: how an image becomes its input, and what its outputs mean.

use paracosm_perception::{Detector, Extent, Group, Segmenter, Task, TaskFlaw};
use paracosm_space::{did_you_mean, nearest};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The smallest and the greatest width and height of an input, in pixels.
const PIXELS: (usize, usize) = (8, 2048);

/// The description of a perception network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// The input of the network.
    pub input: Input,
    /// The output tensors of the network.
    pub output: Output,
    /// The meaning of the outputs.
    pub task: Task,
}

/// The input of a perception network: 1 x 3 x height x width, float.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [input]")]
pub struct Input {
    /// The width and the height in pixels.
    pub size: [usize; 2],
    /// The mean of each channel, which is subtracted from the values 0 to 255.
    pub mean: [f32; 3],
    /// The factor of each channel, by which the difference is multiplied.
    pub scale: [f32; 3],
    /// The order of the channels.
    #[serde(default)]
    pub colours: Colours,
    /// The way in which an image gets the size of the input.
    #[serde(default)]
    pub resize: Resize,
}

/// The order of the colour channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Colours {
    /// Red, green, blue.
    #[default]
    Rgb,
    /// Blue, green, red.
    Bgr,
}

/// The way in which an image gets the size of the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Resize {
    /// Both sides are stretched to the size.
    #[default]
    Stretch,
    /// The image keeps its proportions, and lies in the middle of a grey field (114 of 255).
    Letterbox,
}

/// The output tensors of a perception network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Output {
    /// Boxes with a score for each class.
    Boxes {
        /// The name of the tensor of boxes, 1 x N x 4.
        boxes: String,
        /// The name of the tensor of scores, 1 x N x classes, from 0 to 1.
        scores: String,
        /// The meaning of the four numbers of a box.
        form: Form,
        /// The unit of the numbers.
        unit: Unit,
    },
    /// A score for each class at each pixel.
    Mask {
        /// The name of the tensor, 1 x classes x height x width.
        mask: String,
        /// The names of the classes.
        classes: Vec<String>,
        /// The names of the classes that form the mask. A pixel belongs to the mask if the class with its greatest score
        /// does.
        positive: Vec<String>,
        /// If there is only one class: the score from which on a pixel belongs to the mask.
        threshold: f64,
    },
}

/// The meaning of the four numbers of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// Left, top, right, bottom.
    Xyxy,
    /// Top, left, bottom, right.
    Yxyx,
    /// The middle (x, y), the width, the height.
    Cxcywh,
}

/// The unit of the numbers of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unit {
    /// The share of the width and the height of the input.
    Share,
    /// Pixels of the input.
    Pixels,
}

/// The reason why a description of a perception network is not valid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DescriptionFlaw {
    /// The file is not TOML, or lacks an entry, or has an unknown entry.
    #[error("{}", .0.message().trim())]
    Syntax(toml::de::Error),
    /// The task is not known.
    #[error("`task` is `{found}`, expected `detection` or `segmentation`{}", did_you_mean(.nearest))]
    Task {
        /// The task in the file.
        found: String,
        /// The most similar task.
        nearest: Option<&'static str>,
    },
    /// The size of the input is out of range.
    #[error("`size` of [input] is {} x {}, expected a width and a height from {} to {} pixels", size[0], size[1], PIXELS.0, PIXELS.1)]
    Size {
        /// The width and the height in the file.
        size: [usize; 2],
    },
    /// A number of the input cannot be used.
    #[error("`{entry}` of [input] has {found}, expected {expected}")]
    Number {
        /// The name of the entry.
        entry: &'static str,
        /// The number in the file.
        found: f32,
        /// The numbers that the entry may have.
        expected: &'static str,
    },
    /// The mask has a class that does not exist, or no class.
    #[error("`positive` of [output] is {found}, expected some of {expected}{}", did_you_mean(.nearest))]
    Positive {
        /// The name that does not exist, or "empty".
        found: String,
        /// The names of the classes.
        expected: String,
        /// The most similar class.
        nearest: Option<String>,
    },
    /// The meaning of the outputs is not valid.
    #[error(transparent)]
    Meaning(#[from] TaskFlaw),
}

impl DescriptionFlaw {
    /// Returns the line of the flaw in a text, from 1; `None` if the flaw has no place.
    pub fn line(&self, text: &str) -> Option<usize> {
        match self {
            Self::Syntax(error) => error.span().map(|span| text[..span.start].matches('\n').count() + 1),
            _ => None,
        }
    }
}

/// The names of the tasks.
const TASKS: [&str; 2] = ["detection", "segmentation"];

#[derive(Deserialize)]
#[serde(expecting = "a description of a perception network")]
struct Head {
    task: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a description of a detector")]
struct DetectionFile {
    #[serde(rename = "task")]
    _task: String,
    input: Input,
    output: DetectionOutput,
    #[serde(default)]
    group: Option<Vec<Group>>,
    #[serde(default, rename = "source")]
    _source: toml::Table,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [output]")]
struct DetectionOutput {
    boxes: String,
    scores: String,
    form: Form,
    unit: Unit,
    classes: Vec<String>,
    #[serde(default = "half")]
    threshold: f64,
    #[serde(default = "half")]
    overlap: f64,
    #[serde(default)]
    extent: Extent,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a description of a segmentation network")]
struct SegmentationFile {
    #[serde(rename = "task")]
    _task: String,
    input: Input,
    output: SegmentationOutput,
    #[serde(default)]
    truth: Segmenter,
    #[serde(default, rename = "source")]
    _source: toml::Table,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [output]")]
struct SegmentationOutput {
    mask: String,
    classes: Vec<String>,
    positive: Vec<String>,
    #[serde(default = "half")]
    threshold: f64,
}

fn half() -> f64 {
    0.5
}

impl Description {
    /// Reads the text of a description.
    ///
    /// # Errors
    /// The text is not a description, or contradicts itself.
    pub fn parse(text: &str) -> Result<Self, DescriptionFlaw> {
        let Head { task } = toml::from_str(text).map_err(DescriptionFlaw::Syntax)?;
        let description = match task.as_str() {
            "detection" => Self::from(toml::from_str::<DetectionFile>(text).map_err(DescriptionFlaw::Syntax)?),
            "segmentation" => Self::from(toml::from_str::<SegmentationFile>(text).map_err(DescriptionFlaw::Syntax)?),
            _ => {
                let nearest = nearest(&task, TASKS);
                return Err(DescriptionFlaw::Task { found: task, nearest });
            }
        };
        description.check().map(|()| description)
    }

    /// Checks a description that was read from a file.
    ///
    /// # Errors
    /// The description contradicts itself.
    pub fn check(&self) -> Result<(), DescriptionFlaw> {
        let Input { size, mean, scale, .. } = &self.input;
        if size.iter().any(|pixels| !(PIXELS.0..=PIXELS.1).contains(pixels)) {
            return Err(DescriptionFlaw::Size { size: *size });
        }
        if let Some(found) = mean.iter().find(|mean| !mean.is_finite()) {
            return Err(DescriptionFlaw::Number { entry: "mean", found: *found, expected: "finite numbers" });
        }
        if let Some(found) = scale.iter().find(|scale| !scale.is_normal()) {
            return Err(DescriptionFlaw::Number {
                entry: "scale",
                found: *found,
                expected: "finite numbers other than 0",
            });
        }
        if let Task::Detection(detector) = &self.task {
            detector.check()?;
        }
        if let Output::Mask { classes, positive, threshold, .. } = &self.output {
            let unknown = positive.iter().find(|name| !classes.contains(name));
            if unknown.is_some() || positive.is_empty() {
                let found = unknown.map_or("empty".to_owned(), |name| format!("`{name}`"));
                let nearest = unknown.and_then(|name| nearest(name, classes.iter().map(String::as_str)));
                let nearest = nearest.map(str::to_owned);
                return Err(DescriptionFlaw::Positive { found, expected: classes.join(", "), nearest });
            }
            if !(0.0..=1.0).contains(threshold) {
                return Err(TaskFlaw::Share { entry: "threshold", found: *threshold }.into());
            }
        }
        Ok(())
    }
}

impl From<DetectionFile> for Description {
    fn from(file: DetectionFile) -> Self {
        let DetectionOutput { boxes, scores, form, unit, classes, threshold, overlap, extent } = file.output;
        let groups = file.group.unwrap_or_else(|| Group::usual(&classes));
        Self {
            input: file.input,
            output: Output::Boxes { boxes, scores, form, unit },
            task: Task::Detection(Detector { classes, groups, threshold, overlap, extent }),
        }
    }
}

impl From<SegmentationFile> for Description {
    fn from(file: SegmentationFile) -> Self {
        let SegmentationOutput { mask, classes, positive, threshold } = file.output;
        Self {
            input: file.input,
            output: Output::Mask { mask, classes, positive, threshold },
            task: Task::Segmentation(file.truth),
        }
    }
}
