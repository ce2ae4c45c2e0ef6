//! The images of cameras, with the frame and the calibration of each camera.

use super::recorder::CAMERA;
use super::scene::{frame, stamp};
use super::tape::Tape;
use crate::record::image::{Pixels, png};
use crate::record::missing::Missing;
use crate::record::{Film, Projector};
use foxglove::messages::{CameraCalibration, CompressedImage, FrameTransforms};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use paracosm_campaign::Error;
use paracosm_engine::sensor::{CameraSpec, Cameras};
use paracosm_render::Camera;
use rayon::prelude::*;
use std::io::{Seek, Write};

/// The writer of the images of cameras into a file.
pub(super) struct Images<'a, W: Write + Seek> {
    /// The name of the ego vehicle, which carries the cameras.
    pub ego: &'a str,
    pub tape: &'a mut Tape<W>,
}

impl<W: Write + Seek> Images<'_, W> {
    /// Draws and writes the images of all cameras. Returns sentences about missing images.
    pub fn of_all(&mut self, film: &Film, projector: &mut Projector, cameras: &Cameras) -> Result<Vec<String>, Error> {
        let mut notes = Vec::new();
        for (place, (name, spec)) in cameras.all.iter().enumerate() {
            let mut missing = Missing::of(name, spec);
            self.of(film, projector, place, (name, spec), &mut missing)?;
            notes.extend(missing.notes());
        }
        Ok(notes)
    }

    fn of(
        &mut self,
        film: &Film,
        projector: &mut Projector,
        place: usize,
        (name, spec): (&str, &CameraSpec),
        missing: &mut Missing<'_>,
    ) -> Result<(), Error> {
        let (frame_id, tape) = (format!("{CAMERA}{name}"), &mut *self.tape);
        let frames = tape.topic::<FrameTransforms>(&format!("/tf/camera/{name}"), &[])?;
        let images = tape.topic::<CompressedImage>(&format!("/camera/{name}/image"), &[])?;
        let calibrations = tape.topic::<CameraCalibration>(&format!("/camera/{name}/calibration"), &[])?;
        let camera = Camera::of(spec).map_err(|source| tape.failed(source.into()))?;
        let first = film.shots[place].first().map_or(0.0, |shot| shot.time);
        let transforms = vec![frame(stamp(first), self.ego, &frame_id, &optical(&camera))];
        tape.say(frames, first, &FrameTransforms { transforms });
        tape.flush()?;
        projector.show(film, place, |shots| {
            shots.iter().for_each(|(shot, seen)| missing.see(shot, seen));
            let drawn = shots.par_iter().filter_map(|(shot, seen)| {
                let colours = seen.as_ref().ok()?.frame.rgb.as_deref()?;
                Some((shot.time, png(Pixels::Colours(colours), spec.resolution)))
            });
            for (time, image) in drawn.collect::<Vec<_>>() {
                let data = image.map_err(|source| tape.failed(source.into()))?.into();
                let (timestamp, frame_id) = (stamp(time), frame_id.clone());
                let image = CompressedImage { timestamp, frame_id, data, format: "png".to_owned() };
                tape.say(images, time, &image);
                tape.say(calibrations, time, &calibration(time, &image.frame_id, &camera));
            }
            tape.flush()
        })
    }
}

/// Returns the optical frame of a camera in the frame of its vehicle: x to the right in the image, y down, z ahead.
fn optical(camera: &Camera) -> Isometry3<f64> {
    let turn = UnitQuaternion::new_normalize(Quaternion::new(0.5, -0.5, 0.5, -0.5));
    camera.mount() * Isometry3::from_parts(Translation3::identity(), turn)
}

/// Returns the pinhole of a camera. The lens of a camera may distort its images further, which no pinhole describes.
fn calibration(time: f64, frame_id: &str, camera: &Camera) -> CameraCalibration {
    let (width, height, focal) = (camera.width(), camera.height(), camera.focal_pixels());
    let (x, y) = (0.5 * f64::from(width), 0.5 * f64::from(height));
    CameraCalibration {
        timestamp: stamp(time),
        frame_id: frame_id.to_owned(),
        width,
        height,
        distortion_model: String::new(),
        d: Vec::new(),
        k: vec![focal, 0.0, x, 0.0, focal, y, 0.0, 0.0, 1.0],
        r: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: vec![focal, 0.0, x, 0.0, 0.0, focal, y, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
}
