//! Writes what one camera sees of a test, for people: a film as an MP4 or a GIF file, or a folder of PNG files.
//!
//! Each image is written as soon as it is drawn, so that only a few images are in memory.

use super::image::{Pixels, write};
use super::missing::Missing;
use super::video::Video;
use super::{Film, Projector, Rendering, Shot};
use crate::plot;
use paracosm_campaign::files::{Draft, DraftFolder, is_new};
use paracosm_campaign::{Error, Failure, Reason, Trial, Worker};
use paracosm_engine::sensor::{CameraSpec, Cameras};
use paracosm_render::{Look, Stages, WantedImages};
use paracosm_space::plural;
use paracosm_space::{did_you_mean, nearest};
use rayon::prelude::*;
use std::error::Error as StdError;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// The destination of a film of a test, which is a film file or a new folder of images.
#[derive(Debug)]
pub struct Clip {
    path: PathBuf,
    form: Form,
    look: Look,
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

/// The error that the camera gave no image, so that there is no film to write.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the camera saw nothing: {why}")]
pub struct NothingSeen {
    /// The reason why the camera gave no image, in words.
    pub why: String,
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
        Ok(Self { path: path.to_owned(), form, look: Look::default(), stop: Arc::default() })
    }

    /// Returns the destination for images of another look. The default is the look of the images that drivers see.
    pub fn in_look(self, look: Look) -> Self {
        Self { look, ..self }
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
        let film = Film::of(worker, trial, cameras, &Stages::in_look(self.look))?;
        let mut projector = Projector::new(cameras, WantedImages { rgb: true, ..WantedImages::default() })?;
        let (name, camera) = cameras.all.iter().next().expect("there is a camera in every set");
        let mut missing = Missing::of(name, camera);
        let images = match self.form {
            Form::Images => self.write_images(&film, &mut projector, &mut missing, camera.resolution)?,
            Form::Mp4 | Form::Gif => self.write_film(&film, &mut projector, &mut missing, camera)?,
        };
        let written = format!("{} of camera `{name}` written to {}", plural(images, "image"), self.path.display());
        Ok(std::iter::once(written).chain(missing.notes()).collect())
    }

    fn write_film(
        &self,
        film: &Film,
        projector: &mut Projector,
        missing: &mut Missing<'_>,
        camera: &CameraSpec,
    ) -> Result<usize, Error> {
        let failed = |source| self.failed(source);
        let colours = match self.form {
            Form::Gif => Some(self.colours(film, projector, missing)?),
            Form::Mp4 | Form::Images => None,
        };
        let (draft, file) = Draft::new(&self.path)?;
        let (file, size) = (BufWriter::new(file), camera.resolution);
        let mut reel = match colours {
            Some(colours) => Reel::Gif(Box::new(plot::Reel::begin(file, size, colours.palette()).map_err(failed)?)),
            None => Reel::Mp4(Box::new(Video::begin(file, size, camera.rate).map_err(failed)?)),
        };
        let mut images = 0;
        projector.show(film, 0, |shots| {
            self.go_on()?;
            shots.iter().try_for_each(|(shot, seen)| {
                missing.see(shot, seen);
                let Some(rgb) = colours_of(seen) else { return Ok(()) };
                images += 1;
                reel.show(rgb, shot.time).map_err(failed)
            })
        })?;
        if images == 0 {
            self.nothing(film, missing)?;
        }
        reel.end().map_err(failed)?;
        draft.finish()?;
        Ok(images)
    }

    /// Returns a histogram of the colours of a film.
    fn colours(
        &self,
        film: &Film,
        projector: &mut Projector,
        missing: &mut Missing<'_>,
    ) -> Result<plot::Colours, Error> {
        let mut colours = plot::Colours::default();
        // The camera may be inside something in each of the few sampled images, and still see something in other
        // images.
        for some in [&film.sample(), film] {
            if colours.are_none() {
                projector.show(some, 0, |shots| {
                    self.go_on()?;
                    shots.iter().filter_map(|(_, seen)| colours_of(seen)).for_each(|rgb| colours.count(rgb));
                    Ok(())
                })?;
            }
        }
        if colours.are_none() {
            self.nothing(film, missing)?;
        }
        Ok(colours)
    }

    fn write_images(
        &self,
        film: &Film,
        projector: &mut Projector,
        missing: &mut Missing<'_>,
        size: [u32; 2],
    ) -> Result<usize, Error> {
        let draft = DraftFolder::new(&self.path)?;
        let mut images = 0;
        projector.show(film, 0, |shots| {
            self.go_on()?;
            shots.iter().for_each(|(shot, seen)| missing.see(shot, seen));
            images += shots.iter().filter(|(_, seen)| seen.is_ok()).count();
            shots.par_iter().filter_map(|(shot, seen)| Some((shot, colours_of(seen)?))).try_for_each(|(shot, rgb)| {
                let Shot { number, .. } = shot;
                write(&draft.path().join(format!("{number:06}.png")), Pixels::Colours(rgb), size)
            })
        })?;
        if images == 0 {
            self.nothing(film, missing)?;
        }
        draft.finish()?;
        Ok(images)
    }

    /// Returns an error if the flag of [`until`](Self::until) interrupts the writing.
    fn go_on(&self) -> Result<(), Error> {
        if self.stop.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Returns the error that the film has no image, with the reason.
    fn nothing(&self, film: &Film, missing: &mut Missing<'_>) -> Result<(), Error> {
        let thing = film.shots[0].first().map(|_| "the camera is inside something at all times".to_owned());
        let why = thing.or_else(|| missing.notes().into_iter().next()).unwrap_or_default();
        Err(self.failed(NothingSeen { why }.into()))
    }

    fn failed(&self, source: Box<dyn StdError + Send + Sync>) -> Error {
        Failure::Drawing { path: self.path.clone(), source }.into()
    }
}

fn colours_of(seen: &Result<Rendering, super::Inside>) -> Option<&[u8]> {
    seen.as_ref().ok()?.frame.rgb.as_deref()
}
