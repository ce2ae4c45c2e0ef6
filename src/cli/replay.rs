//! `paracosm-fuzz replay`: runs a test of a campaign's log again, or the tests in regression files.

use super::draw::{FileKind, Target, has_folder, is_ours_to_write};
use super::output::{Format, FormatOption, Table, digits, json, plural, value_words};
use super::usage;
use super::{Failure, Status, Verbosity, on_interrupt, print, regressions, trust};
use crate::engine::sensor::{Cameras, LidarSettings};
use crate::oracles::Trace;
use crate::space::{did_you_mean, nearest};
use clap::{ArgGroup, Args, ValueEnum};
use paracosm_campaign::cameras::read_cameras;
use paracosm_campaign::files::is_no_link;
use paracosm_campaign::{
    Catalogue, Error, Expectation, Log, Metric, Replayed, Study, Subject, Trial, Worker, write_trace,
};
use paracosm_report::birds_eye::MotionRecord;
use paracosm_report::mcap;
use paracosm_report::plot;
use paracosm_report::record::{Clip, cameras_of};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// The options of `replay`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("seen").args(["camera", "mcap"]).multiple(true))]
pub(super) struct Options {
    /// A campaign and the index of a test, or files of `shrink --save`
    #[arg(required = true, value_name = "DIR INDEX | FILE")]
    what: Vec<PathBuf>,
    /// The file for the trace [default: DIR/trace-INDEX.csv]
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,
    /// Draw the run from above
    ///
    /// The file is one picture (.svg, .png) or a film (.gif).
    #[arg(long, value_name = "FILE")]
    draw: Option<PathBuf>,
    /// Film through a camera
    ///
    /// The film goes into a FILE.mp4, a FILE.gif, or PNG files in a new FOLDER.
    #[arg(long, value_name = "FILE|FOLDER")]
    camera: Option<PathBuf>,
    /// Write the run for Foxglove or Rerun
    ///
    /// The file has the frames of all bodies, the roads, the signals, the margins of the requirements and the events; and the images of the
    /// driver's cameras, or of the cameras of --cameras.
    #[arg(long, value_name = "FILE.mcap")]
    mcap: Option<PathBuf>,
    /// Add the points of a LiDAR on the roof to --mcap
    #[arg(long, requires = "mcap", hide_short_help = true)]
    lidar: bool,
    /// The file of cameras for --camera and --mcap
    ///
    /// `paracosm-fuzz record --print-cameras` prints an example [default: the cameras of the driver; for a driver without
    /// cameras, --camera has a camera at the front with 640 x 480 pixels, and --mcap has no images].
    #[arg(long, value_name = "CAMERAS.toml", requires = "seen")]
    cameras: Option<PathBuf>,
    /// The camera for --camera [default: the first]
    ///
    /// The first camera is the first by name.
    #[arg(long, value_name = "NAME", requires = "camera", hide_short_help = true)]
    through: Option<String>,
    /// Show the test also if it ends in another way than in the log
    ///
    /// This is for a driver, a system or a perceiver that was changed since the campaign. The logged results stand beside the new
    /// results. With a command that differs from the command of the campaign, this is the default.
    #[arg(long)]
    changed: bool,
    /// The expected end of the tests in regression files, instead of the expectation in the files
    #[arg(long, value_name = "VERDICT")]
    expect: Option<Ending>,
    /// Write a JUnit report on regression files
    #[arg(long, value_name = "FILE.xml")]
    junit: Option<PathBuf>,
    /// Exit with status 1 if a test does not end as its regression file expects
    ///
    /// A known failure that still fails is expected, so it does not stop a pipeline. With --fail-on-violation, it does.
    #[arg(long, conflicts_with = "fail_on_violation")]
    fail_on_unexpected: bool,
    /// Exit with status 1 if any test fails
    ///
    /// A failure that its regression file expects counts, too.
    #[arg(long)]
    fail_on_violation: bool,
    #[command(flatten)]
    trust: trust::Options,
    #[command(flatten)]
    form: FormatOption,
}

/// The expected end of a test.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Ending {
    /// The test violates the same requirements as before
    Fail,
    /// The test violates no requirement
    Pass,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let found = match self.what.as_slice() {
            [dir, index] if !dir.is_file() => self.replay(dir, parse_index(index)?, catalogue, verbosity)?,
            [dir] if dir.is_dir() => {
                let message = format!("{} is a folder: expected the index of a test after it", dir.display());
                return Err(usage(message).into());
            }
            _ if self.trace.is_some()
                || self.draw.is_some()
                || self.camera.is_some()
                || self.mcap.is_some()
                || self.changed =>
            {
                let message =
                    "--trace, --draw, --camera, --mcap and --changed are for a test of a campaign: replay DIR INDEX";
                return Err(usage(message.into()).into());
            }
            files => {
                let expect = self.expect.map(Expectation::from);
                let counts: fn(&Replayed) -> bool = match self.fail_on_unexpected {
                    true => |replayed| !replayed.as_expected,
                    false => |replayed| replayed.trial.is_failure(),
                };
                regressions::replay(
                    files,
                    catalogue,
                    &self.trust.trust(),
                    expect,
                    self.junit.as_deref(),
                    counts,
                    self.form.format,
                )?
            }
        };
        Ok(if self.fail_on_violation || self.fail_on_unexpected { found } else { Status::Nothing })
    }

    /// Runs a logged test again.
    fn replay(&self, dir: &Path, index: usize, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let only_files = [
            ("--expect", self.expect.is_some()),
            ("--junit", self.junit.is_some()),
            ("--fail-on-unexpected", self.fail_on_unexpected),
        ];
        if let Some((option, _)) = only_files.into_iter().find(|(_, is_given)| *is_given) {
            let message = format!("{option} is for regression files; for a test of a campaign the log has the verdict");
            return Err(usage(message).into());
        }
        let (log, has_other_command) = self.trust.read(dir, catalogue, verbosity)?;
        let (study, logged) = (log.study(), logged(dir, &log, index)?);
        let inputs: Vec<&Path> = self.cameras.as_deref().into_iter().collect();
        let kinds = [FileKind::Svg, FileKind::Png, FileKind::Gif];
        let target = self.draw.as_ref().map(|file| Target::new("--draw", file, &kinds, &inputs)).transpose()?;
        for (option, file) in [("--trace", &self.trace), ("--camera", &self.camera), ("--mcap", &self.mcap)] {
            file.as_deref().map_or(Ok(()), |file| is_ours_to_write(option, file, &inputs))?;
        }
        if let Some(file) = &self.mcap {
            if file.extension().is_none_or(|ending| ending != "mcap") {
                return Err(usage(format!("--mcap {}: expected FILE.mcap", file.display())).into());
            }
            if self.trace.as_ref() == Some(file) {
                return Err(usage(format!("--trace and --mcap are both {}: choose two files", file.display())).into());
            }
        }
        for (option, file) in [("--trace", &self.trace), ("--mcap", &self.mcap)] {
            file.as_deref().map_or(Ok(()), |file| has_folder(option, file))?;
        }
        let clip = self.camera.as_deref().map(Clip::new).transpose()?;
        let given = self.cameras.as_deref().map(read_cameras).transpose()?;
        let given = given.map(|cameras| self.through(cameras.of_test(&logged.test))).transpose()?;
        let seen = [("--draw", &self.draw), ("--camera", &self.camera)];
        let seen = seen.into_iter().find_map(|(option, file)| Some((option, file.as_ref()?)));
        if let (Some((option, file)), Subject::System(_)) = (seen, study.subject()) {
            let message =
                format!("{option} {}: a system has no world to draw; --trace writes its signals", file.display());
            return Err(usage(message).into());
        }
        let mut record = MotionRecord::default();
        let mut tape = self.mcap.as_ref().map(|_| self.recorder()).transpose()?;
        let supervision = verbosity.supervision();
        let stop = Arc::clone(&supervision.stop);
        on_interrupt(Arc::clone(&stop));
        let mut worker = Worker::until(study, supervision)?;
        worker.start()?;
        let watched = target.is_some();
        let (trial, trace) = worker.replay(&log, logged, |run| {
            if watched {
                record.see(run);
            }
            if let Some(tape) = &mut tape {
                tape.see(run);
            }
        });
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted.into());
        }
        // A file from a test that differs from the log would mislead.
        if !trial.repeats(logged) && !self.changed && !has_other_command {
            return Err(difference(&worker, logged, &trial).into());
        }
        if let Some(clip) = clip {
            let cameras = match given {
                Some(given) => given,
                None => self.through(cameras_of(&mut worker)?)?,
            };
            clip.until(stop).write(&mut worker, &trial, &cameras)?.iter().for_each(|line| verbosity.note(line));
        }
        if let (Some(tape), Some(file)) = (&tape, &self.mcap) {
            let filmed = self.filmed(&mut worker, &trial)?;
            let recorded = mcap::Recorded { study, hash: log.hash(), trial: &trial, trace: trace.as_ref() };
            let filmed = filmed.as_ref().map(|filmed| (&mut worker, filmed));
            recorded.write(tape, filmed, file)?.iter().for_each(|line| verbosity.note(line));
        }
        // In the folder of the campaign, a trace of a test that differs from the log would mislead.
        if self.trace.is_some() || trial.repeats(logged) {
            self.write_trace(dir, &trial, trace.as_ref(), verbosity)?;
        }
        if let Some(target) = &target {
            let caption =
                format!("{}, test {}: {}", study.subject().scenario()?.scenario(), trial.index, trial.verdict);
            verbosity.note(target.write(|kind| draw(&record, kind, &caption))?);
        }
        print(&match self.form.format {
            Format::Table => table(study, &trial, logged),
            Format::Json => json(&Replay { logged: (!trial.repeats(logged)).then_some(logged), trial: &trial }),
        })?;
        match trial.error() {
            Some(error) if self.fail_on_violation => Err(format!("test {index} ended in an error: {error}").into()),
            _ if trial.is_failure() => Ok(Status::Violation),
            _ => Ok(Status::Nothing),
        }
    }
}

impl Options {
    /// Writes the trace of the test. Nobody asked for the file in the folder of the campaign, so a note is enough if
    /// this file cannot be written.
    fn write_trace(&self, dir: &Path, trial: &Trial, trace: Option<&Trace>, verbosity: Verbosity) -> Result<(), Error> {
        let default = || dir.join(format!("trace-{}.csv", trial.index));
        let path = self.trace.clone().unwrap_or_else(default);
        let ticks = plural(trial.ticks, "tick");
        let write = |trace| match &self.trace {
            Some(_) => write_trace(&path, trace),
            None => is_no_link(&path).map_err(Error::from).and_then(|()| write_trace(&path, trace)),
        };
        match (trace.map(write), &self.trace) {
            (Some(Ok(())), _) => verbosity.note(format_args!("trace of {ticks} written to {}", path.display())),
            (Some(Err(error)), Some(_)) => return Err(error),
            (Some(Err(error)), None) => {
                verbosity.note(format_args!("the trace was not written: {error}; give another file with --trace"));
            }
            (None, Some(path)) => {
                verbosity.note(format_args!("the test has no trace to write to {}", path.display()));
            }
            (None, None) => {}
        }
        Ok(())
    }

    /// Returns the recorder of a run for --mcap.
    fn recorder(&self) -> Result<mcap::Recorder, Error> {
        let recorder = mcap::Recorder::default();
        if !self.lidar {
            return Ok(recorder);
        }
        // A file is not compressed, so a turn has half of the usual columns: 0.4 degrees between two columns.
        let settings = LidarSettings { columns: 900, ..LidarSettings::default() };
        Ok(recorder.with_lidar(settings).expect("the settings of the LiDAR are valid"))
    }

    /// Returns the cameras whose images --mcap has; `None` if there are none.
    fn filmed(&self, worker: &mut Worker, trial: &Trial) -> Result<Option<Cameras>, Error> {
        if let Some(file) = &self.cameras {
            return Ok(Some(read_cameras(file)?.of_test(&trial.test)));
        }
        let eyes = worker.eyes()?;
        Ok(Some(eyes).filter(|eyes| !eyes.all.is_empty()))
    }

    /// Returns the camera of --through, or the first camera.
    fn through(&self, mut cameras: Cameras) -> Result<Cameras, Error> {
        let names = || cameras.all.keys().map(String::as_str);
        let name = match &self.through {
            Some(name) if cameras.all.contains_key(name) => Some(name.clone()),
            Some(name) => {
                let (all, meant) = (names().collect::<Vec<_>>().join(", "), did_you_mean(&nearest(name, names())));
                return Err(usage(format!("--through {name}: no camera has this name, expected one of {all}{meant}")));
            }
            None => names().next().map(str::to_owned),
        };
        cameras.all.retain(|other, _| Some(other) == name.as_ref());
        Ok(cameras)
    }
}

/// A test that was run again, in JSON.
#[derive(Serialize)]
struct Replay<'a> {
    #[serde(flatten)]
    trial: &'a Trial,
    /// The test in the log, if it ended otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    logged: Option<&'a Trial>,
}

impl From<Ending> for Expectation {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::Fail => Expectation::Fail,
            Ending::Pass => Expectation::Pass,
        }
    }
}

fn parse_index(index: &Path) -> Result<usize, Error> {
    let text = index.to_string_lossy();
    text.parse().map_err(|_| usage(format!("found `{text}`, expected the index of a test after the folder")))
}

/// Returns the trial of this index in the log of a folder.
pub(super) fn logged<'a>(dir: &Path, log: &'a Log, index: usize) -> Result<&'a Trial, Error> {
    log.trials().get(index).ok_or_else(|| {
        let count = log.trials().len();
        let there = if count == 0 { "it has no tests yet".to_owned() } else { format!("expected 0 to {}", count - 1) };
        usage(format!("{} has no test {index}: {there}", dir.display()))
    })
}

/// Width of a film in pixels.
const FILM: f64 = 800.0;

/// Returns the picture of a run from above in the format of a file.
pub(super) fn draw(record: &MotionRecord, kind: FileKind, caption: &str) -> Result<Vec<u8>, Failure> {
    let nothing = "the world of the test could not be built, so there is nothing to draw";
    let story = || record.story(caption).ok_or(nothing);
    match kind {
        FileKind::Svg => Ok(story()?.svg().into_bytes()),
        FileKind::Png => plot::drawing_png(&story()?),
        FileKind::Gif => plot::film_gif(&record.film(FILM, caption).ok_or(nothing)?),
        FileKind::Csv | FileKind::Xodr => unreachable!("the target takes pictures only"),
    }
}

/// Describes the differences between the replay and the log, with what may have caused them.
fn difference(worker: &Worker, logged: &Trial, trial: &Trial) -> String {
    let study = worker.study();
    let (rows, before) = (results(study, trial), results(study, logged));
    let mut message = format!("test {} differs from the log", trial.index);
    for (name, value) in &rows {
        let logged = before.iter().find(|(other, _)| other == name).map_or("nothing", |(_, logged)| logged);
        if logged != value {
            message.push_str(&format!("\n  {name}: {value}, logged {logged}"));
        }
    }
    if rows == before {
        message.push_str(" by less than the digits that `replay` shows");
    }
    if !study.is_of_this_software() {
        message.push_str("\n  the campaign was run by another version of this software");
    }
    if worker.darkroom().is_some() {
        message.push_str("\n  the driver has cameras, and images are the same only on the same graphics adapter");
    }
    if let Some(other) = study.commands().first().map(|named| named.command).or(study.address()) {
        message.push_str(&format!(
            "\n  `{other}` runs in a process of its own: it was changed since the campaign, or it does not answer the same \
             questions in the same way; --changed shows the test as it ends now"
        ));
    }
    message
}

/// Returns the names and the values of all results of a trial in words.
fn results(study: &Study, trial: &Trial) -> Vec<(String, String)> {
    let mut rows = vec![("verdict".to_owned(), trial.verdict.to_string())];
    for id in trial.requirements() {
        let unit = study.requirement(id).map_or("", |requirement| requirement.unit.as_str());
        let value = trial.robustness(id);
        let value =
            value.map_or("undecided".to_owned(), |value| format!("{} {unit}", digits(value)).trim_end().to_owned());
        rows.push((id.to_owned(), value));
    }
    for (name, metric) in trial.metrics() {
        let metric = match metric {
            Metric::Number(number) => format!("{} {}", digits(number), Metric::unit(&name)).trim_end().to_owned(),
            Metric::Flag(flag) => (if flag { "yes" } else { "no" }).to_owned(),
            Metric::Word(word) => word.unwrap_or_else(|| "none".to_owned()),
        };
        rows.push((name, metric));
    }
    if let Some(error) = trial.error() {
        rows.push(("error".to_owned(), error.to_owned()));
    }
    let hash = trial.trace_hash.as_deref().unwrap_or("none");
    rows.push(("trace hash".to_owned(), hash.to_owned()));
    rows
}

/// Describes the trial in words, with logged values beside values that differ.
fn table(study: &Study, trial: &Trial, logged: &Trial) -> String {
    let (rows, before) = (results(study, trial), results(study, logged));
    let mut table = Table::default();
    let was = if trial.verdict == logged.verdict { String::new() } else { format!(", logged {}", logged.verdict) };
    table.heading(&format!("test {}: {}{was}", trial.index, trial.verdict));
    for (parameter, (name, value)) in study.space().parameters().iter().zip(trial.test.iter()) {
        table.row(name, &format!("{} {}", value_words(value), parameter.unit.as_deref().unwrap_or_default()));
    }
    for (name, value) in &rows[1..] {
        let other = before.iter().find(|(other, _)| other == name).filter(|(_, logged)| logged != value);
        let hash = name == "trace hash";
        match other {
            None if hash => table.row(name, &format!("{value}, as logged")),
            None => table.row(name, value),
            Some((_, logged)) => table.row(name, &format!("{value}, logged {logged}")),
        }
    }
    table.finish()
}
