//! The folder of a campaign: `campaign.json` says what is run, `trials.jsonl` what became of it.
//!
//! Nothing is lost and nothing is overwritten: the study is written whole or not at all, every trial is handed
//! to the system as one line as soon as those before it are there, and a folder that holds anything of ours is
//! not begun anew. A line without its end is what a kill leaves behind; it is dropped when the campaign is
//! resumed, and its test run again.

use crate::{Error, Study, Trial, older};
use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const STUDY: &str = "campaign.json";
const TRIALS: &str = "trials.jsonl";
/// The tests that the study counts as done.
const EXTENDED: &str = "extended.csv";
/// What is derived from the trials at the end of a campaign, or later.
const DERIVED: [&str; 13] = [
    "trials.csv",
    "coverage.json",
    "failure-map.svg",
    "failure-map.png",
    "failure-map.csv",
    "modes.json",
    "explanation.json",
    "located.json",
    "blame.json",
    "blame.csv",
    "blame-map.svg",
    "blame-map.png",
    "junit.xml",
];

/// The folder of a campaign, open for appending.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    log: File,
}

impl Folder {
    /// Begins a campaign in a folder that is made if need be.
    ///
    /// # Errors
    /// The folder cannot be written, or holds a campaign.
    pub fn create(path: &Path, study: &Study) -> Result<Self, Error> {
        if path.exists() && !path.is_dir() {
            return Err(Error::Usage(format!("{} is a file, expected a folder to write to", path.display())));
        }
        fs::create_dir_all(path).map_err(Error::file("create", path))?;
        let ours = [STUDY, TRIALS, EXTENDED].into_iter().chain(DERIVED);
        if let Some(name) = ours.into_iter().find(|name| path.join(name).exists()) {
            return Err(Error::Usage(format!(
                "{} holds a campaign already ({name}): continue it with --resume, or write elsewhere with --out",
                path.display()
            )));
        }
        Self::write_study(path, study)?;
        keep_extended(path, study)?;
        Self::open_log(path)
    }

    /// Writes the study of the campaign in a folder, with what it has learned of scales.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_study(path: &Path, study: &Study) -> Result<(), Error> {
        let mut text = serde_json::to_string_pretty(study).expect("a study is always JSON");
        text.push('\n');
        write_whole(&path.join(STUDY), text.as_bytes())
    }

    /// Continues the campaign of this study in its folder, or begins it if there is none yet; the trials that
    /// are there.
    ///
    /// # Errors
    /// The folder holds another campaign, or a log that is broken before its end.
    pub fn resume(path: &Path, study: &Study) -> Result<(Self, Vec<Trial>), Error> {
        if !path.join(STUDY).exists() {
            if let Some(name) = [TRIALS, EXTENDED].into_iter().chain(DERIVED).find(|name| path.join(name).exists()) {
                let message = format!("{} has {name} but no {STUDY}, so it cannot be continued", path.display());
                return Err(Error::Usage(message));
            }
            return Self::create(path, study).map(|folder| (folder, Vec::new()));
        }
        same_study(path, study)?;
        keep_extended(path, study)?;
        let mut folder = Self::open_log(path)?;
        let text = folder.read_log()?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let trials = parse_trials(&path.join(TRIALS), &text[..whole])?;
        let log = path.join(TRIALS);
        folder.log.set_len(whole as u64).map_err(Error::file("write", &log))?;
        folder.log.seek(SeekFrom::End(0)).map_err(Error::file("write", &log))?;
        Ok((folder, trials))
    }

    /// Reads a campaign: its study and the trials that are there. Scales that it had not learned yet are learned from these.
    ///
    /// # Errors
    /// There is none, or a file of it is broken.
    pub fn read(path: &Path) -> Result<(Study, Vec<Trial>), Error> {
        let file = path.join(STUDY);
        let text = fs::read_to_string(&file).map_err(Error::file("read", &file))?;
        let mut study: Study =
            serde_json::from_str(&text).map_err(|error| Error::content(&file, error.line(), error.to_string()))?;
        study.check_format().map_err(|message| Error::content(&file, None, message))?;
        older::complete(&mut study);
        let log = path.join(TRIALS);
        let text = fs::read_to_string(&log).map_err(Error::file("read", &log))?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let trials = parse_trials(&log, &text[..whole])?;
        let learned = study.learned_scales().clone();
        Ok((study.with_scales(learned, &trials), trials))
    }

    /// Reads the tests that the study of this folder counts as done, if there are any.
    ///
    /// # Errors
    /// Their file is not there, broken, or holds others.
    pub fn read_extended(path: &Path, study: &mut Study) -> Result<(), Error> {
        let Study { extends, space, .. } = study;
        extends.as_mut().map_or(Ok(()), |extension| extension.restore(&path.join(EXTENDED), space))
    }

    fn open_log(path: &Path) -> Result<Self, Error> {
        let file = path.join(TRIALS);
        let mut options = File::options();
        let log = options.read(true).write(true).create(true).truncate(false);
        let log = log.open(&file).map_err(Error::file("write", &file))?;
        match log.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), log }),
            Err(TryLockError::WouldBlock) => {
                Err(Error::Usage(format!("another process is writing to {}", file.display())))
            }
            Err(TryLockError::Error(source)) => Err(Error::file("lock", &file)(source)),
        }
    }

    fn read_log(&mut self) -> Result<String, Error> {
        let file = self.path.join(TRIALS);
        let mut bytes = Vec::new();
        self.log.read_to_end(&mut bytes).map_err(Error::file("read", &file))?;
        String::from_utf8(bytes).map_err(|error| {
            let line = error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
            Error::content(&file, line, "found bytes that are no UTF-8, expected a trial as JSON")
        })
    }

    /// Writes a trial down.
    ///
    /// # Errors
    /// The log cannot be written: the disk is full, say.
    pub fn append(&mut self, trial: &Trial) -> Result<(), Error> {
        // A folder that was removed takes the log with it, though writing goes on without a complaint.
        if !self.path.join(TRIALS).exists() {
            let message = format!("{} was removed while the campaign ran", self.path.join(TRIALS).display());
            return Err(Error::Usage(message));
        }
        let mut line = serde_json::to_string(trial).expect("a trial is always JSON");
        line.push('\n');
        self.log.write_all(line.as_bytes()).map_err(Error::file("write", &self.path.join(TRIALS)))
    }

    /// Writes `trials.csv`, the trials as a flat table.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_table(&self, study: &Study, trials: &[Trial]) -> Result<(), Error> {
        write_whole(&self.path.join("trials.csv"), &table(study, trials))
    }

    /// Writes a file beside the trials, whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), Error> {
        write_whole(&self.path.join(name), contents)
    }

    /// Whether a file of that name in a campaign's folder is the campaign's own, not to be written by anybody else.
    pub(crate) fn owns(name: &OsStr) -> bool {
        [STUDY, TRIALS, EXTENDED].into_iter().chain(DERIVED).any(|ours| ours == name)
    }
}

/// Keeps the tests that the study counts as done, if they are not kept yet.
fn keep_extended(path: &Path, study: &Study) -> Result<(), Error> {
    let file = path.join(EXTENDED);
    match &study.extends {
        Some(extension) if !file.exists() => write_whole(&file, &extension.csv(&study.space)?),
        _ => Ok(()),
    }
}

/// Checks that a folder holds the campaign of this study.
fn same_study(path: &Path, study: &Study) -> Result<(), Error> {
    let file = path.join(STUDY);
    let text = fs::read_to_string(&file).map_err(Error::file("read", &file))?;
    let there: serde_json::Value =
        serde_json::from_str(&text).map_err(|error| Error::content(&file, error.line(), error.to_string()))?;
    let here = serde_json::to_value(study).expect("a study is always JSON");
    // The same tests may be read from another file.
    let [tests_there, tests_here] = [&there, &here].map(|study| {
        let mut study = study.clone();
        if let Some(extends) = study.get_mut("extends") {
            *extends = extends["hash"].take();
        }
        // What a campaign learns on its way makes it no other one.
        if let Some(entries) = study.as_object_mut() {
            entries.remove("learned_scales");
        }
        study
    });
    match differing_key(&tests_there, &tests_here) {
        None => Ok(()),
        Some(key) => {
            let show = |study: &serde_json::Value| study.get(key).map_or("nothing".into(), ToString::to_string);
            Err(Error::Usage(format!(
                "{} holds a different campaign: its `{key}` is {}, this command's is {}",
                path.display(),
                show(&there),
                show(&here)
            )))
        }
    }
}

/// The first entry in which two objects differ.
pub(crate) fn differing_key<'v>(there: &'v serde_json::Value, here: &'v serde_json::Value) -> Option<&'v str> {
    let keys = there.as_object().into_iter().chain(here.as_object()).flatten().map(|(key, _)| key.as_str());
    keys.into_iter().find(|key| there.get(key) != here.get(key))
}

fn parse_trials(file: &Path, text: &str) -> Result<Vec<Trial>, Error> {
    let parse = |(i, line): (usize, &str)| {
        if line.ends_with('\r') {
            return Err(Error::content(file, i + 1, "found a carriage return at the end of the line, expected none"));
        }
        let trial: Trial =
            serde_json::from_str(line).map_err(|error| Error::content(file, i + 1, format!("no trial: {error}")))?;
        if trial.index != i {
            let message = format!("found trial {}, expected trial {i}", trial.index);
            return Err(Error::content(file, i + 1, message));
        }
        Ok(trial)
    };
    text.split_terminator('\n').enumerate().map(parse).collect()
}

/// Checks that a file does not exist yet, so that `what` does not replace it.
pub(crate) fn is_new(path: &Path, what: &str) -> Result<(), Error> {
    if path.exists() {
        return Err(Error::Usage(format!("{} exists; {what} does not replace a file", path.display())));
    }
    Ok(())
}

/// Writes a file so that it is never seen half-written, not even after a crash.
pub(crate) fn write_whole(path: &Path, contents: &[u8]) -> Result<(), Error> {
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    let part = PathBuf::from(part);
    let write = || {
        let mut file = File::create(&part)?;
        file.write_all(contents)?;
        file.sync_all()?;
        fs::rename(&part, path)
    };
    write().map_err(|source| {
        // What is left of it is of no use to anybody; that it cannot be removed either changes nothing.
        let _ = fs::remove_file(&part);
        Error::file("write", path)(source)
    })
}

/// The trials as CSV: index, parameters, verdict, robustness, metrics and the rest.
fn table(study: &Study, trials: &[Trial]) -> Vec<u8> {
    let metrics = each_once(trials.iter().flat_map(Trial::metric_names));
    let stated = study.requirements.iter().map(|requirement| requirement.id.as_str());
    let ids = each_once(stated.chain(trials.iter().flat_map(Trial::requirements)));
    let mut csv = csv::Writer::from_writer(Vec::new());
    let parameters = study.space.coordinates().map(|coordinate| coordinate.name());
    let requirements = ids.iter().map(|id| format!("robustness.{id}"));
    let header = ["index".to_owned()].into_iter().chain(parameters).chain(["verdict".to_owned()]);
    let header = header.chain(requirements).chain(metrics.iter().map(|name| format!("metric.{name}")));
    let header = header.chain(["ticks", "trace_hash", "error"].map(str::to_owned));
    let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
    write(header.collect());
    for trial in trials {
        let mut row = vec![trial.index.to_string()];
        row.extend(trial.test.iter().flat_map(|(_, value)| value.scalars()).map(ToString::to_string));
        row.push(trial.verdict.to_string());
        row.extend(ids.iter().map(|id| trial.robustness(id).map_or(String::new(), |value| value.to_string())));
        row.extend(metrics.iter().map(|name| trial.metric(name).map_or(String::new(), ToString::to_string)));
        row.push(trial.ticks.to_string());
        row.push(trial.trace_hash.clone().unwrap_or_default());
        row.push(trial.error.clone().unwrap_or_default());
        write(row);
    }
    csv.into_inner().expect("memory does not fail to flush")
}

fn each_once<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut once = Vec::new();
    for name in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}
