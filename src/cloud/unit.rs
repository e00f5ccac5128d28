//! Units of length, as files and people name them.

/// What a coordinate of 1 is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Millimetre.
    Millimetre,
    /// Centimetre.
    Centimetre,
    /// Metre.
    Metre,
    /// International inch, 25.4 mm.
    Inch,
    /// International foot, 0.3048 m.
    Foot,
    /// Foot of the US survey, 1200/3937 m.
    SurveyFoot,
    /// Degree of longitude and latitude, which is no length.
    Degree,
}

impl Unit {
    /// All of them.
    pub const ALL: [Unit; 7] = [
        Unit::Millimetre,
        Unit::Centimetre,
        Unit::Metre,
        Unit::Inch,
        Unit::Foot,
        Unit::SurveyFoot,
        Unit::Degree,
    ];

    /// As `unit` in the JS interface: `mm`, `cm`, `m`, `in`, `ft`, `us-ft`, `deg`.
    pub fn name(self) -> &'static str {
        match self {
            Unit::Millimetre => "mm",
            Unit::Centimetre => "cm",
            Unit::Metre => "m",
            Unit::Inch => "in",
            Unit::Foot => "ft",
            Unit::SurveyFoot => "us-ft",
            Unit::Degree => "deg",
        }
    }

    /// The unit of that [`Unit::name`].
    pub fn from_name(name: &str) -> Option<Unit> {
        Unit::ALL.into_iter().find(|unit| unit.name() == name)
    }

    /// Its length in metres; `None` of a degree.
    pub fn metres(self) -> Option<f64> {
        match self {
            Unit::Millimetre => Some(0.001),
            Unit::Centimetre => Some(0.01),
            Unit::Metre => Some(1.0),
            Unit::Inch => Some(0.0254),
            Unit::Foot => Some(0.3048),
            Unit::SurveyFoot => Some(1200.0 / 3937.0),
            Unit::Degree => None,
        }
    }

    /// The unit of that length in metres, to one part in a million: the two feet are two parts apart.
    pub fn of_metres(metres: f64) -> Option<Unit> {
        let near = |unit: &Unit| {
            unit.metres()
                .is_some_and(|own| (metres / own - 1.0).abs() < 1e-6)
        };
        Unit::ALL.into_iter().find(near)
    }

    /// How many `other` one of these is; 1 exactly where they are the same, `None` where one is no length.
    pub fn per(self, other: Unit) -> Option<f64> {
        let (own, others) = (self.metres()?, other.metres()?);
        // Units of one system differ by integers, which division of their lengths in metres may miss by a rounding.
        let (more, less) = (own / others, others / own);
        Some(match (more.round(), less.round()) {
            (whole, _) if whole >= 1.0 && (more - whole).abs() < 1e-9 * whole => whole,
            (_, whole) if whole >= 1.0 && (less - whole).abs() < 1e-9 * whole => 1.0 / whole,
            _ => more,
        })
    }
}
