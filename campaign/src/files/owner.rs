//! The mode and the owner of files, on systems where files have them.

use std::fs::{File, Metadata};
use std::io;

#[cfg(unix)]
mod system {
    use super::{File, Metadata, io};
    use std::fs::Permissions;
    use std::io::Write;
    use std::os::fd::AsFd;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};

    /// Gives a new file the mode and the owner of another file. Returns `false` if this user may not give the owner.
    pub fn keep(file: &File, other: &Metadata) -> io::Result<bool> {
        let new = file.metadata()?;
        let is_given = (new.uid(), new.gid()) == (other.uid(), other.gid())
            || fchown(file, Some(other.uid()), Some(other.gid())).is_ok();
        // A change of the owner may change the mode. Therefore the mode comes last.
        if is_given {
            file.set_permissions(other.permissions())?;
        }
        Ok(is_given)
    }

    /// Gives temporary folders the mode of other new folders.
    pub fn like_new_folders(builder: &mut tempfile::Builder) {
        builder.permissions(Permissions::from_mode(0o777));
    }

    /// Returns the standard output or the standard error of this process if the file is the same file. A file to which
    /// the shell has led the output must not be replaced, because the rest of the output would be lost.
    pub fn own_output(file: &Metadata) -> io::Result<Option<File>> {
        let (output, errors) = (io::stdout(), io::stderr());
        // Either may be closed.
        for open in [output.as_fd(), errors.as_fd()].map(|open| open.try_clone_to_owned()).into_iter().flatten() {
            let open = File::from(open);
            let there = open.metadata()?;
            if (there.dev(), there.ino()) == (file.dev(), file.ino()) {
                // The output that this process has so far comes first.
                io::stdout().flush()?;
                return Ok(Some(open));
            }
        }
        Ok(None)
    }
}

#[cfg(not(unix))]
mod system {
    use super::{File, Metadata, io};

    pub fn keep(_: &File, _: &Metadata) -> io::Result<bool> {
        Ok(true)
    }

    pub fn like_new_folders(_: &mut tempfile::Builder) {}

    pub fn own_output(_: &Metadata) -> io::Result<Option<File>> {
        Ok(None)
    }
}

pub(super) use system::{keep, like_new_folders, own_output};
