//! The versions of OpenSCENARIO XML that are read.

use crate::xml::{Element, ReadError};

/// The newest minor version that is read; the major version is 1.
const NEWEST: u32 = 3;

/// Checks the version in the header of a file.
///
/// # Errors
/// The file has no header, or has a version that is not read.
pub(super) fn check(root: Element<'_, '_>) -> Result<(), ReadError> {
    let header = root.child("FileHeader")?;
    if header.required("revMajor")? != "1" {
        return Err(header.unexpected("revMajor", "1"));
    }
    let minor = header.required("revMinor")?.parse().ok().filter(|minor: &u32| *minor <= NEWEST);
    minor.map(|_| ()).ok_or_else(|| header.unexpected("revMinor", format!("a whole number of at most {NEWEST}")))
}
