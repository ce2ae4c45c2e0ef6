//! Notes which images of a camera are missing, and why.

use super::{Inside, Rendering, Shot};
use paracosm_engine::sensor::CameraSpec;
use paracosm_space::plural;

/// The notes on the shots of one camera in a test.
#[derive(Debug)]
pub(crate) struct Missing<'a> {
    camera: (&'a str, &'a CameraSpec),
    shots: usize,
    /// The objects that the camera was inside, each with its name, the time of the first such image and the number of
    /// such images.
    inside: Vec<(String, f64, usize)>,
}

impl<'a> Missing<'a> {
    /// Makes empty notes on the missing images of the camera with the given name.
    pub fn of(name: &'a str, camera: &'a CameraSpec) -> Self {
        Self { camera: (name, camera), shots: 0, inside: Vec::new() }
    }

    /// Adds the result of drawing an image to the notes.
    pub fn see(&mut self, shot: &Shot, seen: &Result<Rendering, Inside>) {
        self.shots += 1;
        if let Err(Inside(thing)) = seen {
            match self.inside.iter_mut().find(|(known, ..)| known == thing) {
                Some((_, _, images)) => *images += 1,
                None => self.inside.push((thing.clone(), shot.time, 1)),
            }
        }
    }

    /// Returns a sentence for each reason why images of the camera are missing.
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
            format!("{images} of camera `{name}` left out: the camera was inside `{thing}`, first at {from:.3} s")
        };
        self.inside.iter().map(note).collect()
    }
}
