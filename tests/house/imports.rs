//! Which module of a crate names which other one.
//!
//! A `use` counts, and so does a path in an expression, a type, a pattern or the tokens of a macro. A name that a
//! module only passes on (`pub use`) counts for the module that passes it on and for the module that has it: a detour
//! hides no circle. A `use …::*` counts for the module that it names, not for the modules that this one has its names
//! from.

use crate::source::{Module, attributes, attributes_in_impl, is_for_tests};
use proc_macro2::{Span, TokenStream, TokenTree};
use std::collections::HashMap;
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, ItemMod, ItemUse, Macro, Path, UseTree, Visibility};

/// That a module names another one of its crate. Modules are numbers: their places in the list.
pub struct Import {
    pub from: usize,
    pub to: usize,
    /// The path as it is written, and its line.
    pub path: String,
    pub line: usize,
}

/// All imports between different modules of a crate.
pub fn imports(modules: &[Module]) -> Vec<Import> {
    let written: Vec<Written> = modules.iter().map(written).collect();
    let names = Names::new(modules, &written);
    let mut imports = Vec::new();
    for (from, written) in written.iter().enumerate() {
        for path in &written.paths {
            for to in names.meant(from, &path.names, 0).into_iter().filter(|to| *to != from) {
                imports.push(Import { from, to, path: path.names.join("::"), line: path.line });
            }
        }
    }
    imports
}

/// The paths in the code of a module.
#[derive(Default)]
struct Written {
    paths: Vec<WrittenPath>,
    /// The names that `use` brings into the module, with the paths that they stand for.
    uses: HashMap<String, Vec<String>>,
}

struct WrittenPath {
    names: Vec<String>,
    line: usize,
}

fn written(module: &Module) -> Written {
    let mut written = Written::default();
    module.items.iter().for_each(|item| written.visit_item(item));
    written
}

impl Written {
    fn path(&mut self, names: Vec<String>, span: Span) {
        if names.len() > 1 {
            self.paths.push(WrittenPath { names, line: span.start().line });
        }
    }

    fn use_tree(&mut self, tree: &UseTree, mut before: Vec<String>) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.use_tree(&path.tree, before);
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.use_tree(tree, before.clone())),
            UseTree::Glob(glob) => self.path(before, glob.star_token.spans[0]),
            UseTree::Name(name) => self.used(before, &name.ident, &name.ident),
            UseTree::Rename(rename) => self.used(before, &rename.ident, &rename.rename),
        }
    }

    fn used(&mut self, mut before: Vec<String>, name: &syn::Ident, alias: &syn::Ident) {
        let alias = if name == "self" { before.last().cloned().unwrap_or_default() } else { alias.to_string() };
        if name != "self" {
            before.push(name.to_string());
        }
        self.uses.insert(alias, before.clone());
        self.path(before, name.span());
    }
}

impl<'ast> Visit<'ast> for Written {
    fn visit_item(&mut self, item: &'ast Item) {
        if !is_for_tests(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !is_for_tests(attributes_in_impl(item)) {
            visit::visit_impl_item(self, item);
        }
    }

    // Neither `pub(super)` nor a derive is an import; a module in a function is none that another could name.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}
    fn visit_attribute(&mut self, _: &'ast Attribute) {}
    fn visit_item_mod(&mut self, _: &'ast ItemMod) {}

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        if item.leading_colon.is_none() {
            self.use_tree(&item.tree, Vec::new());
        }
    }

    fn visit_path(&mut self, path: &'ast Path) {
        if let Some(first) = path.segments.first() {
            self.path(path.segments.iter().map(|segment| segment.ident.to_string()).collect(), first.ident.span());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        self.tokens(call.tokens.clone());
    }
}

impl Written {
    /// Finds `a::b::c` among the tokens of a macro, which is not parsed.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut names: Vec<String> = Vec::new();
        let mut start = Span::call_site();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(ident) if colons == 2 && !names.is_empty() => {
                    names.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Ident(ident) => {
                    self.path(std::mem::take(&mut names), start);
                    names.push(ident.to_string());
                    start = ident.span();
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                other => {
                    self.path(std::mem::take(&mut names), start);
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.tokens(group.stream());
                    }
                }
            }
        }
        self.path(names, start);
    }
}

/// Finds the modules that a path means.
struct Names<'a> {
    modules: &'a [Module],
    written: &'a [Written],
    numbers: HashMap<&'a [String], usize>,
}

impl<'a> Names<'a> {
    fn new(modules: &'a [Module], written: &'a [Written]) -> Self {
        let numbers = modules.iter().enumerate().map(|(number, module)| (&module.path[..], number)).collect();
        Self { modules, written, numbers }
    }

    /// The module that has the last name of a path, after those that only pass a name on. Empty for another crate's
    /// path.
    fn meant(&self, from: usize, path: &[String], detours: usize) -> Vec<usize> {
        let Some((first, mut rest)) = path.split_first() else { return Vec::new() };
        let mut at = match first.as_str() {
            "crate" => 0,
            "self" => from,
            "super" => self.parent(from),
            name => match (self.child(from, name), self.written[from].uses.get(name)) {
                (Some(child), _) => child,
                (None, Some(used)) if detours < 9 && used[0] != *name => {
                    return self.meant(from, &[used, rest].concat(), detours + 1);
                }
                _ => return Vec::new(),
            },
        };
        while let Some((name, after)) = rest.split_first() {
            if name == "super" {
                at = self.parent(at);
            } else if let Some(child) = self.child(at, name) {
                at = child;
            } else {
                return [vec![at], self.passed_on(at, name, after, detours)].concat();
            }
            rest = after;
        }
        vec![at]
    }

    /// The modules that a module has a name from, if the name is not its own.
    fn passed_on(&self, at: usize, name: &str, after: &[String], detours: usize) -> Vec<usize> {
        match self.written[at].uses.get(name) {
            Some(used) if detours < 9 => self.meant(at, &[used, after].concat(), detours + 1),
            _ => Vec::new(),
        }
    }

    fn child(&self, of: usize, name: &str) -> Option<usize> {
        let path = [&self.modules[of].path[..], &[name.to_owned()]].concat();
        self.numbers.get(&path[..]).copied()
    }

    fn parent(&self, of: usize) -> usize {
        let path = &self.modules[of].path;
        self.numbers[&path[..path.len().saturating_sub(1)]]
    }
}
