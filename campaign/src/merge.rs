//! Puts the shards of a campaign together: the merged log has the lines of the shards in their order, byte for byte.

use crate::files::{Lines, read_text_here};
use crate::shard::{Shard, ShardFlaw, Written, read};
use crate::study_file::STUDY;
use crate::trials_file::TRIALS;
use crate::{Catalogue, Doubts, Error, Folder, Log, Trust};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A shard that was read from its folder.
struct Part<'a> {
    folder: &'a Path,
    log: Log,
}

/// Puts the shards of a campaign together in a new folder, which then holds the study and the log of the whole campaign. Returns the folder and the
/// log.
///
/// # Errors
/// A folder holds no shard, or one that has not ended; shards are missing, given twice, or of different campaigns; the user does not trust a
/// command of the campaign; or the new folder cannot be written.
pub fn merge(out: &Path, folders: &[PathBuf], catalogue: &Catalogue, trust: &Trust) -> Result<(Folder, Log), Error> {
    let catalogue = &catalogue.trusting(trust);
    let mut parts = BTreeMap::<usize, Part>::new();
    let mut first: Option<(&Path, Shard, Option<String>)> = None;
    let mut judged = None;
    // The logs of all shards together take long to read.
    let all: Vec<_> = folders.par_iter().map(|folder| read_part(folder, catalogue)).collect();
    for (folder, part) in folders.iter().zip(all) {
        let (Written { shard, tests }, log) = part?;
        let (begun, of, hash) = first.get_or_insert_with(|| (folder, shard, log.hash().map(str::to_owned)));
        let what = match () {
            () if of.of != shard.of => Some(format!("one is of {}, the other of {}", of.of, shard.of)),
            () if hash.as_deref() != log.hash() => {
                Some(format!("their studies have the hashes {} and {}", shown(hash.as_deref()), shown(log.hash())))
            }
            () => differing_requirements(&mut judged, &log),
        };
        if let Some(what) = what {
            return Err(ShardFlaw::Different { first: begun.to_owned(), other: folder.clone(), what }.into());
        }
        if let Some(tests) = tests.filter(|tests| *tests != log.trials().len()) {
            let found = log.trials().len();
            return Err(ShardFlaw::Count { folder: folder.clone(), shard, found, expected: tests }.into());
        }
        if let Some(other) = parts.insert(shard.number, Part { folder, log }) {
            let folders = [other.folder.to_owned(), folder.clone()];
            return Err(ShardFlaw::Twice { folders, shard }.into());
        }
    }
    let of = first.as_ref().map_or(1, |(_, shard, _)| shard.of);
    let missing: Vec<usize> = (1..=of).filter(|number| !parts.contains_key(number)).collect();
    if !missing.is_empty() {
        return Err(ShardFlaw::Missing { missing, of }.into());
    }
    whole(&parts, of)?;
    let log = parts[&1].log.with_trials(Vec::new()).trusting(trust);
    log.study().check_trust()?;
    // A scenario that cannot be used here would leave a folder that cannot be completed.
    if let Ok(simulation) = log.study().subject().scenario() {
        simulation.program()?;
    }
    // The text of the shards, which their lines refer to: this may be another version of the software.
    let text = read_text_here(&parts[&1].folder.join(STUDY))?;
    let mut folder = Folder::begin(out, log.study(), log.extension(), &text, None)?;
    let mut doubts = Vec::new();
    for part in parts.values() {
        let mut lines = Vec::new();
        let file = part.folder.join(TRIALS);
        Lines::open_here(&file)?.read_to_end(&mut lines).map_err(Error::io("read", &file))?;
        folder.append_lines(&lines)?;
        doubts.extend(Doubts::read(part.folder)?);
    }
    if !doubts.is_empty() {
        Doubts::write(out, doubts)?;
    }
    // The lines of the shards were read already.
    let trials = parts.into_values().flat_map(|part| part.log.into_trials()).collect();
    let log = Log::read_study(out, catalogue, trials)?.trusting(trust);
    Ok((folder, log))
}

/// Reads the shard in a folder, which has ended.
fn read_part(folder: &Path, catalogue: &Catalogue) -> Result<(Written, Log), Error> {
    let no_shard = || ShardFlaw::NoShard { folder: folder.to_owned() };
    let written = read(folder)?.ok_or_else(no_shard)?;
    if written.tests.is_none() {
        return Err(ShardFlaw::Unfinished { folder: folder.to_owned(), shard: written.shard }.into());
    }
    let log = Log::read_shard(folder, catalogue, written.shard)?;
    Ok((written, log))
}

/// Returns the difference in words if the tests of a shard are judged by other requirements than the tests of the shards before.
fn differing_requirements(judged: &mut Option<Vec<String>>, log: &Log) -> Option<String> {
    let of_log = log.trials().iter().find(|trial| trial.covers())?;
    let here: Vec<String> = of_log.requirements().map(str::to_owned).collect();
    let there = judged.get_or_insert_with(|| here.clone());
    (*there != here).then(|| format!("one is judged by {}, the other by {}", there.join(", "), here.join(", ")))
}

fn shown(hash: Option<&str>) -> &str {
    hash.unwrap_or("(none)")
}

/// Checks that the shards have all tests of the campaign. A strategy may have fewer tests than the budget: then the last shards are short.
fn whole(parts: &BTreeMap<usize, Part<'_>>, of: usize) -> Result<(), ShardFlaw> {
    let mut is_exhausted = false;
    for (number, Part { folder, log }) in parts {
        let shard = Shard { number: *number, of };
        let (found, range) = (log.trials().len(), shard.range(log.study().sampling().budget));
        let expected = if is_exhausted { 0 } else { range.len() };
        if found > expected {
            return Err(ShardFlaw::Count { folder: folder.to_path_buf(), shard, found, expected });
        }
        is_exhausted |= found < expected;
    }
    Ok(())
}
