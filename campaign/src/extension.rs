//! Tests of a file. A campaign counts them as done, so that it runs only the tests that are missing; or it runs them, with the strategy `given`.
//!
//! The campaign names the tests by their number and their hash. The hash is that of the CSV that the tests would be
//! written as, so that the format of the original file and other contents of it do not matter. The campaign's folder
//! keeps this CSV as `extended.csv`, so that the campaign can be measured when the original file is gone. A replay
//! needs neither file.

use crate::test_set::{read_values, tests_as_csv};
use crate::{Error, Reason, Study};
use paracosm_space::plural;
use paracosm_space::{Point, Space, Values};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_128;

/// Tests of a file, which a campaign counts as done and does not run. With the strategy `given`, it runs these tests.
#[derive(Debug, Clone)]
pub struct Extension {
    record: ExtensionRecord,
    tests: Kept,
}

/// The place of the tests.
#[derive(Debug, Clone)]
enum Kept {
    Here(Vec<Values>),
    In(PathBuf),
}

/// The origin, the number and the hash of the tests of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExtensionRecord {
    /// The path of the file from which the tests were read.
    pub name: String,
    /// The number of tests.
    pub tests: usize,
    /// The hash of the tests, which is the 128-bit XXH3 of `extended.csv`.
    pub hash: String,
}

/// The error that a file does not hold the tests that a campaign extends.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the campaign extends {} with hash {}; found {} with hash {}",
    plural(expected.tests, "test"), expected.hash, plural(found.tests, "test"), found.hash
)]
pub struct OtherTests {
    /// The number and the hash of the tests in the file.
    pub found: ExtensionRecord,
    /// The number and the hash of the tests that the campaign extends.
    pub expected: ExtensionRecord,
}

impl Reason for OtherTests {}

impl Extension {
    /// Reads existing tests of a study from a CSV file. A column with the name of a fixed parameter must have the fixed
    /// value.
    ///
    /// # Errors
    /// The file cannot be read, does not hold tests of the open parameters, or has other values for fixed parameters.
    /// The error says in which line and why.
    pub fn read(path: &Path, study: &Study) -> Result<Self, Error> {
        Ok(Self::of_values(path, study.space(), read_values(path, study.space(), study.fixed())?))
    }

    fn of_values(path: &Path, space: &Space, values: Vec<Values>) -> Self {
        let hash = format!("{:032x}", xxh3_128(&tests_as_csv(space, &values)));
        let record = ExtensionRecord { name: path.display().to_string(), tests: values.len(), hash };
        Self { record, tests: Kept::Here(values) }
    }

    /// Makes an extension from a record of the tests and from the file in which the campaign keeps the tests. The tests
    /// are read when they are needed.
    pub fn kept(record: ExtensionRecord, path: PathBuf) -> Self {
        Self { record, tests: Kept::In(path) }
    }

    /// Returns the origin, the number and the hash of the tests.
    pub fn record(&self) -> &ExtensionRecord {
        &self.record
    }

    /// Returns the tests as points of a space.
    ///
    /// # Errors
    /// The file of the tests cannot be read, or holds other tests.
    pub fn points(&self, space: &Space) -> Result<Vec<Point>, Error> {
        self.values(space)?.iter().map(|test| Ok(space.encode(test)?)).collect()
    }

    /// Returns the tests as CSV, in the format of `extended.csv`.
    ///
    /// # Errors
    /// The same errors as [`points`](Self::points).
    pub fn csv(&self, space: &Space) -> Result<Vec<u8>, Error> {
        Ok(tests_as_csv(space, &self.values(space)?))
    }

    /// Returns the tests that keep all constraints of a space, with their numbers exactly as the file has them.
    ///
    /// # Errors
    /// The same errors as [`points`](Self::points).
    pub fn valid(&self, space: &Space) -> Result<Vec<Values>, Error> {
        let mut valid = Vec::new();
        for test in self.values(space)?.iter() {
            if space.broken_as_written(test)?.is_none() {
                valid.push(space.as_written(test)?);
            }
        }
        Ok(valid)
    }

    /// Returns the texts of the constraints that tests break, each with the position of the test, from 0. The list has the first broken
    /// constraint of each test.
    ///
    /// # Errors
    /// The same errors as [`points`](Self::points).
    pub fn broken<'s>(&self, space: &'s Space) -> Result<Vec<(usize, &'s str)>, Error> {
        let mut broken = Vec::new();
        for (at, test) in self.values(space)?.iter().enumerate() {
            broken.extend(space.broken_as_written(test)?.map(|constraint| (at, constraint.text())));
        }
        Ok(broken)
    }

    fn values(&self, space: &Space) -> Result<Cow<'_, [Values]>, Error> {
        let path = match &self.tests {
            Kept::Here(values) => return Ok(Cow::Borrowed(values)),
            Kept::In(path) => path,
        };
        let values = read_values(path, space, &Values::default())?;
        let found = Self::of_values(path, space, values.clone()).record;
        if found.hash != self.record.hash {
            return Err(Error::in_file(path, None, OtherTests { found, expected: self.record.clone() }));
        }
        Ok(Cow::Owned(values))
    }
}
