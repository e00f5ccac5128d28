//! What may not be as it should: doubts.

use crate::orient::account::{Account, Source};
use serde::Serialize;

/// Something about a result that may not be as it should, for machines and for people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Doubt {
    /// Stable, in kebab case.
    pub code: &'static str,
    /// A sentence.
    pub message: String,
    /// The share of the surface (0-1) that it is about, where that is known.
    pub share: Option<f64>,
}

/// Shares of the surface that are not worth a word.
const LITTLE: f64 = 0.01;
/// The share of what a sensor says that the result may contradict: grazing views and outlines.
const GRAZING: f64 = 0.03;
/// Sources that agree over less than this share disagree.
const AGREE: f64 = 0.8;
/// [`crate::orient::account::WeakestTie::strength`] under which a side is as good as a guess.
const WEAK: f64 = 0.3;

/// What may be wrong with the sides.
pub(crate) fn doubts(account: &Account) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let mut doubt = |code, share: f64, message: String| {
        doubts.push(Doubt {
            code,
            message,
            share: Some(share),
        });
    };
    if account.guessed > LITTLE {
        let share = percent(account.guessed);
        let message = format!("Which side is out is a guess for {share} of the surface.");
        doubt("side-guessed", account.guessed, message);
    }
    let mut disagree = 0.0;
    for said in &account.sources {
        let (name, is_sensor) = match said.source {
            Source::Normals => ("normals", false),
            Source::Viewpoints => ("viewpoints", true),
            Source::Camera => ("camera", true),
            _ => continue,
        };
        let against = 1.0 - said.agreement;
        if said.agreement < AGREE {
            disagree = f64::max(disagree, against);
        } else if is_sensor && against > GRAZING {
            let message = format!(
                "{} of what the {name} saw shows its inner side.",
                percent(against)
            );
            doubt("contradicts-sensor", against, message);
        }
    }
    if disagree > 0.0 {
        let message = format!(
            "What is known of the outer side contradicts itself or the surface over {} of it.",
            percent(disagree)
        );
        doubt("sources-disagree", disagree, message);
    }
    if let Some(tie) = account.weakest_tie.filter(|tie| tie.strength < WEAK) {
        let message = format!(
            "Next to nothing ties {} of the surface to the rest: it may be inside out.",
            percent(tie.share)
        );
        doubt("weak-tie", tie.share, message);
    }
    doubts
}
