//! Doubts about the programs that a campaign starts, which its log does not show: errors that did not repeat, and a test that ends otherwise now.
//!
//! Which tests a process had before depends on the workers and on their speed. So an error counts only if a new process has it, too, and the log is the
//! same for any number of workers. A program with such errors may be unsound all the same, so the user has to know.

use crate::Error;
use crate::files::{read_text_here, write_whole_here};
use paracosm_space::plural;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The file in the folder of a campaign.
pub(crate) const FILE: &str = "doubts.json";

/// The most characters of an error.
const LONGEST_ERROR: usize = 500;

/// The doubts of a campaign about its driver, its system or its perceiver.
#[derive(Debug, Clone, Default)]
pub struct Doubts(Arc<Mutex<Seen>>);

/// The errors that did not repeat. A [`Crew`](crate::Crew) brings the errors of another process as JSON.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Recovered {
    /// The tests whose error did not repeat, with this error.
    tests: BTreeMap<usize, String>,
    /// The number of questions about images whose error did not repeat, and the first of these errors.
    images: Option<(usize, String)>,
}

#[derive(Debug, Default)]
struct Seen {
    /// The errors that did not repeat.
    recovered: Recovered,
    /// A known test that ends otherwise now.
    differing: Option<usize>,
    /// The doubts that the folder had before; `None` until they are read.
    earlier: Option<Vec<String>>,
}

/// The contents of the file.
#[derive(Serialize, Deserialize)]
struct Written {
    doubts: Vec<String>,
}

impl Doubts {
    /// Reads the doubts of a campaign in words from its folder.
    ///
    /// # Errors
    /// The file cannot be read, or has other contents.
    pub fn read(folder: &Path) -> Result<Vec<String>, Error> {
        let path = folder.join(FILE);
        if !path.exists() {
            return Ok(Vec::new());
        }
        let text = read_text_here(&path)?;
        let Written { doubts } =
            serde_json::from_str(&text).map_err(|flaw| Error::in_file(&path, flaw.line(), flaw))?;
        Ok(doubts)
    }

    /// Adds the doubts to the file in the folder of a campaign, after the doubts of an earlier part of the campaign. Writes nothing if there are
    /// no doubts.
    ///
    /// # Errors
    /// The file cannot be read or written.
    pub fn keep_in(&self, folder: &Path) -> Result<(), Error> {
        let notes = self.notes();
        let earlier = self.seen().earlier.take();
        let earlier = earlier.map_or_else(|| Self::read(folder), Ok)?;
        let both = earlier.iter().cloned().chain(notes.iter().cloned()).collect();
        self.seen().earlier = Some(earlier);
        if notes.is_empty() { Ok(()) } else { Self::write(folder, both) }
    }

    /// Writes doubts in words to the folder of a campaign, each once.
    pub(crate) fn write(folder: &Path, mut doubts: Vec<String>) -> Result<(), Error> {
        let mut said = HashSet::new();
        doubts.retain(|doubt| said.insert(doubt.clone()));
        let text = serde_json::to_string_pretty(&Written { doubts }).expect("texts are always JSON");
        write_whole_here(&folder.join(FILE), format!("{text}\n").as_bytes())
    }

    /// Returns the number of tests that ended in an error, and that had a result when they ran again.
    pub fn recovered(&self) -> usize {
        self.seen().recovered.tests.len()
    }

    /// Takes the errors that did not repeat out of the doubts, so that they can travel to the process of the campaign.
    pub fn take_recovered(&self) -> Recovered {
        std::mem::take(&mut self.seen().recovered)
    }

    /// Adds errors of another process that did not repeat.
    pub fn add_recovered(&self, Recovered { tests, images }: Recovered) {
        tests.iter().for_each(|(index, error)| self.recover(*index, error));
        if let Some((count, error)) = images {
            self.seen().recovered.images.get_or_insert((0, error)).0 += count;
        }
    }

    /// Returns the index of a known test of a continued campaign that ends otherwise now.
    pub fn differing(&self) -> Option<usize> {
        self.seen().differing
    }

    /// Returns the doubts in words.
    pub fn notes(&self) -> Vec<String> {
        let Seen { recovered: Recovered { tests: recovered, images }, differing, .. } = &*self.seen();
        let recovered = recovered.first_key_value().map(|(index, error)| {
            let tests = plural(recovered.len(), "test");
            format!(
                "{tests} ended in an error, and had a result when a new process or a new connection ran them again: the program may keep something \
                 from test to test, or fail by chance; the first, test {index}: {error}"
            )
        });
        let images = images.as_ref().map(|(count, error)| {
            let times = plural(*count, "time");
            format!(
                "the perceiver failed {times}, and answered when a new process saw the images again: it may keep something from image to image, \
                 or fail by chance; the first error: {error}"
            )
        });
        let differing = differing.map(|index| {
            format!(
                "test {index} ends otherwise now than before the campaign was continued: the driver, the system or the perceiver has changed since, or \
                 it does not answer the same questions in the same way; so the log may hold the results of two programs"
            )
        });
        [differing, recovered, images].into_iter().flatten().collect()
    }

    /// Adds a test whose error did not repeat.
    pub(crate) fn recover(&self, index: usize, error: &str) {
        self.seen().recovered.tests.entry(index).or_insert_with(|| short(error));
    }

    /// Adds a question about images whose error did not repeat.
    #[cfg(feature = "camera")]
    pub(crate) fn recover_images(&self, error: &str) {
        self.seen().recovered.images.get_or_insert_with(|| (0, short(error))).0 += 1;
    }

    /// Says that a known test ends otherwise now.
    pub(crate) fn differ(&self, index: usize) {
        self.seen().differing.get_or_insert(index);
    }

    fn seen(&self) -> MutexGuard<'_, Seen> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn short(error: &str) -> String {
    error.chars().take(LONGEST_ERROR).collect()
}
