//! Records a labelled data set: a folder for each test, with the images of its cameras and their labels.
//!
//! The folder of a test gets its final name only when the folder is complete. So a folder with this name is always
//! complete, even after a crash.

use super::coco::{ANNOTATIONS, Annotations, merge};
use super::image::{Pixels, depth_words, write};
use super::missing::Missing;
use super::{Film, Inside, Projector, Rendering, Shot};
use paracosm_campaign::cameras::VariedCameras;
use paracosm_campaign::files::{Draft, read_text, write_whole_here};
use paracosm_campaign::{Error, Reason, Trial, Worker};
use paracosm_engine::sensor::Cameras;
use paracosm_render::{Camera, Look, NoCamera, Semantic, Stages, WantedImages, camera_settings};
use paracosm_space::{did_you_mean, nearest};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use thiserror::Error;

/// The file that describes the recording, beside the campaign's own files.
const RECORDING: &str = "recording.json";

/// The kinds of camera outputs that a recording keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kept {
    /// True if the colour images are kept.
    pub rgb: bool,
    /// True if the images of semantic classes are kept.
    pub semantic: bool,
    /// True if the images of depth are kept.
    pub depth: bool,
    /// True if the images of object ids are kept.
    pub instance: bool,
    /// True if the boxes around visible objects are kept.
    pub boxes: bool,
}

impl Kept {
    /// The choice that keeps all camera outputs.
    pub const ALL: Self = Self { rgb: true, semantic: true, depth: true, instance: true, boxes: true };

    /// Returns the images that the renderer has to draw for the outputs that are kept.
    pub fn outputs(self) -> WantedImages {
        WantedImages {
            rgb: self.rgb,
            depth: self.depth,
            semantic: self.semantic || self.boxes,
            instance: self.instance || self.boxes,
            alone: self.boxes,
            ..WantedImages::default()
        }
    }
}

/// The names of the outputs.
const NAMES: [&str; 5] = ["rgb", "semantic", "depth", "instance", "boxes"];

/// The reason why a list of camera outputs is not valid.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OutputsFlaw {
    /// The list of outputs is empty.
    #[error("the list of outputs is empty, expected some of {}", NAMES.join(", "))]
    Nothing,
    /// The list of outputs has an unknown name.
    #[error("unknown output `{name}`, expected some of {}{}", NAMES.join(", "), did_you_mean(.nearest))]
    Unknown {
        /// The unknown name of an output.
        name: String,
        /// The most similar known name, if any name is similar.
        nearest: Option<&'static str>,
    },
}

/// The error that a folder already has a recording with other cameras, outputs or colours.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{} holds a recording with other cameras, outputs or colours; repeat the command that began the recording, or choose another folder \
     with --out", path.display()
)]
pub struct OtherRecording {
    /// The path of the file that describes the existing recording.
    pub path: PathBuf,
}

impl Reason for OutputsFlaw {}
impl Reason for OtherRecording {}

impl FromStr for Kept {
    type Err = OutputsFlaw;

    /// Reads a list of camera outputs, with names from `rgb,semantic,depth,instance,boxes`.
    fn from_str(list: &str) -> Result<Self, OutputsFlaw> {
        if list.trim().is_empty() {
            return Err(OutputsFlaw::Nothing);
        }
        let mut found = [false; 5];
        for name in list.split(',').map(str::trim) {
            let Some(place) = NAMES.iter().position(|known| *known == name) else {
                return Err(OutputsFlaw::Unknown { name: name.to_owned(), nearest: nearest(name, NAMES) });
            };
            found[place] = true;
        }
        let [rgb, semantic, depth, instance, boxes] = found;
        Ok(Self { rgb, semantic, depth, instance, boxes })
    }
}

/// The description of a data set, by which a later recording with other settings is refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Recording {
    kept: Kept,
    /// The seed of the random colours of road users; `None` if colours are not random.
    colours: Option<u64>,
    /// The look of the images; `None` for the look of all images before there was a choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    look: Option<Look>,
    /// The cameras. A setting that tests vary has the middle of its range here; the study holds the range.
    cameras: Cameras,
}

/// The result of recording the cameras in a test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recorded {
    /// The number of recorded images of all cameras.
    pub images: usize,
    /// A sentence for each reason why images are missing.
    pub notes: Vec<String>,
}

/// A data set of labelled camera images, in the folder of its campaign.
#[derive(Debug)]
pub struct Dataset {
    folder: PathBuf,
    recording: Recording,
    cameras: VariedCameras,
    stages: Stages,
}

impl Dataset {
    /// Opens the data set in the folder of a campaign, or begins a new data set. The tests vary the settings that
    /// [`VariedCameras::parameters`] lists.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be written, or if it holds a data set of other cameras, outputs or
    /// colours.
    pub fn open(
        folder: &Path,
        cameras: impl Into<VariedCameras>,
        kept: Kept,
        colours: Option<u64>,
    ) -> Result<Self, Error> {
        let (file, cameras) = (folder.join(RECORDING), cameras.into());
        let look = Some(cameras.look()).filter(|look| *look != Look::default());
        let mut recording = Recording { kept, colours, look, cameras: cameras.nominal().clone() };
        camera_settings().complete(&mut recording.cameras);
        if file.exists() {
            let text = read_text(&file)?;
            let mut there: Recording =
                serde_json::from_str(&text).map_err(|error| Error::in_file(&file, error.line(), error))?;
            // An older version did not write the settings that later versions added.
            camera_settings().complete(&mut there.cameras);
            there.cameras.look = there.look.unwrap_or_default();
            if there != recording {
                return Err(OtherRecording { path: file }.into());
            }
        } else {
            write_whole_here(&file, pretty(&recording).as_bytes())?;
        }
        Ok(Self { folder: folder.to_owned(), recording, cameras, stages: Stages::default() })
    }

    /// Returns `true` if the data set has the recording of a test.
    pub fn has(&self, trial: &Trial) -> bool {
        self.path(trial).exists()
    }

    /// Runs a test again and records the images of its cameras in the data set. The projector must have the data set's
    /// cameras and outputs.
    ///
    /// # Errors
    /// Returns an error if the test is not the test that was logged, its images cannot be drawn, or its folder cannot
    /// be written.
    pub fn record(&self, worker: &mut Worker, trial: &Trial, projector: &mut Projector) -> Result<Recorded, Error> {
        let cameras = self.cameras.of_test(&trial.test);
        let mut film = Film::of(worker, trial, &cameras, &self.stages)?;
        if let Some(seed) = self.recording.colours {
            film.repaint(seed, trial.index);
        }
        if self.cameras.vary() {
            projector.fit(&cameras)?;
        }
        let whole = self.path(trial);
        let part = whole.with_extension("part");
        if part.exists() {
            fs::remove_dir_all(&part).map_err(Error::io("remove", &part))?;
        }
        let recorded = self.write((&film, &cameras, trial), projector, &part);
        if recorded.is_err() {
            // The unfinished folder is of no use. Failing to remove it changes nothing.
            let _ = fs::remove_dir_all(&part);
        }
        let recorded = recorded?;
        fs::rename(&part, &whole).map_err(Error::io("write", &whole))?;
        Ok(recorded)
    }

    /// Writes a COCO file of the boxes in all recorded tests among `trials`, beside the folders of the tests. Programs
    /// that read COCO files load this file.
    ///
    /// # Errors
    /// Returns an error if a file of a test cannot be read, or the new file cannot be written.
    pub fn finish<'t>(&self, trials: impl IntoIterator<Item = &'t Trial>) -> Result<(), Error> {
        if !self.recording.kept.boxes {
            return Ok(());
        }
        let recorded = trials.into_iter().filter(|trial| self.has(trial));
        let tests: Vec<String> = recorded.map(|trial| format!("{:06}", trial.index)).collect();
        let (draft, file) = Draft::new(&self.folder.join(ANNOTATIONS))?;
        merge(&self.folder, &tests, &mut BufWriter::new(file))?;
        draft.finish()
    }

    fn path(&self, trial: &Trial) -> PathBuf {
        self.folder.join(format!("{:06}", trial.index))
    }

    fn write(
        &self,
        (film, cameras, trial): (&Film, &Cameras, &Trial),
        projector: &mut Projector,
        folder: &Path,
    ) -> Result<Recorded, Error> {
        let kept = &self.recording.kept;
        let mut annotations = Annotations::new();
        let mut controls = CONTROLS.to_owned();
        let (mut images, mut notes) = (0, Vec::new());
        fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        for (index, (name, camera)) in cameras.all.iter().enumerate() {
            for kind in kept.kinds() {
                let path = folder.join(name).join(kind);
                fs::create_dir_all(&path).map_err(Error::io("create", &path))?;
            }
            let mut missing = Missing::of(name, camera);
            projector.show(film, index, |shots| {
                for (shot, seen) in &shots {
                    missing.see(shot, seen);
                    controls.push_str(&control_line(name, shot, camera.latency, seen.as_ref().err()));
                    if let Ok(picture) = seen {
                        images += 1;
                        let file = kept.kinds().next().map(|kind| format!("{name}/{kind}/{}", file_name(shot)));
                        annotations.add(name, file, shot, picture);
                    }
                }
                let camera = folder.join(name);
                let pictures = shots.par_iter().filter_map(|(shot, seen)| Some((shot, seen.as_ref().ok()?)));
                pictures.try_for_each(|(shot, picture)| write_images(&camera, shot, picture, *kept))
            })?;
            notes.extend(missing.notes());
        }
        let mut files = vec![
            ("controls.csv", controls),
            (
                "calibration.json",
                pretty(&calibration(cameras, |name| self.cameras.settings_of(name, &trial.test).collect())?),
            ),
        ];
        if kept.boxes {
            files.push((ANNOTATIONS, pretty(&annotations)));
        }
        for (name, contents) in files {
            let path = folder.join(name);
            fs::write(&path, contents).map_err(Error::io("write", &path))?;
        }
        Ok(Recorded { images, notes })
    }
}

impl Kept {
    /// Returns the names of the folders for a camera's images.
    fn kinds(self) -> impl Iterator<Item = &'static str> {
        let kinds =
            [(self.rgb, "rgb"), (self.semantic, "semantic"), (self.depth, "depth"), (self.instance, "instance")];
        kinds.into_iter().filter_map(|(kept, kind)| kept.then_some(kind))
    }
}

fn file_name(shot: &Shot) -> String {
    format!("{:06}.png", shot.number)
}

fn write_images(camera: &Path, shot: &Shot, picture: &Rendering, kept: Kept) -> Result<(), Error> {
    let frame = &picture.frame;
    let size = [frame.width(), frame.height()];
    let depth = frame.planar_depth().map(|depth| depth_words(&depth));
    let palette: Vec<[u8; 3]> = (0..).zip(Semantic::names()).map(|(number, _)| Semantic::colour_of(number)).collect();
    let images = [
        (kept.rgb, "rgb", frame.rgb.as_deref().map(Pixels::Colours)),
        (kept.semantic, "semantic", frame.semantic.as_deref().map(|classes| Pixels::Indices(classes, &palette))),
        (kept.depth, "depth", depth.as_deref().map(Pixels::Words)),
        (kept.instance, "instance", frame.instance.as_deref().map(Pixels::Words)),
    ];
    let wanted = images.into_iter().filter(|(kept, ..)| *kept);
    for (folder, pixels) in wanted.filter_map(|(_, folder, pixels)| Some((folder, pixels?))) {
        write(&camera.join(folder).join(file_name(shot)), pixels, size)?;
    }
    Ok(())
}

const CONTROLS: &str =
    "camera,frame,time,arrival,x,y,heading,speed,travelled,steering,throttle,light,fog,rain,inside\n";

/// Returns a line of the file `controls.csv` for an image. Names of cameras never need quotes; names of objects are
/// quoted if necessary.
fn control_line(camera: &str, shot: &Shot, latency: f64, inside: Option<&Inside>) -> String {
    let Shot { number, time, moment, control } = shot;
    let arrival = time + latency;
    let car = &moment.bodies[0].pose;
    let (x, y, heading) = (car.position.x, car.position.y, car.heading);
    let (speed, travelled, weather) = (moment.speed, moment.travelled, moment.weather);
    let (steering, throttle) = (control.steering, control.throttle);
    let inside = inside.map_or(String::new(), |Inside(thing)| quoted(thing));
    format!(
        "{camera},{number},{time},{arrival},{x},{y},{heading},{speed},{travelled},{steering},{throttle},{},{},{},{inside}\n",
        weather.light, weather.fog, weather.rain
    )
}

/// Returns a text as a field of a CSV file, in quotes if necessary.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// Returns the contents of the file `calibration.json`. It holds each camera's matrix, which maps x to the right, y
/// down and z forward to pixels, the place where the camera is mounted, and the values of the camera's settings that
/// vary from test to test.
fn calibration<'n>(
    cameras: &'n Cameras,
    varied: impl Fn(&'n str) -> BTreeMap<&'static str, f64>,
) -> Result<serde_json::Value, Error> {
    let described = cameras.all.iter().map(|(name, spec)| {
        let camera = Camera::of(spec).map_err(|flaw| NoCamera { camera: name.clone(), flaw: flaw.into() })?;
        let [width, height] = spec.resolution;
        let (focal, x, y) = (camera.focal_pixels(), f64::from(width) / 2.0, f64::from(height) / 2.0);
        let pose = camera.mount().to_homogeneous();
        let rows: Vec<Vec<f64>> = pose.row_iter().map(|row| row.iter().copied().collect()).collect();
        let mut described = json!({
            "width": width,
            "height": height,
            "K": [[focal, 0.0, x], [0.0, focal, y], [0.0, 0.0, 1.0]],
            "camera_to_car": rows,
            "rate": spec.rate,
            "latency": spec.latency,
            "position": spec.position,
            "yaw_pitch_roll": spec.yaw_pitch_roll,
        });
        let varied = varied(name);
        if !varied.is_empty() {
            described["varied"] = json!(varied);
        }
        Ok((name.clone(), described))
    });
    let cameras = described.collect::<Result<serde_json::Map<_, _>, Error>>()?;
    let axes = "of the car and of a camera: x forward, y to the left, z up, in metres; K takes x to the right, y down, \
                z forward, and the middle of the upper left pixel is at (0.5, 0.5); depth images are metres along a camera's axis times 256, 0 for none";
    Ok(json!({"axes": axes, "cameras": cameras}))
}

fn pretty(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("what is recorded is always JSON");
    text.push('\n');
    text
}
