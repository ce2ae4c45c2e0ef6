//! Shows a campaign as one HTML file that opens anywhere: no server, no request, no network.
//!
//! A [`Page`] is the results of a campaign and the runs of some of its tests. The file has three parts: a JSON document (`document.rs`), the
//! table of all tests (`columns.rs`), and one record for each run that can be played (`run.rs`). All are compressed inside the file. The
//! program that shows them is built from `report/web`, and stands in the repository with its hash, so that no build needs npm.
//!
//! `docs/report-data.md` describes the document for other programs.

mod columns;
mod document;
mod pack;
mod roads;
mod run;
mod runs;
mod whole;

pub use document::{Finding, FindingTable};
#[cfg(feature = "viewer")]
pub(crate) use run::{Record, Recorder};
pub use runs::Runs;

#[cfg(feature = "viewer")]
pub(crate) use document::Grid;
use document::{Document, MAPS};
use pack::{BUNDLE, base64, gzip};
use paracosm_analysis::{Coverage, Effects, Growth, Modes, Plausible, Summary};
use paracosm_campaign::{Log, Reason};
use serde_json::{Map, Value};
use std::fmt::Write;
use thiserror::Error;

/// The greatest size of a page in megabytes, unless the user gives another one.
pub const MEGABYTES: f64 = 8.0;

/// The share of a page that tests take at most, so that runs have room.
const TESTS: f64 = 0.75;

/// The results of a campaign that a page shows.
#[derive(Debug, Clone)]
pub struct Page<'a> {
    /// The log of the campaign.
    pub log: &'a Log,
    /// The name of the folder of the campaign, for commands on the page.
    pub folder: String,
    /// The name of the program that has the commands on the page.
    pub program: String,
    /// True if the campaign still runs, or was interrupted.
    pub unfinished: bool,
    /// The counts of verdicts, and the result of each requirement.
    pub summary: &'a Summary,
    /// The summary of the plausible tests; `None` if all tests are plausible.
    pub plausible: Option<&'a Plausible>,
    /// The coverage of the space by the tests.
    pub coverage: &'a Coverage,
    /// The coverage by the first tests of the campaign, for growing numbers of tests.
    pub growth: Vec<Growth>,
    /// The failure modes of the campaign.
    pub modes: &'a Modes,
    /// The effects of the open parameters; `None` if they are not known.
    pub effects: Option<&'a Effects>,
    /// The names of the two coordinates that explain the failures best; `None` if a map cannot be drawn.
    pub axes: Option<[String; 2]>,
    /// Results in words.
    pub findings: Vec<Finding>,
    /// Further results, each under the name of its file in the folder of the campaign.
    pub results: Map<String, Value>,
    /// The comparison with an earlier campaign; `None` if there is none.
    pub changes: Option<Value>,
}

/// The error that a page does not fit into the size that the user allows.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("the page needs at least {least:.2} MB without any run, but {most} MB are allowed: allow more with --max-mb")]
pub struct TooSmall {
    /// The size of the page without runs, in megabytes.
    pub least: f64,
    /// The allowed size in megabytes.
    pub most: f64,
}

impl Reason for TooSmall {}

impl Page<'_> {
    /// Returns the text of the HTML file, with at most this number of megabytes. Tests and runs that do not fit are left out, and the page
    /// says so. The table of tests takes at most three quarters of the room, and leaves failing tests out last. Runs of a sample of passing tests
    /// are left out before runs of failing tests.
    ///
    /// # Errors
    /// A model of the failures cannot be fitted, or not even the results fit.
    pub fn html(&self, runs: &Runs, megabytes: f64) -> Result<String, paracosm_campaign::Error> {
        let most = (megabytes * 1e6) as usize;
        let mut document = Document::of(self, MAPS)?;
        let shell = BUNDLE.script.len() + BUNDLE.style.len() + base64(&gzip(&document.json())).len() + 4096;
        let room = most.checked_sub(shell).ok_or(TooSmall { least: shell as f64 / 1e6, most: megabytes })?;
        let tests = columns::pack(self, (room as f64 * TESTS) as usize);
        document.tests = tests.described;
        let mut left = room.saturating_sub(tests.text.len());
        loop {
            let kept = runs.within(left);
            document.runs = kept.described;
            let text = self.assemble(&document, &tests.text, &kept.texts);
            match text.len().checked_sub(most).filter(|excess| *excess > 0) {
                None => return Ok(text),
                Some(_) if kept.texts.is_empty() => {
                    return Err(TooSmall { least: text.len() as f64 / 1e6, most: megabytes }.into());
                }
                Some(excess) => left = left.saturating_sub(excess),
            }
        }
    }

    /// Returns the text of the page as a viewer serves it: with all tests and without runs, which the page asks of the viewer.
    ///
    /// # Errors
    /// A model of the failures cannot be fitted.
    #[cfg(feature = "viewer")]
    pub fn served(&self) -> Result<String, paracosm_campaign::Error> {
        let tests = columns::pack(self, usize::MAX);
        // The page asks for further maps when somebody looks at them.
        let mut document = Document::of(self, 1)?;
        (document.served, document.tests) = (true, tests.described);
        Ok(self.assemble(&document, &tests.text, &[]))
    }

    fn assemble(&self, document: &Document, tests: &str, runs: &[(String, String)]) -> String {
        let mut text = String::new();
        // Only this script and this style are run, and nothing is asked of a network. A page that is served asks its server.
        let policy = format!(
            "default-src 'none'; script-src '{}'; style-src '{}'; img-src data:; base-uri 'none'; form-action 'none'{}",
            BUNDLE.script_hash,
            BUNDLE.style_hash,
            if document.served { "; connect-src 'self'; media-src blob:" } else { "" }
        );
        let title = pack::escaped(&self.log.study().title());
        let _ = write!(
            text,
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title} - PARACOSM</title>\n<style>{}</style>\n</head>\n<body>\n\
             <noscript>This page needs JavaScript. It asks nothing of a network.</noscript>\n<main id=\"page\"></main>\n",
            BUNDLE.style
        );
        let mut block = |id: &str, contents: &str| {
            let _ = writeln!(text, "<script type=\"application/gzip\" id=\"{id}\">{contents}</script>");
        };
        block("document", &base64(&gzip(&document.json())));
        block("tests", tests);
        for (id, run) in runs {
            block(id, run);
        }
        let _ = write!(text, "<script>{}</script>\n</body>\n</html>\n", BUNDLE.script);
        text
    }
}
