//! The folder of a campaign, open for appending: `campaign.json` describes the tests, and `trials.jsonl` holds their
//! results.
//!
//! Nothing is lost and nothing is overwritten. The study is written whole or not at all. Every trial is written to the
//! file as one line as soon as the trials before it are written. A folder that holds files of a campaign is not begun
//! anew. A process that is killed may leave a line without its end; when the campaign is resumed, this line is dropped
//! and its test runs again.

use crate::files::{Lines, create_folder, read_text_here, remove_leftovers, write_whole_here};
use crate::json::differing_key;
use crate::lock::Lock;
use crate::scales::Learned;
use crate::study_file::{STUDY, StudyFile, hash_of_text};
use crate::trial::Line;
use crate::trials_file::{Read, TRIALS, read_trials};
use crate::{Error, Extension, Failure, Reason, Shard, Study, Trial, doubts, run_in, shard};
use same_file::Handle;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The file of the tests that the study counts as done.
pub(crate) const EXTENDED: &str = "extended.csv";
/// The names of the files about the programs that a campaign starts.
const OF_PROGRAMS: [&str; 5] = [run_in::FILE, doubts::FILE, "driver.log", "perceiver.log", "system.log"];
/// The names of the files that hold results derived from the trials of a campaign.
pub const DERIVED: [&str; 18] = [
    "effects.json",
    "trials.csv",
    "coverage.json",
    "failure-map.svg",
    "failure-map.png",
    "failure-map.csv",
    "modes.json",
    "points.json",
    "perception.json",
    "explanation.json",
    "located.json",
    "blame.json",
    "blame.csv",
    "blame-map.svg",
    "blame-map.png",
    "severity-map.svg",
    "severity-map.png",
    "junit.xml",
];

/// The folder of a campaign, to which trials and results are written.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    log: File,
    /// The identity of the log.
    handle: Handle,
    /// The hash of the study, which every line of the log has; `None` in a log of an older version.
    study: Option<String>,
}

/// The reason why a campaign cannot be begun or continued in a folder.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FolderFlaw {
    /// The path leads to a file instead of a folder.
    #[error("{} is a file, expected a folder to write to", path.display())]
    File {
        /// The path of the file.
        path: PathBuf,
    },
    /// The folder already holds a campaign.
    #[error(
        "{} holds a campaign already ({name}): continue it with --resume (`resume=True` in Python), or choose another folder (--out)", path.display()
    )]
    Occupied {
        /// The path of the folder.
        path: PathBuf,
        /// The name of a file that belongs to the existing campaign.
        name: &'static str,
    },
    /// The folder holds files of a campaign, but no `campaign.json`.
    #[error("{} has {name} but no {STUDY}, so the campaign cannot be continued", path.display())]
    NoStudy {
        /// The path of the folder.
        path: PathBuf,
        /// The name of a file in the folder that belongs to a campaign.
        name: &'static str,
    },
    /// The folder holds the campaign of a different study.
    #[error("{} holds a different campaign: its `{key}` is {there}, that of this command is {here}", path.display())]
    OtherStudy {
        /// The path of the folder.
        path: PathBuf,
        /// The name of the first entry of `campaign.json` that differs from the given study.
        key: String,
        /// The value of the differing entry in the folder.
        there: String,
        /// The value of the differing entry in the given study.
        here: String,
    },
}

/// The error that a file name is reserved for a campaign's own files.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{} has the name of a campaign's own file, which {what} must not replace", path.display())]
pub struct NotYours {
    /// The path of the file with the reserved name.
    pub path: PathBuf,
    /// The kind of content that should be written, with an article, for example "a trace".
    pub what: &'static str,
}

impl Reason for FolderFlaw {}
impl Reason for NotYours {}

impl Folder {
    /// Begins a campaign in a folder, and creates the folder if necessary.
    ///
    /// # Errors
    /// The folder cannot be written, or holds a campaign.
    pub fn create(path: &Path, study: &Study, extension: Option<&Extension>) -> Result<Self, Error> {
        Self::begin(path, study, extension, &StudyFile::new(study, &Learned::new(), extension).text(), None)
    }

    /// Begins a shard of a campaign in a folder, and creates the folder if necessary.
    ///
    /// # Errors
    /// The folder cannot be written, or holds a campaign.
    pub fn create_shard(
        path: &Path,
        study: &Study,
        extension: Option<&Extension>,
        shard: Shard,
    ) -> Result<Self, Error> {
        Self::begin(path, study, extension, &StudyFile::new(study, &Learned::new(), extension).text(), Some(shard))
    }

    /// Begins a campaign, or a shard of it, with this text of `campaign.json`.
    pub(crate) fn begin(
        path: &Path,
        study: &Study,
        extension: Option<&Extension>,
        text: &str,
        shard: Option<Shard>,
    ) -> Result<Self, Error> {
        if path.exists() && !path.is_dir() {
            return Err(FolderFlaw::File { path: path.to_owned() }.into());
        }
        create_folder(path)?;
        let log = Lock::of(&path.join(TRIALS))?;
        if let Some(name) = present(path, &[STUDY]) {
            return Err(FolderFlaw::Occupied { path: path.to_owned(), name }.into());
        }
        // Nobody may take a shard for a whole campaign.
        shard.map_or(Ok(()), |shard| shard.write(path, None))?;
        write_whole_here(&path.join(STUDY), text.as_bytes())?;
        keep_extended(path, study, extension)?;
        run_in::keep(path, study)?;
        Self::open(path, log, Some(hash_of_text(text)))
    }

    /// Opens the folder of a study's campaign to continue the campaign, and returns the trials in the log. Begins the
    /// campaign if the folder holds no campaign yet.
    ///
    /// # Errors
    /// The folder holds another campaign, or a log that is broken before its last line.
    pub fn resume(path: &Path, study: &Study, extension: Option<&Extension>) -> Result<(Self, Vec<Trial>), Error> {
        if !path.join(STUDY).exists() {
            if let Some(name) = present(path, &[]) {
                return Err(FolderFlaw::NoStudy { path: path.to_owned(), name }.into());
            }
            return Self::create(path, study, extension).map(|folder| (folder, Vec::new()));
        }
        shard::is_whole(path)?;
        Self::go_on(path, study, extension, 0..study.sampling().budget)
    }

    /// Opens the folder of a shard to continue the shard, and returns the trials in its log. Begins the shard if the folder holds no campaign yet.
    ///
    /// # Errors
    /// The folder holds another campaign or shard, or a log that is broken before its last line.
    pub fn resume_shard(
        path: &Path,
        study: &Study,
        extension: Option<&Extension>,
        shard: Shard,
    ) -> Result<(Self, Vec<Trial>), Error> {
        if !path.join(STUDY).exists() {
            return Self::create_shard(path, study, extension, shard).map(|folder| (folder, Vec::new()));
        }
        shard.is_in(path)?;
        Self::go_on(path, study, extension, shard.range(study.sampling().budget))
    }

    fn go_on(
        path: &Path,
        study: &Study,
        extension: Option<&Extension>,
        indices: Range<usize>,
    ) -> Result<(Self, Vec<Trial>), Error> {
        let log = Lock::of(&path.join(TRIALS))?;
        let hash = same_study(path, study, extension)?;
        keep_extended(path, study, extension)?;
        let mut folder = Self::open(path, log, Some(hash.clone()))?;
        let file = path.join(TRIALS);
        let Read { trials, bytes, is_older } = read_trials(&file, Lines::of(&folder.log), study, &hash, indices)?;
        // A log of an older version goes on as it began.
        folder.study = folder.study.filter(|_| !is_older);
        folder.log.set_len(bytes).map_err(Error::io("write", &file))?;
        folder.log.seek(SeekFrom::End(0)).map_err(Error::io("write", &file))?;
        Ok((folder, trials))
    }

    fn open(path: &Path, lock: Lock, study: Option<String>) -> Result<Self, Error> {
        // Processes that were killed leave their temporary files.
        remove_leftovers(path, Self::owns);
        let log = lock.kept();
        let handle = log.try_clone().and_then(Handle::from_file).map_err(Error::io("open", &path.join(TRIALS)))?;
        Ok(Self { path: path.to_owned(), log, handle, study })
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the hash of the study, which every line of the log has; `None` in a log of an older version.
    pub(crate) fn hash(&self) -> Option<&str> {
        self.study.as_deref()
    }

    /// Writes `campaign.json` again, with the scales that the campaign has learned.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_study(&self, study: &Study, learned: &Learned, extension: Option<&Extension>) -> Result<(), Error> {
        self.is_still_there()?;
        write_study(&self.path, study, learned, extension).map(|_| ())
    }

    /// Appends a trial to the log.
    ///
    /// # Errors
    /// The log cannot be written: the disk is full, say.
    pub fn append(&mut self, trial: &Trial) -> Result<(), Error> {
        let file = self.path.join(TRIALS);
        self.is_still_there()?;
        let line = Line::of(trial, self.study.as_deref());
        let mut line = serde_json::to_string(&line).expect("a trial is always JSON");
        line.push('\n');
        self.log.write_all(line.as_bytes()).map_err(Error::io("write", &file))
    }

    /// Notes in the folder of a shard that all tests of the shard have run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn end_shard(&self, shard: Shard, tests: usize) -> Result<(), Error> {
        self.is_still_there()?;
        shard.write(&self.path, Some(tests))
    }

    /// Appends lines of a log to the log.
    pub(crate) fn append_lines(&mut self, lines: &[u8]) -> Result<(), Error> {
        self.is_still_there()?;
        self.log.write_all(lines).map_err(Error::io("write", &self.path.join(TRIALS)))
    }

    /// Writes a file to the campaign's folder, completely or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), Error> {
        self.is_still_there()?;
        write_whole_here(&self.path.join(name), contents)
    }

    /// Checks that the path of the log still leads to the log. If the folder was removed or moved, writing to the open
    /// log still succeeds, and another campaign may have begun at the path.
    fn is_still_there(&self) -> Result<(), Error> {
        let path = self.path.join(TRIALS);
        let is_there = Handle::from_path(&path).is_ok_and(|there| there == self.handle);
        if is_there { Ok(()) } else { Err(Failure::Removed { path }.into()) }
    }

    /// Returns `true` if the campaign of a study in a folder has not ended after this number of tests: it still runs, or it was
    /// interrupted.
    pub fn is_unfinished(folder: &Path, study: &Study, tests: usize) -> bool {
        // A campaign writes its coverage once it has ended.
        tests < study.sampling().budget && !folder.join("coverage.json").exists()
    }

    /// Returns `true` if the campaign reserves the given file name for its own files.
    pub fn owns(name: &OsStr) -> bool {
        [STUDY, TRIALS, EXTENDED, shard::FILE].into_iter().chain(OF_PROGRAMS).chain(DERIVED).any(|ours| ours == name)
    }
}

/// Returns the name of a campaign's file that exists. It is one of `first`, the log, the tests that count as done, or
/// an artefact. A log without a byte is no campaign: a process may have ended after it locked the folder.
fn present(path: &Path, first: &[&'static str]) -> Option<&'static str> {
    let mut ours = first.iter().copied().chain([TRIALS, EXTENDED]).chain(DERIVED);
    ours.find(|name| fs::metadata(path.join(name)).is_ok_and(|there| *name != TRIALS || there.len() > 0))
}

/// Writes `campaign.json`, and returns its text.
fn write_study(path: &Path, study: &Study, learned: &Learned, extension: Option<&Extension>) -> Result<String, Error> {
    let text = StudyFile::new(study, learned, extension).text();
    write_whole_here(&path.join(STUDY), text.as_bytes())?;
    Ok(text)
}

/// Writes the tests that the study counts as done to the folder, if they are not there yet.
fn keep_extended(path: &Path, study: &Study, extension: Option<&Extension>) -> Result<(), Error> {
    let file = path.join(EXTENDED);
    match extension {
        Some(extension) if !file.exists() => write_whole_here(&file, &extension.csv(study.space())?),
        _ => Ok(()),
    }
}

/// Checks that a folder holds the campaign of this study, and returns the hash of the study.
fn same_study(path: &Path, study: &Study, extension: Option<&Extension>) -> Result<String, Error> {
    let file = path.join(STUDY);
    let text = read_text_here(&file)?;
    // The scenario may have got further parameters since the folder was written, which are nominal there.
    let there = StudyFile::parse(&text, &study.catalogue());
    let there = there.map_err(|flaw| Error::in_file(&file, flaw.line(), flaw))?;
    let here = StudyFile::new(study, &Learned::new(), extension);
    let (tests_there, tests_here) = (there.identity(), here.identity());
    let Some(key) = differing_key(&tests_there, &tests_here) else { return Ok(hash_of_text(&text)) };
    let [there, here] = [there, here].map(|study| serde_json::to_value(study).expect("a study is always JSON"));
    let show = |study: &serde_json::Value| study.get(key).map_or("nothing".into(), ToString::to_string);
    let (there, here) = (show(&there), show(&here));
    Err(FolderFlaw::OtherStudy { path: path.to_owned(), key: key.to_owned(), there, here }.into())
}
