//! A camera that is ready to draw: the pinhole for the renderer, and the lens for the light, made from the description.

use crate::lens::Lens;
use crate::{Camera, CameraFlaw, CameraSettings, Frame, NoCamera, WantedImages, camera_settings};
use paracosm_engine::sensor::{CameraSpec, Cameras, Chance};

/// A camera that is ready to draw, with its lens, its sensor and the seed of its noise.
#[derive(Debug, Clone)]
pub struct Optics {
    /// The name of the camera.
    pub name: String,
    /// The pinhole camera, without the effects of the lens.
    pub camera: Camera,
    lens: Lens,
    seed: u64,
}

impl Optics {
    /// Prepares all cameras of a set for drawing, and returns the cameras sorted by name.
    ///
    /// # Errors
    /// A camera cannot be made; the error names it.
    pub fn of(cameras: &Cameras) -> Result<Vec<Self>, NoCamera> {
        Self::with(camera_settings(), cameras)
    }

    /// Prepares all cameras of a set for drawing, with a given table of camera settings.
    ///
    /// # Errors
    /// A camera cannot be made; the error names it.
    pub fn with(settings: CameraSettings, cameras: &Cameras) -> Result<Vec<Self>, NoCamera> {
        let ready = |(name, spec): (&String, &CameraSpec)| {
            let camera = settings.check(spec).and_then(|()| Ok(Camera::of(spec)?));
            let camera = camera.map_err(|flaw: CameraFlaw| NoCamera { camera: name.clone(), flaw })?;
            let lens = Lens::with(settings.effects(), spec);
            Ok(Self { name: name.clone(), camera, lens, seed: cameras.seed })
        };
        cameras.all.iter().map(ready).collect()
    }

    /// Returns the camera with another seed for its noise.
    pub fn with_seed(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    /// Returns the images that the renderer has to draw so that the camera can give the `wanted` images. The images
    /// have colours in sRGB, or linear light if the lens changes the light.
    pub fn needs(&self, wanted: WantedImages) -> WantedImages {
        let plain = self.is_plain();
        WantedImages { rgb: wanted.rgb && plain, linear: wanted.rgb && !plain, ..wanted }
    }

    /// Returns `true` if the lens and the sensor leave all colours unchanged.
    pub fn is_plain(&self) -> bool {
        self.lens.is_plain()
    }

    /// Returns the camera's image of a frame in sRGB, with the noise of image `number`; `None` if the frame has no
    /// linear light.
    pub fn develop(&self, frame: &Frame, number: u64) -> Option<Vec<u8>> {
        self.lens.develop(frame, |effect| self.chance(effect, number))
    }

    /// Returns the source of randomness for one effect of the lens or sensor in image `number`.
    pub fn chance(&self, effect: &str, number: u64) -> Chance {
        Chance::of(self.seed, &format!("{}, {effect}", self.name), number)
    }
}
