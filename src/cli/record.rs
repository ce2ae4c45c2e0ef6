//! `paracosm-fuzz record`: runs a campaign, and records its tests with cameras.

use super::arguments::RECORDED;
use super::output::plural;
use super::run::{self, Conducted};
use super::usage;
use super::{Failure, Status, Verbosity, print};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use paracosm_campaign::cameras::{VariedCameras, read_cameras, standard_cameras, standard_cameras_file};
use paracosm_campaign::{Catalogue, Error, Trial, Worker};
use paracosm_report::record::{Dataset, Kept, Projector};
use std::path::PathBuf;
use std::sync::atomic::Ordering;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz record pedestrian-crossing --strategy halton --budget 20 --out images
  paracosm-fuzz record pedestrian-crossing --outputs rgb,depth --colours 7 --out images
  paracosm-fuzz record --print-cameras > cameras.toml
      a file of cameras to edit
  paracosm-fuzz record pedestrian-crossing --cameras cameras.toml
      use the edited file

Beside the files of the campaign, --out gets a folder for each test. The folder 000017 of test 17 has for a \
    camera `front`:
  front/rgb/000003.png: colours of its fourth image, in sRGB
  front/semantic/000003.png: the class of each pixel, numbered and coloured as CARLA does
  front/depth/000003.png: metres along the camera's axis times 256, 16 bits; 0 if the ray hits nothing (as in \
    KITTI)
  front/instance/000003.png: the number of the thing, 16 bits; 0 for a pixel without a thing
  annotations.json: boxes and masks in the COCO format, with occlusion and boxes in 3D
  calibration.json: the cameras' matrices and where they are mounted
  controls.csv: for each image its time, pose and speed, and the driver's answer
The file annotations.json beside these folders has the boxes and masks of all tests as one dataset.";

/// The options of `record`.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    run: run::Options,
    /// The cameras on the ego vehicle
    ///
    /// A setting that is a range, "LO..HI", or a list, "A,B,C", becomes a parameter of the tests, named camera.NAME.SETTING
    /// [default: the file of --print-cameras].
    #[arg(long, value_name = "CAMERAS.toml", help_heading = RECORDED)]
    cameras: Option<PathBuf>,
    /// Only print the file of the default camera
    ///
    /// The file explains every setting.
    #[arg(long, help_heading = RECORDED)]
    print_cameras: bool,
    /// The outputs to write
    ///
    /// Some of rgb, semantic, depth, instance, boxes [default: all of them].
    #[arg(long, value_name = "LIST", default_value = "rgb,semantic,depth,instance,boxes", hide_default_value = true, help_heading = RECORDED)]
    outputs: String,
    /// Paint cars and people in random colours
    ///
    /// The colours of every test are drawn from this seed. Colours should not matter to a driver.
    #[arg(long, value_name = "SEED", help_heading = RECORDED, hide_short_help = true)]
    colours: Option<u64>,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        if self.print_cameras {
            return print(&standard_cameras_file()).map(|()| Status::Nothing);
        }
        if self.run.subject.is_system() {
            return Err(usage(
                "--system: a system has no world that cameras could record; `record` needs a scenario".into(),
            )
            .into());
        }
        let cameras = match &self.cameras {
            Some(path) => read_cameras(path)?,
            None => VariedCameras::from(standard_cameras()),
        };
        let kept: Kept = self.outputs.parse()?;
        // A missing adapter is reported before a long campaign, not after it.
        let mut projector = Projector::new(cameras.nominal(), kept.outputs())?;
        let conducted = self.run.conduct(catalogue, verbosity, |study| Ok(study.open_cameras(&cameras)))?;
        let dataset = Dataset::open(&self.run.out, cameras, kept, self.colours)?;
        self.record(&conducted, &dataset, &mut projector, verbosity)?;
        Ok(conducted.found)
    }

    fn record(
        &self,
        conducted: &Conducted,
        dataset: &Dataset,
        projector: &mut Projector,
        verbosity: Verbosity,
    ) -> Result<(), Failure> {
        let Conducted { report, stop, .. } = conducted;
        let (study, trials) = (report.log.study(), report.log.trials());
        let (sound, broken): (Vec<&Trial>, Vec<&Trial>) = trials.iter().partition(|trial| trial.covers());
        let left: Vec<&Trial> = sound.into_iter().filter(|trial| !dataset.has(trial)).collect();
        let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new(left.len() as u64) };
        let template = "{bar:40.blue/white} {human_pos}/{human_len} tests recorded  {eta} left  {msg}";
        let bar = bar.with_style(ProgressStyle::with_template(template).expect("the template is one"));
        let (mut worker, mut images) = (Worker::new(study)?, 0);
        for trial in &left {
            if stop.load(Ordering::Relaxed) {
                bar.finish_and_clear();
                let message = "the tests recorded so far are complete; --resume continues from there";
                return Err(format!("{}\n  {message}", Error::Interrupted).into());
            }
            let recorded = dataset.record(&mut worker, trial, projector)?;
            images += recorded.images;
            bar.suspend(|| {
                recorded.notes.iter().for_each(|note| verbosity.note(format_args!("test {}: {note}", trial.index)));
            });
            bar.set_message(plural(images, "image"));
            bar.inc(1);
        }
        bar.finish_and_clear();
        dataset.finish(trials)?;
        let (tests, drawn) = (plural(left.len(), "test"), plural(images, "image"));
        verbosity.note(format_args!("{drawn} of {tests} written to {}", self.run.out.display()));
        if !broken.is_empty() {
            verbosity.note(format_args!(
                "{} ended as invalid or in an error and cannot be recorded",
                plural(broken.len(), "test")
            ));
        }
        Ok(())
    }
}
