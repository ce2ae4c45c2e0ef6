//! Keeps results of runs in the folder of an audit, so that an audit that goes on after a kill does not run the same tests again.
//!
//! A result is known by a hash of its study, with the version of the software, and of its test. So a line of another study or of another
//! released version is never used. The file is for the audit alone: without the file, the same runs are made again.

use paracosm_campaign::files::{create_folder, is_no_link};
use paracosm_campaign::reasons::InUse;
use paracosm_campaign::{Error, Learned, Reason, Study, StudyFile};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_128;

/// The file with the results.
const FILE: &str = "runs.jsonl";

/// Results of runs, by the keys of the runs.
#[derive(Debug)]
pub struct Kept {
    path: PathBuf,
    /// The results that were there at the beginning, each as JSON.
    known: HashMap<String, String>,
    file: Mutex<File>,
    /// The first error in writing. A result that cannot be kept ends the audit, since the disk is full.
    flaw: Mutex<Option<Error>>,
}

/// The error that a line is not the result of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the line is not what an audit has written; delete the file, and the same runs are made again")]
pub struct ForeignLine;

impl Reason for ForeignLine {}

/// A line of the file.
#[derive(Serialize, Deserialize)]
struct Line<T> {
    /// The 128-bit XXH3 of what the result depends on, as 32 hexadecimal digits.
    key: String,
    result: T,
    /// The 128-bit XXH3 of the key and the result, which tells a line that somebody has changed.
    hash: String,
}

impl Kept {
    /// Opens the results in the folder of an audit, which are kept for an audit that goes on.
    ///
    /// # Errors
    /// The file cannot be written, a line is not what an audit writes, or another audit is using the folder.
    pub fn open(folder: &Path) -> Result<Self, Error> {
        create_folder(folder)?;
        let path = folder.join(FILE);
        is_no_link(&path)?;
        let mut options = File::options();
        let options = options.create(true).truncate(false).write(true).read(true);
        let mut file = options.open(&path).map_err(Error::io("write", &path))?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(InUse { folder: folder.to_owned(), holder: None }.into());
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(Error::io("read", &path))?;
        // A last line without its end was cut off.
        bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
        let mut known = HashMap::new();
        for (index, line) in bytes.split(|byte| *byte == b'\n').filter(|line| !line.is_empty()).enumerate() {
            let line: Option<Line<serde_json::Value>> = serde_json::from_slice(line).ok();
            let line = line.map(|Line { key, result, hash }| (key, result.to_string(), hash));
            let line = line.filter(|(key, result, hash)| *hash == of_line(key, result));
            let flaw = || Error::in_file(&path, Some(index + 1), ForeignLine);
            let (key, result, _) = line.ok_or_else(flaw)?;
            known.insert(key, result);
        }
        let end = bytes.len() as u64;
        file.set_len(end).and_then(|()| file.seek(SeekFrom::Start(end))).map_err(Error::io("write", &path))?;
        Ok(Self { path, known, file: Mutex::new(file), flaw: Mutex::new(None) })
    }

    /// Returns the result with a key; `None` if it is not known.
    fn get<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        serde_json::from_str(self.known.get(key)?).ok()
    }

    fn put<T: Serialize>(&self, key: String, result: &T) {
        let result = serde_json::to_value(result).expect("results are always JSON");
        let hash = of_line(&key, &result.to_string());
        let mut line = serde_json::to_vec(&Line { key, result, hash }).expect("results are always JSON");
        line.push(b'\n');
        let written = self.file.lock().unwrap_or_else(PoisonError::into_inner).write_all(&line);
        if let Err(error) = written {
            let mut flaw = self.flaw.lock().unwrap_or_else(PoisonError::into_inner);
            flaw.get_or_insert_with(|| Error::io("write", &self.path)(error));
        }
    }

    /// Returns the kept result. If there is none, this does the work, and keeps its result if `is_sure` says so.
    ///
    /// # Errors
    /// The work fails.
    pub(super) fn or<T: Serialize + DeserializeOwned>(
        &self,
        key: &Key,
        what: &impl Serialize,
        is_sure: impl FnOnce(&T) -> bool,
        work: impl FnOnce() -> Result<T, Error>,
    ) -> Result<T, Error> {
        let key = key.of(what);
        if let Some(result) = self.get(&key) {
            return Ok(result);
        }
        let result = work()?;
        if is_sure(&result) {
            self.put(key, &result);
        }
        Ok(result)
    }

    /// Checks that all results could be kept.
    ///
    /// # Errors
    /// A result could not be written.
    pub(super) fn check(&self) -> Result<(), Error> {
        self.flaw.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
    }
}

/// The study that results belong to, with a name for their kind.
pub(super) struct Key(u128);

impl Key {
    pub fn new(kind: &str, study: &Study) -> Self {
        let identity = StudyFile::new(study, &Learned::new(), None).identity();
        Self(hash(&(kind, identity)))
    }

    fn of(&self, what: &impl Serialize) -> String {
        format!("{:032x}", hash(&(self.0.to_string(), what)))
    }
}

/// Returns the hash of a line of the file.
fn of_line(key: &str, result: &str) -> String {
    format!("{:032x}", hash(&(key, result)))
}

/// Returns `true` if a folder has results of an audit.
pub(super) fn has_results(folder: &Path) -> bool {
    folder.join(FILE).metadata().is_ok_and(|file| file.len() > 0)
}

fn hash(value: &impl Serialize) -> u128 {
    xxh3_128(&serde_json::to_vec(value).expect("it is always JSON"))
}
