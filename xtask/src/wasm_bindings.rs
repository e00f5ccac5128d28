//! The JavaScript that wasm-bindgen writes, as a function that makes instances.
//!
//! As written it is a module that holds one instance for ever: a page that has made and left a hundred engines would
//! still hold the memory of a hundred.

use std::fs;
use std::path::Path;

use crate::shell::Result;

/// Rewrites a module of wasm-bindgen's in place.
pub fn make_factory(file: &Path) -> Result<()> {
    let unreadable = |error| format!("{} cannot be rewritten: {error}", file.display());
    let module = fs::read_to_string(file).map_err(unreadable)?;
    fs::write(file, factory(&module)?).map_err(unreadable)
}

/// `export function f() {…}` for each `f` to one exported function that gives an object of all of them, and `instantiate`.
fn factory(module: &str) -> Result<String> {
    let mut body = String::new();
    let mut names = Vec::new();
    let mut started = false;
    for line in module.lines() {
        if let Some(function) = line.strip_prefix("export function ") {
            let name = function.split('(').next().unwrap_or_default();
            names.push(name);
            body.push_str(&format!("function {function}\n"));
        } else if line == "export { initSync, __wbg_init as default };" {
            started = true;
        } else if line.starts_with("export ") || line.starts_with("import ") {
            return Err(format!(
                "wasm-bindgen writes something new, `{line}`: teach xtask/src/wasm_bindings.rs what it means"
            ));
        } else if !line.starts_with("/* @ts-self-types") {
            body.push_str(line);
            body.push('\n');
        }
    }
    if !started || names.is_empty() {
        return Err("wasm-bindgen writes no module that xtask/src/wasm_bindings.rs knows".into());
    }
    let names = names.join(", ");
    Ok(format!(
        "// @ts-nocheck\n/** @returns {{any}} */\nexport function makeBindings() {{\n{body}\nreturn {{ instantiate: __wbg_init, {names} }};\n}}\n"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_is_given_by_the_factory() {
        let module = "/* @ts-self-types=\"./a.d.ts\" */\nexport function one(a) {\n}\nlet wasm;\n\
            export function two() {\n}\nexport { initSync, __wbg_init as default };\n";
        let made = factory(module).unwrap();
        assert_eq!(made.matches("export").count(), 1);
        assert!(made.contains("\nfunction one(a) {\n}\nlet wasm;\nfunction two() {"));
        assert!(made.ends_with("return { instantiate: __wbg_init, one, two };\n}\n"));
    }

    #[test]
    fn what_is_not_known_is_refused() {
        assert!(
            factory("export class Cloud {\n")
                .unwrap_err()
                .contains("export class Cloud")
        );
        assert!(factory("import * as snippet from 'x';\n").is_err());
        assert!(factory("let wasm;\n").is_err());
    }
}
