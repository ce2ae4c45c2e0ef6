//! The meaning of a perceiver's answers: which classes of road users its boxes mean, or which surfaces its mask means.

use paracosm_space::{did_you_mean, nearest};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The classes of road users in the ground truth.
pub const KINDS: [&str; 7] = ["car", "van", "truck", "bus", "motorcycle", "bicycle", "pedestrian"];

/// The meaning of the answers of a perceiver.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Task {
    /// The answers are boxes.
    Detection(Detector),
    /// The answers are masks.
    Segmentation(Segmenter),
}

/// The signals of a detector.
const OF_DETECTORS: [&str; 12] = [
    "perception.images",
    "perception.objects",
    "perception.matches",
    "perception.misses",
    "perception.centred",
    "perception.visible",
    "perception.found",
    "perception.false_alarms",
    "perception.recall",
    "perception.precision",
    "perception.margin",
    Task::UNMATCHED,
];

/// The signals of a segmentation network.
const OF_SEGMENTERS: [&str; 4] =
    ["perception.images", "perception.overlap", "perception.recall", "perception.precision"];

impl Task {
    /// The name of the signal with the seconds for which a road user that should be detected has had no match: the
    /// greatest of all road users.
    pub const UNMATCHED: &str = "perception.unmatched";

    /// Returns the names of the signals that a perceiver adds to the trace of a test, in the order of their columns.
    pub fn signals(&self) -> &'static [&'static str] {
        match self {
            Self::Detection(_) => &OF_DETECTORS,
            Self::Segmentation(_) => &OF_SEGMENTERS,
        }
    }
}

/// The meaning of the boxes of a detector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Detector {
    /// The names of the classes of the boxes, by their numbers.
    pub classes: Vec<String>,
    /// The groups of classes that are compared with the ground truth.
    pub groups: Vec<Group>,
    /// The score from which on a box counts as a detection.
    pub threshold: f64,
    /// The overlap (IoU) with a better box of the same class above which a box is dropped; 1 drops no box.
    pub overlap: f64,
    /// The part of an object that a box should enclose.
    pub extent: Extent,
}

/// The part of an object that a box should enclose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// The visible part, as in COCO.
    #[default]
    Visible,
    /// The whole object, with the parts that other objects hide.
    Whole,
}

/// Classes of a detector that mean the same kind of road user.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// The name of the group.
    pub name: String,
    /// The names of the detector's classes.
    pub detects: Vec<String>,
    /// The classes of road users in the ground truth that a box may mean.
    pub is: Vec<String>,
    /// The classes of road users that may be detected and need not be, such as the rider of a bicycle for a class of
    /// people.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub may_be: Vec<String>,
}

/// The meaning of the masks of a segmentation network.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segmenter {
    /// The semantic classes of the pixels that the mask should have.
    pub is: Vec<String>,
}

impl Default for Segmenter {
    /// Makes the meaning of a mask of the road: the road and its markings.
    fn default() -> Self {
        Self { is: ["road", "road_line"].map(str::to_owned).to_vec() }
    }
}

/// The reason why the description of a task is not valid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TaskFlaw {
    /// The detector has no classes.
    #[error("`classes` is empty, expected the name of each class that the detector gives a score")]
    NoClasses,
    /// No class of the detector means a road user.
    #[error(
        "no class of the detector means a road user; the classes are {found}; add tables [[group]] with `name`, `detects` and \
         `is`"
    )]
    NoGroup {
        /// The names of the detector's classes.
        found: String,
    },
    /// A number is out of range.
    #[error("`{entry}` is {found}, expected a number from 0 to 1")]
    Share {
        /// The name of the entry.
        entry: &'static str,
        /// The number that was found.
        found: f64,
    },
    /// A group names a class that does not exist.
    #[error("`{entry}` of group `{group}` has `{name}`, expected some of {}{}", expected.join(", "), did_you_mean(.nearest))]
    Unknown {
        /// The entry of the group.
        entry: &'static str,
        /// The name of the group.
        group: String,
        /// The name that does not exist.
        name: String,
        /// The names that exist.
        expected: Vec<String>,
        /// The most similar name.
        nearest: Option<String>,
    },
    /// A class of the detector belongs to two groups.
    #[error("class `{class}` belongs to the groups `{first}` and `{second}`, expected one group")]
    Twice {
        /// The name of the class.
        class: String,
        /// The name of the first group.
        first: String,
        /// The name of the second group.
        second: String,
    },
}

/// A usual group.
struct Usual {
    name: &'static str,
    /// The names that detectors commonly give to the classes.
    detects: &'static [&'static str],
    is: &'static [&'static str],
    may_be: &'static [&'static str],
}

const USUAL: [Usual; 4] = [
    Usual {
        name: "vehicle",
        detects: &["car", "van", "truck", "lorry", "bus", "vehicle"],
        is: &["car", "van", "truck", "bus"],
        may_be: &[],
    },
    Usual { name: "motorcycle", detects: &["motorcycle", "motorbike"], is: &["motorcycle"], may_be: &[] },
    Usual { name: "bicycle", detects: &["bicycle", "cyclist"], is: &["bicycle"], may_be: &["motorcycle"] },
    Usual {
        name: "person",
        detects: &["person", "pedestrian"],
        is: &["pedestrian"],
        may_be: &["motorcycle", "bicycle"],
    },
];

impl Detector {
    /// Makes a detector of these classes with the usual groups, the threshold 0.5 and the overlap 0.5.
    pub fn of(classes: Vec<String>) -> Self {
        let groups = Group::usual(&classes);
        Self { classes, groups, threshold: 0.5, overlap: 0.5, extent: Extent::default() }
    }

    /// Returns the group of each class; `None` for a class that means no road user.
    pub fn groups_of_classes(&self) -> Vec<Option<usize>> {
        let group_of = |class: &String| self.groups.iter().position(|group| group.detects.contains(class));
        self.classes.iter().map(group_of).collect()
    }

    /// Checks the description.
    ///
    /// # Errors
    /// The description contradicts itself, or names classes that do not exist.
    pub fn check(&self) -> Result<(), TaskFlaw> {
        if self.classes.is_empty() {
            return Err(TaskFlaw::NoClasses);
        }
        if self.groups.is_empty() {
            return Err(TaskFlaw::NoGroup { found: self.classes.join(", ") });
        }
        for (entry, found) in [("threshold", self.threshold), ("overlap", self.overlap)] {
            if !(0.0..=1.0).contains(&found) {
                return Err(TaskFlaw::Share { entry, found });
            }
        }
        let kinds = KINDS.map(str::to_owned);
        for (i, group) in self.groups.iter().enumerate() {
            let check = |entry: &'static str, names: &[String], known: &[String]| match names
                .iter()
                .find(|name| !known.contains(name))
            {
                None => Ok(()),
                Some(name) => Err(TaskFlaw::Unknown {
                    entry,
                    group: group.name.clone(),
                    name: name.clone(),
                    expected: known.to_vec(),
                    nearest: nearest(name, known.iter().map(String::as_str)).map(str::to_owned),
                }),
            };
            check("detects", &group.detects, &self.classes)?;
            check("is", &group.is, &kinds)?;
            check("may_be", &group.may_be, &kinds)?;
            for earlier in &self.groups[..i] {
                if let Some(class) = group.detects.iter().find(|class| earlier.detects.contains(class)) {
                    let (first, second) = (earlier.name.clone(), group.name.clone());
                    return Err(TaskFlaw::Twice { class: class.clone(), first, second });
                }
            }
        }
        Ok(())
    }
}

impl Group {
    /// Returns the usual groups for these classes of a detector. Names are compared without case.
    pub fn usual(classes: &[String]) -> Vec<Self> {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let group = |usual: &Usual| {
            let detects = classes.iter().filter(|class| usual.detects.contains(&class.to_lowercase().as_str()));
            let detects: Vec<String> = detects.cloned().collect();
            let (name, is, may_be) = (usual.name.to_owned(), owned(usual.is), owned(usual.may_be));
            (!detects.is_empty()).then_some(Self { name, detects, is, may_be })
        };
        USUAL.iter().filter_map(group).collect()
    }
}
