//! Writes films as MP4 files, which players and browsers show: H.264 in its constrained baseline profile, 4:2:0.
//!
//! Each picture is compressed and written as it comes, so that only the sizes and times of pictures are in memory. The
//! box that a player reads first therefore stands at the end of the file.

mod container;
mod level;
mod planes;
#[cfg(test)]
mod tests;

use container::{HEADER, MDAT_SIZE, Picture, Track};
use level::level;
use planes::Planes;
use rusty_h264_common::nal::split_annex_b;
use rusty_h264_common::{NalUnitType, YuvPlanes};
use rusty_h264_encoder::{Encoder, EncoderConfig};
use std::error::Error as StdError;
use std::io::{Seek, SeekFrom, Write};

type Failure = Box<dyn StdError + Send + Sync>;

/// The strength of the compression, from 0 to 51. At this value its losses are not visible.
const QUANTISER: u8 = 17;
/// The number of pictures from one key picture to the next; a player can jump to key pictures.
const BETWEEN_KEYS: u32 = 50;

/// A film that is written picture by picture.
pub(super) struct Video<W: Write + Seek> {
    file: W,
    encoder: Encoder,
    planes: Planes,
    track: Track,
}

impl<W: Write + Seek> Video<W> {
    /// Begins an MP4 film with a width and a height in pixels and about `rate` pictures a second. Colours are stored
    /// for squares of two by two pixels, so that an odd size is rounded up and the last pixels are repeated.
    ///
    /// # Errors
    /// Returns an error if the pictures are larger than H.264 allows, or nothing can be written.
    pub fn begin(mut file: W, size: [u32; 2], rate: f64) -> Result<Self, Failure> {
        let planes = Planes::new(size);
        let [width, height] = planes.size();
        let level = level([width, height], rate).ok_or_else(|| {
            format!(
                "a film of {} x {} pixels is larger than an MP4 file allows; write a .gif file or a folder of PNG files instead",
                size[0], size[1]
            )
        })?;
        let settings = EncoderConfig {
            level_idc: level,
            qp: QUANTISER,
            bitrate: 0,
            gop_size: BETWEEN_KEYS,
            ..EncoderConfig::baseline(width as usize, height as usize)
        };
        let encoder = Encoder::new(settings)?;
        file.write_all(&HEADER)?;
        Ok(Self { file, encoder, track: Track::new([width, height], rate, planes.matrix_code()), planes })
    }

    /// Adds a picture with its time in seconds, which must be later than all earlier times. `rgb` holds red, green and
    /// blue of each pixel.
    ///
    /// # Errors
    /// Returns an error if nothing can be written.
    pub fn show(&mut self, rgb: &[u8], seconds: f64) -> Result<(), Failure> {
        // A film begins at time 0. The camera may have no image then, and the film is black until there is one.
        if self.track.pictures.is_empty() && seconds > 0.0 {
            self.add(&vec![0; rgb.len()], 0.0)?;
        }
        self.add(rgb, seconds)
    }

    fn add(&mut self, rgb: &[u8], seconds: f64) -> Result<(), Failure> {
        self.planes.take(rgb);
        let [width, height] = self.planes.size().map(|pixels| pixels as usize);
        let [y, u, v] = self.planes.all();
        let planes = YuvPlanes::new(width, height, y, u, v, width, width / 2)
            .ok_or("a picture has another size than the film")?;
        let coded = self.encoder.encode_planes(&planes)?;
        let mut picture = Picture { seconds, ..Picture::default() };
        for unit in split_annex_b(&coded) {
            match NalUnitType::from_id(unit.first().copied().unwrap_or_default()) {
                NalUnitType::Sps => self.track.sequence = unit.to_vec(),
                NalUnitType::Pps => self.track.parameters = unit.to_vec(),
                kind => {
                    picture.is_key |= kind == NalUnitType::IdrSlice;
                    let length = u32::try_from(unit.len())?;
                    self.file.write_all(&length.to_be_bytes())?;
                    self.file.write_all(unit)?;
                    picture.bytes += 4 + length;
                }
            }
        }
        self.track.pictures.push(picture);
        Ok(())
    }

    /// Writes the end of the MP4 file. The last picture is shown for the usual duration of one picture.
    ///
    /// # Errors
    /// Returns an error if the film is too long for the file format, or nothing can be written.
    pub fn end(mut self) -> Result<(), Failure> {
        self.file.write_all(&self.track.contents()?)?;
        self.file.seek(SeekFrom::Start(MDAT_SIZE))?;
        self.file.write_all(&self.track.mdat_size().to_be_bytes())?;
        self.file.flush()?;
        Ok(())
    }
}
