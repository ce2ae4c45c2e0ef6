//! Remembers in which folder the commands of a campaign ran, because `python3 my_driver.py` is another command elsewhere.
//!
//! The folder is written as a path from the folder of the campaign, so that both can move together.

use crate::files::{read_text_here, write_whole_here};
use crate::{Error, Study};
use serde::{Deserialize, Serialize};
use std::path::{Component, Path, PathBuf};

/// The file in the folder of a campaign.
pub(crate) const FILE: &str = "commands.json";

#[derive(Serialize, Deserialize)]
struct RunIn {
    /// The folder in which the commands of the campaign ran, as a path from the folder of the campaign.
    run_in: PathBuf,
}

/// Writes the folder of this process to the folder of a campaign, if the study runs commands. Does nothing if
/// the path between the folders is not known or is no text.
pub(crate) fn keep(campaign: &Path, study: &Study) -> Result<(), Error> {
    let here = std::env::current_dir().and_then(|here| here.canonicalize());
    let (Ok(here), Ok(folder)) = (here, campaign.canonicalize()) else { return Ok(()) };
    if study.commands().is_empty() {
        return Ok(());
    }
    // A path that is no text cannot stand in JSON.
    let Ok(text) = serde_json::to_string(&RunIn { run_in: from(&folder, &here) }) else { return Ok(()) };
    write_whole_here(&campaign.join(FILE), format!("{text}\n").as_bytes())
}

/// Returns the folder in which the commands of a campaign ran, as far as the file says so. Nobody looks at the folder, which a stranger may
/// have named.
pub(crate) fn read(campaign: &Path) -> Option<PathBuf> {
    let text = read_text_here(&campaign.join(FILE)).ok()?;
    let RunIn { run_in } = serde_json::from_str(&text).ok()?;
    let mut folder = campaign.canonicalize().ok()?;
    for part in run_in.components() {
        match part {
            Component::ParentDir => drop(folder.pop()),
            Component::Normal(name) => folder.push(name),
            Component::CurDir => {}
            Component::Prefix(_) | Component::RootDir => return None,
        }
    }
    Some(folder)
}

/// Returns the path from one folder to another; both paths are absolute.
fn from(folder: &Path, to: &Path) -> PathBuf {
    let [mut ours, mut theirs] = [folder, to].map(|path| path.components().peekable());
    while ours.peek().is_some() && ours.peek() == theirs.peek() {
        ours.next();
        theirs.next();
    }
    let path: PathBuf = ours.map(|_| Component::ParentDir).chain(theirs).collect();
    if path.as_os_str().is_empty() { PathBuf::from(".") } else { path }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_leads_from_one_folder_to_another() {
        let cases = [("/a/b", "/a", ".."), ("/a", "/a/b", "b"), ("/a/b/c", "/a/d", "../../d"), ("/a", "/a", ".")];
        for (folder, to, path) in cases {
            assert_eq!(from(Path::new(folder), Path::new(to)), Path::new(path), "{folder} to {to}");
        }
    }
}
