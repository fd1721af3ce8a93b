//! Files that import each other in a circle, crate by crate.
//!
//! An import is one of the file that defines what it names: a file that only lists modules and exports their names
//! is no station on the way. Methods of one type that are spread over files do not count, since no import tells of them.

mod source;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::Path;

use source::Source;

use crate::files;

/// A module by the names that lead to it from the root of its crate.
type Module = Vec<String>;

/// The circles of each crate.
pub fn check(root: &Path) -> Vec<String> {
    let files = match files::list(root) {
        Ok(files) => files,
        Err(problem) => return vec![problem],
    };
    let mut crates: BTreeMap<String, Tree> = BTreeMap::new();
    for file in files.iter().filter(|file| files::is(file, "rs")) {
        let Some((folder, module)) = place(file) else {
            continue;
        };
        let text = std::fs::read_to_string(root.join(file)).unwrap_or_default();
        let name = file.display().to_string();
        let tree = crates.entry(folder).or_default();
        tree.files.insert(module, (name, Source::new(&text)));
    }
    let circles = crates.values_mut().flat_map(Tree::circles);
    let told = circles.map(|circle| {
        format!(
            "files import each other in a circle: {}",
            circle.join(" → ")
        )
    });
    told.collect()
}

/// Folder of the crate and module of a source file; `None` of files that are no part of a library.
fn place(file: &Path) -> Option<(String, Module)> {
    let text = file.to_str()?.strip_suffix(".rs")?;
    let (folder, inner) = text.split_once("/src/")?;
    let mut module: Module = inner.split('/').map(str::to_owned).collect();
    if matches!(
        module.last().map(String::as_str),
        Some("mod" | "lib" | "main")
    ) {
        module.pop();
    }
    Some((folder.to_owned(), module))
}

/// The modules of a crate.
#[derive(Default)]
struct Tree {
    files: BTreeMap<Module, (String, Source)>,
}

impl Tree {
    /// For each group of files that reach each other one of its shortest circles.
    fn circles(&mut self) -> Vec<Vec<String>> {
        self.drop_tests();
        let edges: BTreeMap<&Module, BTreeSet<Module>> = self
            .files
            .keys()
            .map(|module| (module, self.uses(module)))
            .collect();
        let mut told = BTreeSet::new();
        let mut circles = Vec::new();
        for module in self.files.keys() {
            let Some(circle) = shortest(module, &edges) else {
                continue;
            };
            if circle.iter().any(|station| told.contains(station)) {
                continue;
            }
            told.extend(circle.iter().cloned());
            let names = circle.iter().chain([module]);
            circles.push(names.map(|module| self.files[module].0.clone()).collect());
        }
        circles
    }

    fn drop_tests(&mut self) {
        let of_tests: Vec<Module> = self
            .files
            .iter()
            .flat_map(|(module, (_, source))| {
                let inner = source.of_tests.iter();
                inner.map(|name| [module.as_slice(), std::slice::from_ref(name)].concat())
            })
            .collect();
        let is_test = |module: &Module| of_tests.iter().any(|test| module.starts_with(test));
        self.files.retain(|module, _| !is_test(module));
    }

    /// Modules that define what a module names.
    fn uses(&self, module: &Module) -> BTreeSet<Module> {
        let source = &self.files[module].1;
        if source.lists {
            return BTreeSet::new();
        }
        // a name that the file only gives on is not used in it
        let used = |name: &String| !source.exports.contains(name) || source.names.contains(name);
        let imports = source.imports.iter().filter(|(name, _)| used(name));
        let imports = imports.map(|(_, path)| path);
        let named = imports.chain(&source.globs).chain(&source.paths);
        let mut found: BTreeSet<Module> = named
            .filter_map(|path| self.defining(module, path, 0))
            .filter(|found| !self.files[found].1.lists)
            .collect();
        found.remove(module);
        found
    }

    /// The module that defines what a path names as it stands in `module`; `None` if that is not in this crate.
    fn defining(&self, module: &Module, path: &[String], depth: usize) -> Option<Module> {
        let (mut here, mut rest) = (module.clone(), path);
        match path.first()?.as_str() {
            "crate" => (here, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|name| name == "super") {
                    here.pop();
                    rest = &rest[1..];
                }
            }
            name => {
                let source = &self.files.get(module)?.1;
                let is_local = source.children.iter().any(|child| child == name)
                    || source
                        .imports
                        .get(name)
                        .is_some_and(|path| path[0] != *name);
                if !is_local {
                    return None;
                }
            }
        }
        while let Some((name, behind)) = rest.split_first() {
            let (_, source) = self.files.get(&here)?;
            let inner = [here.as_slice(), std::slice::from_ref(name)].concat();
            if self.files.contains_key(&inner) {
                (here, rest) = (inner, behind);
                continue;
            }
            return match source.imports.get(name) {
                Some(import) if depth < 16 => {
                    let path = [import.as_slice(), behind].concat();
                    self.defining(&here, &path, depth + 1)
                }
                _ => Some(here),
            };
        }
        Some(here)
    }
}

/// The shortest circle through a module, begun with it.
fn shortest(module: &Module, edges: &BTreeMap<&Module, BTreeSet<Module>>) -> Option<Vec<Module>> {
    let mut before: BTreeMap<&Module, &Module> = BTreeMap::new();
    let mut queue = VecDeque::from([module]);
    while let Some(now) = queue.pop_front() {
        for next in &edges[now] {
            if next == module {
                let mut circle = vec![now.clone()];
                while let Some(&station) = before.get(&circle[circle.len() - 1]) {
                    circle.push(station.clone());
                }
                circle.reverse();
                return Some(circle);
            }
            if !before.contains_key(next) {
                before.insert(next, now);
                queue.push_back(next);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        let mut tree = Tree::default();
        for (name, text) in files {
            let (_, module) = place(Path::new(&format!("crates/x/src/{name}"))).unwrap();
            let source = Source::new(text);
            tree.files.insert(module, ((*name).to_owned(), source));
        }
        tree.circles()
            .iter()
            .map(|circle| circle.join(" → "))
            .collect()
    }

    #[test]
    fn a_list_is_no_station_but_a_parent_that_defines_is() {
        let list = "mod a;\nmod b;\npub use a::A;\npub use b::B;";
        let (a, b) = ("struct A;", "use crate::A;\nstruct B(A);");
        assert!(circles(&[("lib.rs", list), ("a.rs", a), ("b.rs", b)]).is_empty());
        let back = "struct A(Option<Box<crate::B>>);";
        assert_eq!(
            circles(&[("lib.rs", list), ("a.rs", back), ("b.rs", b)]),
            ["a.rs → b.rs → a.rs"]
        );
        let defines = "mod b;\npub struct A;\nfn f() -> usize { b::g() }";
        assert_eq!(
            circles(&[
                ("a/mod.rs", defines),
                ("a/b.rs", "use super::A;\nstruct B(A);")
            ]),
            ["a/mod.rs → a/b.rs → a/mod.rs"]
        );
    }

    #[test]
    fn tests_may_name_what_they_test() {
        let a = "#[cfg(test)]\nmod tests;\nuse crate::b::B;\npub struct A;";
        let b = "pub struct B;\n#[cfg(test)]\nmod tests { use crate::a::A; }";
        let tests = "use super::*;\nuse crate::a::A;";
        assert!(circles(&[("a.rs", a), ("b.rs", b), ("a/tests.rs", tests)]).is_empty());
    }
}
