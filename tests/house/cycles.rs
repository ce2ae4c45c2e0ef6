//! The modules of a crate do not import one another in a circle.
//!
//! A module stands for all that it contains. So the children of one parent are compared with each other: an import from
//! somewhere in `a` to somewhere in `b` is an edge from `a` to `b`. A parent and its descendants may import each other:
//! the parent is the whole, and its children are the parts.

use crate::expect_none;
use crate::imports::{Import, imports};
use crate::source::{Module, modules, modules_of};
use crate::workspace::crates;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

#[test]
fn no_two_modules_import_each_other_in_a_circle() {
    let targets =
        crates().into_iter().flat_map(|krate| krate.targets.into_iter().map(move |file| (krate.name.clone(), file)));
    let wrong: Vec<_> = targets.flat_map(|(name, file)| cycles_of(&name, &modules(&file))).collect();
    expect_none(
        &wrong,
        "These modules cannot be understood one by one. Move the item that closes the circle to the module that owns it, below \
         both, or pass it as an argument.",
    );
}

/// The circles of a crate, each as a text with one import for each step.
fn cycles_of(name: &str, modules: &[Module]) -> Vec<String> {
    let imports = imports(modules);
    let mut graphs: BTreeMap<&[String], Graph> = BTreeMap::new();
    for import in &imports {
        let (from, to) = (&modules[import.from].path, &modules[import.to].path);
        let common = from.iter().zip(to).take_while(|(one, other)| one == other).count();
        if let (Some(one), Some(other)) = (from.get(common), to.get(common)) {
            graphs.entry(&from[..common]).or_default().entry(one).or_default().entry(other).or_insert(import);
        }
    }
    let told = |(parent, graph): (&[String], Graph)| {
        let circles = circles(&graph);
        circles.iter().map(|circle| told(name, parent, circle, modules)).collect::<Vec<_>>()
    };
    graphs.into_iter().flat_map(told).collect()
}

/// The imports between the children of one module: from, to, one import.
type Graph<'a> = BTreeMap<&'a str, BTreeMap<&'a str, &'a Import>>;

/// The shortest circle through each module that is in one, each circle once.
fn circles<'a>(graph: &Graph<'a>) -> Vec<Vec<&'a Import>> {
    let mut seen = BTreeSet::new();
    let shortest = graph.keys().filter_map(|start| shortest_back(graph, start));
    let new = shortest.filter(|(names, _)| seen.insert(names.iter().copied().collect::<BTreeSet<_>>()));
    new.map(|(_, imports)| imports).collect()
}

/// The shortest way from a module back to itself: the modules, and the imports.
fn shortest_back<'a>(graph: &Graph<'a>, start: &'a str) -> Option<(Vec<&'a str>, Vec<&'a Import>)> {
    let mut ways = VecDeque::from([(start, Vec::new(), Vec::new())]);
    let mut reached = BTreeSet::new();
    while let Some((at, names, imports)) = ways.pop_front() {
        for (next, import) in graph.get(at).into_iter().flatten() {
            let (names, imports) = ([&names[..], &[*next]].concat(), [&imports[..], &[*import]].concat());
            if *next == start {
                return Some((names, imports));
            }
            if reached.insert(*next) {
                ways.push_back((*next, names, imports));
            }
        }
    }
    None
}

fn told(name: &str, parent: &[String], circle: &[&Import], modules: &[Module]) -> String {
    let place = [&[name.to_owned()], parent].concat().join("::");
    let steps = circle.iter().map(|import| {
        let (from, to) = (&modules[import.from], &modules[import.to]);
        let part = |module: &Module| module.path[parent.len()..].join("::");
        format!("    {} uses {}: {}:{}: {}", part(from), part(to), from.name(), import.line, import.path)
    });
    format!("{place} has a circle:\n{}", steps.collect::<Vec<_>>().join("\n"))
}

#[test]
fn circles_are_found_whatever_the_way_that_a_name_takes() {
    for (code, circles) in [
        ("mod a { use crate::b::X; } mod b { use super::a::Y; }", 1),
        ("mod a { use crate::X; } mod b { fn f() { crate::a::y() } } pub use b::X;", 1),
        ("mod a { fn f() { vec![super::b::X]; } } mod b { mod c { use crate::a::Y as Z; } }", 1),
        ("mod a { use crate::b::X; } mod b { use crate::c::Y; } mod c { use crate::a::Z; }", 1),
        ("mod a { mod b { use super::c::X; } mod c { use super::b::X; } }", 1),
        ("mod a { use crate::b::X; } mod b { use super::Y; } struct Y;", 0),
        ("mod a { mod b { use super::X; } use b::Y; struct X; }", 0),
        ("mod a { use crate::b::X; } mod b { #[cfg(test)] mod tests { use crate::a::Y; } }", 0),
    ] {
        assert_eq!(cycles_of("it", &modules_of(code)).len(), circles, "{code}");
    }
}
