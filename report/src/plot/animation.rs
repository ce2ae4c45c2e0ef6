//! Writes a film of a run as an animated GIF of small size: a frame stores only what differs from the frame before.
//!
//! A GIF has at most 256 colours. The film uses the most frequent colours, by Heckbert's popularity algorithm ("Color
//! Image Quantization for Frame Buffer Display", 1982), which suits pictures with few flat colours.

use super::raster::{draw, opaque, rasterised};
use crate::birds_eye::Animation;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::collections::BTreeMap;
use std::error::Error as StdError;
use std::io::Write;

/// The seconds for which a frame of a drawn film is shown.
const SECONDS: f64 = 0.1;
/// The hundredths of a second for which the last frame is shown, and the least for every other frame. Most players take
/// a shorter time for a mistake and slow down.
const LAST_DELAY: u16 = 250;
const LEAST_DELAY: u64 = 2;
/// The number of frames that the colours are taken from.
const SAMPLES: usize = 12;
/// The colour index of a pixel that is as in the frame before.
const UNCHANGED: u8 = 255;
/// The number of bits of red, green and blue by which two colours are distinguished.
const BITS: u32 = 5;

type Failure = Box<dyn StdError + Send + Sync>;

/// Returns a bird's-eye film as the contents of a GIF file that repeats for ever.
///
/// # Errors
/// Returns an error if the encoder fails, for example because the film is more than 65,535 pixels wide.
pub fn film_gif(film: &Animation) -> Result<Vec<u8>, Failure> {
    let scenes: Vec<_> = film.scenes.iter().map(|scene| rasterised(scene, 1.0)).collect();
    let pixels = |index: usize| {
        let frame = &film.frames[index];
        let mut pixels = scenes[frame.scene].clone();
        draw(&mut pixels, &frame.drawing, 1.0);
        opaque(&pixels)
    };
    let mut colours = Colours::default();
    let last = film.frames.len() - 1;
    (0..SAMPLES).for_each(|i| colours.count(&pixels(i * last / (SAMPLES - 1))));
    let mut file = Vec::new();
    let mut reel = Reel::begin(&mut file, [scenes[0].width(), scenes[0].height()], colours.palette())?;
    for index in 0..=last {
        reel.show(&pixels(index), SECONDS * index as f64)?;
    }
    reel.end()?;
    Ok(file)
}

/// A writer of a GIF file that repeats for ever, frame by frame.
pub struct Reel<W: Write> {
    encoder: Encoder<W>,
    palette: Palette,
    width: usize,
    /// The colour indices of the pixels of the last frame.
    before: Option<Vec<u8>>,
    /// The last frame that is not written yet, with its time in hundredths of a second. The frame is written when it is
    /// known for how long it is shown.
    waiting: Option<(Frame<'static>, u64)>,
}

impl<W: Write> Reel<W> {
    /// Begins a GIF file with a width and a height in pixels and a palette of colours.
    ///
    /// # Errors
    /// Returns an error if the film is more than 65,535 pixels wide, or nothing can be written.
    pub fn begin(file: W, [width, height]: [u32; 2], palette: Palette) -> Result<Self, Failure> {
        let mut encoder = Encoder::new(file, u16::try_from(width)?, u16::try_from(height)?, &palette.colours)?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self { encoder, palette, width: width as usize, before: None, waiting: None })
    }

    /// Adds a frame with its time in seconds, which must be later than all earlier times. `pixels` holds red, green and
    /// blue of each pixel. A frame that comes too soon after the last frame to be shown is left out.
    ///
    /// # Errors
    /// Returns an error if nothing can be written.
    pub fn show(&mut self, pixels: &[u8], seconds: f64) -> Result<(), Failure> {
        // The times are rounded, not the differences between them, so that a film runs at the right speed.
        let time = (100.0 * seconds).round() as u64;
        if let Some((frame, since)) = &mut self.waiting {
            let delay = time.saturating_sub(*since);
            if delay < LEAST_DELAY {
                return Ok(());
            }
            frame.delay = u16::try_from(delay).unwrap_or(u16::MAX);
            self.encoder.write_frame(frame)?;
        }
        let palette = &mut self.palette;
        let now: Vec<u8> = pixels.chunks_exact(3).map(|rgb| palette.index([rgb[0], rgb[1], rgb[2]])).collect();
        self.waiting = Some((changes(self.before.as_deref(), &now, self.width), time));
        self.before = Some(now);
        Ok(())
    }

    /// Ends the GIF file with the last frame, which is shown for a longer time than the other frames.
    ///
    /// # Errors
    /// Returns an error if nothing can be written.
    pub fn end(mut self) -> Result<(), Failure> {
        if let Some((mut last, _)) = self.waiting.take() {
            last.delay = LAST_DELAY;
            self.encoder.write_frame(&last)?;
        }
        self.encoder.into_inner()?.flush()?;
        Ok(())
    }
}

/// Returns a GIF frame of the smallest rectangle that contains all changed pixels. Unchanged pixels in the rectangle
/// are transparent.
fn changes(before: Option<&[u8]>, now: &[u8], width: usize) -> Frame<'static> {
    let same = |i: usize| before.is_some_and(|before| before[i] == now[i]);
    let changed = (0..now.len()).filter(|i| !same(*i)).map(|i| (i % width, i / width));
    // A frame without a change is one pixel that stays as it is.
    let corners = changed.fold(None, |corners, (x, y)| {
        let (left, top, right, bottom) = corners.unwrap_or((x, y, x, y));
        Some((left.min(x), top.min(y), right.max(x), bottom.max(y)))
    });
    let (left, top, right, bottom) = corners.unwrap_or((0, 0, 0, 0));
    let rectangle = (top..=bottom).flat_map(|y| (left..=right).map(move |x| y * width + x));
    let buffer: Vec<u8> = rectangle.map(|i| if same(i) { UNCHANGED } else { now[i] }).collect();
    Frame {
        left: left as u16,
        top: top as u16,
        width: (right - left + 1) as u16,
        height: (bottom - top + 1) as u16,
        transparent: Some(UNCHANGED),
        dispose: DisposalMethod::Keep,
        buffer: buffer.into(),
        ..Frame::default()
    }
}

/// A histogram of the colours of pictures.
#[derive(Default)]
pub struct Colours {
    /// The number of pixels of each bin of colours, and the sums of their red, green and blue.
    bins: BTreeMap<usize, (u64, [u64; 3])>,
}

impl Colours {
    /// Returns `true` if no picture was counted.
    #[cfg(feature = "camera")]
    pub fn are_none(&self) -> bool {
        self.bins.is_empty()
    }

    /// Adds the colours of a picture to the histogram, given as red, green and blue of each pixel.
    pub fn count(&mut self, picture: &[u8]) {
        for rgb in picture.chunks_exact(3) {
            let (count, sums) = self.bins.entry(bin([rgb[0], rgb[1], rgb[2]])).or_default();
            *count += 1;
            sums.iter_mut().zip(rgb).for_each(|(sum, part)| *sum += u64::from(*part));
        }
    }

    /// Returns the palette of the most frequent colours.
    pub fn palette(self) -> Palette {
        let mut bins: Vec<_> = self.bins.into_values().collect();
        bins.sort_by(|a, b| b.cmp(a));
        bins.truncate(usize::from(UNCHANGED));
        let colours = bins.iter().flat_map(|(count, sums)| sums.map(|sum| ((sum + count / 2) / count) as u8)).collect();
        Palette { colours, nearest: vec![None; 1 << (3 * BITS)] }
    }
}

/// The colours of a GIF film, at most 255.
pub struct Palette {
    /// The red, green and blue of each colour; at most 255 colours.
    colours: Vec<u8>,
    /// The index of the nearest colour for each bin; `None` if the nearest colour was not searched for yet.
    nearest: Vec<Option<u8>>,
}

impl Palette {
    fn index(&mut self, rgb: [u8; 3]) -> u8 {
        let colours = &self.colours;
        *self.nearest[bin(rgb)].get_or_insert_with(|| {
            let far =
                |colour: &[u8]| -> u32 { colour.iter().zip(rgb).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum() };
            let nearest = colours.chunks_exact(3).enumerate().min_by_key(|(_, colour)| far(colour));
            nearest.map_or(0, |(index, _)| index as u8)
        })
    }
}

/// Returns the histogram bin of a colour. Colours of one bin are not distinguished.
fn bin(rgb: [u8; 3]) -> usize {
    rgb.into_iter().fold(0, |bin, part| bin << BITS | usize::from(part >> (8 - BITS)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::birds_eye::{Contour, Drawing, Frame as Still, PathSegment, PictureItem};

    /// Draws a square of this colour at a place, without a background.
    fn square(at: f64, colour: [u8; 3], side: f64) -> Drawing {
        let corners = [[at, 0.0], [at + side, 0.0], [at + side, side], [at, side]];
        let mut segments = vec![PathSegment::Move(corners[0])];
        segments.extend(corners[1..].iter().map(|corner| PathSegment::Line(*corner)));
        segments.push(PathSegment::Close);
        let marks = vec![PictureItem::Fill { contour: Contour { segments }, paint: colour.into() }];
        Drawing { width: 60.0, height: 20.0, marks }
    }

    #[test]
    fn a_film_of_few_colours_is_played_back_pixel_by_pixel() {
        let (day, night) = ([230, 230, 230], [20, 20, 40]);
        let scenes = vec![square(0.0, day, 60.0), square(0.0, night, 60.0)];
        let still = |i: usize| Still {
            scene: usize::from(i >= 12),
            time: i as f64,
            // The square stands still for a while.
            drawing: square(2.0 * i.min(8) as f64, [200, 0, 0], 10.0),
        };
        let film = Animation { scenes, frames: (0..20).map(still).collect() };
        let file = film_gif(&film).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&file[..]).unwrap();
        let mut shown = vec![0; 60 * 20 * 3];
        for (i, expected) in film.frames.iter().enumerate() {
            let frame = decoder.read_next_frame().unwrap().expect("there is a frame for each");
            let (left, top, width) = (usize::from(frame.left), usize::from(frame.top), usize::from(frame.width));
            for (pixel, rgba) in frame.buffer.chunks_exact(4).enumerate().filter(|(_, rgba)| rgba[3] > 0) {
                let at = 3 * ((top + pixel / width) * 60 + left + pixel % width);
                shown[at..at + 3].copy_from_slice(&rgba[..3]);
            }
            let mut pixels = rasterised(&film.scenes[expected.scene], 1.0);
            draw(&mut pixels, &expected.drawing, 1.0);
            assert!(shown == opaque(&pixels), "frame {i}");
            let stands = i > 8 && i != 12;
            assert!(!stands || frame.buffer.len() == 4, "frame {i} says nothing new");
        }
        assert!(decoder.read_next_frame().unwrap().is_none());
    }

    #[test]
    fn a_film_runs_as_fast_as_its_images_were_taken_with_no_frame_shorter_than_can_be_shown() {
        let delays = |times: &[f64]| {
            let mut colours = Colours::default();
            (0..times.len()).for_each(|i| colours.count(&[i as u8; 3]));
            let mut file = Vec::new();
            let mut reel = Reel::begin(&mut file, [1, 1], colours.palette()).unwrap();
            times.iter().enumerate().for_each(|(i, time)| reel.show(&[i as u8; 3], *time).unwrap());
            reel.end().unwrap();
            let mut decoder = gif::DecodeOptions::new().read_info(&file[..]).unwrap();
            let mut delays = Vec::new();
            while let Some(frame) = decoder.read_next_frame().unwrap() {
                delays.push(frame.delay);
            }
            assert_eq!(delays.pop(), Some(LAST_DELAY));
            delays
        };
        let every =
            |rate: f64, seconds: f64| (0..=(rate * seconds) as usize).map(|i| i as f64 / rate).collect::<Vec<_>>();
        assert_eq!(delays(&every(10.0, 1.0)), [10; 10]);
        assert_eq!(delays(&every(30.0, 0.2)), [3, 4, 3, 3, 4, 3]);
        for (rate, frames) in [(30.0, 158), (60.0, 211), (100.0, 264), (7.0, 37)] {
            let (found, last) = (delays(&every(rate, 5.29)), (rate * 5.29_f64).floor() / rate);
            assert!(found.len().abs_diff(frames) < 3, "{} frames at {rate} Hz", found.len());
            let seconds = f64::from(found.iter().map(|delay| u32::from(*delay)).sum::<u32>()) / 100.0;
            assert!((seconds - last).abs() <= 0.015, "{seconds} s at {rate} Hz");
            assert!(found.iter().all(|delay| *delay >= 2), "{rate} Hz");
        }
        // Images were lost in between.
        assert_eq!(delays(&[0.5, 0.6, 1.0, 1.1]), [10, 40, 10]);
    }

    #[test]
    fn the_most_frequent_colours_are_kept_and_the_others_are_shown_by_the_nearest_of_them() {
        let colour = |i: u32| [i % 8, i / 8 % 8, i / 64].map(|part| (32 * part) as u8);
        let picture: Vec<u8> =
            (0..300).flat_map(|i| std::iter::repeat_n(colour(i), 1 + i as usize)).flatten().collect();
        let mut colours = Colours::default();
        colours.count(&picture);
        let mut palette = colours.palette();
        assert_eq!(palette.colours.len(), 3 * 255);
        let far =
            |a: [u8; 3], b: &[u8]| -> u32 { a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(*b)).pow(2)).sum() };
        for i in 0..300 {
            let index = usize::from(palette.index(colour(i)));
            let shown = &palette.colours[3 * index..][..3];
            let nearest = palette.colours.chunks_exact(3).map(|kept| far(colour(i), kept)).min();
            assert_eq!(Some(far(colour(i), shown)), nearest, "colour {i}");
            assert_eq!(colour(i) == shown, i >= 45, "colour {i}");
        }
    }
}
