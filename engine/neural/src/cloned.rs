//! The networks that come with the software, each taught by the study that is named in its recipe (see the README beside
//! the weights).

/// A network that was taught to drive in some scenarios.
#[derive(Debug, Clone, Copy)]
pub struct Cloned {
    /// Its name, that of its file.
    pub name: &'static str,
    /// The scenarios that it was taught for.
    pub scenarios: &'static [&'static str],
    /// The file.
    pub contents: &'static [u8],
}

/// All of them.
pub const CLONED: &[Cloned] = &[
    Cloned {
        name: "follow",
        scenarios: &["follow-leader", "oncoming-distractor"],
        contents: include_bytes!("../weights/follow.onnx"),
    },
    Cloned { name: "loop", scenarios: &["t-loop"], contents: include_bytes!("../weights/loop.onnx") },
    Cloned { name: "stop", scenarios: &["pedestrian-crossing"], contents: include_bytes!("../weights/stop.onnx") },
];
