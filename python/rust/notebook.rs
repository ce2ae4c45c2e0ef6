//! A report in a notebook: the verdicts, the doubts, the failure map and the failure modes.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use paracosm::Report;
use paracosm::oracles::Verdict;
use paracosm::space::plural;
use std::fmt::Write;
use std::path::Path;

/// The most failure modes. A notebook shows a report beside others.
const MOST_MODES: usize = 10;

/// Returns a report as HTML.
pub fn page(report: &Report, folder: &Path) -> String {
    let mut html = format!("<p><b>{}</b><br>", escaped(&report.log.study().title()));
    let _ = write!(html, "{}, in {}</p>", counts(report), escaped(&folder.display().to_string()));
    for doubt in &report.doubts {
        let _ = write!(html, "<p>Doubt: {}</p>", escaped(doubt));
    }
    // As an image, because a file of a stranger's folder may hold a script.
    if let Ok(svg) = std::fs::read(folder.join("failure-map.svg")) {
        let _ = write!(html, "<img src=\"data:image/svg+xml;base64,{}\">", BASE64_STANDARD.encode(svg));
    }
    let modes = &report.modes.modes;
    if !modes.is_empty() {
        html += "<p>Failure modes:</p><ol>";
        for mode in modes.iter().take(MOST_MODES) {
            let tests = plural(mode.count, "test");
            let _ = write!(html, "<li>{tests}, such as test {}: {}</li>", mode.representative, escaped(&mode.words));
        }
        html += "</ol>";
        if let Some(more) = modes.len().checked_sub(MOST_MODES).filter(|more| *more > 0) {
            let _ = write!(html, "<p>{} in <code>modes</code></p>", plural(more, "more mode"));
        }
    }
    html
}

/// Returns the number of tests with each verdict that occurs.
pub fn counts(report: &Report) -> String {
    let counts = Verdict::ALL.iter().map(|verdict| (report.summary.count(*verdict), verdict));
    let counts: Vec<String> =
        counts.filter(|(count, _)| *count > 0).map(|(n, verdict)| format!("{n} {verdict}")).collect();
    counts.join(", ")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
