//! Divides a campaign into shards, which run on any machines. `merge.rs` puts the shards together again.
//!
//! A shard has the tests of one range of indices. Each shard knows the whole study, and computes its tests itself. So a study can be divided only if
//! its tests do not depend on outcomes. The folder of a shard looks like the folder of a campaign. The file `shard.json` in it tells other commands
//! that the log is not whole.

use crate::files::{read_text_here, write_whole_here};
use crate::{Error, Reason, Study};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use thiserror::Error;

/// The file in the folder of a shard.
pub(crate) const FILE: &str = "shard.json";

/// The greatest number of shards of a campaign.
const MOST: usize = 100_000;

/// A shard of a campaign: its number, from 1 on, and the number of all shards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Numbers", into = "Numbers")]
pub struct Shard {
    pub(crate) number: usize,
    pub(crate) of: usize,
}

/// The numbers of a shard as a file has them.
#[derive(Serialize, Deserialize)]
struct Numbers {
    shard: usize,
    of: usize,
}

/// The contents of the file.
#[derive(Serialize, Deserialize)]
pub(crate) struct Written {
    #[serde(flatten)]
    pub shard: Shard,
    /// The number of tests of the shard, once all of them have run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tests: Option<usize>,
}

/// A reason why a campaign cannot be divided, or why shards cannot be put together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ShardFlaw {
    /// The text does not name a shard.
    #[error("found the shard `{shard}`, expected I/N, such as 2/64: the number I is from 1 to N, and N at most {MOST}")]
    Syntax {
        /// The shard that was given.
        shard: String,
    },
    /// The strategy learns from outcomes.
    #[error(
        "the strategy {strategy} learns from the outcomes of all tests before, so its campaign cannot be divided into shards; choose a strategy \
         such as halton"
    )]
    Adaptive {
        /// The name of the strategy.
        strategy: String,
    },
    /// The campaign ends with the first failing test.
    #[error(
        "a campaign that stops at its first failing test cannot be divided into shards: a shard does not know the tests of the others"
    )]
    StopsAtFirst,
    /// The folder holds a shard, and a whole campaign was expected.
    #[error("{} holds shard {shard} of a campaign, and no whole campaign: `merge` puts the shards together", folder.display())]
    IsShard {
        /// The folder.
        folder: PathBuf,
        /// The shard in the folder.
        shard: Shard,
    },
    /// The folder holds no shard.
    #[error("{} holds no shard of a campaign: `run --shard I/N` makes one", folder.display())]
    NoShard {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder holds another shard.
    #[error("{} holds shard {found}, and this command runs shard {expected}", folder.display())]
    OtherShard {
        /// The folder.
        folder: PathBuf,
        /// The shard in the folder.
        found: Shard,
        /// The shard of the command.
        expected: Shard,
    },
    /// Not all tests of a shard have run.
    #[error("{} holds shard {shard}, which has not ended: continue it with --resume", folder.display())]
    Unfinished {
        /// The folder.
        folder: PathBuf,
        /// The shard in the folder.
        shard: Shard,
    },
    /// Two shards are of different campaigns.
    #[error("{} and {} hold shards of different campaigns: {what}", first.display(), other.display())]
    Different {
        /// The folder of the first shard.
        first: PathBuf,
        /// The folder of a shard that does not belong to it.
        other: PathBuf,
        /// The difference in words.
        what: String,
    },
    /// Two folders hold the same shard.
    #[error("{} and {} both hold shard {shard}: give each shard once", folders[0].display(), folders[1].display())]
    Twice {
        /// The folders.
        folders: [PathBuf; 2],
        /// The shard that both hold.
        shard: Shard,
    },
    /// Shards are missing.
    #[error("{} of {of} shards are missing: {}", missing.len(), in_words(missing))]
    Missing {
        /// The numbers of the missing shards.
        missing: Vec<usize>,
        /// The number of all shards.
        of: usize,
    },
    /// A shard has another number of tests than the study asks for.
    #[error("{} holds {found} tests of shard {shard}, expected {expected}", folder.display())]
    Count {
        /// The folder.
        folder: PathBuf,
        /// The shard in the folder.
        shard: Shard,
        /// The number of tests in the log.
        found: usize,
        /// The number of tests that the shard should have.
        expected: usize,
    },
}

impl Reason for ShardFlaw {}

/// Returns the first numbers of a list in words.
fn in_words(numbers: &[usize]) -> String {
    let first: Vec<String> = numbers.iter().take(8).map(ToString::to_string).collect();
    first.join(", ") + if numbers.len() > first.len() { ", .." } else { "" }
}

impl Shard {
    /// Returns the range of the indices of the tests of the shard, in a campaign of `tests` tests.
    pub fn range(self, tests: usize) -> Range<usize> {
        let end = |number: usize| (number as u128 * tests as u128 / self.of as u128) as usize;
        end(self.number - 1)..end(self.number)
    }

    /// Checks that the campaign of a study can be divided.
    ///
    /// # Errors
    /// The tests of the study depend on outcomes.
    pub fn check(study: &Study) -> Result<(), ShardFlaw> {
        let sampling = study.sampling();
        if sampling.strategy.is_adaptive() {
            return Err(ShardFlaw::Adaptive { strategy: sampling.strategy.name().to_owned() });
        }
        if sampling.stop_at_first { Err(ShardFlaw::StopsAtFirst) } else { Ok(()) }
    }

    /// Returns the shard in a folder; `None` if the folder holds none.
    ///
    /// # Errors
    /// The file of the shard cannot be read, or has other contents.
    pub fn in_folder(folder: &Path) -> Result<Option<Self>, Error> {
        Ok(read(folder)?.map(|written| written.shard))
    }

    /// Checks that a folder holds this shard.
    pub(crate) fn is_in(self, folder: &Path) -> Result<(), Error> {
        let flaw = match Self::in_folder(folder)? {
            Some(found) if found == self => return Ok(()),
            Some(found) => ShardFlaw::OtherShard { folder: folder.to_owned(), found, expected: self },
            None => ShardFlaw::NoShard { folder: folder.to_owned() },
        };
        Err(flaw.into())
    }

    /// Writes the shard to its folder, with the number of its tests once all of them have run.
    pub(crate) fn write(self, folder: &Path, tests: Option<usize>) -> Result<(), Error> {
        let text = serde_json::to_string(&Written { shard: self, tests }).expect("numbers are always JSON");
        write_whole_here(&folder.join(FILE), format!("{text}\n").as_bytes())
    }
}

impl TryFrom<Numbers> for Shard {
    type Error = ShardFlaw;

    fn try_from(Numbers { shard, of }: Numbers) -> Result<Self, ShardFlaw> {
        let is_shard = (1..=of).contains(&shard) && of <= MOST;
        is_shard
            .then_some(Self { number: shard, of })
            .ok_or_else(|| ShardFlaw::Syntax { shard: format!("{shard}/{of}") })
    }
}

impl From<Shard> for Numbers {
    fn from(Shard { number, of }: Shard) -> Self {
        Self { shard: number, of }
    }
}

impl FromStr for Shard {
    type Err = ShardFlaw;

    fn from_str(text: &str) -> Result<Self, ShardFlaw> {
        let flaw = || ShardFlaw::Syntax { shard: text.to_owned() };
        let (number, of) = text.split_once('/').ok_or_else(flaw)?;
        let [shard, of] = [number, of].map(|part| part.parse().ok());
        Numbers { shard: shard.ok_or_else(flaw)?, of: of.ok_or_else(flaw)? }.try_into()
    }
}

/// Writes the shard as `I/N`.
impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// Reads the file in a folder; `None` if the folder holds no shard.
pub(crate) fn read(folder: &Path) -> Result<Option<Written>, Error> {
    let file = folder.join(FILE);
    if !file.exists() {
        return Ok(None);
    }
    let text = read_text_here(&file)?;
    serde_json::from_str(&text).map(Some).map_err(|flaw| Error::in_file(&file, flaw.line(), flaw))
}

/// Checks that the folder does not hold a shard.
pub(crate) fn is_whole(folder: &Path) -> Result<(), Error> {
    match Shard::in_folder(folder)? {
        Some(shard) => Err(ShardFlaw::IsShard { folder: folder.to_owned(), shard }.into()),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_test_is_in_exactly_one_shard_and_shards_differ_by_at_most_one_test() {
        for tests in (0..60).chain([99_999, 100_000, usize::MAX]) {
            for of in (1..=40).chain([64, 499]) {
                let shards: Vec<Range<usize>> = (1..=of).map(|number| Shard { number, of }.range(tests)).collect();
                assert_eq!((shards[0].start, shards[of - 1].end), (0, tests));
                assert!(shards.windows(2).all(|pair| pair[0].end == pair[1].start), "{tests} in {of}");
                let sizes = || shards.iter().map(Range::len);
                assert!(sizes().max().unwrap() - sizes().min().unwrap() <= 1, "{tests} in {of}");
            }
        }
    }

    #[test]
    fn a_shard_is_written_as_a_number_of_a_number() {
        assert_eq!("2/64".parse::<Shard>().unwrap().to_string(), "2/64");
        for text in ["0/4", "5/4", "4", "a/4", "1/0", "-1/4", "1/4/4", "1/100001", ""] {
            assert_eq!(text.parse::<Shard>(), Err(ShardFlaw::Syntax { shard: text.to_owned() }), "{text}");
        }
    }
}
