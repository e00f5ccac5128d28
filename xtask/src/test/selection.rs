//! What `cargo xtask test` is asked to run.

use crate::shell::Result;

/// A check that `--only` can name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Check {
    Fmt,
    Clippy,
    Native,
    Wasm,
    Types,
    Pkg,
    Element,
    Page,
    Cluster,
}

impl Check {
    /// The quick ones first.
    const ALL: [(Check, &str); 9] = [
        (Check::Fmt, "fmt"),
        (Check::Clippy, "clippy"),
        (Check::Native, "native"),
        (Check::Wasm, "wasm"),
        (Check::Types, "types"),
        (Check::Pkg, "pkg"),
        (Check::Element, "element"),
        (Check::Page, "page"),
        (Check::Cluster, "cluster"),
    ];

    fn named(name: &str) -> Option<Self> {
        let known = Check::ALL.iter().find(|(_, known)| *known == name);
        known.map(|(check, _)| *check)
    }

    fn names() -> String {
        Check::ALL.map(|(_, name)| name).join(",")
    }

    /// Whether one file of it can be run alone.
    fn has_files(self) -> bool {
        !matches!(self, Check::Fmt | Check::Clippy | Check::Types)
    }

    /// These read what `cargo xtask build` writes.
    pub fn needs_package(self) -> bool {
        matches!(
            self,
            Check::Types | Check::Pkg | Check::Element | Check::Page | Check::Cluster
        )
    }
}

/// What the command line asks for.
#[derive(Debug, PartialEq)]
pub enum Selection {
    Checks(Vec<Check>),
    /// One file of a check, or its tests of one name.
    File {
        check: Check,
        file: String,
        name: Option<String>,
    },
}

impl Selection {
    pub fn parse(options: &[String]) -> Result<Self> {
        let words: Vec<&str> = options.iter().map(String::as_str).collect();
        match words[..] {
            [] => Ok(Self::Checks(Check::ALL.map(|(check, _)| check).to_vec())),
            ["--only", list] => list
                .split(',')
                .map(Check::named)
                .collect::<Option<Vec<Check>>>()
                .map(Self::Checks)
                .ok_or_else(|| {
                    format!(
                        "`--only {list}` names something else than {}",
                        Check::names()
                    )
                }),
            [part, ref file @ ..] if !part.starts_with('-') && file.len() <= 2 => {
                let check = Check::named(part).ok_or_else(|| {
                    format!(
                        "there is no part `{part}` to test: expected {}",
                        Check::names()
                    )
                })?;
                match *file {
                    [] => Ok(Self::Checks(vec![check])),
                    _ if !check.has_files() => Err(format!("`{part}` is tested as a whole")),
                    [file] => Ok(Self::file(check, file, None)),
                    [file, name, ..] => Ok(Self::file(check, file, Some(name))),
                }
            }
            _ => Err("`test` takes `--only fmt,clippy,…`, or `PART [FILE [NAME]]`".into()),
        }
    }

    fn file(check: Check, file: &str, name: Option<&str>) -> Self {
        Self::File {
            check,
            file: file.into(),
            name: name.map(String::from),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn select(options: &[&str]) -> Result<Selection> {
        let options: Vec<String> = options.iter().map(|option| option.to_string()).collect();
        Selection::parse(&options)
    }

    #[test]
    fn everything_is_checked_unless_told() {
        let all = Check::ALL.map(|(check, _)| check).to_vec();
        assert_eq!(select(&[]), Ok(Selection::Checks(all)));
        assert_eq!(
            select(&["--only", "page,fmt"]),
            Ok(Selection::Checks(vec![Check::Page, Check::Fmt]))
        );
    }

    #[test]
    fn one_part_or_one_file_of_it() {
        assert_eq!(select(&["wasm"]), Ok(Selection::Checks(vec![Check::Wasm])));
        assert_eq!(
            select(&["pkg", "cli"]),
            Ok(Selection::file(Check::Pkg, "cli", None))
        );
        assert_eq!(
            select(&["native", "fcm", "eq_5"]),
            Ok(Selection::file(Check::Native, "fcm", Some("eq_5")))
        );
    }

    #[test]
    fn an_unknown_check_is_refused() {
        for (options, named) in [
            (&["--only", "fmt,lint"][..], "fmt,lint"),
            (&["lint"], "`lint`"),
            (&["fmt", "src"], "`fmt`"),
            (&["--only"], "PART"),
            (&["pkg", "cli", "a", "b"], "PART"),
        ] {
            let error = select(options).unwrap_err();
            assert!(error.contains(named), "{error}");
        }
    }
}
