//! Tests that a campaign counts as done, and so runs only what they lack.
//!
//! The study names them by their number and their hash, which is that of the CSV they would be written as: how the
//! file they came from is formatted, and what else is in it, changes nothing. The folder of the campaign keeps that CSV
//! as `extended.csv`, so that the campaign can be measured when the file is gone. A replay needs neither.

use crate::Error;
use crate::tests_file::read_values;
use paracosm_coverage::{Point, Space, Values};
use serde::{Deserialize, Serialize};
use std::path::Path;
use xxhash_rust::xxh3::xxh3_128;

/// Tests that are there already.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extension {
    /// The file that they were read from.
    pub name: String,
    /// How many there are.
    pub tests: usize,
    /// The hash of the tests: XXH3, 128 bits, of `extended.csv`.
    pub hash: String,
    /// The tests, unless only what is said of them was read.
    #[serde(skip)]
    values: Option<Vec<Values>>,
}

impl Extension {
    /// Reads tests of a space; `fixed` are the values of the parameters that are none of it, from which a column of such
    /// a name must not differ.
    pub(crate) fn read(path: &Path, space: &Space, fixed: &Values) -> Result<Self, Error> {
        let values = read_values(path, space, fixed)?;
        let hash = format!("{:032x}", xxh3_128(&csv(space, &values)));
        Ok(Self { name: path.display().to_string(), tests: values.len(), hash, values: Some(values) })
    }

    /// Reads the tests from the file in which a campaign keeps them.
    pub(crate) fn restore(&mut self, path: &Path, space: &Space) -> Result<(), Error> {
        let found = Self::read(path, space, &Values::default())?;
        if found.hash != self.hash {
            let message = format!(
                "found {} tests of hash {}, expected the {} of hash {} that the campaign extends",
                found.tests, found.hash, self.tests, self.hash
            );
            return Err(Error::content(path, None, message));
        }
        self.values = found.values;
        Ok(())
    }

    /// The tests as points.
    pub(crate) fn points(&self, space: &Space) -> Result<Vec<Point>, Error> {
        self.values()?.iter().map(|test| Ok(space.encode(test)?)).collect()
    }

    /// The tests as `extended.csv` has them.
    pub(crate) fn csv(&self, space: &Space) -> Result<Vec<u8>, Error> {
        Ok(csv(space, self.values()?))
    }

    fn values(&self) -> Result<&[Values], Error> {
        let missing = || {
            Error::Usage(format!("the study extends {} tests of {}, which have not been read", self.tests, self.name))
        };
        self.values.as_deref().ok_or_else(missing)
    }
}

/// Tests as CSV, a column for every coordinate.
fn csv(space: &Space, tests: &[Values]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
    write(space.coordinates().map(|coordinate| coordinate.name()).collect());
    for test in tests {
        write(test.iter().flat_map(|(_, value)| value.scalars()).map(ToString::to_string).collect());
    }
    csv.into_inner().expect("memory does not fail to flush")
}
