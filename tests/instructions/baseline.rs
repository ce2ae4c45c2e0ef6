//! The baseline: how many instructions each work took when the file was written, and with which compiler.

use std::process::Command;

/// The file of the baseline, relative to the root of the repository.
pub const FILE: &str = "tests/instructions/baseline.csv";

/// The instructions of works, by their names.
#[derive(Default)]
pub struct Baseline {
    /// The compiler that built the works.
    pub compiler: String,
    works: Vec<(String, u64)>,
}

impl Baseline {
    /// Reads the baseline; `None` if there is no such file.
    pub fn read() -> Option<Self> {
        let text = std::fs::read_to_string(FILE).ok()?;
        let mut lines = text.lines();
        let compiler = lines.next().and_then(|line| line.strip_prefix("# ")).unwrap_or_default().to_owned();
        let works = lines.skip(1).map(|line| {
            let (count, name) = line.split_once(',').expect("a number of instructions and a name");
            (name.to_owned(), count.parse().expect("a number of instructions"))
        });
        Some(Self { compiler, works: works.collect() })
    }

    /// Returns the instructions of a work; `None` if the baseline does not have the work.
    pub fn of(&self, work: &str) -> Option<u64> {
        self.works.iter().find(|(name, _)| name == work).map(|(_, count)| *count)
    }

    /// Sets the instructions of a work.
    pub fn set(&mut self, work: &str, count: u64) {
        match self.works.iter_mut().find(|(name, _)| name == work) {
            Some((_, old)) => *old = count,
            None => self.works.push((work.to_owned(), count)),
        }
    }

    /// Writes the baseline.
    pub fn write(&self) {
        let mut text = format!("# {}\ninstructions,work\n", self.compiler);
        for (name, count) in &self.works {
            text += &format!("{count},{name}\n");
        }
        std::fs::write(FILE, text).expect("the baseline can be written");
    }
}

/// Returns the compiler and the processor's architecture, on which the number of instructions depends.
pub fn compiler() -> String {
    let version = Command::new("rustc").arg("--version").output();
    let version = version
        .map_or_else(|_| "unknown compiler".to_owned(), |out| String::from_utf8_lossy(&out.stdout).trim().to_owned());
    format!("{version}, {}-{}", std::env::consts::ARCH, std::env::consts::OS)
}
