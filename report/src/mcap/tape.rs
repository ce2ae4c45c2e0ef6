//! An MCAP file that is being written: messages are collected, and written in the order of their times.

use foxglove::{Encode, Schema};
use mcap::records::{MessageHeader, Metadata};
use mcap::{McapError, WriteOptions, Writer};
use paracosm_campaign::{Error, Failure, Reason};
use std::collections::BTreeMap;
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reason why a run cannot be written as an MCAP file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Unwritable {
    /// The run has neither a world nor a trace.
    #[error(
        "test {index} has neither a world nor a trace, so there is nothing to write; choose a test that ended as pass, fail or inconclusive"
    )]
    Nothing {
        /// The index of the test in the campaign.
        index: usize,
    },
}

impl Reason for Unwritable {}

/// A topic of a file. Its messages have one schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Topic(u16);

/// A message that waits for its turn.
struct Waiting {
    nanoseconds: u64,
    topic: Topic,
    data: Vec<u8>,
}

/// A file that is being written.
pub(super) struct Tape<W: Write + Seek> {
    writer: Writer<W>,
    path: PathBuf,
    waiting: Vec<Waiting>,
    /// The number of messages of each topic so far.
    written: BTreeMap<u16, u32>,
}

impl<W: Write + Seek> Tape<W> {
    /// Begins a file. The path is for errors.
    pub fn begin(to: W, path: &Path) -> Result<Self, Error> {
        let options = WriteOptions::new().compression(None).library("paracosm");
        let writer = options.create(to).map_err(|source| broken(path, source))?;
        Ok(Self { writer, path: path.to_owned(), waiting: Vec::new(), written: BTreeMap::new() })
    }

    /// Adds a topic for messages of one type, with facts about it, or finds the same topic.
    pub fn topic<M: Encode>(&mut self, name: &str, facts: &[(&str, &str)]) -> Result<Topic, Error> {
        let Schema { name: schema, encoding, data } = M::get_schema().expect("every message here has a schema");
        let facts = facts.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
        let writer = &mut self.writer;
        let channel = writer
            .add_schema(&schema, &encoding, &data)
            .and_then(|schema| writer.add_channel(schema, name, &M::get_message_encoding(), &facts));
        channel.map(Topic).map_err(|source| broken(&self.path, source))
    }

    /// Returns the number of messages so far, and the number of topics that have messages.
    pub fn counts(&self) -> [usize; 2] {
        [self.written.values().map(|count| *count as usize).sum(), self.written.len()]
    }

    /// Adds a message at a time in seconds since the run began.
    pub fn say<M: Encode>(&mut self, topic: Topic, seconds: f64, message: &M) {
        let mut data = Vec::with_capacity(message.encoded_len().unwrap_or_default());
        // A vector grows, so that there is always room.
        let is_encoded = message.encode(&mut data).is_ok();
        debug_assert!(is_encoded, "a message did not fit into a vector");
        self.waiting.push(Waiting { nanoseconds: nanoseconds(seconds), topic, data });
    }

    /// Writes all messages that wait, in the order of their times.
    pub fn flush(&mut self) -> Result<(), Error> {
        // The order of messages at the same time stays.
        self.waiting.sort_by_key(|message| message.nanoseconds);
        for Waiting { nanoseconds, topic, data } in &self.waiting {
            let number = self.written.entry(topic.0).or_default();
            let header = MessageHeader {
                channel_id: topic.0,
                sequence: *number,
                log_time: *nanoseconds,
                publish_time: *nanoseconds,
            };
            *number += 1;
            self.writer.write_to_known_channel(&header, data).map_err(|source| broken(&self.path, source))?;
        }
        self.waiting.clear();
        Ok(())
    }

    /// Ends the file with facts about the run.
    pub fn end(mut self, facts: &[(String, String)]) -> Result<(), Error> {
        let metadata = Metadata { name: "paracosm".to_owned(), metadata: facts.iter().cloned().collect() };
        let written = self.writer.write_metadata(&metadata).and_then(|()| self.writer.finish()).map(drop);
        written.map_err(|source| broken(&self.path, source))?;
        self.writer.into_inner().flush().map_err(Error::io("write", &self.path))
    }

    /// Returns the error that something could not be written.
    pub fn failed(&self, source: Box<dyn std::error::Error + Send + Sync>) -> Error {
        Failure::Drawing { path: self.path.clone(), source }.into()
    }
}

/// Returns whole nanoseconds.
pub(super) fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round().max(0.0) as u64
}

fn broken(path: &Path, source: McapError) -> Error {
    match source {
        McapError::Io(source) => Error::io("write", path)(source),
        source => Failure::Drawing { path: path.to_owned(), source: source.into() }.into(),
    }
}
