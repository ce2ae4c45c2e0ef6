//! Puts data and programs into an HTML file.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;

/// The program of the page, as `report/web` builds it.
pub(super) struct Bundle {
    pub script: &'static str,
    pub style: &'static str,
    /// The hashes of both by which a browser knows that it may run them.
    pub script_hash: &'static str,
    pub style_hash: &'static str,
}

pub(super) static BUNDLE: Bundle = Bundle {
    script: include_str!("../../web/dist/page.js"),
    style: include_str!("../../web/dist/page.css"),
    script_hash: include_str!("../../web/dist/page.js.sha256"),
    style_hash: include_str!("../../web/dist/page.css.sha256"),
};

/// Compresses bytes. The result does not depend on the time or the machine.
pub(super) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("memory takes all bytes")
}

/// Writes bytes as text, which may stand in an HTML file as it is.
pub(super) fn base64(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Returns a text as it may stand in HTML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use sha2::{Digest, Sha256};

    #[test]
    fn the_hashes_beside_the_bundle_are_those_of_the_bundle() {
        for (contents, hash) in [(BUNDLE.script, BUNDLE.script_hash), (BUNDLE.style, BUNDLE.style_hash)] {
            assert_eq!(format!("sha256-{}", base64(&Sha256::digest(contents))), hash);
        }
    }

    #[test]
    fn the_bundle_cannot_end_its_own_element() {
        assert!(!BUNDLE.script.contains("</script") && !BUNDLE.script.contains("<!--"));
        assert!(!BUNDLE.style.contains("</style"));
    }
}
