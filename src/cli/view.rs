//! `paracosm-fuzz view`: shows a campaign in a browser, also while it runs, and runs further tests.

use super::{Failure, Status, Verbosity, on_interrupt, print, program, trust, usage};
use crate::report::viewer::{Doorway, Viewer};
use crate::{Beside, Report};
use clap::Args;
use paracosm_campaign::cameras::read_cameras;
use paracosm_campaign::{Catalogue, Error, Subject, end_all_processes};
#[cfg(unix)]
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{self, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz view paracosm-out --open
      opens the page of the campaign in a browser; Ctrl-C ends it

The page is the page of `report`, and more: it plays every test, and a click on the map runs a test there. In the window of a test, each \
    parameter can be dragged, and the test runs with the new value. There are buttons for the simplest test that still fails, for the \
    drivers that prevent a failure, and for the view of each camera. The campaign may still run: the page tells of new tests.

The page is served on this machine alone, at an address with a secret. Nothing is written: a test that is run here is no test of the campaign.";

/// The programs that open an address in the browser of the user, on this system.
const OPENERS: &[&str] = if cfg!(target_os = "macos") {
    &["open"]
} else if cfg!(windows) {
    &["explorer"]
} else {
    &["xdg-open", "gio", "wslview"]
};

/// The options of `view`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign, which may still run
    dir: PathBuf,
    /// Open the page in a browser
    #[arg(long)]
    open: bool,
    /// The port of the page [default: a free port]
    #[arg(long, value_name = "N")]
    port: Option<u16>,
    /// The cameras that film tests on the page
    ///
    /// `record --print-cameras` prints a file of cameras [default: the cameras of the driver, or a camera at the front].
    #[arg(long, value_name = "CAMERAS.toml")]
    cameras: Option<PathBuf>,
    #[command(flatten)]
    trust: trust::Options,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let (log, _) = self.trust.read(&self.dir, catalogue, verbosity)?;
        let supervision = verbosity.supervision();
        // What is noted about the folder is noted once.
        let read = || self.trust.read(&self.dir, catalogue, Verbosity::SILENT).map(|(log, _)| log);
        let page = || -> Result<String, Error> {
            Report::read(read()?, &self.dir)?.page(&self.dir, program::name(), Beside::default())?.served()
        };
        let cameras = self.cameras.as_deref().map(read_cameras).transpose()?;
        let viewer = Viewer {
            study: log.study(),
            folder: &self.dir,
            read: &read,
            page: &page,
            cameras: cameras.as_ref(),
            supervision: supervision.clone(),
        };
        if let (Some(file), Subject::System(_)) = (&self.cameras, log.study().subject()) {
            let message = format!("--cameras {}: a system has no world that a camera could film", file.display());
            return Err(usage(message).into());
        }
        // Nobody should see an address that answers nothing.
        log.study().check_trust()?;
        let doorway = Doorway::at(self.port.unwrap_or(0)).map_err(Error::unavailable)?;
        on_interrupt(supervision.stop.clone());
        end_soon_after(supervision.stop.clone());
        print(&format!("{doorway}\n"))?;
        verbosity.note("Ctrl-C ends the viewer");
        if self.open && !opened(&doorway.to_string()) {
            verbosity.note("found no program that opens a browser: open the address yourself");
        }
        viewer.serve(doorway)?;
        Ok(Status::Nothing)
    }
}

/// Ends the program some time after the flag is set. A page of a large campaign takes a minute to make, and nobody waits for it any more. Nothing is
/// lost, because a viewer writes nothing.
fn end_soon_after(stop: Arc<AtomicBool>) {
    thread::spawn(move || {
        while !stop.load(Ordering::Relaxed) {
            thread::sleep(Duration::from_millis(50));
        }
        thread::sleep(Duration::from_secs(2));
        end_all_processes();
        process::exit(0);
    });
}

/// Opens an address in the browser of the user; returns `true` if a program for this was found.
fn opened(address: &str) -> bool {
    OPENERS.iter().any(|opener| {
        let mut command = Command::new(opener);
        if *opener == "gio" {
            command.arg("open");
        }
        command.arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        // Ctrl-C ends the viewer, and not a browser that it has started.
        #[cfg(unix)]
        command.process_group(0);
        let Ok(mut program) = command.spawn() else { return false };
        // Somebody has to wait for the program once it has ended.
        thread::spawn(move || program.wait());
        true
    })
}
