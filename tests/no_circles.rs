//! Imports between files never run in a circle: data flows one way.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

type Graph = BTreeMap<PathBuf, BTreeSet<PathBuf>>;

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && path.file_name().unwrap() != "bin" {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// `a/b.rs` and `a/b/mod.rs` are the module a, b.
fn module(root: &Path, file: &Path) -> Vec<String> {
    let relative = file.strip_prefix(root).unwrap().with_extension("");
    let mut names: Vec<String> = relative
        .iter()
        .map(|part| part.to_str().unwrap().to_owned())
        .collect();
    let last = names.last().unwrap();
    if ["mod", "lib", "main"].contains(&last.as_str()) {
        names.pop();
    }
    names
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The names that braces list, without what follows them: of `a::b, c::{d, e}` a and c.
fn listed(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut items) = (0, 0, Vec::new());
    for (i, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => {
                items.push(&list[start..i]);
                break;
            }
            '}' => depth -= 1,
            ',' if depth == 0 => {
                items.push(&list[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    let first = |item: &'_ str| {
        item.trim()
            .find(|c| !is_name(c))
            .unwrap_or(item.trim().len())
    };
    items
        .iter()
        .map(|item| &item.trim()[..first(item)])
        .collect()
}

/// The paths that start with `crate`, `self` or `super`, as names.
fn paths(code: &str) -> Vec<Vec<&str>> {
    let mut found = Vec::new();
    for start in ["crate::", "self::", "super::"] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| is_name(c) || c == ':') {
                continue;
            }
            let end = code[at..].find(|c| !is_name(c) && c != ':');
            let (path, rest) = code[at..].split_at(end.unwrap_or(code.len() - at));
            let names: Vec<_> = path.split("::").filter(|name| !name.is_empty()).collect();
            match rest.strip_prefix('{') {
                Some(list) => {
                    let all = listed(list).into_iter();
                    found.extend(all.map(|name| [&names[..], &[name]].concat()));
                }
                None => found.push(names),
            }
        }
    }
    found
}

/// The code without comments, with `self::` before paths that start with a child.
fn with_self(code: &str, children: &[&String]) -> String {
    let mut out = String::new();
    for line in code.lines().map(str::trim_start) {
        if line.starts_with("//") {
            continue;
        }
        let mut line = line.to_owned();
        for child in children {
            let path = format!("{child}::");
            let mut from = 0;
            while let Some(at) = line[from..].find(&path).map(|at| at + from) {
                let before = line[..at].chars().next_back();
                from = at + path.len();
                if !before.is_some_and(|c| is_name(c) || c == ':') {
                    line.insert_str(at, "self::");
                    from += "self::".len();
                }
            }
        }
        out += &line;
        out.push('\n');
    }
    out
}

fn imports(root: &Path) -> Graph {
    let mut files = Vec::new();
    rust_files(root, &mut files);
    let modules: BTreeMap<_, _> = files.iter().map(|f| (module(root, f), f)).collect();
    let mut graph = Graph::new();
    for file in &files {
        let text = std::fs::read_to_string(file).unwrap();
        // Tests may look at everything.
        let tests = ["#[cfg(test)]\nmod ", "#[cfg(all(test"];
        let end = tests.iter().filter_map(|start| text.find(start)).min();
        let code = &text[..end.unwrap_or(text.len())];
        let own = module(root, file);
        let children = modules
            .keys()
            .filter(|m| m.split_last().is_some_and(|(_, p)| p == own));
        let children: Vec<_> = children.filter_map(|m| m.last()).collect();
        let code = with_self(code, &children);
        let mut to = BTreeSet::new();
        for path in paths(&code) {
            let mut place = match path[0] {
                "crate" => Vec::new(),
                _ => own.clone(),
            };
            for &name in &path {
                match name {
                    "crate" | "self" => {}
                    "super" => drop(place.pop()),
                    _ => {
                        place.push(name.to_owned());
                        if !modules.contains_key(&place) {
                            place.pop();
                            break;
                        }
                    }
                }
            }
            // The root only declares and hands on; whoever takes types from there cannot be followed.
            let type_of_root = path[0] == "crate"
                && path
                    .get(1)
                    .is_some_and(|name| name.starts_with(char::is_uppercase));
            assert!(
                !type_of_root || root.ends_with("welkin"),
                "{}: {path:?}",
                file.display()
            );
            to.extend(
                modules
                    .get(&place)
                    .filter(|_| !place.is_empty())
                    .copied()
                    .cloned(),
            );
        }
        to.remove(file);
        graph.insert(file.clone(), to);
    }
    graph
}

/// Takes away files that import nothing of what is left, and those that nothing of it imports, until nothing changes.
fn circles(mut graph: Graph) -> Graph {
    loop {
        let left = graph.len();
        let imported: BTreeSet<_> = graph.values().flatten().cloned().collect();
        graph.retain(|file, to| !to.is_empty() && imported.contains(file));
        let files: BTreeSet<_> = graph.keys().cloned().collect();
        graph
            .values_mut()
            .for_each(|to| to.retain(|f| files.contains(f)));
        if graph.len() == left {
            return graph;
        }
    }
}

const ROOMS: [&str; 6] = [
    "src",
    "src/bin/welkin",
    "fitter/src",
    "tools/src",
    "tools/src/bin/compare",
    "tools/src/bin/motion",
];

#[test]
fn no_file_imports_itself_by_way_of_others() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut edges = 0;
    for room in ROOMS {
        let graph = imports(&here.join(room));
        assert!(graph.len() > 2, "{room}");
        edges += graph.values().map(BTreeSet::len).sum::<usize>();
        let left = circles(graph);
        assert!(left.is_empty(), "{room}: {left:#?}");
    }
    assert!(edges > 500, "{edges}");
}

#[test]
fn a_circle_is_found() {
    let graph = |edges: &[(&str, &str)]| -> Graph {
        let mut graph = Graph::new();
        for (from, to) in edges {
            graph.entry(from.into()).or_default().insert(to.into());
            graph.entry(to.into()).or_default();
        }
        graph
    };
    assert!(circles(graph(&[("a", "b"), ("b", "c"), ("a", "c")])).is_empty());
    assert_eq!(
        circles(graph(&[("a", "b"), ("b", "c"), ("c", "b")])).len(),
        2
    );
    let child = "b".to_owned();
    let code = "use b::Y;\nfn f() { b::g(); crate::b::h(); }\n// b::z\n";
    assert_eq!(
        with_self(code, &[&child]),
        "use self::b::Y;\nfn f() { self::b::g(); crate::b::h(); }\n"
    );
    assert_eq!(
        paths("use super::{a::b, c::{d, e}};"),
        [vec!["super", "a"], vec!["super", "c"]]
    );
    assert_eq!(
        paths("use crate::a::b; self::c(); xsuper::d"),
        [vec!["crate", "a", "b"], vec!["self", "c"]]
    );
}
