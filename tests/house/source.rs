//! The modules of a crate, as syntax trees, without what is compiled only for tests.

use crate::workspace::root;
use std::fs;
use std::path::{Path, PathBuf};
use syn::{Attribute, Item, Lit, Meta};

/// A module: its own items, without those of its children.
pub struct Module {
    /// Its names from the root of the crate, which has none.
    pub path: Vec<String>,
    pub file: PathBuf,
    pub items: Vec<Item>,
}

impl Module {
    /// Its file, from the root of the workspace.
    pub fn name(&self) -> String {
        self.file.strip_prefix(root()).unwrap_or(&self.file).display().to_string()
    }
}

/// Reads the modules of the crate whose first file is given, parents before their children.
pub fn modules(first: &Path) -> Vec<Module> {
    let mut modules = Vec::new();
    let folder = first.parent().expect("a file lies in a folder");
    read(first, folder, Vec::new(), &mut modules);
    modules
}

/// The modules of a crate that is one text.
pub fn modules_of(text: &str) -> Vec<Module> {
    let items = syn::parse_str::<syn::File>(text).expect("it is a crate").items;
    let mut modules = Vec::new();
    add(items, &root().join("lib.rs"), root(), Vec::new(), &mut modules);
    modules
}

/// Reads a file that is a module, and the modules below it; `folder` has the files of its children.
fn read(file: &Path, folder: &Path, path: Vec<String>, modules: &mut Vec<Module>) {
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    add(syntax.items, file, folder, path, modules);
}

fn add(items: Vec<Item>, file: &Path, folder: &Path, path: Vec<String>, modules: &mut Vec<Module>) {
    let (children, items): (Vec<_>, Vec<_>) =
        items.into_iter().filter(|item| !is_for_tests(attributes(item))).partition(|item| matches!(item, Item::Mod(_)));
    modules.push(Module { path: path.clone(), file: file.to_owned(), items });
    for child in children {
        let Item::Mod(child) = child else { unreachable!("the partition keeps modules only") };
        let name = child.ident.to_string();
        let path = [path.clone(), vec![name.clone()]].concat();
        let below = folder.join(&name);
        match (child.content, named_file(&child.attrs)) {
            (Some((_, items)), _) => add(items, file, &below, path, modules),
            (None, Some(other)) => read(&file.with_file_name(other), &below, path, modules),
            (None, None) if below.join("mod.rs").is_file() => read(&below.join("mod.rs"), &below, path, modules),
            (None, None) => read(&below.with_extension("rs"), &below, path, modules),
        }
    }
}

/// The file that `#[path = "…"]` names.
fn named_file(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().filter(|attribute| attribute.path().is_ident("path")).find_map(|attribute| {
        let Meta::NameValue(pair) = &attribute.meta else { return None };
        let syn::Expr::Lit(syn::ExprLit { lit: Lit::Str(file), .. }) = &pair.value else { return None };
        Some(file.value())
    })
}

/// Whether something is compiled for tests only: `#[test]`, or a `#[cfg(…)]` that asks for `test` or `doctest`.
pub fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.parse_args::<Meta>().is_ok_and(|asked| asks_for_tests(&asked))
    })
}

fn asks_for_tests(asked: &Meta) -> bool {
    match asked {
        Meta::Path(name) => name.is_ident("test") || name.is_ident("doctest"),
        Meta::List(list) if list.path.is_ident("all") => {
            let all = syn::punctuated::Punctuated::<Meta, syn::Token![,]>::parse_terminated;
            list.parse_args_with(all).is_ok_and(|all| all.iter().any(asks_for_tests))
        }
        _ => false,
    }
}

/// The attributes of an item.
pub fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::ExternCrate(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::ForeignMod(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::TraitAlias(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// The attributes of an item in an `impl`.
pub fn attributes_in_impl(item: &syn::ImplItem) -> &[Attribute] {
    match item {
        syn::ImplItem::Const(item) => &item.attrs,
        syn::ImplItem::Fn(item) => &item.attrs,
        syn::ImplItem::Type(item) => &item.attrs,
        _ => &[],
    }
}
