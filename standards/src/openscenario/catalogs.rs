//! The catalogs of a scenario: entries of other files that a scenario refers to by name.

use super::elements::schema;
use super::scope::{Node, Scope};
use crate::xml::{Document, Element, Flaw, ReadError};
use std::collections::BTreeMap;
use std::path::Path;

/// The catalog files of a scenario, by the names of the catalogs.
#[derive(Debug, Default)]
pub(super) struct CatalogFiles(BTreeMap<String, Document>);

/// The trees of the catalogs of a scenario.
pub(super) struct Catalogs<'a>(BTreeMap<&'a str, Element<'a, 'a>>);

impl CatalogFiles {
    /// Reads all catalogs in the folders that a scenario names. `folder` is the folder of the scenario.
    pub fn read(locations: Option<Node<'_>>, folder: &Path) -> Result<Self, ReadError> {
        let mut files = BTreeMap::new();
        for location in locations.into_iter().flat_map(Node::elements) {
            let directory = location.child("Directory")?;
            let path = folder.join(directory.required("path")?.as_ref());
            // A scenario may name folders that it does not use. A reference to a catalog in them is an error.
            if !path.exists() {
                continue;
            }
            let unreadable = |error| directory.error(Flaw::Folder { folder: path.clone(), error });
            let entries = std::fs::read_dir(&path).map_err(unreadable)?;
            let mut found =
                entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
            found.retain(|file| file.extension().is_some_and(|extension| extension == "xosc"));
            found.sort();
            for file in found {
                let document = Document::open(&file)?;
                let name = {
                    let tree = document.tree()?;
                    let root = document.root(&tree, "OpenSCENARIO")?;
                    root.first("Catalog").map(|catalog| catalog.required("name").map(str::to_owned)).transpose()?
                };
                if let Some(name) = name {
                    files.insert(name, document);
                }
            }
        }
        Ok(Self(files))
    }

    /// Parses the trees of all catalogs.
    pub fn trees(&self) -> Result<Vec<roxmltree::Document<'_>>, ReadError> {
        self.0.values().map(Document::tree).collect()
    }

    /// Returns the catalogs with their trees, which [`CatalogFiles::trees`] has parsed.
    pub fn catalogs<'a>(&'a self, trees: &'a [roxmltree::Document<'a>]) -> Result<Catalogs<'a>, ReadError> {
        let catalog = |((name, document), tree): ((&'a String, &'a Document), &'a roxmltree::Document<'a>)| {
            Ok((name.as_str(), document.root(tree, "OpenSCENARIO")?.child("Catalog")?))
        };
        self.0.iter().zip(trees).map(catalog).collect::<Result<_, _>>().map(Catalogs)
    }
}

impl Catalogs<'_> {
    /// Reads an element that is given directly or by a `CatalogReference`. The element sees its own parameters, with
    /// the values that the reference assigns.
    pub fn resolved<T>(
        &self,
        node: Node<'_>,
        kinds: &[&'static str],
        read: impl FnOnce(Node<'_>) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        if node.name() != "CatalogReference" {
            let mut scope = node.scope.clone();
            declare(node, &mut scope)?;
            return read(Node { element: node.element, scope: &scope });
        }
        let catalog = node.required("catalogName")?;
        let known = self.0.get(catalog.as_ref()).copied();
        let catalog = known.ok_or_else(|| node.dangling("catalogName", "catalog", self.0.keys().copied()))?;
        let entry_name = node.required("entryName")?;
        let entries = || catalog.elements().filter(|entry| kinds.contains(&entry.name()));
        let entry = entries().find(|entry| entry.text("name") == Some(entry_name.as_ref())).ok_or_else(|| {
            node.dangling("entryName", "entry of the catalog", entries().filter_map(|entry| entry.text("name")))
        })?;
        schema().check(entry)?;
        let mut scope = node.scope.clone();
        declare(Node { element: entry, scope: node.scope }, &mut scope)?;
        for assignment in node.first("ParameterAssignments").into_iter().flat_map(|all| all.all("ParameterAssignment"))
        {
            let name = assignment.element.required("parameterRef")?;
            let name = name.strip_prefix('$').unwrap_or(name).to_owned();
            scope.set(name, assignment.required("value")?.into_owned());
        }
        read(Node { element: entry, scope: &scope })
    }
}

/// Adds the parameters that an element declares to a scope.
pub(super) fn declare(node: Node<'_>, scope: &mut Scope) -> Result<(), ReadError> {
    for declaration in node.first("ParameterDeclarations").into_iter().flat_map(|all| all.all("ParameterDeclaration")) {
        let here = Node { element: declaration.element, scope };
        let (name, value) = (here.required("name")?.into_owned(), here.text("value")?.unwrap_or_default().into_owned());
        scope.set(name, value);
    }
    Ok(())
}
