//! Draws what one camera sees of a test, image by image, so that only a few images are in memory.

use super::missing::Missing;
use super::video::Video;
use super::{Film, Projector, Rendering, Shot};
use paracosm_campaign::cameras::standard_cameras;
use paracosm_campaign::{Error, Reason, Trial, Worker};
use paracosm_engine::sensor::{CameraSpec, Cameras};
use paracosm_render::{Look, Stages, WantedImages};
use std::error::Error as StdError;
use std::io::Cursor;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// The film of the first of a set of cameras, ready to be drawn.
pub(super) struct Footage<'a> {
    film: Film,
    projector: Projector,
    missing: Missing<'a>,
    pub name: &'a str,
    pub camera: &'a CameraSpec,
    stop: &'a AtomicBool,
}

/// The error that the camera gave no image, so that there is no film.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("camera {camera} saw nothing: {why}")]
struct NothingSeen {
    camera: String,
    why: String,
}

/// The error that a film cannot be made.
#[derive(Debug, Error)]
#[error("camera {camera} gives no film: {source}")]
struct NoFilm {
    camera: String,
    source: Box<dyn StdError + Send + Sync>,
}

impl Reason for NothingSeen {}
impl Reason for NoFilm {}

impl<'a> Footage<'a> {
    /// Runs a test again, and keeps what the first of these cameras sees. The flag ends the drawing once it is set.
    ///
    /// # Errors
    /// There is no adapter, the camera is not possible, or the test is not the test that was logged.
    pub fn of(worker: &mut Worker, trial: &Trial, cameras: &'a Cameras, stop: &'a AtomicBool) -> Result<Self, Error> {
        let film = Film::of(worker, trial, cameras, &Stages::default())?;
        let projector = Projector::new(cameras, WantedImages { rgb: true, ..WantedImages::default() })?;
        let (name, camera) = cameras.all.iter().next().expect("there is a camera in every set");
        Ok(Self { film, projector, missing: Missing::of(name, camera), name, camera, stop })
    }

    /// Draws all images in batches; `each` gets every image of a batch that the camera gave. Returns the number of images.
    ///
    /// # Errors
    /// The flag is set, a view cannot be drawn, `each` fails, or the camera gave no image.
    pub fn show(&mut self, mut each: impl FnMut(&[(&Shot, &[u8])]) -> Result<(), Error>) -> Result<usize, Error> {
        let Self { film, projector, missing, stop, .. } = self;
        let mut images = 0;
        projector.show(film, 0, |shots| {
            if stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            shots.iter().for_each(|(shot, seen)| missing.see(shot, seen));
            let seen: Vec<(&Shot, &[u8])> =
                shots.iter().filter_map(|(shot, seen)| Some((*shot, colours_of(seen)?))).collect();
            images += seen.len();
            each(&seen)
        })?;
        if images > 0 { Ok(images) } else { Err(self.nothing().into()) }
    }

    /// Draws a few images, spread evenly over the test; if the camera gave none of these images, draws all images.
    ///
    /// # Errors
    /// The flag is set, a view cannot be drawn, or the camera gave no image.
    pub fn glance(&mut self, mut each: impl FnMut(&[u8])) -> Result<(), Error> {
        let mut images = 0;
        for some in [&self.film.sample(), &self.film] {
            if images == 0 {
                self.projector.show(some, 0, |shots| {
                    if self.stop.load(Ordering::Relaxed) {
                        return Err(Error::Interrupted);
                    }
                    shots.iter().filter_map(|(_, seen)| colours_of(seen)).for_each(|rgb| {
                        images += 1;
                        each(rgb);
                    });
                    Ok(())
                })?;
            }
        }
        if images > 0 { Ok(()) } else { Err(self.nothing().into()) }
    }

    /// Returns lines of text that say which images are missing.
    pub fn notes(&self) -> Vec<String> {
        self.missing.notes()
    }

    fn nothing(&self) -> NothingSeen {
        let thing = self.film.shots[0].first().map(|_| "it is inside something at all times".to_owned());
        let why = thing.or_else(|| self.notes().into_iter().next()).unwrap_or_default();
        NothingSeen { camera: self.name.to_owned(), why }
    }
}

fn colours_of(seen: &Result<Rendering, super::Inside>) -> Option<&[u8]> {
    seen.as_ref().ok()?.frame.rgb.as_deref()
}

/// Runs a test again, and returns the film of the first of these cameras as the contents of an MP4 file. The flag ends the drawing once it is
/// set.
///
/// # Errors
/// There is no adapter, the camera is not possible or its images are too large for a film, the test is not the test that was logged, or nothing
/// was seen.
pub fn mp4(worker: &mut Worker, trial: &Trial, cameras: &Cameras, stop: &AtomicBool) -> Result<Vec<u8>, Error> {
    let mut footage = Footage::of(worker, trial, cameras, stop)?;
    let (name, camera) = (footage.name, footage.camera);
    let failed = |source| Error::unavailable(NoFilm { camera: name.to_owned(), source });
    let mut file = Cursor::new(Vec::new());
    let mut video = Video::begin(&mut file, camera.resolution, camera.rate).map_err(failed)?;
    footage.show(|seen| seen.iter().try_for_each(|(shot, rgb)| video.show(rgb, shot.time).map_err(failed)))?;
    video.end().map_err(failed)?;
    Ok(file.into_inner())
}

/// Returns the cameras of the driver, or a camera for people if the driver has no camera.
///
/// # Errors
/// No driver can be made.
pub fn cameras_of(worker: &mut Worker) -> Result<Cameras, Error> {
    let eyes = worker.eyes()?;
    Ok(if eyes.all.is_empty() { Cameras { look: Look::Textured, ..standard_cameras() } } else { eyes })
}
