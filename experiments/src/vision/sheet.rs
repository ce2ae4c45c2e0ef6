//! Sheets of images: what perceivers see and what they answer, in rows and columns.

use super::Failure;
use super::detectors::{Found, Vehicles};
use image::imageops::{self, FilterType};
use image::{ImageFormat, Rgb, RgbImage};
use imageproc::drawing::draw_hollow_rect_mut;
use imageproc::rect::Rect as Frame;
use paracosm::campaign::gallery::Shown;
use paracosm::perception::{Mask, Picture, Rect};
use std::io::Cursor;

/// The colour of something right: found road, or a found vehicle.
const RIGHT: Rgb<u8> = Rgb([40, 200, 80]);
/// The colour of something that was missed.
const MISSED: Rgb<u8> = Rgb([230, 40, 40]);
/// The colour of a false alarm.
const FALSE: Rgb<u8> = Rgb([255, 190, 0]);
/// The space between images in pixels.
const SPACE: u32 = 6;
/// The thickness of the sides of boxes in pixels.
const THICK: i32 = 2;

/// Returns the pixels of a picture.
pub fn pixels(picture: &Picture<'_>) -> RgbImage {
    RgbImage::from_raw(picture.width, picture.height, picture.rgb.to_vec()).expect("a picture has three bytes a pixel")
}

/// Returns the image in this multiple of its size.
pub fn enlarged(image: &RgbImage, factor: u32) -> RgbImage {
    imageops::resize(image, factor * image.width(), factor * image.height(), FilterType::Nearest)
}

/// Colours the pixels of a mask by the truth: found, missed, and false.
pub fn mark(image: &mut RgbImage, answer: &Mask, truth: &Mask) {
    for ((pixel, answered), is_true) in image.pixels_mut().zip(&answer.pixels).zip(&truth.pixels) {
        let colour = match (answered, is_true) {
            (true, true) => RIGHT,
            (false, true) => MISSED,
            (true, false) => FALSE,
            (false, false) => continue,
        };
        pixel.0.iter_mut().zip(colour.0).for_each(|(part, colour)| *part = part.midpoint(colour));
    }
}

/// Returns an image with all vehicles and the boxes of a detector: found, missed and false. Vehicles that need not be found
/// have no box.
pub fn answered(shown: &Shown, vehicles: &Vehicles, found: &Found, threshold: f64) -> RgbImage {
    let mut image = pixels(&shown.picture());
    let matching = vehicles.matched(found, threshold);
    for place in vehicles.counting() {
        let colour = if matching.detected[place].is_some() { RIGHT } else { MISSED };
        frame(&mut image, &vehicles.objects[place].rect, colour);
    }
    for (place, object) in matching.detections.iter().zip(&matching.objects) {
        if object.is_none() {
            frame(&mut image, &found[*place].rect, FALSE);
        }
    }
    image
}

/// Returns the image in half of its size.
pub fn halved(image: &RgbImage) -> RgbImage {
    imageops::resize(image, image.width() / 2, image.height() / 2, FilterType::Triangle)
}

/// Draws a box.
fn frame(image: &mut RgbImage, rect: &Rect, colour: Rgb<u8>) {
    for more in 0..THICK {
        let [left, top] = [rect.left, rect.top].map(|at| at.round() as i32 - more);
        let [width, height] = [rect.width, rect.height].map(|side| (side.round() as i32 + 2 * more).max(1) as u32);
        draw_hollow_rect_mut(image, Frame::at(left, top).of_size(width, height), colour);
    }
}

/// Returns the PNG of a sheet of images of one size, in rows from the top.
pub fn png(rows: &[Vec<RgbImage>]) -> Result<Vec<u8>, Failure> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let (width, height) = rows.iter().flatten().next().ok_or("a sheet without images")?.dimensions();
    let along = |count: u32, side: u32| count * side + (count - 1) * SPACE;
    let (across, down) = (along(columns, width), along(rows.len() as u32, height));
    let mut sheet = RgbImage::from_pixel(across, down, Rgb([255; 3]));
    for (row, y) in rows.iter().zip(0i64..) {
        for (image, x) in row.iter().zip(0i64..) {
            let corner = [(x, width), (y, height)].map(|(place, side)| place * i64::from(side + SPACE));
            imageops::replace(&mut sheet, image, corner[0], corner[1]);
        }
    }
    let mut file = Cursor::new(Vec::new());
    sheet.write_to(&mut file, ImageFormat::Png)?;
    Ok(file.into_inner())
}
