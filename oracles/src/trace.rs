//! The trace of a run: named signals, with a sample of each signal per tick.
//!
//! Oracles see only the trace. So people can look at everything that is judged (as CSV). A replay is compared with the
//! original run by the hash of the trace.

use xxhash_rust::xxh3::Xxh3;

/// The named signals of a run over time, sampled every `dt` seconds from time 0 on.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    dt: f64,
    signals: Vec<String>,
    /// The samples of all signals at the first tick, then the samples of all signals at the second tick, and so on.
    samples: Vec<f64>,
    complete: bool,
}

impl Trace {
    /// Makes an empty trace of the given signals, which is sampled every `dt` seconds.
    ///
    /// # Panics
    /// There is no signal, or `dt` is not a positive number. Both are mistakes of the program, not of its input.
    pub fn new(dt: f64, signals: Vec<String>) -> Self {
        assert!(dt > 0.0 && !signals.is_empty(), "a trace needs a sample period and a signal");
        Self { dt, signals, samples: Vec::new(), complete: false }
    }

    /// Reserves memory for the given number of ticks, so that recording the ticks allocates nothing.
    pub fn reserve(&mut self, ticks: usize) {
        self.samples.reserve_exact(ticks * self.signals.len());
    }

    /// Appends one tick with a sample of every signal, in the order of the signals.
    ///
    /// # Panics
    /// The number of samples in the row differs from the number of signals.
    pub fn record(&mut self, row: &[f64]) {
        assert_eq!(row.len(), self.signals.len(), "one sample per signal");
        self.samples.extend_from_slice(row);
    }

    /// Marks the trace as complete, since the run reached its planned end and nothing more will happen.
    pub fn finish(&mut self) {
        self.complete = true;
    }

    /// Returns `true` if the run reached its planned end, and `false` if the run was cut short.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// Returns the sample period of the trace, in seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Returns the names of the signals in the trace.
    pub fn signals(&self) -> &[String] {
        &self.signals
    }

    /// Returns the number of ticks, which is the number of samples of each signal.
    pub fn len(&self) -> usize {
        self.samples.len() / self.signals.len()
    }

    /// Returns `true` if the trace has no samples.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Returns the samples of all signals at each tick, in the order of the ticks. The ticks are at the times 0, `dt`,
    /// `2 dt` and so on.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.samples.chunks_exact(self.signals.len())
    }

    /// Returns the samples of the signal with the given name, or `None` if the trace does not have the signal.
    pub fn signal(&self, name: &str) -> Option<impl DoubleEndedIterator<Item = f64> + ExactSizeIterator + '_> {
        let column = self.signals.iter().position(|signal| signal == name)?;
        Some(self.samples.chunks_exact(self.signals.len()).map(move |row| row[column]))
    }

    /// Returns a hash of the whole content of the trace, as 32 hexadecimal digits of XXH3-128.
    ///
    /// Traces with the same hash are identical bit for bit, except with a negligible probability.
    pub fn hash(&self) -> String {
        let mut hasher = Xxh3::new();
        hasher.update(&self.dt.to_le_bytes());
        hasher.update(&[u8::from(self.complete)]);
        for signal in &self.signals {
            hasher.update(signal.as_bytes());
            hasher.update(&[0]);
        }
        let mut bytes = [0; 8 * 512];
        for block in self.samples.chunks(512) {
            for (bytes, sample) in bytes.chunks_exact_mut(8).zip(block) {
                bytes.copy_from_slice(&sample.to_le_bytes());
            }
            hasher.update(&bytes[..8 * block.len()]);
        }
        format!("{:032x}", hasher.digest128())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(samples: &[f64]) -> Trace {
        let mut trace = Trace::new(0.01, vec!["a".into(), "b".into()]);
        samples.chunks(2).for_each(|row| trace.record(row));
        trace
    }

    #[test]
    fn a_trace_gives_back_what_was_recorded() {
        let trace = trace(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(trace.len(), 2);
        assert_eq!(trace.signal("b").unwrap().collect::<Vec<_>>(), [2.0, 4.0]);
        assert!(trace.signal("c").is_none());
    }

    #[test]
    fn the_hash_tells_traces_apart_by_one_bit() {
        let samples: Vec<f64> = (0..400).map(f64::from).collect();
        let mut other = samples.clone();
        other[399] = other[399].next_up();
        assert_eq!(trace(&samples).hash(), trace(&samples).hash());
        assert_ne!(trace(&samples).hash(), trace(&other).hash());
        let mut finished = trace(&samples);
        finished.finish();
        assert_ne!(trace(&samples).hash(), finished.hash());
    }
}
