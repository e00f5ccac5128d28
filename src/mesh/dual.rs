//! Dual marching cubes over the crossed cells: one vertex for each loop of a cell, one quad for each crossed edge.
//!
//! **Why the result is manifold.** The loops of all cells are the faces of marching cubes' polygon mesh, a closed
//! 2-manifold when every cell that the surface crosses is there; quads around its vertices, the crossed edges, are its
//! dual. Four cells around a lattice edge share nothing but that edge, so no two quads have three corners in common, and
//! a diagonal joins no two cells that anything else joins. The one thing that can go wrong are two loops on either
//! side of an ambiguous face that both pass through it twice: the edge between their vertices would have four quads.
//! Turning such a face (R. Wenger, *Isosurfaces*, 2013, section 3.4) splits both loops and merges none, so one sweep
//! over the faces settles it. Then all neighbours of a vertex differ and its link is one simple cycle.
//!
//! **Why no triangle is degenerate or flipped.** Each vertex stays strictly inside its cell, so the corners of a quad
//! lie in the four quadrants around their lattice edge. Seen along the edge the quad is star-shaped, and the diagonal
//! from its reflex corner, if it has one, gives two triangles that run the right way round.

use crate::base::error::Result;
use crate::base::par;
use crate::mesh::creases::{self, Candidate, Crossing, Moved};
use crate::mesh::curves::OnCrease;
use crate::mesh::lattice::{Lattice, Place, corner};
use crate::mesh::loops::{LoopTable, Loops, ambiguous_faces, edge_corners, face_corners};
use crate::mesh::probe::{Probe, Quad, Vertex, clamp};
use crate::mesh::surface::Implicit;
use glam::{DVec3, IVec3, Vec3};

/// Newton steps towards the zero set; a step that moves less than [`SETTLED`] edges is the last.
const STEPS: usize = 3;
/// See [`STEPS`].
const SETTLED: f64 = 0.05;
/// Longest Newton step in edges.
const LONGEST_STEP: f64 = 0.5;
/// Bricks between two progress calls.
const BRICKS_PER_SLICE: usize = 64;
/// Quads that one index of a parallel map takes.
const QUADS_PER_TASK: usize = 4096;
/// Quads that one parallel map takes.
const QUADS_PER_SLICE: usize = 1 << 18;

/// A crossed cell.
#[derive(Clone, Copy)]
struct Cell {
    signs: u8,
    /// See [`crate::mesh::loops`].
    joined: u8,
    /// A corner's value is not from a fitted function.
    filled: bool,
    /// The vertex of its first loop.
    first_vertex: u32,
}

/// The dual mesh.
pub(crate) struct Dual {
    /// In the order of the cells; those at the end of an open surface may have no quad.
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) quads: Vec<Quad>,
    /// What the cells know of creases, in ascending order of vertices.
    pub(crate) creases: Vec<OnCrease>,
}

impl Dual {
    /// Drops the quads that are not to `stay`.
    pub(crate) fn retain(&mut self, mut stay: impl FnMut(&Quad) -> bool) {
        let vertices = &mut self.vertices;
        self.quads.retain(|quad| {
            let stays = stay(quad);
            if !stays {
                for v in quad.vertices {
                    vertices[v as usize].quads -= 1;
                }
            }
            stays
        });
    }
}

/// Makes the dual mesh of the crossed cells.
pub(crate) fn build<F: Implicit>(
    field: &F,
    lattice: Lattice,
    sharp: bool,
    progress: &mut dyn FnMut(f32) -> Result<()>,
) -> Result<Dual> {
    let cells = Cells::new(&lattice);
    let mut vertices = Vec::with_capacity(cells.vertices);
    for slice in cells.order.chunks(BRICKS_PER_SLICE) {
        let placed = par::map(
            slice.len(),
            || Probe::new(field),
            |k, probe| cells.place(slice[k], probe),
        );
        placed.into_iter().for_each(|v| vertices.extend(v));
        progress(0.7 * vertices.len() as f32 / cells.vertices as f32)?;
    }
    // A closed surface has about as many.
    let mut quads = par::flat_map(
        cells.order.len(),
        cells.vertices,
        || (),
        |k, ()| cells.quads(cells.order[k]),
    );
    for v in quads.iter().flat_map(|quad| quad.vertices) {
        vertices[v as usize].quads += 1;
    }
    let mut on_creases = Vec::new();
    if sharp {
        let on_crease = creases::mark(&vertices, &quads);
        let mut done = 0;
        for slice in cells.order.chunks(BRICKS_PER_SLICE) {
            let moved = par::map(
                slice.len(),
                || Probe::new(field),
                |k, probe| cells.sharpen(slice[k], &on_crease, probe),
            );
            for Moved { position, crease } in moved.into_iter().flatten() {
                let vertex: &mut Vertex = &mut vertices[crease.vertex as usize];
                (vertex.position, vertex.normal, vertex.sharp) = (position, crease.normal, true);
                on_creases.push(crease);
            }
            done += slice.len();
            progress(0.7 + 0.2 * done as f32 / cells.order.len() as f32)?;
        }
    }
    drop(cells);
    drop(lattice);
    for slice in quads.chunks_mut(QUADS_PER_SLICE) {
        let tasks: Vec<&[Quad]> = slice.chunks(QUADS_PER_TASK).collect();
        let choose = |k: usize| {
            let all = tasks[k].iter();
            all.map(|&q| choose_diagonal(q, &vertices)).collect()
        };
        let cut: Vec<Vec<Quad>> = par::map(tasks.len(), || (), |k, ()| choose(k));
        slice.copy_from_slice(&cut.concat());
    }
    progress(1.0)?;
    Ok(Dual {
        vertices,
        quads,
        creases: on_creases,
    })
}

/// The crossed cells with their loops.
struct Cells<'a> {
    lattice: &'a Lattice,
    table: LoopTable,
    /// Bricks by position.
    order: Vec<u32>,
    /// By brick: its first cell.
    first: Vec<u32>,
    /// By brick in `order`, then by number.
    cells: Vec<Cell>,
    vertices: usize,
}

impl<'a> Cells<'a> {
    fn new(lattice: &'a Lattice) -> Cells<'a> {
        let order: Vec<u32> = lattice
            .order()
            .into_iter()
            .filter(|&b| lattice.bricks[b as usize].crossed.len() > 0)
            .collect();
        let mut first = vec![0; lattice.bricks.len()];
        let mut count = 0;
        for &b in &order {
            first[b as usize] = count;
            count += lattice.bricks[b as usize].crossed.len() as u32;
        }
        let cells = par::flat_map(
            order.len(),
            count as usize,
            || (),
            |k, ()| {
                let crossed = &lattice.bricks[order[k] as usize].crossed;
                crossed
                    .iter()
                    .map(|i| read_cell(lattice, (order[k], i)))
                    .collect::<Vec<_>>()
            },
        );
        let mut result = Cells {
            lattice,
            table: LoopTable::new(),
            order,
            first,
            cells,
            vertices: 0,
        };
        result.turn_faces();
        for cell in &mut result.cells {
            cell.first_vertex = result.vertices as u32;
            result.vertices += result.table.get(cell.signs, cell.joined).count();
        }
        result
    }

    fn id(&self, (b, i): Place) -> usize {
        self.first[b as usize] as usize + self.lattice.bricks[b as usize].crossed.rank(i)
    }

    fn loops(&self, cell: &Cell) -> Loops {
        self.table.get(cell.signs, cell.joined)
    }

    /// The crossed cells of a brick.
    fn of_brick(&self, b: u32) -> impl Iterator<Item = (Place, &Cell)> {
        let brick = &self.lattice.bricks[b as usize];
        let first = self.first[b as usize] as usize;
        brick
            .crossed
            .iter()
            .zip(&self.cells[first..])
            .map(move |(i, cell)| ((b, i), cell))
    }

    /// Wenger's fix: no ambiguous face keeps one loop twice on both sides.
    fn turn_faces(&mut self) {
        for k in 0..self.order.len() {
            let b = self.order[k];
            let crossed = self.lattice.bricks[b as usize].crossed;
            for (id, i) in (self.first[b as usize] as usize..).zip(crossed.iter()) {
                let ambiguous = ambiguous_faces(self.cells[id].signs);
                for axis in (0..3).filter(|a| ambiguous >> (2 * a + 1) & 1 == 1) {
                    let (here, there) = (2 * axis + 1, 2 * axis);
                    let Some(next) = self.lattice.crossed((b, i), IVec3::AXES[axis]) else {
                        continue;
                    };
                    let other = self.id(next);
                    let twice = |id: usize, face| self.loops(&self.cells[id]).meets_twice(face);
                    if twice(id, here) && twice(other, there) {
                        self.cells[id].joined ^= 1 << here;
                        self.cells[other].joined ^= 1 << there;
                    }
                }
            }
        }
    }

    /// The vertices of a brick: from the mean of each loop's crossings towards the zero set.
    fn place<F: Implicit>(&self, b: u32, probe: &mut Probe<F>) -> Vec<Vertex> {
        let mut vertices = Vec::new();
        // Coordinates inside of the cell (0-1), and the cell's corner.
        let mut inner: Vec<(DVec3, DVec3)> = Vec::new();
        let mut moving: Vec<usize> = Vec::new();
        for (place, cell) in self.of_brick(b) {
            let (values, loops) = (self.lattice.corners(place), self.loops(cell));
            for l in 0..loops.count() {
                let (mut sum, mut degree) = (DVec3::ZERO, 0u8);
                for edge in loops.edges(l) {
                    sum += crossing(edge, &values);
                    degree += 1;
                }
                if !cell.filled {
                    moving.push(vertices.len());
                }
                inner.push((clamp(sum / degree as f64), self.lattice.position(place)));
                vertices.push(Vertex {
                    position: Vec3::ZERO,
                    normal: Vec3::ZERO,
                    degree,
                    quads: 0,
                    sharp: false,
                });
            }
        }
        let edge = self.lattice.edge;
        for _ in 0..STEPS {
            probe.at.clear();
            probe
                .at
                .extend(moving.iter().map(|&v| inner[v].1 + edge * inner[v].0));
            probe.evaluate();
            let mut k = 0;
            moving.retain(|&v| {
                k += 1;
                let Some((value, gradient)) = probe.found[k - 1] else {
                    return false;
                };
                vertices[v].normal = gradient.normalize().as_vec3();
                let step = gradient * (-value / gradient.length_squared() / edge);
                inner[v].0 = clamp(inner[v].0 + step.clamp_length_max(LONGEST_STEP));
                step.length() > SETTLED
            });
        }
        for (vertex, (inside, corner)) in vertices.iter_mut().zip(&inner) {
            vertex.position = (*corner + edge * *inside).as_vec3();
        }
        vertices
    }

    /// The quads around the crossed edges that start at the lowest corners of a brick's cells.
    fn quads(&self, b: u32) -> Vec<Quad> {
        let mut quads = Vec::new();
        for (place, cell) in self.of_brick(b) {
            for axis in 0..3 {
                let [low, high] = edge_corners(4 * axis).map(|c| cell.signs >> c & 1);
                if low == high {
                    continue;
                }
                // The cells around the edge, counter-clockwise seen against the axis, and what the edge is to each.
                let (u, v) = (IVec3::AXES[(axis + 1) % 3], IVec3::AXES[(axis + 2) % 3]);
                let around = [(IVec3::ZERO, 0), (-u, 1), (-u - v, 3), (-v, 2)];
                let mut filled = false;
                let corners = around.map(|(d, s)| {
                    let cell = &self.cells[self.id(self.lattice.crossed(place, d)?)];
                    filled |= cell.filled;
                    Some(cell.first_vertex + self.loops(cell).through(4 * axis + s) as u32)
                });
                if let [Some(p), Some(q), Some(r), Some(s)] = corners {
                    let rising = low == 1;
                    let vertices = if rising { [p, q, r, s] } else { [p, s, r, q] };
                    quads.push(Quad {
                        vertices,
                        axis: axis as u8,
                        rising,
                        filled,
                    });
                }
            }
        }
        quads
    }

    /// The marked vertices of a brick that lie on creases, moved there.
    fn sharpen<F: Implicit>(&self, b: u32, marked: &[bool], probe: &mut Probe<F>) -> Vec<Moved> {
        let edge = self.lattice.edge;
        let (mut candidates, mut crossings) = (Vec::new(), Vec::new());
        for (place, cell) in self.of_brick(b).filter(|(_, cell)| !cell.filled) {
            let loops = self.loops(cell);
            for l in (0..loops.count()).filter(|l| marked[cell.first_vertex as usize + l]) {
                let (start, lowest) = (crossings.len(), self.lattice.position(place));
                let values = self.lattice.corners(place);
                crossings.extend(loops.edges(l).map(|e| {
                    let ends = edge_corners(e);
                    let low = lowest + edge * corner(ends[0]).as_dvec3();
                    Crossing::new(
                        low,
                        edge * DVec3::AXES[e / 4],
                        ends.map(|c| values[c] as f64),
                    )
                }));
                candidates.push(Candidate {
                    vertex: cell.first_vertex + l as u32,
                    corner: lowest,
                    crossings: start..crossings.len(),
                });
            }
        }
        creases::sharpen(&candidates, &mut crossings, edge, probe)
    }
}

fn read_cell(lattice: &Lattice, place: Place) -> Cell {
    let values = lattice.corners(place);
    let signs = (0..8).fold(0, |s, c| s | u8::from(values[c] < 0.0) << c);
    let ambiguous = ambiguous_faces(signs);
    let joined = (0..6).filter(|&f| ambiguous >> f & 1 == 1 && joins_inside(f, &values));
    let joined = joined.fold(0, |mask, f| mask | 1 << f);
    Cell {
        signs,
        joined,
        filled: !lattice.is_fitted(place),
        first_vertex: 0,
    }
}

/// Whether the inside corners of an ambiguous face are joined: whether the bilinear interpolant is inside at its saddle
/// (G. M. Nielson, B. Hamann, "The asymptotic decider", 1991). Products of two `f32` are exact in `f64`, so both cells
/// of the face decide alike.
fn joins_inside(face: usize, values: &[f32; 8]) -> bool {
    let [p, q, r, s] = face_corners(face).map(|c| values[c] as f64);
    let (pr, qs) = (p * r, q * s);
    if p < 0.0 { pr > qs } else { qs > pr }
}

/// Where the surface crosses an edge, in the cell's coordinates (0-1), by linear interpolation.
fn crossing(edge: usize, values: &[f32; 8]) -> DVec3 {
    let [low, high] = edge_corners(edge);
    let (v, w) = (values[low] as f64, values[high] as f64);
    let mut at = corner(low).as_dvec3();
    at[edge / 4] = v / (v - w);
    at
}

/// Turns the quad so that its cut is the better diagonal: both triangles run the right way round along the lattice
/// edge, a crease is followed, and the worse triangle is as good as can be.
fn choose_diagonal(quad: Quad, vertices: &[Vertex]) -> Quad {
    let corners = quad.vertices.map(|v| &vertices[v as usize]);
    let quality = |first: usize| {
        let p = |k: usize| corners[(first + k) % 4].position.as_dvec3();
        let rates = [[p(0), p(1), p(2)], [p(0), p(2), p(3)]].map(|[a, b, c]| {
            let cross = (b - a).cross(c - a);
            let along = if quad.rising {
                cross[quad.axis as usize]
            } else {
                -cross[quad.axis as usize]
            };
            let squares =
                (b - a).length_squared() + (c - b).length_squared() + (a - c).length_squared();
            // Area over squared edges; negative where the triangle is flipped.
            if along > 0.0 {
                cross.length() / squares
            } else {
                -1.0
            }
        });
        let on_crease = corners[first].sharp && corners[(first + 2) % 4].sharp;
        (rates[0].min(rates[1]), on_crease)
    };
    let ((worst, crease), (other_worst, other_crease)) = (quality(0), quality(1));
    let turn = if worst > 0.0 && other_worst > 0.0 && crease != other_crease {
        other_crease
    } else {
        other_worst > worst
    };
    let [p, q, r, s] = quad.vertices;
    Quad {
        vertices: if turn { [q, r, s, p] } else { [p, q, r, s] },
        ..quad
    }
}
