// Written by `cargo xtask build` from src/base/params/table.rs: change an option there.
import { choice, integer, named, nested, number, oneOf, toggle } from './rules.js';

export const TARGETS = {
  ratio: number(0, 1, { open: '(' }),
  count: integer(1, 0xffffffff),
  tolerance: number(0, 1, { open: '()' }),
  flatness: number(0, 1, { open: '(' }),
};

export const REDUCE = {
  target: oneOf(TARGETS, { ratio: 1 / 3 }),
  method: choice('adaptive', 'paper'),
  fuzzifier: number(1, 100, { open: '(' }),
  epsilon: number(0, 1, { open: '(' }),
  maxIterations: integer(1, 100000),
  norm: choice('euclidean', 'diagonal', 'mahalanobis'),
  clusters: choice('proportional', 'validity'),
  curvatureWeight: number(0, 1, { fallback: 0.5 }),
  placement: choice('implicit', 'mesh', 'center', 'sample'),
  seed: integer(0, Number.MAX_SAFE_INTEGER, 0),
  cellPoints: integer(8, 65536),
  maxDepth: integer(1, 21, 21),
  attributes: named(choice('mean', 'majority', 'nearest')),
  assignment: toggle(false),
  cells: toggle(false),
  outliers: choice('keep', 'drop'),
};

export const RECONSTRUCT = {
  reduce: nested('reduce', REDUCE),
  accuracy: number(0, 1, { open: '()', fallback: 6e-4 }),
  kernel: choice('triharmonic', 'biharmonic', 'thin-plate'),
  smoothing: number(0, 1000000, { or: 'auto', fallback: 'auto' }),
  orient: toggle(true),
  orientation: choice('auto', 'normals', 'viewpoints', 'up', 'outward', 'inward'),
  flip: toggle(false),
  propagation: choice('global', 'paper'),
  resolution: number(0.0001, 0.25, { or: 'auto', fallback: 'auto' }),
  triangles: integer(1, 0xffffffff),
  sharp: toggle(true),
  fairing: toggle(true),
  boundary: choice('auto', 'closed', 'base', 'open'),
  maxHole: number(0, 1, { or: 'auto', fallback: 'auto' }),
  scatter: choice('drop', 'keep'),
  distances: toggle(false),
  keep: toggle(false),
};
