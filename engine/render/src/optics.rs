//! A camera that is ready to draw: the pinhole for the renderer, and the lens for the light, made from the description.

use crate::lens::Lens;
use crate::{Camera, CameraFlaw, CameraSettings, Frame, NoCamera, WantedImages, camera_settings};
use paracosm_engine::sensor::{CameraSpec, Cameras, Chance};

/// A camera with its lens and its noise.
#[derive(Debug, Clone)]
pub struct Optics {
    /// The name of the camera.
    pub name: String,
    /// The pinhole camera without the lens.
    pub camera: Camera,
    lens: Lens,
    seed: u64,
}

impl Optics {
    /// Makes all cameras of a set, in the order of their names.
    ///
    /// # Errors
    /// A camera cannot be made; the error names it.
    pub fn of(cameras: &Cameras) -> Result<Vec<Self>, NoCamera> {
        Self::with(camera_settings(), cameras)
    }

    /// Makes all cameras of a set, by another table of settings.
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

    /// Returns the same camera with another seed for its noise.
    pub fn with_seed(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    /// Returns the outputs that the renderer has to draw for the `wanted` outputs. They have colours, or linear light
    /// if the lens changes it.
    pub fn needs(&self, wanted: WantedImages) -> WantedImages {
        let plain = self.is_plain();
        WantedImages { rgb: wanted.rgb && plain, linear: wanted.rgb && !plain, ..wanted }
    }

    /// Returns `true` if the lens does not change colours.
    pub fn is_plain(&self) -> bool {
        self.lens.is_plain()
    }

    /// Returns the colours that the camera makes of linear light, with the noise of image `number`; `None` if the frame
    /// has no light.
    pub fn develop(&self, frame: &Frame, number: u64) -> Option<Vec<u8>> {
        self.lens.develop(frame, |effect| self.chance(effect, number))
    }

    /// Returns the source of randomness for an effect in image `number`.
    pub fn chance(&self, effect: &str, number: u64) -> Chance {
        Chance::of(self.seed, &format!("{}, {effect}", self.name), number)
    }
}
