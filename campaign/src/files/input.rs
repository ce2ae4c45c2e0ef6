//! Reads files of others within limits: a file that never ends must not fill the memory.

use crate::{Error, Reason};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use thiserror::Error;

/// The greatest number of bytes of a file that is read as a whole.
const MOST_WHOLE: u64 = 256 << 20;

/// The greatest number of bytes of a line in a file that is read line by line.
const MOST_LINE: usize = 64 << 20;

/// The reason why a file is not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum InputFlaw {
    /// The file is larger than files of its kind may be.
    #[error("the file has more than {} MiB, the most that is read as a whole", MOST_WHOLE >> 20)]
    TooLarge,
    /// A line of the file is longer than lines may be.
    #[error("a line has more than {} MiB, the most that is read", MOST_LINE >> 20)]
    LongLine,
    /// The file in the folder of a campaign is a pipe, a device or a folder.
    #[error("found no regular file, expected a file that a campaign wrote")]
    NotRegular,
}

impl Reason for InputFlaw {}

/// A file that is read line by line. Reading ends with an error as soon as a line is too long.
pub struct Lines<R = File> {
    input: R,
    /// The number of bytes since the last end of a line.
    since: usize,
}

impl<R: Read> Lines<R> {
    /// Reads lines from an input.
    pub fn of(input: R) -> Self {
        Self { input, since: 0 }
    }
}

impl Lines {
    /// Opens a file that is read line by line. The file may be a pipe.
    ///
    /// # Errors
    /// The file cannot be opened.
    pub fn open(path: &Path) -> Result<Self, Error> {
        Ok(Self::of(File::open(path).map_err(Error::io("read", path))?))
    }

    /// Opens a file in the folder of a campaign.
    ///
    /// # Errors
    /// The file cannot be opened, or is no regular file.
    pub fn open_here(path: &Path) -> Result<Self, Error> {
        is_regular(path)?;
        Self::open(path)
    }
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.input.read(buffer)?;
        self.since = match buffer[..read].iter().rposition(|byte| *byte == b'\n') {
            Some(end) => read - end - 1,
            None => self.since + read,
        };
        if self.since > MOST_LINE { Err(io::Error::other(InputFlaw::LongLine)) } else { Ok(read) }
    }
}

/// Checks that a file in the folder of a campaign is a regular file. To open a pipe would wait for its writer.
pub fn is_regular(path: &Path) -> Result<(), Error> {
    let found = path.metadata().map_err(Error::io("read", path))?;
    if found.is_file() { Ok(()) } else { Err(Error::in_file(path, None, InputFlaw::NotRegular)) }
}

/// Reads the bytes of a whole file. The file may be a pipe.
///
/// # Errors
/// The file cannot be read, or is too large.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(Error::io("read", path))?;
    file.take(MOST_WHOLE + 1).read_to_end(&mut bytes).map_err(Error::io("read", path))?;
    if bytes.len() as u64 > MOST_WHOLE { Err(Error::in_file(path, None, InputFlaw::TooLarge)) } else { Ok(bytes) }
}

/// Reads the text of a whole file. The file may be a pipe.
///
/// # Errors
/// The file cannot be read, is too large, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, Error> {
    let text = String::from_utf8(read_bytes(path)?);
    text.map_err(|error| Error::io("read", path)(io::Error::new(io::ErrorKind::InvalidData, error)))
}

/// Reads the text of a file in the folder of a campaign.
///
/// # Errors
/// The file is no regular file, cannot be read, is too large, or is not UTF-8.
pub fn read_text_here(path: &Path) -> Result<String, Error> {
    is_regular(path)?;
    read_text(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_end_is_refused_before_it_fills_the_memory() {
        let mut sink = Vec::new();
        let error = Lines::of(io::repeat(b'x')).read_to_end(&mut sink).unwrap_err();
        assert_eq!(error.to_string(), "a line has more than 64 MiB, the most that is read");
        assert!(sink.len() <= 64 << 20, "{} bytes", sink.len());
    }

    #[test]
    fn many_short_lines_are_read() {
        let line = "0.5,0.25\n".repeat(1000);
        let mut text = String::new();
        Lines::of(line.as_bytes()).read_to_string(&mut text).unwrap();
        assert_eq!(text, line);
    }

    #[test]
    fn a_folder_in_place_of_a_file_of_a_campaign_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let error = read_text_here(dir.path()).unwrap_err();
        assert!(error.to_string().contains("found no regular file"), "{error}");
    }
}
