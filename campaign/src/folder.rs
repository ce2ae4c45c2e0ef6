//! The folder of a campaign, open for appending: `campaign.json` describes the tests, and `trials.jsonl` holds their
//! results.
//!
//! Nothing is lost and nothing is overwritten. The study is written whole or not at all. Every trial is written to the
//! file as one line as soon as the trials before it are written. A folder that holds files of a campaign is not begun
//! anew. A process that is killed may leave a line without its end; when the campaign is resumed, this line is dropped
//! and its test runs again.

use crate::files::write_whole;
use crate::json::differing_key;
use crate::scales::Learned;
use crate::study_file::StudyFile;
use crate::trials_file::read_trials;
use crate::{Catalogue, Error, Extension, Failure, Reason, Study, Trial};
use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

pub(crate) const STUDY: &str = "campaign.json";
pub(crate) const TRIALS: &str = "trials.jsonl";
/// The file of the tests that the study counts as done.
pub(crate) const EXTENDED: &str = "extended.csv";
/// The names of the files that hold results derived from the trials of a campaign.
pub const DERIVED: [&str; 13] = [
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

/// The folder of a campaign, to which trials and results are written.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    log: File,
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
        "{} holds a campaign already ({name}): continue it with --resume, or write elsewhere with --out", path.display()
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
    /// Another process writes to the folder.
    #[error("another process is writing to {}; wait until it ends", path.display())]
    InUse {
        /// The path of the log, which another process has locked.
        path: PathBuf,
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
        if path.exists() && !path.is_dir() {
            return Err(FolderFlaw::File { path: path.to_owned() }.into());
        }
        fs::create_dir_all(path).map_err(Error::io("create", path))?;
        if let Some(name) = present(path, &[STUDY]) {
            return Err(FolderFlaw::Occupied { path: path.to_owned(), name }.into());
        }
        write_study(path, study, &Learned::new(), extension)?;
        keep_extended(path, study, extension)?;
        Self::open(path)
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
        same_study(path, study, extension)?;
        keep_extended(path, study, extension)?;
        let mut folder = Self::open(path)?;
        let file = path.join(TRIALS);
        let (trials, whole) = read_trials(&file, &folder.log)?;
        folder.log.set_len(whole).map_err(Error::io("write", &file))?;
        folder.log.seek(SeekFrom::End(0)).map_err(Error::io("write", &file))?;
        Ok((folder, trials))
    }

    fn open(path: &Path) -> Result<Self, Error> {
        let file = path.join(TRIALS);
        let mut options = File::options();
        let log = options.read(true).write(true).create(true).truncate(false);
        let log = log.open(&file).map_err(Error::io("write", &file))?;
        match log.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), log }),
            Err(TryLockError::WouldBlock) => Err(FolderFlaw::InUse { path: file }.into()),
            Err(TryLockError::Error(source)) => Err(Error::io("lock", &file)(source)),
        }
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes `campaign.json` again, with the scales that the campaign has learned.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_study(&self, study: &Study, learned: &Learned, extension: Option<&Extension>) -> Result<(), Error> {
        write_study(&self.path, study, learned, extension)
    }

    /// Appends a trial to the log.
    ///
    /// # Errors
    /// The log cannot be written: the disk is full, say.
    pub fn append(&mut self, trial: &Trial) -> Result<(), Error> {
        let file = self.path.join(TRIALS);
        // A removed folder takes the log with it, but writing to the open file still succeeds.
        if !file.exists() {
            return Err(Failure::Removed { path: file }.into());
        }
        let mut line = serde_json::to_string(trial).expect("a trial is always JSON");
        line.push('\n');
        self.log.write_all(line.as_bytes()).map_err(Error::io("write", &file))
    }

    /// Writes a file to the campaign's folder, completely or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), Error> {
        write_whole(&self.path.join(name), contents)
    }

    /// Returns `true` if the campaign reserves the given file name for its own files.
    pub fn owns(name: &OsStr) -> bool {
        [STUDY, TRIALS, EXTENDED].into_iter().chain(DERIVED).any(|ours| ours == name)
    }
}

/// Returns the name of a campaign's file that exists. It is one of `first`, the log, the tests that count as done, or
/// an artefact.
fn present(path: &Path, first: &[&'static str]) -> Option<&'static str> {
    let mut ours = first.iter().copied().chain([TRIALS, EXTENDED]).chain(DERIVED);
    ours.find(|name| path.join(name).exists())
}

fn write_study(path: &Path, study: &Study, learned: &Learned, extension: Option<&Extension>) -> Result<(), Error> {
    write_whole(&path.join(STUDY), StudyFile::new(study, learned, extension).text().as_bytes())
}

/// Writes the tests that the study counts as done to the folder, if they are not there yet.
fn keep_extended(path: &Path, study: &Study, extension: Option<&Extension>) -> Result<(), Error> {
    let file = path.join(EXTENDED);
    match extension {
        Some(extension) if !file.exists() => write_whole(&file, &extension.csv(study.space())?),
        _ => Ok(()),
    }
}

/// Checks that a folder holds the campaign of this study.
fn same_study(path: &Path, study: &Study, extension: Option<&Extension>) -> Result<(), Error> {
    let file = path.join(STUDY);
    let text = fs::read_to_string(&file).map_err(Error::io("read", &file))?;
    let there = StudyFile::parse(&text, &Catalogue::default());
    let there = there.map_err(|flaw| Error::in_file(&file, flaw.line(), flaw))?;
    let here = StudyFile::new(study, &Learned::new(), extension);
    let (tests_there, tests_here) = (there.identity(), here.identity());
    let Some(key) = differing_key(&tests_there, &tests_here) else { return Ok(()) };
    let [there, here] = [there, here].map(|study| serde_json::to_value(study).expect("a study is always JSON"));
    let show = |study: &serde_json::Value| study.get(key).map_or("nothing".into(), ToString::to_string);
    let (there, here) = (show(&there), show(&here));
    Err(FolderFlaw::OtherStudy { path: path.to_owned(), key: key.to_owned(), there, here }.into())
}
