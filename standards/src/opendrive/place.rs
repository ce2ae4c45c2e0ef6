//! Places along a road or a section, which do not fall from element to element.

use crate::xml::{Element, ReadError};

/// Returns the place in an attribute, which must not lie before the place `before`.
pub(super) fn place(element: Element<'_, '_>, attribute: &'static str, before: &mut f64) -> Result<f64, ReadError> {
    let s = element.length(attribute)?;
    if s < *before {
        let expected = format!("at least {before}, the place of the <{}> before", element.name());
        return Err(element.unexpected(attribute, expected));
    }
    *before = s;
    Ok(s)
}
