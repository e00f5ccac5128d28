//! Which side is out: one sign a sub-domain (section 4.2, Algorithm 1).
//!
//! Sub-domains are joined by edges whose weight says how well their *fitted functions* agree ([`graph`]). The energy of signs
//! s is E = −Σ w_ab s_a s_b. [`Propagation::Paper`] is Algorithm 1 ([`paper`]): an advancing front with belief propagation on
//! local graphs. [`Propagation::Global`] lowers the energy over the whole graph ([`descent`]): a front that is wrong once
//! stays wrong.
//!
//! The energy knows nothing of out and in, and next to nothing across gaps that were never scanned. So the surface falls
//! into *parts* that are tied by more than a contact ([`parts`]), and each is turned as a whole ([`sides`]) by
//! - evidence: the cloud's normals, where it was seen from, checked before they are believed ([`evidence`], [`camera`]). It is
//!   a term h_a s_a of the energy, too;
//! - else the mean winding number over its own sites, ½ for what is closed, 0 for a sheet. (A volume about a centroid says
//!   nothing of an open surface: a disc that looks up counts negative below the centroid.)
//! - else up;
//! - its ties, and what is seen together from far away ([`seen`]).
//!
//! A closed component that lies in the solid of an odd number of others is a cave's wall, and looks into the cave ([`caves`]).
//! Last, the winding number of the whole is asked ([`inverted`]): it knows what is inside out where little ties it.
//!
//! **In**: [`Fits`] with their [`Sites`] (unit frame, normals of arbitrary sign), [`Evidence`]. **Out**: [`Signs`], one a sub-domain,
//! oriented unit normals of the sites, and the [`Account`] of what decided where.
//!
//! **Cost**: linear in the edges, a dozen a sub-domain, times the logarithm of their number for the descent; winding numbers take
//! n log n for n sites.

pub mod account;
pub(crate) mod camera;
pub(crate) mod caves;
pub(crate) mod descent;
pub(crate) mod domains;
pub mod evidence;
pub(crate) mod graph;
pub(crate) mod inverted;
pub(crate) mod paper;
pub(crate) mod parts;
pub(crate) mod seen;
pub(crate) mod sides;
pub(crate) mod solved;
pub mod source;
pub(crate) mod winding;

use crate::base::error::Result;
use crate::base::params::{Orientation, Propagation};
use crate::base::progress::{Progress, Stage};
use crate::fit::Fits;
use crate::fit::cells::Sites;
use crate::orient::account::Account;
use crate::orient::caves::turn_caves;
use crate::orient::descent::{descend, settle};
use crate::orient::domains::{Domains, mean_winding};
use crate::orient::evidence::{Evidence, Known};
use crate::orient::graph::{Adjacency, Edge, adjacency, components, edges, energy, spanning_signs};
use crate::orient::inverted::Inverted;
use crate::orient::paper::{advancing_front, turn_outward};
use crate::orient::parts::Parts;
use crate::orient::sides::turn_parts;
use crate::orient::solved::Solved;
use crate::orient::source::Source;
use glam::Vec3;

/// The signs and what they cost.
#[derive(Debug, Clone)]
pub struct Signs {
    /// +1 or −1 for each sub-domain's function.
    pub signs: Vec<f32>,
    /// E = −Σ w_ab s_a s_b over all edges, divided by Σ |w|: −1 when all edges agree.
    pub energy: f64,
    /// The same for the signs that were handed on from neighbour to neighbour, before conflicts were solved over the whole
    /// graph.
    pub energy_before: f64,
    /// Oriented unit normal of every site; zero where the site belongs to no sub-domain.
    pub normals: Vec<Vec3>,
    /// Whether the sub-domain is part of a surface: its connected component has at least [`SMALLEST`] sites of its own,
    /// or is the largest. Fewer are taken for outliers.
    pub kept: Vec<bool>,
    /// What decided.
    pub account: Account,
}

impl Signs {
    /// The other side of everything.
    pub fn invert(&mut self) {
        self.signs.iter_mut().for_each(|s| *s = -*s);
        self.normals.iter_mut().for_each(|n| *n = -*n);
    }

    /// Whether the sites enclose something that they look into: a room, with the solid around it.
    pub fn look_inward(&self, sites: &Sites) -> bool {
        /// Rooms without a ceiling have −0.3.
        const INWARD: f64 = -0.2;
        mean_winding(&sites.tree, &self.normals, &sites.spacing) < INWARD
    }
}

/// Sites of the smallest connected component that counts as a surface, unless it is the largest: fewer than a
/// sub-domain's support cannot be told from scattered points.
pub const SMALLEST: usize = 16;
/// Mean winding number over a component's own sites from which on it is closed.
const CLOSED: f64 = 0.35;
/// Mean winding number of the whole at a part from which on the whole encloses something there: half way from what says
/// nothing, 0, to what a closed surface has.
const ENCLOSING: f64 = 0.25;

/// Infers the signs; with `sites.oriented` every sign is +1 already.
pub fn orient(
    fits: &Fits,
    sites: &Sites,
    evidence: &Evidence,
    (orientation, propagation): (Orientation, Propagation),
    progress: &mut dyn Progress,
) -> Result<Signs> {
    let domains = Domains::new(fits, sites, progress)?;
    let n = domains.len();
    let edges = edges(&domains);
    let adjacency = adjacency(n, &edges);
    let components = components(&adjacency);
    let solve = Solve {
        domains: &domains,
        edges: &edges,
        adjacency: &adjacency,
        components: &components,
        kept: kept(&components, fits),
    };
    let solved = match propagation {
        _ if sites.oriented => Solved {
            energy_before: energy(&edges, &vec![1.0; n]),
            signs: vec![1.0; n],
            sources: vec![Source::Normals; n],
            said: Vec::new(),
            parts: None,
        },
        Propagation::Paper => solve.by_front(),
        Propagation::Global => solve.by_energy(evidence, orientation),
    };
    let account = account::of(&domains, &edges, &solved);
    progress.update(Stage::Orient, 1.0)?;
    Ok(Signs {
        energy: energy(&edges, &solved.signs),
        energy_before: solved.energy_before,
        normals: domains.agreed_normals(&solved.signs),
        signs: solved.signs,
        kept: solve.kept,
        account,
    })
}

/// What the signs are inferred from.
struct Solve<'a> {
    domains: &'a Domains<'a>,
    edges: &'a [Edge],
    adjacency: &'a Adjacency,
    components: &'a [Vec<u32>],
    kept: Vec<bool>,
}

impl Solve<'_> {
    /// Algorithm 1, and every component by its volume.
    fn by_front(&self) -> Solved {
        let n = self.domains.len();
        let mut signs = vec![1.0; n];
        advancing_front(self.domains, self.edges, self.adjacency, &mut signs);
        let energy_before = energy(self.edges, &signs);
        let mut sources = vec![Source::Guess; n];
        let mut solids: Vec<&[u32]> = Vec::new();
        for component in self.components {
            if turn_outward(component, self.domains, &mut signs) {
                component
                    .iter()
                    .for_each(|&s| sources[s as usize] = Source::Shell);
                solids.push(component);
            }
        }
        solids.retain(|c| self.kept[c[0] as usize]);
        turn_caves(&solids, self.domains, &mut signs);
        Solved {
            signs,
            energy_before,
            sources,
            said: Vec::new(),
            parts: None,
        }
    }

    /// The least energy, and every part by what is known of it.
    fn by_energy(&self, evidence: &Evidence, orientation: Orientation) -> Solved {
        let domains = self.domains;
        let mut signs = spanning_signs(domains.len(), self.edges);
        let energy_before = energy(self.edges, &signs);
        descend(self.edges, &vec![0.0; domains.len()], &mut signs);
        let mut parts = Parts::new(domains, self.edges, &mut signs);
        let known = evidence.weighed(domains, self.edges, (&signs, &parts), orientation);
        if !known.is_empty() {
            descend(self.edges, &known.unary, &mut signs);
            parts = Parts::new(domains, self.edges, &mut signs);
        }
        let by_part = turn_parts(domains, &parts, &known, evidence, &mut signs);
        let along = parts.along_sheets(domains, self.edges, self.adjacency);
        settle(&along, &known.unary, &mut signs);
        self.turn_caves(&known, &mut signs);
        let around = Inverted {
            domains,
            edges: self.edges,
            adjacency: self.adjacency,
            is_known: known.values.iter().map(|&x| x != 0.0).collect(),
        }
        .turn(&parts, &mut signs);
        let enclosing = parts.sums(|s| around[s as usize] as f32);
        let enclosing: Vec<bool> = enclosing
            .iter()
            .zip(parts.members.iter())
            .map(|(sum, part)| f64::from(*sum) > ENCLOSING * part.len() as f64)
            .collect();
        let source = |&p: &u32| match by_part[p as usize] {
            Source::Up | Source::Guess if enclosing[p as usize] => Source::Shell,
            source => source,
        };
        let mut sources: Vec<Source> = parts.of.iter().map(source).collect();
        for (source, known) in sources.iter_mut().zip(&known.sources) {
            if *known != Source::Guess {
                *source = *known;
            }
        }
        if orientation == Orientation::Inward {
            signs.iter_mut().for_each(|s| *s = -*s);
        }
        Solved {
            signs,
            energy_before,
            sources,
            said: known.said,
            parts: Some((parts, enclosing)),
        }
    }

    /// Turns closed components that are caves and of which nothing is known.
    fn turn_caves(&self, known: &Known, signs: &mut [f32]) {
        let is_free = |c: &[u32]| c.iter().all(|&s| known.values[s as usize] == 0.0);
        let mut solids: Vec<&[u32]> = self
            .components
            .iter()
            .map(Vec::as_slice)
            .filter(|c| self.kept[c[0] as usize] && is_free(c))
            .collect();
        if solids.len() < 2 {
            return;
        }
        solids.retain(|c| self.domains.enclosed(c, signs) > CLOSED);
        turn_caves(&solids, self.domains, signs);
    }
}

/// [`Signs::kept`].
fn kept(components: &[Vec<u32>], fits: &Fits) -> Vec<bool> {
    let size = |c: &Vec<u32>| {
        c.iter()
            .map(|&s| fits.subdomains[s as usize].core)
            .sum::<usize>()
    };
    let enough = SMALLEST.min(components.iter().map(size).max().unwrap_or(0));
    let mut kept = vec![false; fits.subdomains.len()];
    for component in components.iter().filter(|c| size(c) >= enough) {
        component.iter().for_each(|&s| kept[s as usize] = true);
    }
    kept
}
