//! Traces as files: writes traces to look at and to plot, and reads traces to judge them.

use crate::files::write_whole;
use crate::folder::{Folder, NotYours};
use crate::samples::TraceFlaw;
use crate::{Error, Reason};
use paracosm_oracles::Trace;
use std::io::Read;
use std::path::Path;
use thiserror::Error;

/// The greatest deviation of a time, as a share of the sample period.
const TOLERANCE: f64 = 0.01;

/// The share of a period by which a time may lie before a new sample at the same time, because times are rounded.
const ROUNDING: f64 = 1e-6;

/// The greatest number of numbers of a trace that is sampled again.
const MOST_NUMBERS: f64 = 1e8;

/// Writes a trace to a CSV file, with a column `time` in seconds and a column for each signal.
///
/// # Errors
/// The file cannot be written, or has the name of a file that belongs to a campaign.
pub fn write_trace(path: &Path, trace: &Trace) -> Result<(), Error> {
    if path.file_name().is_some_and(Folder::owns) {
        return Err(NotYours { path: path.to_owned(), what: "a trace" }.into());
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

/// Reads a trace from CSV, in the format that [`write_trace`] writes. The columns are `time` in seconds, evenly spaced
/// from 0 on, and one for each signal, with numbers, `true` and `false`. After each sample from the second on,
/// `goes_on` gets the trace so far. If it returns `false`, the trace is returned as one that was cut short; otherwise
/// it is complete.
///
/// With `every`, a period in seconds, the samples may have any ascending times, and the trace has samples every so many seconds from
/// the first time on, which becomes 0. Between two samples of the file, a signal is a straight line. A signal with `true`
/// or `false` keeps its value up to the next sample. The trace comes with the samples of the file that it skips.
///
/// # Errors
/// `goes_on` returns an error; or the source, called `path`, is not a valid table: the error says in which line and
/// why.
pub fn read_trace(
    path: &Path,
    source: impl Read,
    every: Option<f64>,
    mut goes_on: impl FnMut(&Trace) -> Result<bool, Error>,
) -> Result<(Trace, Skipped), Error> {
    let mut csv = csv::Reader::from_reader(source);
    let broken = |error: csv::Error| Error::in_csv(path, error);
    let header: Vec<String> = csv.headers().map_err(broken)?.iter().map(str::to_owned).collect();
    let mut table = Table::new(header, every).map_err(|flaw| Error::in_file(path, 1, flaw))?;
    for record in csv.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map(|position| position.line() as usize);
        table.take(record.iter()).map_err(|flaw| Error::in_file(path, line, FlawOfFile { flaw }))?;
        if let Some(trace) = &table.trace
            && !goes_on(trace)?
        {
            return Ok((table.trace.expect("it was just seen"), table.skipped));
        }
    }
    let samples = table.trace.as_ref().map_or(usize::from(table.before.is_some()), Trace::len);
    let enough = table.trace.filter(|trace| trace.len() > 1);
    let mut trace = enough.ok_or_else(|| Error::in_file(path, None, TraceFlaw::TooShort { samples }))?;
    trace.finish();
    let mut skipped = table.skipped;
    skipped.samples += usize::from(!table.is_used);
    Ok((trace, skipped))
}

/// A flaw in the samples of a file, with the way to read a file whose times are not even.
#[derive(Debug, Error)]
#[error("{flaw}{}", self.advice())]
struct FlawOfFile {
    #[source]
    flaw: TraceFlaw,
}

impl Reason for FlawOfFile {}

impl FlawOfFile {
    fn advice(&self) -> &'static str {
        match self.flaw {
            TraceFlaw::Begins { .. } | TraceFlaw::Uneven { .. } => {
                "; `paracosm-fuzz monitor --every SECONDS` samples the file again"
            }
            _ => "",
        }
    }
}

/// The samples of a file that a trace with another period does not have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skipped {
    /// The number of samples on which some signal of the trace does not depend at any time.
    pub samples: usize,
    /// The number of samples of the file.
    pub of: usize,
    /// The shortest time in seconds between two samples of the file.
    pub shortest: f64,
}

/// A trace that is being read.
struct Table {
    /// The index of the column of times, and the signals of the other columns.
    time: usize,
    signals: Vec<String>,
    /// The period of a trace that is sampled again.
    every: Option<f64>,
    /// `true` for the signals that have been `true` or `false`.
    truths: Vec<bool>,
    /// The times of the first and the last sample.
    begun: f64,
    last: f64,
    /// The last sample, if it is needed for the next one.
    before: Option<Vec<f64>>,
    /// The samples that the trace does not have so far.
    skipped: Skipped,
    /// True if all signals of the trace depend on the last sample.
    is_used: bool,
    trace: Option<Trace>,
}

impl Table {
    fn new(header: Vec<String>, every: Option<f64>) -> Result<Self, TraceFlaw> {
        let Some(time) = header.iter().position(|name| name == "time") else {
            return Err(TraceFlaw::NoTime { signals: header });
        };
        let mut signals = header;
        signals.remove(time);
        if signals.is_empty() {
            return Err(TraceFlaw::NoSignal);
        }
        TraceFlaw::check_names(signals.iter().map(String::as_str))?;
        let truths = vec![false; signals.len()];
        let skipped = Skipped { samples: 0, of: 0, shortest: f64::INFINITY };
        Ok(Self {
            time,
            signals,
            every,
            truths,
            begun: 0.0,
            last: 0.0,
            before: None,
            skipped,
            is_used: true,
            trace: None,
        })
    }

    fn take<'a>(&mut self, cells: impl Iterator<Item = &'a str>) -> Result<(), TraceFlaw> {
        let sample = self.trace.as_ref().map_or(usize::from(self.before.is_some()), Trace::len);
        let (mut time, mut row) = (f64::NAN, Vec::with_capacity(self.signals.len()));
        for (column, cell) in cells.enumerate() {
            let name = if column == self.time { "time" } else { &self.signals[row.len()] };
            let no_number = || TraceFlaw::NoNumber { signal: name.to_owned(), found: cell.to_owned(), sample };
            let number = number(cell.trim()).ok_or_else(no_number)?;
            if column == self.time {
                time = number;
            } else {
                self.truths[row.len()] |= is_truth(cell.trim());
                row.push(number);
            }
        }
        match self.every {
            Some(every) => self.sampled_again(every, time, row, sample)?,
            None => self.as_it_is(time, row, sample)?,
        }
        self.skipped.of += 1;
        self.last = time;
        Ok(())
    }

    /// Adds a sample to an evenly spaced trace.
    fn as_it_is(&mut self, time: f64, row: Vec<f64>, sample: usize) -> Result<(), TraceFlaw> {
        let step = time - self.last;
        match (&mut self.trace, self.before.take()) {
            (None, None) if time == 0.0 => self.before = Some(row),
            (None, None) => return Err(TraceFlaw::Begins { at: time }),
            (None, Some(_)) if !(time > 0.0 && time.is_finite()) => {
                return Err(TraceFlaw::Falls { from: 0.0, to: time, sample });
            }
            (None, Some(first)) => {
                let trace = self.trace.insert(Trace::new(time, self.signals.clone()));
                trace.record(&first);
                trace.record(&row);
            }
            (Some(trace), _) if (step - trace.dt()).abs() <= TOLERANCE * trace.dt() => trace.record(&row),
            (Some(trace), _) => {
                return Err(TraceFlaw::Uneven { sample, found: time, expected: self.last + trace.dt() });
            }
        }
        Ok(())
    }

    /// Adds the samples of the new period up to the time of a sample of the file.
    fn sampled_again(&mut self, every: f64, time: f64, row: Vec<f64>, sample: usize) -> Result<(), TraceFlaw> {
        if !time.is_finite() {
            return Err(TraceFlaw::NoNumber { signal: "time".to_owned(), found: time.to_string(), sample });
        }
        let (Some(before), Some(trace)) = (&self.before, &mut self.trace) else {
            let trace = self.trace.insert(Trace::new(every, self.signals.clone()));
            trace.record(&row);
            (self.begun, self.before) = (time, Some(row));
            return Ok(());
        };
        if time <= self.last {
            return Err(TraceFlaw::Falls { from: self.last, to: time, sample });
        }
        let samples = (time - self.begun) / every;
        if samples * self.signals.len() as f64 > MOST_NUMBERS {
            return Err(TraceFlaw::TooLong { samples, signals: self.signals.len() });
        }
        let (mut is_used, mut has_between) = (false, false);
        let keeps = |at: usize| self.truths[at] || !(row[at] - before[at]).is_finite();
        let is_straight = (0..row.len()).all(|at| !keeps(at));
        self.skipped.shortest = self.skipped.shortest.min(time - self.last);
        loop {
            let next = self.begun + trace.len() as f64 * every;
            if next > time + ROUNDING * every {
                break;
            }
            let share = (next - self.last) / (time - self.last);
            has_between |= share < 1.0;
            // A signal that keeps its value between two samples does not depend on the second one.
            is_used |= share >= 1.0 || is_straight;
            let value = |at: usize| match (before[at], row[at]) {
                (_, after) if share >= 1.0 => after,
                (before, _) if keeps(at) => before,
                (before, after) => before + share * (after - before),
            };
            trace.record(&(0..row.len()).map(value).collect::<Vec<f64>>());
        }
        self.skipped.samples += usize::from(!self.is_used && !has_between);
        self.is_used = is_used;
        self.before = Some(row);
        Ok(())
    }
}

/// Returns `true` if a cell is a truth in words.
fn is_truth(cell: &str) -> bool {
    matches!(cell, "true" | "false")
}

/// Returns the number in a cell; `None` if the cell has no number.
fn number(cell: &str) -> Option<f64> {
    match cell {
        "true" => Some(1.0),
        "false" => Some(0.0),
        _ => cell.parse().ok().filter(|number: &f64| !number.is_nan()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Trace, String> {
        read_trace(Path::new("t.csv"), text.as_bytes(), None, |_| Ok(true))
            .map(|(trace, _)| trace)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_table_is_read_as_the_trace_that_it_is() {
        let trace = read("on,time,speed\ntrue,0,1\nfalse,0.1,-inf\n1,0.2,3e1\n").unwrap();
        assert_eq!(
            (trace.dt(), trace.signals(), trace.is_complete()),
            (0.1, &["on".to_owned(), "speed".into()][..], true)
        );
        assert_eq!(trace.rows().flatten().copied().collect::<Vec<_>>(), [1.0, 1.0, 0.0, f64::NEG_INFINITY, 1.0, 30.0]);
        let mut seen = 0;
        let two = read_trace(Path::new("t.csv"), "time,x\n0,1\n1,2\n2,3\n".as_bytes(), None, |trace| {
            seen = trace.len();
            Ok(false)
        });
        assert!(seen == 2 && !two.unwrap().0.is_complete());
    }

    #[test]
    fn samples_on_which_the_new_period_does_not_depend_are_counted() {
        let skipped =
            |text: &str, every| read_trace(Path::new("t.csv"), text.as_bytes(), every, |_| Ok(true)).unwrap().1;
        let spike = "time,x\n0,1\n0.33,1\n0.35,99\n0.37,1\n1,1\n";
        let coarse = skipped(spike, Some(0.1));
        assert_eq!((coarse.samples, coarse.of), (1, 5));
        assert!((coarse.shortest - 0.02).abs() < 1e-9);
        assert_eq!(skipped(spike, Some(coarse.shortest)).samples, 0);
        // A truth keeps its value, so that a short one between two samples is lost.
        let short = "time,on\n0,false\n0.05,false\n0.15,true\n0.18,false\n1,false\n";
        assert_eq!(skipped(short, Some(0.1)).samples, 1);
        // Only the last sample, at 1 s, is not on the period.
        assert_eq!(skipped(short, Some(0.03)).samples, 1);
        assert_eq!(skipped(short, Some(0.02)).samples, 0);
        let even = "time,x\n0,1\n0.1,5\n0.2,2\n0.3,4\n";
        assert_eq!(skipped(even, Some(0.1)).samples, 0);
        // Every other sample is on the new period, and the last one is not.
        assert_eq!(skipped(even, Some(0.2)).samples, 2);
        assert_eq!(skipped(even, None).samples, 0);
    }

    #[test]
    fn samples_at_any_times_are_sampled_again_on_straight_lines() {
        let again = |text: &str, every| {
            let trace = read_trace(Path::new("t.csv"), text.as_bytes(), Some(every), |_| Ok(true));
            trace
                .map(|(trace, _)| trace.rows().map(<[f64]>::to_vec).collect::<Vec<_>>())
                .map_err(|error| error.to_string())
        };
        // From 100 s on, with a gap; a truth keeps its value, and so does a number beside an infinite one.
        let text = "time,x,on,y\n100,0,true,1\n100.3,3,false,inf\n101,10,true,2\n";
        let expected: Vec<[f64; 3]> = vec![
            [0.0, 1.0, 1.0],
            [2.5, 1.0, 1.0],
            [5.0, 0.0, f64::INFINITY],
            [7.5, 0.0, f64::INFINITY],
            [10.0, 1.0, 2.0],
        ];
        let found = again(text, 0.25).unwrap();
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            let is_near = |(a, b): (&f64, f64)| *a == b || (a - b).abs() < 1e-9;
            assert!(found.iter().zip(expected).all(is_near), "{found:?} {expected:?}");
        }
        // A trace with even samples stays as it is.
        assert_eq!(again("time,x\n0,1\n0.1,5\n0.2,2\n0.3,4\n", 0.1).unwrap(), [[1.0], [5.0], [2.0], [4.0]]);
        for (text, every, says) in [
            ("time,x\n1,1\n", 0.1, "found 1 sample, expected at least 2"),
            ("time,x\n1,1\n1.5,2\n", 9.0, "found 1 sample, expected at least 2"),
            ("time,x\n1,1\n1,2\n", 0.1, "line 3: `time` goes from 1 to 1"),
            ("time,x\ninf,1\n", 0.1, "line 2: `time` is `inf`"),
            ("time,x\n0,1\n1e9,2\n", 1e-3, "line 3: the trace would have"),
        ] {
            let message = again(text, every).unwrap_err();
            assert!(message.contains(says), "{says}: {message}");
        }
    }

    #[test]
    fn what_is_no_trace_is_named_with_its_line() {
        for (text, says) in [
            ("", "expected `time`"),
            ("time\n0\n", "no signal beside `time`"),
            ("time,x,x\n", "two signals are called `x`"),
            ("time,x\n0,1\n", "found 1 sample, expected at least 2"),
            ("time,x\n1,1\n", "line 2: the trace begins at 1 s, expected 0 s"),
            ("time,x\n0,1\n0,1\n", "line 3: `time` goes from 0 to 0 at sample 1, expected it to rise"),
            ("time,x\n0,1\n1,NaN\n", "line 3: `x` is `NaN` at sample 1, expected a number"),
            ("time,x\n0,1\n1,\n", "line 3: `x` is `` at sample 1, expected a number"),
            ("time,x\n0,1\n1,2\n3,2\n", "line 4: the samples are not evenly spaced: sample 2 is at 3 s, expected 2 s"),
            ("time,x\n0,1\n1,2,3\n", "line 3"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.starts_with("t.csv") && message.contains(says), "{says}: {message}");
        }
    }
}
