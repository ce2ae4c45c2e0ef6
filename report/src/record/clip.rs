//! Writes what one camera sees of a test, for people: a film as an MP4 or a GIF file, or a folder of PNG files.
//!
//! Each image is written as soon as it is drawn.

use super::Shot;
use super::footage::Footage;
use super::image::{Pixels, write};
use super::video::Video;
use crate::plot;
use paracosm_campaign::files::{Draft, DraftFolder, is_new};
use paracosm_campaign::{Error, Failure, Reason, Trial, Worker};
use paracosm_engine::sensor::Cameras;
use paracosm_space::plural;
use paracosm_space::{did_you_mean, nearest};
use rayon::prelude::*;
use std::error::Error as StdError;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use thiserror::Error;

/// The destination of a film of a test, which is a film file or a new folder of images.
#[derive(Debug)]
pub struct Clip {
    path: PathBuf,
    form: Form,
    stop: Arc<AtomicBool>,
}

/// The format of a clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Mp4,
    Gif,
    /// The format of separate PNG files in a folder.
    Images,
}

/// A film that is being written.
enum Reel {
    Mp4(Box<Video<BufWriter<File>>>),
    Gif(Box<plot::Reel<BufWriter<File>>>),
}

impl Reel {
    fn show(&mut self, rgb: &[u8], seconds: f64) -> Result<(), Box<dyn StdError + Send + Sync>> {
        match self {
            Self::Mp4(video) => video.show(rgb, seconds),
            Self::Gif(reel) => reel.show(rgb, seconds),
        }
    }

    fn end(self) -> Result<(), Box<dyn StdError + Send + Sync>> {
        match self {
            Self::Mp4(video) => video.end(),
            Self::Gif(reel) => reel.end(),
        }
    }
}

/// The error that the file name of a clip has an unknown ending.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "--camera {}: found the ending `.{ending}`, expected FILE.mp4, FILE.gif, or a FOLDER without an ending for PNG files{}",
    path.display(), did_you_mean(.nearest)
)]
pub struct UnknownEnding {
    /// The path that was given for the clip.
    pub path: PathBuf,
    /// The unknown ending of the file name.
    pub ending: String,
    /// The most similar known ending, if any ending is similar.
    pub nearest: Option<&'static str>,
}

impl Reason for UnknownEnding {}

impl Clip {
    /// Makes the destination of a film, which is a file that ends in `.mp4` or `.gif`, or a folder of images whose name
    /// has no ending.
    ///
    /// # Errors
    /// Returns an error if the folder exists already, or the name has another ending.
    pub fn new(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let form = match ending.as_deref() {
            Some("mp4") => Form::Mp4,
            Some("gif") => Form::Gif,
            None => Form::Images,
            Some(other) => {
                let (path, ending) = (path.to_owned(), other.to_owned());
                return Err(UnknownEnding { path, ending, nearest: nearest(other, ["mp4", "gif"]) }.into());
            }
        };
        if form == Form::Images {
            is_new(path, "a film")?;
        }
        Ok(Self { path: path.to_owned(), form, stop: Arc::default() })
    }

    /// Returns the destination with a flag that, once set, stops the writing of a film, so that no file is left behind.
    pub fn until(self, stop: Arc<AtomicBool>) -> Self {
        Self { stop, ..self }
    }

    /// Runs a test again and writes the film of the first camera. Returns lines of text that say what was written and
    /// which images are missing.
    ///
    /// # Errors
    /// Returns an error if there is no adapter, the test is not the test that was logged, nothing was seen, or nothing
    /// can be written.
    pub fn write(&self, worker: &mut Worker, trial: &Trial, cameras: &Cameras) -> Result<Vec<String>, Error> {
        let mut footage = Footage::of(worker, trial, cameras, &self.stop)?;
        let images = match self.form {
            Form::Images => self.write_images(&mut footage)?,
            Form::Mp4 | Form::Gif => self.write_film(&mut footage)?,
        };
        let written =
            format!("{} of camera `{}` written to {}", plural(images, "image"), footage.name, self.path.display());
        Ok(std::iter::once(written).chain(footage.notes()).collect())
    }

    fn write_film(&self, footage: &mut Footage<'_>) -> Result<usize, Error> {
        let failed = |source| self.failed(source);
        let mut colours = plot::Colours::default();
        if self.form == Form::Gif {
            footage.glance(|rgb| colours.count(rgb))?;
        }
        let (draft, file) = Draft::new(&self.path)?;
        let (file, camera) = (BufWriter::new(file), footage.camera);
        let mut reel = match self.form {
            Form::Gif => {
                Reel::Gif(Box::new(plot::Reel::begin(file, camera.resolution, colours.palette()).map_err(failed)?))
            }
            _ => Reel::Mp4(Box::new(Video::begin(file, camera.resolution, camera.rate).map_err(failed)?)),
        };
        let images =
            footage.show(|seen| seen.iter().try_for_each(|(shot, rgb)| reel.show(rgb, shot.time).map_err(failed)))?;
        reel.end().map_err(failed)?;
        draft.finish()?;
        Ok(images)
    }

    fn write_images(&self, footage: &mut Footage<'_>) -> Result<usize, Error> {
        let draft = DraftFolder::new(&self.path)?;
        let size = footage.camera.resolution;
        let images = footage.show(|seen| {
            seen.par_iter().try_for_each(|(Shot { number, .. }, rgb)| {
                write(&draft.path().join(format!("{number:06}.png")), Pixels::Colours(rgb), size)
            })
        })?;
        draft.finish()?;
        Ok(images)
    }

    fn failed(&self, source: Box<dyn StdError + Send + Sync>) -> Error {
        Failure::Drawing { path: self.path.clone(), source }.into()
    }
}
