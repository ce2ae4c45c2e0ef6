//! The hash of the files that a scenario reads, so that a campaign is not continued after one of them has changed.

use super::{Study, Subject};
use crate::error::Error;
use std::collections::BTreeSet;
use xxhash_rust::xxh3::xxh3_128;

impl Study {
    /// Takes the hash of the files of the scenario with the values of the study: the fixed values, and each value of each open
    /// parameter that chooses among files.
    pub(super) fn hash_files(&mut self) -> Result<(), Error> {
        let Subject::Scenario(_) = &self.subject else { return Ok(()) };
        let program = self.program()?;
        let nominal = self.nominal()?;
        let mut hashes: BTreeSet<String> = program.files_hash(&nominal).into_iter().collect();
        for name in program.files_chosen_by() {
            let open = self.space.parameters().iter().find(|parameter| parameter.name == *name);
            for value in open.and_then(|parameter| parameter.levels()).into_iter().flatten() {
                let mut test = nominal.clone();
                test.set(name.as_str(), value.clone());
                hashes.extend(program.files_hash(&test));
            }
        }
        let all: Vec<String> = hashes.into_iter().collect();
        self.subject.scenario_mut()?.files = match &all[..] {
            [] => None,
            [one] => Some(one.clone()),
            several => Some(format!("{:032x}", xxh3_128(several.concat().as_bytes()))),
        };
        Ok(())
    }
}
