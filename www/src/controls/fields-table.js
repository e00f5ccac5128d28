// Written by `cargo xtask build` from src/base/params/table.rs: change an option there.
/** Options that have a control, by name. */
export const FIELDS = {
  method: { in: 'reduce', kind: 'choice', label: 'Method', hint: 'Adaptive keeps more points where the surface bends. The other is fuzzy c-means to the letter.', choices: { adaptive: 'Adaptive', paper: 'As in the paper' } },
  fuzzifier: { in: 'reduce', kind: 'number', label: 'Fuzzifier m', hint: 'How softly points belong to more than one cluster.', low: 1.05, high: 4, least: 1, most: 100, open: '(', unit: '', follows: { adaptive: 1.5, paper: 2 } },
  outliers: { in: 'reduce', kind: 'choice', label: 'Stray points', hint: 'Isolated points far from all others, as dust and reflections leave them.', choices: { keep: 'Keep', drop: 'Leave out' } },
  accuracy: { in: 'reconstruct', kind: 'number', label: 'Accuracy of the fit', hint: 'Patches are divided until they are this close to the points, in per cent of the diagonal.', low: 5e-5, high: 5e-3, least: 0, most: 1, open: '()', times: 100, unit: '%' },
  smoothing: { in: 'reconstruct', kind: 'number', label: 'Smoothing', hint: 'Left empty, it follows the noise that was measured.', low: 1e-4, high: 10, least: 0, most: 1000000, open: '', unit: '', auto: true },
  orientation: { in: 'reconstruct', kind: 'choice', label: 'Outer side', hint: 'What decides which side of the surface is out.', choices: { auto: 'As the scan tells', up: 'Up: land, floors', outward: 'Outward: objects', inward: 'Inward: rooms' } },
  flip: { in: 'reconstruct', kind: 'flag', label: 'Flip', hint: 'The other side of everything is out.' },
  sharp: { in: 'reconstruct', kind: 'flag', label: 'Keep creases sharp', hint: 'Edges and corners stay; without it they are rounded.' },
  fairing: { in: 'reconstruct', kind: 'flag', label: 'Smooth the grain', hint: 'What noise left in the surface is smoothed away; edges stay.' },
  boundary: { in: 'reconstruct', kind: 'choice', label: 'Holes', hint: 'What happens where nothing was scanned.', choices: { auto: 'Close small ones', closed: 'Close all', base: 'Flat base', open: 'Leave open' } },
};

/** The ways to say how much is kept; `start` is where a change to it begins. */
export const TARGETS = {
  ratio: { label: 'Share of the points', low: 0.005, high: 1, least: 0, most: 1, open: '(', times: 100, unit: '%', start: 1 / 3 },
  count: { label: 'Number of points', low: 64, high: 1e6, least: 1, most: 0xffffffff, open: '', unit: '', whole: true, start: 10000 },
  tolerance: { label: 'Tolerance', low: 1e-4, high: 0.02, least: 0, most: 1, open: '()', times: 100, unit: '%', start: 1e-3 },
  flatness: { label: 'Flatness λ', low: 1e-5, high: 0.01, least: 0, most: 1, open: '(', unit: '', start: 6e-4 },
};
