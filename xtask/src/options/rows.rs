//! The rows of `src/base/params/table.rs` as data. `src/base/params/rows.rs` makes types of the same rows.

/// A choice, an amount or a set of options.
pub struct Item {
    /// Of the type in Rust.
    pub name: &'static str,
    pub docs: &'static [&'static str],
    pub body: Body,
}

pub enum Body {
    Choice(Vec<Choice>),
    /// `'auto'` or a number: what either means.
    Auto {
        auto: &'static [&'static str],
        number: &'static [&'static str],
    },
    /// Exactly one of these.
    Amount(Vec<Row>),
    Options(Vec<Row>),
}

pub struct Choice {
    pub variant: &'static str,
    pub word: &'static str,
    /// On the page.
    pub label: Option<&'static str>,
    pub docs: &'static [&'static str],
}

/// One option, or one way to say an amount.
pub struct Row {
    pub kind: &'static str,
    pub name: &'static str,
    pub ty: &'static str,
    pub default: &'static str,
    pub docs: &'static [&'static str],
    pub facets: Vec<Facet>,
}

pub enum Facet {
    /// `above 0 to 1`.
    Range(&'static str),
    /// What holds by default, by the method's variant.
    Follows(Vec<(&'static str, &'static str)>),
    /// What holds by default, in words.
    Default(&'static str),
    /// Where the page begins, of an amount.
    Start(&'static str),
    Flag(&'static str),
    Field(Field),
}

/// A control on the page.
pub struct Field {
    pub label: &'static str,
    pub hint: &'static str,
    /// The slider's ends.
    pub slider: Option<(&'static str, &'static str)>,
    pub percent: bool,
}

/// What a row accepts.
pub struct Range {
    pub auto: bool,
    pub low: String,
    pub low_included: bool,
    pub high: Option<String>,
    pub high_included: bool,
}

impl Row {
    pub fn range(&self) -> Option<Range> {
        let text = self.find(|facet| match facet {
            Facet::Range(text) => Some(*text),
            _ => None,
        })?;
        let numbers = text.strip_prefix("auto or ");
        let words: Vec<&str> = numbers.unwrap_or(text).split_whitespace().collect();
        let (low, high) = match words[..] {
            [_, low] => (low, None),
            [_, low, _, high] => (low, Some(high)),
            _ => panic!("{}: no range is written `{text}`", self.name),
        };
        Some(Range {
            auto: numbers.is_some(),
            low: super::number(low),
            low_included: words[0] == "from",
            high: high.map(super::number),
            high_included: words.get(2) != Some(&"below"),
        })
    }

    /// The defaults of the two methods.
    pub fn follows(&self) -> Option<&[(&'static str, &'static str)]> {
        self.find(|facet| match facet {
            Facet::Follows(values) => Some(&values[..]),
            _ => None,
        })
    }

    pub fn default_in_words(&self) -> Option<&'static str> {
        self.find(|facet| match facet {
            Facet::Default(words) => Some(*words),
            _ => None,
        })
    }

    pub fn start(&self) -> Option<&'static str> {
        self.find(|facet| match facet {
            Facet::Start(value) => Some(*value),
            _ => None,
        })
    }

    pub fn flag(&self) -> Option<&'static str> {
        self.find(|facet| match facet {
            Facet::Flag(words) => Some(*words),
            _ => None,
        })
    }

    pub fn field(&self) -> Option<&Field> {
        self.find(|facet| match facet {
            Facet::Field(field) => Some(field),
            _ => None,
        })
    }

    fn find<'a, T>(&'a self, pick: impl Fn(&'a Facet) -> Option<T>) -> Option<T> {
        self.facets.iter().find_map(pick)
    }
}

macro_rules! table {
    ($( $(#[doc = $doc:literal])* $sort:ident $name:ident { $($rows:tt)* } )*) => {
        fn table() -> Vec<rows::Item> {
            vec![ $( rows::Item { name: stringify!($name), docs: &[$($doc),*], body: body!($sort $($rows)*) } ),* ]
        }
    };
}

macro_rules! body {
    (choice $( $(#[doc = $doc:literal])* $variant:ident $word:literal $($label:literal)?, )*) => {
        rows::Body::Choice(vec![ $( rows::Choice {
            variant: stringify!($variant),
            word: $word,
            label: None$(.or(Some($label)))?,
            docs: &[$($doc),*],
        } ),* ])
    };
    (auto $(#[doc = $auto:literal])* Auto "auto", $(#[doc = $number:literal])* $variant:ident,) => {
        rows::Body::Auto { auto: &[$($auto),*], number: &[$($number),*] }
    };
    (amount $(
        $(#[doc = $doc:literal])*
        $kind:ident $variant:ident: $ty:ty, $word:literal $(, $facet:ident($($fact:tt)*))*;
    )*) => {
        rows::Body::Amount(vec![ $( rows::Row {
            kind: stringify!($kind),
            name: $word,
            ty: stringify!($ty),
            default: "None",
            docs: &[$($doc),*],
            facets: vec![ $( facet!($facet $($fact)*) ),* ],
        } ),* ])
    };
    (options $(
        $(#[doc = $doc:literal])*
        $kind:ident $field:ident: $ty:ty = $default:expr $(, $facet:ident($($fact:tt)*))*;
    )*) => {
        rows::Body::Options(vec![ $( rows::Row {
            kind: stringify!($kind),
            name: stringify!($field),
            ty: stringify!($ty),
            default: stringify!($default),
            docs: &[$($doc),*],
            facets: vec![ $( facet!($facet $($fact)*) ),* ],
        } ),* ])
    };
}

macro_rules! facet {
    (range $($range:tt)*) => { rows::Facet::Range(stringify!($($range)*)) };
    (follows $($method:ident $value:literal),*) => { rows::Facet::Follows(vec![ $( (stringify!($method), stringify!($value)) ),* ]) };
    (default $words:literal) => { rows::Facet::Default($words) };
    (start $value:expr) => { rows::Facet::Start(stringify!($value)) };
    (flag $words:literal) => { rows::Facet::Flag($words) };
    (field $label:literal, $low:literal to $high:literal $(, $percent:ident)?) => {
        facet!(field $label, "", $low to $high $(, $percent)?)
    };
    (field $label:literal, $hint:literal $(, $low:literal to $high:literal $(, $percent:ident)?)?) => {
        rows::Facet::Field(rows::Field {
            label: $label,
            hint: $hint,
            slider: None$(.or(Some((stringify!($low), stringify!($high)))))?,
            percent: false$($(|| stringify!($percent) == "percent")?)?,
        })
    };
}
