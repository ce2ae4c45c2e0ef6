//! The versions of OpenSCENARIO XML that are read.

use crate::xml::{Element, ReadError};

/// The newest minor version that is read; the major version is 1.
pub(super) const NEWEST: u32 = 3;

/// The minor version that is written, unless a part of the file needs a newer one.
pub(super) const WRITTEN: u32 = 2;

/// The elements that only the newest version has, and that are read or have no effect.
pub(super) const OF_NEWEST: [&str; 10] = [
    "AngleCondition",
    "ClothoidSpline",
    "ClothoidSplineSegment",
    "LogNormalDistribution",
    "MonitorDeclarations",
    "PositionStart",
    "RelativeAngleCondition",
    "Trailer",
    "TrailerCoupler",
    "TrailerHitch",
];
/// The attributes that only the newest version has.
pub(super) const ATTRIBUTES_OF_NEWEST: [(&str, &str); 2] =
    [("ActivateControllerAction", "objectControllerRef"), ("ObjectController", "name")];

/// Checks the version in the header of a file.
///
/// # Errors
/// The file has no header, or has a version that is not read.
pub(super) fn check(root: Element<'_, '_>) -> Result<(), ReadError> {
    minor(root).map(|_| ())
}

/// Returns the minor version in the header of a file.
fn minor(root: Element<'_, '_>) -> Result<u32, ReadError> {
    let header = root.child("FileHeader")?;
    if header.required("revMajor")? != "1" {
        return Err(header.unexpected("revMajor", "1"));
    }
    let minor = header.required("revMinor")?.parse().ok().filter(|minor: &u32| *minor <= NEWEST);
    minor.ok_or_else(|| header.unexpected("revMinor", format!("a whole number of at most {NEWEST}")))
}

/// The minor version of a file that is put together from parts of other files.
#[derive(Debug, Clone, Copy)]
pub(super) struct Version(u32);

impl Version {
    /// Returns the version of a file without parts.
    pub fn usual() -> Self {
        Self(WRITTEN)
    }

    /// Makes room for an element and its attributes.
    pub fn hold(&mut self, element: Element<'_, '_>) -> Result<(), ReadError> {
        let name = element.name();
        let has = |(of, attribute): &(&str, &str)| *of == name && element.has(attribute);
        // An action assigns the controller of an `ObjectController` since the newest version.
        let is_newest = OF_NEWEST.contains(&name)
            || ATTRIBUTES_OF_NEWEST.iter().any(has)
            || name == "AssignControllerAction" && element.first("ObjectController").is_some()
            || name == "Axles" && element.first("FrontAxle").is_none();
        self.0 = self.0.max(if is_newest { NEWEST } else { minor(element.outermost())? });
        Ok(())
    }

    /// Returns the minor version.
    pub fn minor(self) -> u32 {
        self.0
    }
}
