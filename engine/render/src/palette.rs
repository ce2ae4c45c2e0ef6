//! The colours of semantic classes.

use crate::Semantic;

/// Red, green and blue of the classes in the order of their numbers, as CARLA draws them since its version 0.9.14.
const COLOURS: [[u8; 3]; 29] = [
    [0, 0, 0],
    [128, 64, 128],
    [244, 35, 232],
    [70, 70, 70],
    [102, 102, 156],
    [190, 153, 153],
    [153, 153, 153],
    [250, 170, 30],
    [220, 220, 0],
    [107, 142, 35],
    [152, 251, 152],
    [70, 130, 180],
    [220, 20, 60],
    [255, 0, 0],
    [0, 0, 142],
    [0, 0, 70],
    [0, 60, 100],
    [0, 80, 100],
    [0, 0, 230],
    [119, 11, 32],
    [110, 190, 160],
    [170, 120, 50],
    [55, 90, 80],
    [45, 60, 150],
    [157, 234, 50],
    [81, 0, 81],
    [150, 100, 100],
    [230, 150, 140],
    [180, 165, 180],
];

/// The names of the classes in the order of their numbers, as CARLA has them.
const NAMES: [&str; 29] = [
    "unlabeled",
    "road",
    "sidewalk",
    "building",
    "wall",
    "fence",
    "pole",
    "traffic_light",
    "traffic_sign",
    "vegetation",
    "terrain",
    "sky",
    "pedestrian",
    "rider",
    "car",
    "truck",
    "bus",
    "train",
    "motorcycle",
    "bicycle",
    "static",
    "dynamic",
    "other",
    "water",
    "road_line",
    "ground",
    "bridge",
    "rail_track",
    "guard_rail",
];

impl Semantic {
    /// Returns the names of all semantic classes, in the order of their numbers.
    pub fn names() -> &'static [&'static str] {
        &NAMES
    }

    /// Returns the red, green and blue of the class in CARLA's images.
    pub fn colour(self) -> [u8; 3] {
        COLOURS[self as usize]
    }

    /// Returns the red, green and blue of the class with a given number; black if no class has the number.
    pub fn colour_of(number: u8) -> [u8; 3] {
        COLOURS.get(usize::from(number)).copied().unwrap_or_default()
    }
}
