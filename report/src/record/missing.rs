//! Says which images of a camera there are not, and why.

use super::{Inside, Rendering, Shot};
use paracosm_engine::sensor::CameraSpec;

/// What came of the shots of one camera in a test.
#[derive(Debug)]
pub(super) struct Missing<'a> {
    camera: (&'a str, &'a CameraSpec),
    shots: usize,
    /// What it was inside, since when, and for how many images.
    inside: Vec<(String, f64, usize)>,
}

impl<'a> Missing<'a> {
    /// Nothing yet of a camera of this name.
    pub fn of(name: &'a str, camera: &'a CameraSpec) -> Self {
        Self { camera: (name, camera), shots: 0, inside: Vec::new() }
    }

    /// Takes note of a shot.
    pub fn see(&mut self, shot: &Shot, seen: &Result<Rendering, Inside>) {
        self.shots += 1;
        if let Err(Inside(thing)) = seen {
            match self.inside.iter_mut().find(|(known, ..)| known == thing) {
                Some((_, _, images)) => *images += 1,
                None => self.inside.push((thing.clone(), shot.time, 1)),
            }
        }
    }

    /// What there is to say, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let (name, CameraSpec { dropped, latency, .. }) = self.camera;
        if self.shots == 0 {
            let why = format!(
                "each was lost (`dropped` is {dropped}) or would have come too late (`latency` is {latency} s)"
            );
            return vec![format!("camera `{name}` has no image: {why}")];
        }
        let note = |(thing, from, images): &(String, f64, usize)| {
            let images = if *images == 1 { "1 image".to_owned() } else { format!("{images} images") };
            format!("{images} of camera `{name}` inside `{thing}`, from {from:.3} s, with nothing to see")
        };
        self.inside.iter().map(note).collect()
    }
}
