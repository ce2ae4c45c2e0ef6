//! The catalogs of a scenario: entries of other files that a scenario refers to by name.

use super::elements::schema;
use super::linked;
use super::local::{Local, declare};
use super::scope::Node;
use super::version;
use crate::xml::{Document, Element, Flaw, NoEffect, ReadError};
use paracosm_space::nearest;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// The greatest number of references that lead to entries of catalogs. An entry may refer to others several times, so few files can
/// have very many references.
const MOST_REFERENCES: usize = 100_000;

/// The catalog files of a scenario.
#[derive(Debug, Default)]
pub(super) struct CatalogFiles {
    /// The files by the names of the catalogs. The parts of a catalog may be in several files.
    all: BTreeMap<String, Vec<Document>>,
    /// The folders that do not exist, each with the file and the line of the element that names it.
    absent: Vec<(PathBuf, u32, PathBuf)>,
}

/// The catalogs of a scenario.
pub(super) struct Catalogs<'a> {
    all: BTreeMap<&'a str, Vec<Element<'a, 'a>>>,
    absent: Option<&'a (PathBuf, u32, PathBuf)>,
    found: RefCell<Found>,
    /// The entries that are being read, each within the one before, by their names and lines.
    open: RefCell<Vec<(String, u32)>>,
    /// The number of references that have been followed.
    references: Cell<usize>,
}

/// The facts about the parts of a scenario that come up while the parts are read.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// The parameters of parts with demands that depend on the test.
    pub locals: Vec<Local>,
    /// The parts of entries of catalogs that have no effect, by the file and the line of the entry.
    pub without_effect: BTreeMap<(PathBuf, u32), Vec<NoEffect>>,
    /// The attributes whose values have no effect, or another one, each with its file.
    pub remarks: Vec<(PathBuf, NoEffect)>,
}

impl Found {
    /// Describes the parts of entries that have no effect: each name once for each file.
    pub fn notes(&self) -> Vec<String> {
        let mut all: BTreeMap<(&Path, &str), NoEffect> = BTreeMap::new();
        let of_entries =
            self.without_effect.iter().flat_map(|((file, _), parts)| parts.iter().map(move |of| (file, of)));
        for (file, part) in of_entries.chain(self.remarks.iter().map(|(file, part)| (file, part))) {
            let known = all.entry((file, &part.name)).or_insert_with(|| NoEffect { count: 0, ..part.clone() });
            known.count += part.count;
        }
        let mut all: Vec<_> = all.into_iter().map(|((file, _), part)| (file, part)).collect();
        all.sort_by_key(|(file, part)| (*file, part.line));
        all.into_iter().map(|(file, part)| part.in_file(file)).collect()
    }
}

impl CatalogFiles {
    /// Returns the texts of the files, in the order of the names of the catalogs.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.all.values().flatten().map(Document::text)
    }

    /// Returns the paths of the files.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.all.values().flatten().map(Document::file)
    }

    /// Reads all catalogs in the folders that a scenario names. `folder` is the folder of the scenario.
    pub fn read(locations: Option<Node<'_>>, folder: &Path) -> Result<Self, ReadError> {
        let (mut all, mut absent): (BTreeMap<String, Vec<Document>>, _) = (BTreeMap::new(), Vec::new());
        for location in locations.into_iter().flat_map(Node::elements) {
            let directory = location.child("Directory")?;
            let path = linked::within(directory, "path", folder)?;
            // A scenario may name folders that it does not use. A reference to a catalog in them is an error.
            if !path.exists() {
                let element = directory.element;
                absent.push((element.file().to_owned(), element.line(), path));
                continue;
            }
            let unreadable = |error| directory.error(Flaw::Folder { folder: path.clone(), error });
            let entries = std::fs::read_dir(&path).map_err(unreadable)?;
            let mut found =
                entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
            found.retain(|file| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xosc")));
            found.sort();
            for file in found {
                let document = Document::open(&file)?;
                let name = {
                    let root = document.root("OpenSCENARIO")?;
                    let name = |catalog: Element<'_, '_>| {
                        version::check(root)?;
                        catalog.required("name").map(str::to_owned)
                    };
                    root.first("Catalog").map(name).transpose()?
                };
                if let Some(name) = name {
                    let files = all.entry(name).or_default();
                    // Two kinds of catalogs may be in one folder.
                    let real = |document: &Document| document.file().canonicalize().ok();
                    if files.iter().all(|known| real(known) != real(&document)) {
                        files.push(document);
                    }
                }
            }
        }
        Ok(Self { all, absent })
    }

    /// Describes the folders that do not exist.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.absent.iter().map(|(file, line, folder)| {
            format!("{}:{line}: there is no folder {}, so it gives no catalog", file.display(), folder.display())
        })
    }

    /// Returns the catalogs by their names.
    pub fn catalogs(&self) -> Result<Catalogs<'_>, ReadError> {
        let mut all = BTreeMap::new();
        for (name, files) in &self.all {
            let roots = files.iter().map(|document| document.root("OpenSCENARIO"));
            let parts = roots.map(|root| root?.child("Catalog")).collect::<Result<_, ReadError>>()?;
            all.insert(name.as_str(), parts);
        }
        let (found, open, references) = Default::default();
        Ok(Catalogs { all, absent: self.absent.first(), found, open, references })
    }
}

impl<'a> Catalogs<'a> {
    /// Returns the entry that an element `CatalogReference` names, which is one of the given kinds; `None` if there is none.
    pub fn entry(&self, reference: Node<'_>, kinds: &[&str]) -> Result<Option<Element<'a, 'a>>, ReadError> {
        let [catalog, name] = [reference.required("catalogName")?, reference.required("entryName")?];
        let mut entries = self.all.get(catalog.as_ref()).into_iter().flatten().flat_map(|part| part.elements());
        Ok(entries.find(|entry| kinds.contains(&entry.name()) && entry.text("name") == Some(name.as_ref())))
    }

    /// Reads an element that is given directly or by a `CatalogReference`. The element sees its own parameters, with
    /// the values that the reference assigns.
    pub fn resolved<T>(
        &self,
        node: Node<'_>,
        kinds: &[&'static str],
        read: impl FnOnce(Node<'_>) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        if node.name() != "CatalogReference" {
            return self.declaring(node, &[], read);
        }
        let catalog = node.required("catalogName")?;
        let known = self.all.get(catalog.as_ref());
        let catalog = known.ok_or_else(|| self.unknown(node, &catalog))?;
        let entry_name = node.required("entryName")?;
        let is_named = |entry: &Element<'_, '_>| entry.text("name") == Some(entry_name.as_ref());
        let entries = catalog.iter().flat_map(|part| part.elements());
        let mut named = entries.filter(|entry| kinds.contains(&entry.name())).filter(is_named);
        let entry = named.next().ok_or_else(|| no_entry(node, catalog, kinds, &entry_name))?;
        if let Some(second) = named.next() {
            let (element, found) = (second.name().to_owned(), entry_name.clone().into_owned());
            if second.file() != entry.file() {
                let (file, line) = (entry.file().to_owned(), entry.line());
                return Err(second.error(Flaw::SecondEntry { element, name: found, file, line }));
            }
            return Err(second.error(Flaw::Taken { element, attribute: "name", found, first: entry.line() }));
        }
        let key = (entry_name.clone().into_owned(), entry.line());
        if self.open.borrow().contains(&key) {
            return Err(node.unexpected("entryName", &entry_name, "an entry that does not refer to itself"));
        }
        self.references.set(self.references.get() + 1);
        if self.references.get() > MOST_REFERENCES {
            let expected = format!("at most {MOST_REFERENCES} references to entries of catalogs");
            return Err(node.unexpected("entryName", &entry_name, expected));
        }
        self.check(entry)?;
        let assignments: Vec<_> = node.first("ParameterAssignments").into_iter().flat_map(Node::elements).collect();
        self.open.borrow_mut().push(key);
        let read = self.declaring(Node { element: entry, scope: node.scope }, &assignments, read);
        self.open.borrow_mut().pop();
        read
    }

    /// Reads an element that sees the parameters of a scope, and the parameters that the element declares.
    pub fn declaring<T>(
        &self,
        node: Node<'_>,
        assignments: &[Node<'_>],
        read: impl FnOnce(Node<'_>) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        let mut scope = node.scope.clone();
        let locals = declare(node.element, &mut scope, assignments)?;
        self.found.borrow_mut().locals.extend(locals);
        read(Node { element: node.element, scope: &scope })
    }

    /// Makes the error that a reference names no catalog. The reason may be a folder that does not exist.
    fn unknown(&self, node: Node<'_>, name: &str) -> ReadError {
        match self.absent {
            Some((file, line, folder)) if nearest(name, self.all.keys().copied()).is_none() => {
                let (folder, read) = (folder.clone(), std::fs::read_dir(folder));
                let error = read.err().unwrap_or_else(|| io::ErrorKind::NotFound.into());
                ReadError { file: file.clone(), line: Some(*line), flaw: Box::new(Flaw::Folder { folder, error }) }
            }
            _ => node.dangling("catalogName", "catalog", self.all.keys().copied()),
        }
    }

    /// Remarks that an attribute of an element has no effect with its value, or another one.
    pub fn remark(&self, node: Node<'_>, attribute: &str, reason: &'static str) {
        let (name, line) = (format!("{}.{attribute}", node.name()), node.element.line());
        let remark = NoEffect { name, reason, nearest: None, count: 1, line };
        self.found.borrow_mut().remarks.push((node.element.file().to_owned(), remark));
    }

    /// Checks an entry, once.
    fn check(&self, entry: Element<'_, '_>) -> Result<(), ReadError> {
        let key = (entry.file().to_owned(), entry.line());
        if !self.found.borrow().without_effect.contains_key(&key) {
            let notes = schema().check(entry)?;
            self.found.borrow_mut().without_effect.insert(key, notes);
        }
        Ok(())
    }

    /// Returns the facts that have come up since the last call.
    pub fn found(&self) -> Found {
        self.found.take()
    }
}

/// Makes the error that a catalog has no entry of the given kinds with a name.
fn no_entry(reference: Node<'_>, catalog: &[Element<'_, '_>], kinds: &[&str], name: &str) -> ReadError {
    let entries = || catalog.iter().flat_map(|part| part.elements());
    if let Some(other) = entries().find(|entry| entry.text("name") == Some(name)) {
        let (kinds, kind, file, line) = (kinds.join(" or "), other.name(), other.file().display(), other.line());
        return reference.unexpected("entryName", name, format!("a {kinds}; the entry in {file}:{line} is a {kind}"));
    }
    let names = entries().filter(|entry| kinds.contains(&entry.name())).filter_map(|entry| entry.text("name"));
    reference.dangling("entryName", "entry of the catalog", names)
}
