//! The networks that come with the software. The recipe of each network names the study that taught it (see the README
//! beside the weights).

/// A network that comes with the software and was trained to drive in the listed scenarios.
#[derive(Debug, Clone, Copy)]
pub struct Cloned {
    /// The name of the network, which is also the name of its file.
    pub name: &'static str,
    /// The names of the scenarios for which the network was trained.
    pub scenarios: &'static [&'static str],
    /// The contents of the network's ONNX file.
    pub contents: &'static [u8],
}

/// All networks that come with the software.
pub const CLONED: &[Cloned] = &[
    Cloned {
        name: "follow",
        scenarios: &["follow-leader", "oncoming-distractor"],
        contents: include_bytes!("../weights/follow.onnx"),
    },
    Cloned { name: "loop", scenarios: &["t-loop"], contents: include_bytes!("../weights/loop.onnx") },
    Cloned { name: "stop", scenarios: &["pedestrian-crossing"], contents: include_bytes!("../weights/stop.onnx") },
];
