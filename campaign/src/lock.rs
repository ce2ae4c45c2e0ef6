//! The lock on the folder of a campaign, which only one process holds.
//!
//! The log is locked before anything is written. So of two campaigns that are started at once in one folder, one is
//! refused and has written nothing.

use crate::files::{is_no_link, is_regular};
use crate::{Error, Reason};
use std::fs::{self, File, Metadata, TryLockError};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The error that another process writes to the folder of a campaign.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{} is writing to {}; wait until it ends", holder.as_deref().unwrap_or("another process"), folder.display())]
pub struct InUse {
    /// The path of the folder.
    pub folder: PathBuf,
    /// The process that writes to the folder, in words, if the system tells.
    pub holder: Option<String>,
}

impl Reason for InUse {}

/// The locked log of a campaign. If the lock is dropped before a campaign begins, a log that the lock has created is
/// removed.
pub struct Lock {
    log: Option<File>,
    created: Option<PathBuf>,
}

impl Lock {
    /// Locks the log at a path, and creates the log if necessary.
    ///
    /// # Errors
    /// Another process holds the lock, or the log cannot be written.
    pub fn of(path: &Path) -> Result<Self, Error> {
        is_no_link(path)?;
        let mut options = File::options();
        options.read(true).write(true);
        let is_new = !path.exists();
        if !is_new {
            is_regular(path)?;
        }
        let log = options.create(true).truncate(false).open(path).map_err(Error::io("write", path))?;
        match log.try_lock() {
            Ok(()) => Ok(Self { log: Some(log), created: is_new.then(|| path.to_owned()) }),
            Err(TryLockError::WouldBlock) => {
                let holder = log.metadata().ok().and_then(|there| holder(&there));
                Err(InUse { folder: path.parent().unwrap_or(path).to_owned(), holder }.into())
            }
            Err(TryLockError::Error(source)) => Err(Error::io("lock", path)(source)),
        }
    }

    /// Returns the log, which stays locked until it is closed.
    pub fn kept(mut self) -> File {
        self.created = None;
        self.log.take().expect("a lock has a log until it is kept")
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if let Some(path) = &self.created {
            // An empty log does no harm.
            let _ = fs::remove_file(path);
        }
    }
}

/// Returns the process that holds a lock on a file, in words. Linux lists all locks; other systems do not tell.
#[cfg(target_os = "linux")]
fn holder(file: &Metadata) -> Option<String> {
    use std::os::linux::fs::MetadataExt;
    let device = file.st_dev();
    let (major, minor) = ((device >> 8) & 0xfff, (device & 0xff) | ((device >> 12) & 0xf_ff00));
    let inode = format!("{major:02x}:{minor:02x}:{}", file.st_ino());
    let locks = fs::read_to_string("/proc/locks").ok()?;
    let fields = locks.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let pid =
        fields.filter(|fields| fields.get(5) == Some(&inode.as_str())).find_map(|fields| fields.get(4).copied())?;
    // A process of another container has no number here.
    let pid: u32 = pid.parse().ok().filter(|pid| *pid > 0)?;
    let command = fs::read(format!("/proc/{pid}/cmdline")).ok()?;
    let words = command.split(|byte| *byte == 0).filter(|word| !word.is_empty()).map(String::from_utf8_lossy);
    let command: String = words.collect::<Vec<_>>().join(" ").chars().filter(|c| !c.is_control()).take(120).collect();
    Some(format!("process {pid} (`{command}`)"))
}

#[cfg(not(target_os = "linux"))]
fn holder(_: &Metadata) -> Option<String> {
    None
}
