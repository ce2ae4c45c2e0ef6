//! Reads the numbers in a model's buffers. Every offset and length that a file states is checked.

use super::{GltfError, GltfFlaw};
use gltf::accessor::{DataType, Dimensions};
use gltf::{Accessor, Document, buffer};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// The greatest size of a model with its buffers, in MiB.
pub(super) const MOST_MEBIBYTES: u64 = 256;

/// Reads a file, and takes its size from the number of bytes that are left. Returns `None` if the file is larger. The
/// file must be a regular file: other files may have no end.
pub(super) fn read(path: &Path, left: &mut u64) -> io::Result<Option<Vec<u8>>> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is no regular file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(*left + 1).read_to_end(&mut bytes)?;
    Ok(left.checked_sub(bytes.len() as u64).map(|rest| {
        *left = rest;
        bytes
    }))
}

/// Returns the path of a file to which a model refers. It must be below the folder of the model, also behind links.
fn beside(model: &Path, uri: &str) -> Result<PathBuf, GltfError> {
    let broken = |problem| GltfError::Format { path: model.to_owned(), problem };
    let outside = || broken(GltfFlaw::Outside { uri: uri.to_owned() });
    let name = unescaped(uri);
    if !Path::new(&name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(outside());
    }
    let folder = match model.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let file = folder.join(name);
    let real = |path: &Path| fs::canonicalize(path).map_err(|source| GltfError::Read { path: path.to_owned(), source });
    let (file, folder) = (real(&file)?, real(folder)?);
    if !file.starts_with(folder) {
        return Err(outside());
    }
    if !file.is_file() {
        return Err(broken(GltfFlaw::NoFile { uri: uri.to_owned() }));
    }
    Ok(file)
}

/// Returns the bytes to which a model refers, in its own text or in a file that may have as many bytes as are left.
pub(super) fn referred(model: &Path, uri: &str, left: &mut u64) -> Result<Vec<u8>, GltfError> {
    let broken = |problem| GltfError::Format { path: model.to_owned(), problem };
    match uri.strip_prefix("data:") {
        Some(data) => {
            let text = data.split_once(";base64,").map(|(_, text)| text);
            text.and_then(base64).ok_or_else(|| broken(GltfFlaw::NoBase64))
        }
        None => {
            let file = beside(model, uri)?;
            let bytes = read(&file, left).map_err(|source| GltfError::Read { path: file, source })?;
            bytes.ok_or_else(|| broken(GltfFlaw::TooLarge))
        }
    }
}

/// The buffers of a model.
pub(super) struct Bytes(Vec<Vec<u8>>);

impl Bytes {
    /// Reads all buffers, which may have as many bytes in files as are left.
    pub fn of(document: &Document, mut blob: Option<Vec<u8>>, path: &Path, left: &mut u64) -> Result<Self, GltfError> {
        let broken = |problem| GltfError::Format { path: path.to_owned(), problem };
        let mut read = |buffer: buffer::Buffer<'_>| match buffer.source() {
            buffer::Source::Bin => blob.take().ok_or_else(|| broken(GltfFlaw::NoBinary)),
            buffer::Source::Uri(uri) => referred(path, uri, left),
        };
        Ok(Self(document.buffers().map(&mut read).collect::<Result<_, _>>()?))
    }

    /// Returns the bytes of a view of a buffer; `None` if the buffer has too few.
    pub fn view(&self, view: &buffer::View<'_>) -> Option<&[u8]> {
        self.0.get(view.buffer().index())?.get(view.offset()..view.offset().checked_add(view.length())?)
    }

    /// Returns the bytes of every element of an accessor, `size` bytes each.
    fn elements(&self, accessor: &Accessor<'_>, size: usize) -> Result<Vec<&[u8]>, GltfFlaw> {
        let index = accessor.index();
        let view = match (accessor.view(), accessor.sparse()) {
            (Some(view), None) => view,
            _ => return Err(GltfFlaw::NoView { accessor: index }),
        };
        let bytes = self.view(&view);
        let element = |i: usize| {
            let from = view.stride().unwrap_or(size).max(size).checked_mul(i)?.checked_add(accessor.offset())?;
            bytes?.get(from..from.checked_add(size)?)
        };
        // The file may state any count; the bytes must suffice for it.
        let count = accessor.count();
        if count > 0 && element(count - 1).is_none() {
            return Err(GltfFlaw::TooFewBytes { accessor: index, elements: count });
        }
        Ok((0..count).map_while(element).collect())
    }
}

/// Returns vectors of floating-point numbers.
pub(super) fn floats<const N: usize>(accessor: &Accessor<'_>, bytes: &Bytes) -> Result<Vec<[f32; N]>, GltfFlaw> {
    if accessor.data_type() != DataType::F32 || accessor.dimensions().multiplicity() != N {
        let (found, shape) = (accessor.data_type(), accessor.dimensions());
        return Err(GltfFlaw::NoFloats { accessor: accessor.index(), shape, found, expected: N });
    }
    let number = |element: &[u8], i: usize| f32::from_le_bytes(std::array::from_fn(|byte| element[4 * i + byte]));
    let elements = bytes.elements(accessor, 4 * N)?;
    Ok(elements.into_iter().map(|element| std::array::from_fn(|i| number(element, i))).collect())
}

/// Returns indices of corners.
pub(super) fn indices(accessor: &Accessor<'_>, bytes: &Bytes) -> Result<Vec<u32>, GltfFlaw> {
    let size = accessor.data_type().size();
    let whole = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
    if !whole || accessor.dimensions() != Dimensions::Scalar {
        return Err(GltfFlaw::NoIndices { accessor: accessor.index(), found: accessor.data_type() });
    }
    let number = |element: &[u8]| element.iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte));
    Ok(bytes.elements(accessor, size)?.into_iter().map(number).collect())
}

/// Returns the bytes of a text in base64 (RFC 4648), with or without padding.
fn base64(text: &str) -> Option<Vec<u8>> {
    let digit = |letter: u8| match letter {
        b'A'..=b'Z' => Some(letter - b'A'),
        b'a'..=b'z' => Some(letter - b'a' + 26),
        b'0'..=b'9' => Some(letter - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    };
    let digits: Vec<u8> = text.trim_end_matches('=').bytes().map(digit).collect::<Option<_>>()?;
    let group = |four: &[u8]| {
        let bits = four.iter().fold(0_u32, |bits, digit| bits << 6 | u32::from(*digit)) << (6 * (4 - four.len()));
        bits.to_be_bytes()[1..four.len()].to_vec()
    };
    Some(digits.chunks(4).flat_map(group).collect())
}

/// Returns a file name without its escapes, for example with a space for `%20`.
fn unescaped(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let (mut out, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let escaped = (bytes[at] == b'%').then(|| uri.get(at + 1..at + 3)).flatten();
        match escaped.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                out.push(byte);
                at += 3;
            }
            None => {
                out.push(bytes[at]);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}
