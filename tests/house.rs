//! The layout of `src/`: a folder (a *wing*) for each stage, imports that run down only, and files of one idea.
//!
//! The order of the wings is the order of the modules in `src/lib.rs`. All paths that start with `crate`, `super`, or a file of
//! the same folder count as imports, in `use` lines and in the code, in tests too.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Lines that a file of one idea has at most.
const LINES: usize = 450;

/// The source files by module path: `["mesh", "dual"]`; the file of a folder has the folder's path.
type Files = BTreeMap<Vec<String>, String>;

fn files() -> Files {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Files::new();
    collect(&root, &mut Vec::new(), &mut found);
    found
}

fn collect(folder: &Path, path: &mut Vec<String>, found: &mut Files) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let file = entry.expect("an entry").path();
        let name = file.file_stem().expect("a name").to_string_lossy();
        path.push(name.into_owned());
        if file.is_dir() {
            collect(&file, path, found);
        } else {
            let text = std::fs::read_to_string(&file).expect("a text");
            let is_folder = ["lib", "mod"].contains(&path[path.len() - 1].as_str());
            found.insert(path[..path.len() - usize::from(is_folder)].to_vec(), text);
        }
        path.pop();
    }
}

/// Without comments, and with strings emptied.
fn code(text: &str) -> String {
    let mut code = String::new();
    for line in text.lines() {
        let mut in_string = false;
        let mut chars = line.chars().peekable();
        while let Some(c) = chars.next() {
            match c {
                '\\' if in_string => drop(chars.next()),
                // A character, not a string's end.
                '\'' if !in_string && chars.peek() == Some(&'"') => drop(chars.next()),
                '"' => in_string = !in_string,
                '/' if !in_string && chars.peek() == Some(&'/') => break,
                _ if in_string => {}
                c => code.push(c),
            }
        }
        code.push('\n');
    }
    // Who may see something is no import.
    let mut parts = code.split("pub(in ");
    let first = parts.next().unwrap_or_default().to_string();
    parts.fold(first, |code, part| {
        code + part.split_once(')').map_or("", |(_, after)| after)
    })
}

/// All paths of a code as lists of names, those in braces one by one: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(start) = rest.find(|c: char| c.is_alphabetic() || c == '_') {
        rest = &rest[start..];
        rest = path(rest, &mut Vec::new(), &mut found);
    }
    found
}

/// Reads the path that `rest` starts with, below `prefix`, and returns what follows it.
fn path<'a>(rest: &'a str, prefix: &mut Vec<String>, found: &mut Vec<Vec<String>>) -> &'a str {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let end = rest.find(|c| !is_name(c)).unwrap_or(rest.len());
    prefix.push(rest[..end].to_string());
    let mut rest = &rest[end..];
    if let Some(below) = rest.strip_prefix("::") {
        rest = below;
        if below.starts_with(is_name) {
            rest = path(below, prefix, found);
        } else if let Some(mut group) = below.strip_prefix('{') {
            loop {
                group = group.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
                if let Some(after) = group.strip_prefix('}') {
                    rest = after;
                    break;
                }
                // A name, a glob, or `as` and its name, which lead nowhere.
                group = match group.starts_with(is_name) {
                    true => path(group, prefix, found),
                    false => group.get(1..).unwrap_or(""),
                };
            }
        } else {
            found.push(prefix.clone());
        }
    } else {
        found.push(prefix.clone());
    }
    prefix.pop();
    rest
}

/// The modules that a file imports from.
fn imports(module: &[String], text: &str, files: &Files) -> BTreeSet<Vec<String>> {
    let code = code(text);
    // What is `super` to a file's tests is the file itself.
    let (body, tests) = code.split_once("mod tests {").unwrap_or((&code, ""));
    let in_body = paths(body).into_iter().map(|path| (path, false));
    let in_tests = paths(tests).into_iter().map(|path| (path, true));
    let mut found = BTreeSet::new();
    for (path, in_tests) in in_body.chain(in_tests) {
        // A word alone leads nowhere: `pub(crate)`, a declaration, a variable.
        if path.len() == 1 {
            continue;
        }
        let (from, below): (&[String], &[String]) = match path[0].as_str() {
            "crate" => (&[], &path[1..]),
            "super" if in_tests => continue,
            "super" => {
                let up = path.iter().take_while(|name| *name == "super").count();
                (&module[..module.len() - up], &path[up..])
            }
            // A file below this one, or a name from elsewhere.
            _ => (module, &path[..]),
        };
        let mut target = [from, below].concat();
        while !files.contains_key(&target) {
            target.pop();
        }
        let is_relative = path[0] != "crate" && path[0] != "super";
        if target != module && !(is_relative && target.len() <= module.len()) {
            found.insert(target);
        }
    }
    found
}

fn arrows() -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let files = files();
    let of = |(module, text): (&Vec<String>, &String)| {
        let imports = imports(module, text, &files);
        (module.clone(), imports)
    };
    files.iter().map(of).collect()
}

/// The wings in the order in which `src/lib.rs` names them.
fn wings() -> Vec<String> {
    let root = code(&files()[&vec![]]);
    let words: Vec<&str> = root.split_whitespace().collect();
    let modules = words.windows(2).filter(|pair| pair[0] == "mod");
    modules
        .map(|pair| pair[1].trim_end_matches(';').to_string())
        .collect()
}

#[test]
fn wings_import_only_those_that_data_came_through_before() {
    let wings = wings();
    let place = |name: &String| wings.iter().position(|wing| wing == name);
    let mut wrong = String::new();
    for (module, imports) in arrows() {
        let Some(wing) = module.first() else { continue };
        for import in imports {
            let (from, to) = (module.join("::"), import.join("::"));
            match import.first() {
                None => writeln!(
                    wrong,
                    "{from} takes a name from the crate's root: name the wing that has it"
                ),
                Some(other) if place(other) > place(wing) => writeln!(
                    wrong,
                    "{from} imports {to}, but data flows from {wing} to {other}: move what both need to the wing that \
                     comes first, or to base"
                ),
                Some(_) => Ok(()),
            }
            .expect("text");
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    assert!(wings.len() > 10 && wings[0] == "base", "{wings:?}");
}

#[test]
fn no_files_import_each_other() {
    let mut arrows = arrows();
    // The root names everything so that users of the crate find it; nothing inside imports it.
    arrows.remove(&vec![]);
    let reached = |start: &Vec<String>| {
        let (mut reached, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(module) = open.pop() {
            let imports = arrows.get(module).into_iter().flatten();
            open.extend(imports.filter(|import| reached.insert((*import).clone())));
        }
        reached
    };
    let reached: BTreeMap<_, _> = arrows
        .keys()
        .map(|module| (module, reached(module)))
        .collect();
    let mut circle = String::new();
    for (module, imports) in &arrows {
        let back = imports.iter().filter(|import| {
            reached
                .get(import)
                .is_some_and(|reached| reached.contains(module))
        });
        for import in back {
            writeln!(circle, "{} <- {}", module.join("::"), import.join("::")).expect("text");
        }
    }
    assert!(
        circle.is_empty(),
        "these import each other in a circle: give what both need, mostly a type, a file of its own\n{circle}"
    );
}

#[test]
fn a_file_is_one_idea() {
    let long: Vec<String> = files()
        .iter()
        .filter(|(_, text)| text.lines().count() > LINES)
        .map(|(module, text)| format!("{}: {} lines", module.join("::"), text.lines().count()))
        .collect();
    assert!(
        long.is_empty(),
        "over {LINES} lines are more than one idea: split by what a reader looks for\n{}",
        long.join("\n")
    );
}

/// What the reading of paths rests on.
#[test]
fn paths_are_read_as_the_compiler_reads_them() {
    let code = code(
        "use crate::a::{self, b::{C, d}, e as f}; // crate::g\nlet x = \"crate::h\"; super::i::j(k)",
    );
    let found: Vec<String> = paths(&code).iter().map(|path| path.join("::")).collect();
    for path in [
        "crate::a::self",
        "crate::a::b::C",
        "crate::a::b::d",
        "crate::a::e",
        "super::i::j",
    ] {
        assert!(
            found.iter().any(|found| found == path),
            "{path} in {found:?}"
        );
    }
    assert!(
        !found
            .iter()
            .any(|path| path.contains('g') || path.contains('h'))
    );
}
