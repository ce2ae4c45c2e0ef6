//! Writes the files of a map in the folder of its campaign.

use super::{FailureMap, Picture};
use paracosm_campaign::{Artefact, Error, Failure};
use std::path::PathBuf;

/// The files of a map, which are pictures and, with an estimated probability, a table of numbers.
#[derive(Debug, Clone, Copy)]
pub enum MapFiles<'m> {
    /// The failure map, which shows the verdict of each test.
    Failures(&'m FailureMap),
    /// The blame map, which shows the blame for each failure.
    Blame(&'m FailureMap),
    /// The severity map, which shows the impact speed of each test.
    Severity(&'m FailureMap),
}

impl Artefact for MapFiles<'_> {
    fn files(&self) -> Vec<&'static str> {
        match self {
            Self::Failures(map) if map.estimate.is_some() => {
                vec!["failure-map.svg", "failure-map.png", "failure-map.csv"]
            }
            Self::Failures(_) => vec!["failure-map.svg", "failure-map.png"],
            Self::Severity(_) => vec!["severity-map.svg", "severity-map.png"],
            Self::Blame(_) => vec!["blame-map.svg", "blame-map.png"],
        }
    }

    fn contents(&self, file: &str) -> Result<Vec<u8>, Error> {
        let (Self::Failures(map) | Self::Blame(map) | Self::Severity(map)) = *self;
        let picture = || Picture::of(map.clone());
        let drawn = match file.rsplit_once('.') {
            Some((_, "svg")) => picture().svg().map(String::into_bytes),
            Some((_, "png")) => picture().png(),
            _ => Ok(map.estimate.as_ref().map(paracosm_analysis::FailureEstimate::csv).unwrap_or_default()),
        };
        drawn.map_err(|source| Failure::Drawing { path: PathBuf::from(file), source }.into())
    }
}
