//! Writes the parts of a video file around the pictures: boxes of the ISO base media file format (ISO/IEC 14496-12),
//! with H.264 stored as in ISO/IEC 14496-15.
//!
//! All pictures lie one after the other in one box, `mdat`. The box `moov` follows and says where and when each picture
//! is.

use std::num::TryFromIntError;

/// The ticks of the file's clock in a second, as is usual for video.
const CLOCK: u32 = 90_000;

/// The beginning of a file: its kind, and the head of the box of pictures, whose size is not known yet.
pub(super) const HEADER: [u8; 48] = *b"\0\0\0\x20ftypisom\0\0\x02\0isomiso2avc1mp41\0\0\0\x01mdat\0\0\0\0\0\0\0\0";

/// The position in the file of the size of that box.
pub(super) const MDAT_SIZE: u64 = 40;
/// The length of that box's head.
const MDAT_HEAD: u64 = 16;

/// One picture.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Picture {
    /// The time of the picture, in seconds.
    pub seconds: f64,
    /// The size in bytes of the picture in the file.
    pub bytes: u32,
    /// True if a player can start the film at the picture.
    pub is_key: bool,
}

/// The pictures of a film, and the facts about them that a player needs.
pub(super) struct Track {
    size: [u32; 2],
    rate: f64,
    /// The standard code of the matrix that converts colours to brightness and colour differences.
    matrix: u16,
    /// The sequence parameter set of the H.264 encoder. The picture parameter set follows.
    pub sequence: Vec<u8>,
    pub parameters: Vec<u8>,
    pub pictures: Vec<Picture>,
}

impl Track {
    /// Makes a track without pictures, for pictures with a width and a height in pixels.
    pub fn new(size: [u32; 2], rate: f64, matrix: u16) -> Self {
        Self { size, rate, matrix, sequence: Vec::new(), parameters: Vec::new(), pictures: Vec::new() }
    }

    /// Returns the size in bytes of the MP4 box `mdat`, which holds the pictures, including its head.
    pub fn mdat_size(&self) -> u64 {
        MDAT_HEAD + self.pictures.iter().map(|picture| u64::from(picture.bytes)).sum::<u64>()
    }

    /// Returns the MP4 box `moov`, which describes the pictures of the film.
    ///
    /// # Errors
    /// Returns an error if the film lasts longer than 13 hours, or has more than 4 billion pictures.
    pub fn contents(&self) -> Result<Vec<u8>, TryFromIntError> {
        let durations = self.durations()?;
        let duration = u32::try_from(durations.iter().map(|ticks| u64::from(*ticks)).sum::<u64>())?;
        let media = container(b"mdia", &[self.media_header(duration), handler(), self.information(&durations)?]);
        let track = container(b"trak", &[self.track_header(duration), media]);
        Ok(container(b"moov", &[movie_header(duration), track]))
    }

    /// Returns the duration of each picture in ticks of the file's clock. The times are rounded, not the differences
    /// between them, so that a film runs at the right speed.
    fn durations(&self) -> Result<Vec<u32>, TryFromIntError> {
        let ticks = |seconds: f64| (seconds * f64::from(CLOCK)).round() as u64;
        let times = self.pictures.iter().map(|picture| ticks(picture.seconds));
        let last = self.pictures.last().map(|picture| ticks(picture.seconds + 1.0 / self.rate));
        let next = times.clone().skip(1).chain(last);
        times.zip(next).map(|(this, next)| u32::try_from(next.saturating_sub(this).max(1))).collect()
    }

    fn track_header(&self, duration: u32) -> Vec<u8> {
        let [width, height] = self.size.map(|pixels| pixels << 16);
        // Flags: the track is enabled and part of the film. Words: no time of creation or of change; track number 1.
        let words = [0, 0, 1, 0, duration, 0, 0, 0, 0];
        versioned(b"tkhd", 3, &[&big(&words), &MATRIX, &big(&[width, height])])
    }

    fn media_header(&self, duration: u32) -> Vec<u8> {
        // The language is `und`: undetermined.
        versioned(b"mdhd", 0, &[&big(&[0, 0, CLOCK, duration]), &[0x55, 0xC4, 0, 0]])
    }

    fn information(&self, durations: &[u32]) -> Result<Vec<u8>, TryFromIntError> {
        let video = versioned(b"vmhd", 1, &[&[0; 8]]);
        // The pictures are in this same file.
        let here = versioned(b"dref", 0, &[&big(&[1]), &versioned(b"url ", 1, &[])]);
        let count = u32::try_from(self.pictures.len())?;
        let keys = self.pictures.iter().zip(1..).filter(|(picture, _)| picture.is_key).map(|(_, number)| number);
        let keys: Vec<u32> = keys.collect();
        let sizes: Vec<u32> = self.pictures.iter().map(|picture| picture.bytes).collect();
        let mut runs: Vec<[u32; 2]> = Vec::new();
        for duration in durations {
            match runs.last_mut() {
                Some([pictures, same]) if same == duration => *pictures += 1,
                _ => runs.push([1, *duration]),
            }
        }
        let tables = [
            versioned(b"stsd", 0, &[&big(&[1]), &self.description()]),
            versioned(b"stts", 0, &[&big(&[u32::try_from(runs.len())?]), &big(runs.as_flattened())]),
            versioned(b"stss", 0, &[&big(&[u32::try_from(keys.len())?]), &big(&keys)]),
            versioned(b"stsc", 0, &[&big(&[1, 1, count, 1])]),
            versioned(b"stsz", 0, &[&big(&[0, count]), &big(&sizes)]),
            versioned(b"stco", 0, &[&big(&[1, HEADER.len() as u32])]),
        ];
        Ok(container(b"minf", &[video, container(b"dinf", &[here]), container(b"stbl", &tables)]))
    }

    /// Returns the MP4 box that describes the encoding of the pictures.
    fn description(&self) -> Vec<u8> {
        let [width, height] = self.size.map(|pixels| (pixels as u16).to_be_bytes());
        let [profile, constraints, level] = [1, 2, 3].map(|byte| self.sequence.get(byte).copied().unwrap_or_default());
        let length = |unit: &[u8]| (unit.len() as u16).to_be_bytes();
        let (sequence, parameters) = (&self.sequence, &self.parameters);
        let units =
            [&[1, profile, constraints, level, 0xFF, 0xE1][..], &length(sequence), sequence, &[1], &length(parameters)];
        let coding = boxed(b"avcC", &[&units.concat(), parameters]);
        // The colours of sRGB are those of BT.709; the values have the range of television.
        let colours = boxed(b"colr", &[b"nclx\0\x01\0\x01", &self.matrix.to_be_bytes(), &[0]]);
        let dots_per_inch = big(&[0x0048_0000, 0x0048_0000]);
        // Six reserved bytes and reference number 1; sixteen unused bytes; one picture a sample, no name, 24 bits deep.
        let head =
            [&[0, 0, 0, 0, 0, 0, 0, 1][..], &[0; 16], &width, &height, &dots_per_inch, &[0, 0, 0, 0, 0, 1], &[0; 32]];
        boxed(b"avc1", &[&head.concat(), &[0, 24, 0xFF, 0xFF], &coding, &colours])
    }
}

/// The matrix of a picture that is neither turned nor moved.
const MATRIX: [u8; 36] = *b"\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x40\0\0\0";

fn movie_header(duration: u32) -> Vec<u8> {
    // Normal speed; full volume, though there is no sound; the next track would have number 2.
    let words = [0, 0, CLOCK, duration, 0x0001_0000, 0x0100_0000, 0, 0];
    versioned(b"mvhd", 0, &[&big(&words), &MATRIX, &[0; 24], &big(&[2])])
}

fn handler() -> Vec<u8> {
    versioned(b"hdlr", 0, &[&[0; 4], b"vide", &[0; 12], b"camera\0"])
}

/// Returns an MP4 box that contains other boxes.
fn container(kind: &[u8; 4], boxes: &[Vec<u8>]) -> Vec<u8> {
    boxed(kind, &boxes.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

/// Returns an MP4 box that begins with the version 0 and flags.
fn versioned(kind: &[u8; 4], flags: u32, parts: &[&[u8]]) -> Vec<u8> {
    boxed(kind, &[&[&flags.to_be_bytes()[..]], parts].concat())
}

/// Returns an MP4 box, which consists of a size, a kind and contents.
fn boxed(kind: &[u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let contents = parts.concat();
    [&(8 + contents.len() as u32).to_be_bytes()[..], kind, &contents].concat()
}

fn big(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_be_bytes()).collect()
}
