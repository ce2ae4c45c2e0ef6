//! The folder of an audit: what is audited, and the mutants that have been tried, so that the audit can go on after a kill.

use super::kept::has_results;
use super::{Audit, Suite, Tried};
use paracosm_campaign::files::{create_folder, is_no_link, write_whole_here};
use paracosm_campaign::reasons::InUse;
use paracosm_campaign::{Error, Learned, Reason, StudyFile, differing_key};
use paracosm_mutants::Mutant;
use serde::Serialize;
use serde_json::Value;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_128;

/// The file that says what is audited.
const SETTINGS: &str = "audit-settings.json";
/// The file with a line for each mutant that has been tried.
const TRIED: &str = "mutants.jsonl";

/// The reason why an audit cannot use a folder.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum AuditFolderFlaw {
    /// The folder holds an audit already.
    #[error("{} holds an audit already; --resume continues it, and --out names another folder", path.display())]
    Occupied {
        /// The path of the folder.
        path: PathBuf,
    },
    /// The folder holds another audit than the one that is to go on.
    #[error("{} holds another audit: `{key}` differs; repeat the command of that audit, or name another folder with --out", path.display())]
    Other {
        /// The path of the folder.
        path: PathBuf,
        /// The first entry that differs.
        key: String,
    },
    /// A line is not a mutant that this audit tries at this place.
    #[error("the line is not the result of mutant {index} of this audit")]
    Line {
        /// The number of the mutant, from 0.
        index: usize,
    },
    /// The file is not JSON, so it does not say what is audited.
    #[error("the file is not the JSON that an audit writes")]
    NoSettings,
}

impl Reason for AuditFolderFlaw {}

/// The folder of an audit, to which mutants are added as they are tried.
#[derive(Debug)]
pub struct AuditFolder {
    path: PathBuf,
    tried: File,
}

/// The study, the suites and the mutants of an audit, in the form of the file.
#[derive(Serialize)]
struct Settings {
    study: Value,
    suites: Vec<SuiteEntry>,
    mutants: usize,
    /// The 128-bit XXH3 of the mutants, as JSON.
    mutants_hash: String,
}

#[derive(Serialize)]
struct SuiteEntry {
    name: String,
    tests: usize,
    /// The 128-bit XXH3 of the values of the tests, as JSON.
    hash: String,
}

impl AuditFolder {
    /// Opens the folder of an audit. Returns the mutants that have been tried; there are some only if the audit is resumed.
    ///
    /// # Errors
    /// The folder cannot be written, holds an audit that is not to go on, or holds another audit.
    pub fn open(path: &Path, audit: &Audit, resume: bool) -> Result<(Self, Vec<Tried>), Error> {
        if !resume && path.join(SETTINGS).exists() {
            return Err(AuditFolderFlaw::Occupied { path: path.to_owned() }.into());
        }
        create_folder(path)?;
        let settings = serde_json::to_value(audit.settings()).expect("what is audited is always JSON");
        let (file, tried) = (path.join(SETTINGS), path.join(TRIED));
        is_no_link(&tried)?;
        let mut options = File::options();
        let mut log = options.create(true).append(true).read(true).open(&tried).map_err(Error::io("write", &tried))?;
        if let Err(TryLockError::WouldBlock) = log.try_lock() {
            return Err(InUse { folder: path.to_owned(), holder: None }.into());
        }
        let there = read_settings(&file)?;
        let mut known = Vec::new();
        let mut text = String::new();
        log.read_to_string(&mut text).map_err(Error::io("read", &tried))?;
        // A last line without its end was cut off.
        text.truncate(text.rfind('\n').map_or(0, |end| end + 1));
        match there {
            None => {
                text.clear();
                write_whole_here(
                    &file,
                    &[&serde_json::to_vec_pretty(&settings).expect("it is JSON")[..], b"\n"].concat(),
                )?;
            }
            Some(there) => {
                if let Some(key) = differing_key(&there, &settings) {
                    let (path, key) = (path.to_owned(), key.to_owned());
                    return Err(AuditFolderFlaw::Other { path, key }.into());
                }
                for (index, line) in text.lines().enumerate() {
                    let one = serde_json::from_str(line).ok().filter(|one: &Tried| audit.tries(index, one));
                    let flaw = || Error::in_file(&tried, Some(index + 1), AuditFolderFlaw::Line { index });
                    known.push(one.ok_or_else(flaw)?);
                }
            }
        }
        log.set_len(text.len() as u64).map_err(Error::io("write", &tried))?;
        Ok((Self { path: path.to_owned(), tried: log }, known))
    }

    /// Checks that a new audit may use a folder, before slow work begins.
    ///
    /// # Errors
    /// The folder holds an audit, which is not to go on.
    pub fn check(path: &Path, resume: bool) -> Result<(), AuditFolderFlaw> {
        let is_occupied = !resume && (path.join(SETTINGS).exists() || has_results(path));
        if is_occupied { Err(AuditFolderFlaw::Occupied { path: path.to_owned() }) } else { Ok(()) }
    }

    /// Checks that a folder does not hold an audit of another study or of other suites, before slow work begins.
    ///
    /// # Errors
    /// The folder holds such an audit, or its file cannot be read.
    pub fn check_same(path: &Path, audit: &Audit) -> Result<(), Error> {
        let file = path.join(SETTINGS);
        let Some(there) = read_settings(&file)? else { return Ok(()) };
        let here = serde_json::to_value(audit.settings()).expect("what is audited is always JSON");
        match ["study", "suites"].into_iter().find(|key| there.get(key) != here.get(key)) {
            Some(key) => Err(AuditFolderFlaw::Other { path: path.to_owned(), key: key.to_owned() }.into()),
            None => Ok(()),
        }
    }

    /// Adds a mutant that has been tried.
    ///
    /// # Errors
    /// The file cannot be written: the disk is full, say.
    pub fn add(&mut self, tried: &Tried) -> Result<(), Error> {
        let mut line = serde_json::to_string(tried).expect("a tried mutant is always JSON");
        line.push('\n');
        self.tried.write_all(line.as_bytes()).map_err(Error::io("write", &self.path.join(TRIED)))
    }
}

impl Audit<'_> {
    fn settings(&self) -> Settings {
        let study = StudyFile::new(self.study, &Learned::new(), None);
        let entry = |suite: &Suite| SuiteEntry {
            name: suite.name.clone(),
            tests: suite.points.len(),
            hash: hash(&suite.values(self.study)),
        };
        let mutants: Vec<&Mutant> = self.tried_mutants().iter().map(|noticed| &noticed.mutant).collect();
        Settings {
            study: study.identity(),
            suites: self.suites.iter().map(entry).collect(),
            mutants: mutants.len(),
            mutants_hash: hash(&mutants),
        }
    }

    /// Returns `true` if a line is about the mutant at this place, and has an entry for each suite.
    fn tries(&self, index: usize, one: &Tried) -> bool {
        self.tried_mutants().get(index).is_some_and(|noticed| noticed.mutant == one.mutant)
            && one.kills.len() == self.suites.len()
    }
}

/// Reads the file that says what is audited; `None` if there is no such file.
fn read_settings(file: &Path) -> Result<Option<Value>, Error> {
    match fs::read_to_string(file) {
        Ok(text) => {
            let flaw = |_| Error::in_file(file, None, AuditFolderFlaw::NoSettings);
            serde_json::from_str(&text).map(Some).map_err(flaw)
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Error::io("read", file)(error)),
    }
}

/// Returns the 128-bit XXH3 of a value as JSON, as 32 hexadecimal digits.
fn hash(value: &impl Serialize) -> String {
    format!("{:032x}", xxh3_128(&serde_json::to_vec(value).expect("it is always JSON")))
}
