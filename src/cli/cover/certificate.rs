//! The option `--certificate` of `paracosm-cover estimate`.

use crate::cli::Verbosity;
use crate::cli::output::{digits, plural};
use paracosm_analysis::certificate::certify;
use paracosm_analysis::{Coverage, Limit, Watch};
use paracosm_campaign::{Error, TestSet};
use paracosm_coverage::Measure;
use std::path::Path;

/// Measures tests and writes a certificate. Notes say what the certificate proves, and where this is less than the
/// measured value.
pub(super) fn write(
    file: &Path,
    tests: &TestSet,
    measures: &[Measure],
    k: Option<usize>,
    limit: Limit,
    watch: &mut Watch,
    verbosity: Verbosity,
) -> Result<Coverage, Error> {
    let (coverage, certificate) = certify(tests, measures, k, limit, watch)?;
    certificate.write(file)?;
    for claim in &certificate.claims {
        let k = claim.k.map_or(String::new(), |k| format!(", k = {k}"));
        let pivots: usize = claim.proofs.iter().map(|proof| proof.pivots.len()).sum();
        verbosity.note(format_args!(
            "{}: {}{k} at most {} ({}, {})",
            file.display(),
            claim.measure,
            digits(claim.upper),
            plural(claim.proofs.len(), "projection"),
            if pivots == 1 { "1 box".to_owned() } else { format!("{pivots} boxes") },
        ));
        if let Some(note) = &claim.note {
            verbosity.note(format_args!("warning: {}: {note}", claim.measure));
        }
    }
    Ok(coverage)
}
