//! A trace as a file, to look at and to plot.

use crate::folder::write_whole;
use crate::{Error, Folder};
use paracosm_oracles::Trace;
use std::path::Path;

/// Writes a trace as CSV: a column `time` in seconds, then one for each signal.
///
/// # Errors
/// The file cannot be written, or has the name of a file that belongs to a campaign.
pub fn write_trace(path: &Path, trace: &Trace) -> Result<(), Error> {
    if path.file_name().is_some_and(Folder::owns) {
        let message =
            format!("{} has the name of a campaign's own file, which a trace must not replace", path.display());
        return Err(Error::Usage(message));
    }
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
    write(["time".to_owned()].into_iter().chain(trace.signals().iter().cloned()).collect());
    for (tick, row) in trace.rows().enumerate() {
        let time = tick as f64 * trace.dt();
        write([time].iter().chain(row).map(ToString::to_string).collect());
    }
    write_whole(path, &csv.into_inner().expect("memory does not fail to flush"))
}
