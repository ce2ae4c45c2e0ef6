//! The files that a scenario reads: their hash, so that a campaign is not continued after one of them has changed, and their paths.

use super::{Study, Subject};
use crate::error::Error;
use paracosm_engine::FilesRead;
use std::collections::BTreeSet;
use std::path::PathBuf;
use xxhash_rust::xxh3::xxh3_128;

impl Study {
    /// Returns the paths of the files that the scenario reads, as it opens them.
    ///
    /// # Errors
    /// The study was read from a file, and its scenario does not exist.
    pub fn scenario_files(&self) -> Result<BTreeSet<PathBuf>, Error> {
        Ok(self.files_read()?.into_iter().flat_map(|read| read.paths).collect())
    }

    /// Takes the hash of the files of the scenario.
    pub(super) fn hash_files(&mut self) -> Result<(), Error> {
        let Subject::Scenario(_) = &self.subject else { return Ok(()) };
        let hashes: BTreeSet<String> = self.files_read()?.into_iter().map(|read| read.hash).collect();
        let all: Vec<String> = hashes.into_iter().collect();
        self.subject.scenario_mut()?.files = match &all[..] {
            [] => None,
            [one] => Some(one.clone()),
            several => Some(format!("{:032x}", xxh3_128(several.concat().as_bytes()))),
        };
        Ok(())
    }

    /// Returns the files of the scenario with the values of the study: the fixed values, and each value of each open parameter that
    /// chooses among files.
    fn files_read(&self) -> Result<Vec<FilesRead>, Error> {
        let Subject::Scenario(_) = &self.subject else { return Ok(Vec::new()) };
        let (program, nominal) = (self.program()?, self.nominal()?);
        let mut read: Vec<FilesRead> = program.files_read(&nominal).into_iter().collect();
        for name in program.files_chosen_by() {
            let open = self.space.parameters().iter().find(|parameter| parameter.name == *name);
            for value in open.and_then(|parameter| parameter.levels()).into_iter().flatten() {
                let mut test = nominal.clone();
                test.set(name.as_str(), value.clone());
                read.extend(program.files_read(&test));
            }
        }
        Ok(read)
    }
}
