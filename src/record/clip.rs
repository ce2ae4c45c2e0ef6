//! What one camera sees of a test, for people: as a film in a GIF file, or as a folder of PNG files.

use super::image::{Pixels, png};
use super::{Film, Projector};
use crate::folder::is_new;
use crate::{Error, Trial, Worker, plot};
use paracosm_engine::sensor::Cameras;
use paracosm_render::{Outputs, Stages};
use std::fs;
use std::path::{Path, PathBuf};

/// Where a clip goes, which does not exist yet.
#[derive(Debug)]
pub struct Clip {
    path: PathBuf,
    is_film: bool,
}

impl Clip {
    /// A clip in a file that ends in `.gif`, or in a folder of images, whose name has no ending.
    ///
    /// # Errors
    /// It exists, or its name has another ending.
    pub fn new(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_film = match ending.as_deref() {
            Some("gif") => true,
            None => false,
            Some(other) => {
                let message = format!(
                    "--camera {}: found the ending `.{other}`, expected FILE.gif, or a FOLDER without an ending for PNG files",
                    path.display()
                );
                return Err(Error::Usage(message));
            }
        };
        is_new(path, "a film")?;
        Ok(Self { path: path.to_owned(), is_film })
    }

    /// Films a test of a worker's study with the first of these cameras; in words, what was written.
    ///
    /// # Errors
    /// There is no adapter, the test is not the one that was logged, nothing was seen, or nothing can be written.
    pub fn write(&self, worker: &mut Worker, trial: &Trial, cameras: &Cameras) -> Result<String, Error> {
        let film = Film::of(worker, trial, cameras, &Stages::default())?;
        let mut projector = Projector::new(cameras, Outputs { rgb: true, ..Outputs::default() })?;
        let mut images: Vec<(u64, Vec<u8>)> = Vec::new();
        projector.show(&film, 0, |pictures| {
            let colours = pictures.into_iter().map(|(shot, picture)| (shot.number, picture.frame.rgb));
            images.extend(colours.filter_map(|(number, rgb)| Some((number, rgb?))));
            Ok(())
        })?;
        let camera = cameras.all.values().next().expect("there is a camera in every set");
        let drawn = format!("{} images", images.len());
        let failed = |message: String| Error::Picture { path: self.path.clone(), message };
        if images.is_empty() {
            return Err(failed("the camera saw nothing".to_owned()));
        }
        if self.is_film {
            let images: Vec<_> = images.into_iter().map(|(_, rgb)| rgb).collect();
            let film = plot::gif_of_images(&images, camera.resolution, 1.0 / camera.rate);
            crate::folder::write_whole(&self.path, &film.map_err(|error| failed(error.to_string()))?)?;
        } else {
            let part = self.path.with_extension("part");
            fs::create_dir_all(&part).map_err(Error::file("create", &part))?;
            for (number, rgb) in images {
                let file = part.join(format!("{number:06}.png"));
                let contents = png(Pixels::Colours(&rgb), camera.resolution);
                let contents = contents.map_err(|error| failed(error.to_string()))?;
                fs::write(&file, contents).map_err(Error::file("write", &file))?;
            }
            fs::rename(&part, &self.path).map_err(Error::file("write", &self.path))?;
        }
        Ok(format!("{drawn} written to {}", self.path.display()))
    }
}
