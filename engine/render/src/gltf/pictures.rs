//! The images on the surfaces of a model: PNG and JPEG, within the file or beside it under the rules of buffers.

use super::bytes::Bytes;
use super::{GltfError, GltfFlaw};
use crate::mesh::picture::{MOST, Picture};
use gltf::{Document, Material, image};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// The most pixels of an image each way.
const MOST_PIXELS: usize = 8192;

/// The images of the base colours of a model.
#[derive(Default)]
pub(super) struct Pictures {
    pub all: Vec<Picture>,
    /// The place in `all` of each image, by its index in the file.
    places: BTreeMap<usize, u8>,
}

impl Pictures {
    /// Reads the images of all base colours, which may have as many bytes in files as are left.
    pub fn of(document: &Document, bytes: &Bytes, path: &Path, left: &mut u64) -> Result<Self, GltfError> {
        let broken = |problem| GltfError::Format { path: path.to_owned(), problem };
        let mut pictures = Self::default();
        for material in document.materials() {
            let Some(texture) = material.pbr_metallic_roughness().base_color_texture() else { continue };
            let image = texture.texture().source();
            if pictures.places.contains_key(&image.index()) {
                continue;
            }
            if pictures.all.len() == MOST {
                return Err(broken(GltfFlaw::TooManyImages));
            }
            let wrong = |problem| broken(GltfFlaw::NoImage { image: image.index(), problem });
            let data = match image.source() {
                image::Source::View { view, .. } => {
                    bytes.view(&view).map(<[u8]>::to_vec).ok_or_else(|| wrong(ImageFlaw::NoBytes))?
                }
                image::Source::Uri { uri, .. } => super::bytes::referred(path, uri, left)?,
            };
            pictures.places.insert(image.index(), pictures.all.len() as u8);
            pictures.all.push(picture(&data).map_err(wrong)?);
        }
        Ok(pictures)
    }

    /// Returns the place of the picture of a material, and the number of its set of texture coordinates.
    pub fn place(&self, material: &Material<'_>) -> Option<(u8, u32)> {
        let texture = material.pbr_metallic_roughness().base_color_texture()?;
        Some((*self.places.get(&texture.texture().source().index())?, texture.tex_coord()))
    }
}

/// The reason why an image of a model cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ImageFlaw {
    /// The image lies outside the bytes of its buffer.
    #[error("its buffer has too few bytes for it")]
    NoBytes,
    /// The image is neither a PNG nor a JPEG image.
    #[error("it is neither a PNG nor a JPEG image")]
    NoFormat,
    /// The image has too many pixels.
    #[error("it has {width} x {height} pixels, expected at most {MOST_PIXELS} each way")]
    TooLarge {
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// The image is a broken PNG image.
    #[error("it is no sound PNG image: {0}")]
    Png(#[from] png::DecodingError),
    /// The image is a broken JPEG image.
    #[error("it is no sound JPEG image: {0}")]
    Jpeg(#[from] zune_jpeg::errors::DecodeErrors),
}

fn picture(data: &[u8]) -> Result<Picture, ImageFlaw> {
    let (width, height, rgb) = match data {
        [0x89, b'P', b'N', b'G', ..] => png_pixels(data)?,
        [0xff, 0xd8, ..] => jpeg_pixels(data)?,
        _ => return Err(ImageFlaw::NoFormat),
    };
    Ok(Picture::new(width, height, &rgb))
}

fn checked(width: usize, height: usize) -> Result<(), ImageFlaw> {
    let fits = [width, height].iter().all(|pixels| (1..=MOST_PIXELS).contains(pixels));
    if fits { Ok(()) } else { Err(ImageFlaw::TooLarge { width, height }) }
}

/// Returns the width, the height, and the red, green and blue of the pixels of a PNG image.
fn png_pixels(data: &[u8]) -> Result<(usize, usize, Vec<u8>), ImageFlaw> {
    let mut decoder = png::Decoder::new(Cursor::new(data));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info()?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    checked(width, height)?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or(ImageFlaw::TooLarge { width, height })?];
    let frame = reader.next_frame(&mut pixels)?;
    let rgb = |pixel: &[u8]| if pixel.len() < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
    Ok((width, height, pixels.chunks_exact(frame.color_type.samples()).flat_map(rgb).collect()))
}

/// Returns the width, the height, and the red, green and blue of the pixels of a JPEG image.
fn jpeg_pixels(data: &[u8]) -> Result<(usize, usize, Vec<u8>), ImageFlaw> {
    // Without instructions of particular processors, so that the pixels are the same on every machine.
    let options = DecoderOptions::default()
        .set_use_unsafe(false)
        .set_max_width(MOST_PIXELS)
        .set_max_height(MOST_PIXELS)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(data), options);
    let pixels = decoder.decode()?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    checked(width, height)?;
    if pixels.len() == 3 * width * height { Ok((width, height, pixels)) } else { Err(ImageFlaw::NoBytes) }
}
