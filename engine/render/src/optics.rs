//! A camera ready to draw with: from its description to the pinhole for the renderer, and the lens for its light.

use crate::lens::Lens;
use crate::{Camera, CameraFlaw, CameraSettings, Frame, NoCamera, WantedImages, camera_settings};
use paracosm_engine::sensor::{CameraSpec, Cameras, Chance};

/// A camera with its lens and its noise.
#[derive(Debug, Clone)]
pub struct Optics {
    /// The name of the camera.
    pub name: String,
    /// The camera without its lens.
    pub camera: Camera,
    lens: Lens,
    seed: u64,
}

impl Optics {
    /// All of a set, in the order of their names.
    ///
    /// # Errors
    /// There is no such camera; the error names it.
    pub fn of(cameras: &Cameras) -> Result<Vec<Self>, NoCamera> {
        Self::with(camera_settings(), cameras)
    }

    /// All of a set, by a table of settings of one's own.
    ///
    /// # Errors
    /// There is no such camera; the error names it.
    pub fn with(settings: CameraSettings, cameras: &Cameras) -> Result<Vec<Self>, NoCamera> {
        let ready = |(name, spec): (&String, &CameraSpec)| {
            let camera = settings.check(spec).and_then(|()| Ok(Camera::of(spec)?));
            let camera = camera.map_err(|flaw: CameraFlaw| NoCamera { camera: name.clone(), flaw })?;
            let lens = Lens::with(settings.effects(), spec);
            Ok(Self { name: name.clone(), camera, lens, seed: cameras.seed })
        };
        cameras.all.iter().map(ready).collect()
    }

    /// The same with other noise.
    pub fn with_seed(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    /// The outputs that the renderer draws for these: colours as they are, or light for the lens.
    pub fn needs(&self, wanted: WantedImages) -> WantedImages {
        let plain = self.is_plain();
        WantedImages { rgb: wanted.rgb && plain, linear: wanted.rgb && !plain, ..wanted }
    }

    /// Whether colours go through it as they are.
    pub fn is_plain(&self) -> bool {
        self.lens.is_plain()
    }

    /// The colours that it gives of linear light, with the noise of this image; `None` where the frame has no light.
    pub fn develop(&self, frame: &Frame, number: u64) -> Option<Vec<u8>> {
        self.lens.develop(frame, |effect| self.chance(effect, number))
    }

    /// The chance of an effect in an image of this number.
    pub fn chance(&self, effect: &str, number: u64) -> Chance {
        Chance::of(self.seed, &format!("{}, {effect}", self.name), number)
    }
}
