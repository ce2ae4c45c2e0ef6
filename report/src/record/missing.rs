//! Notes which images of a camera are missing, and why.

use super::{Inside, Rendering, Shot};
use paracosm_engine::sensor::CameraSpec;
use paracosm_space::plural;

/// The notes on the shots of one camera in a test.
#[derive(Debug)]
pub(super) struct Missing<'a> {
    camera: (&'a str, &'a CameraSpec),
    shots: usize,
    /// The things that the camera was inside, each with its name, the time of the first such image, and the number of
    /// images.
    inside: Vec<(String, f64, usize)>,
}

impl<'a> Missing<'a> {
    /// Makes empty notes for the camera of this name.
    pub fn of(name: &'a str, camera: &'a CameraSpec) -> Self {
        Self { camera: (name, camera), shots: 0, inside: Vec::new() }
    }

    /// Notes the result of a shot.
    pub fn see(&mut self, shot: &Shot, seen: &Result<Rendering, Inside>) {
        self.shots += 1;
        if let Err(Inside(thing)) = seen {
            match self.inside.iter_mut().find(|(known, ..)| known == thing) {
                Some((_, _, images)) => *images += 1,
                None => self.inside.push((thing.clone(), shot.time, 1)),
            }
        }
    }

    /// Returns the notes, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let (name, CameraSpec { dropped, latency, .. }) = self.camera;
        if self.shots == 0 {
            let why = format!(
                "every image was lost (`dropped` is {dropped}) or would have come too late (`latency` is {latency} s)"
            );
            return vec![format!("camera `{name}` has no image: {why}")];
        }
        let note = |(thing, from, images): &(String, f64, usize)| {
            let images = plural(*images, "image");
            format!("camera `{name}` was inside `{thing}` from {from:.3} s on: {images} show nothing")
        };
        self.inside.iter().map(note).collect()
    }
}
