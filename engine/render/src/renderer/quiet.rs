//! Keeps a message of the graphics driver from the terminal, which looks like an error and is none.
//!
//! Mesa looks for the display of the desktop to choose an adapter. Where there is none, in a container, say, it prints that
//! `XDG_RUNTIME_DIR` is not set. Everything else that is printed meanwhile is printed afterwards.

/// Opens graphics while standard error is held back, if the message is to be expected.
#[cfg(unix)]
pub(super) fn quietly<T>(open: impl FnOnce() -> T) -> T {
    use std::io::Write;
    if std::env::var_os(VARIABLE).is_some() {
        return open();
    }
    // Two threads that hold standard error at once would give it back in the wrong order.
    static ONE: std::sync::Mutex<()> = std::sync::Mutex::new(());
    let _one = ONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let Ok(held) = Held::begin() else { return open() };
    let opened = open();
    let text = held.end();
    let rest: Vec<&str> = text.split_inclusive('\n').filter(|line| !line.contains(VARIABLE)).collect();
    let _ = std::io::stderr().write_all(rest.concat().as_bytes());
    opened
}

#[cfg(not(unix))]
pub(super) fn quietly<T>(open: impl FnOnce() -> T) -> T {
    open()
}

#[cfg(unix)]
const VARIABLE: &str = "XDG_RUNTIME_DIR";

/// Standard error while it leads to a pipe.
#[cfg(unix)]
struct Held {
    /// The end of the pipe with the text.
    text: rustix::fd::OwnedFd,
    /// The file to which standard error leads otherwise.
    kept: rustix::fd::OwnedFd,
}

#[cfg(unix)]
impl Held {
    /// Lets standard error lead to a pipe.
    fn begin() -> rustix::io::Result<Self> {
        use rustix::pipe::{PipeFlags, pipe_with};
        let kept = rustix::io::fcntl_dupfd_cloexec(rustix::stdio::stderr(), 0)?;
        // A full pipe loses text instead of waiting for ever.
        let (text, end) = pipe_with(PipeFlags::CLOEXEC | PipeFlags::NONBLOCK)?;
        rustix::stdio::dup2_stderr(&end)?;
        Ok(Self { text, kept })
    }

    /// Lets standard error lead to its file again, and returns the text in the pipe.
    fn end(self) -> String {
        self.give_back();
        let (mut all, mut part) = (Vec::new(), [0; 4096]);
        while let Ok(read @ 1..) = rustix::io::read(&self.text, &mut part[..]) {
            all.extend_from_slice(&part[..read]);
        }
        String::from_utf8_lossy(&all).into_owned()
    }

    fn give_back(&self) {
        let _ = rustix::stdio::dup2_stderr(&self.kept);
    }
}

/// A panic gives standard error back, too.
#[cfg(unix)]
impl Drop for Held {
    fn drop(&mut self) {
        self.give_back();
    }
}
