"""Times scikit-fuzzy's cmeans on some of the cells on standard input (little-endian float32 x y z), for bench.mjs.

  python tests/bench/fcm_skfuzzy.py POINTS CLUSTERS M ERROR SWEEPS TIMED < cells

Prints JSON: scikit-fuzzy's version, the cells that were timed, the seconds they took together, mean sweeps a cell.
"""
import json
import sys
import time

import numpy as np
import skfuzzy

size, clusters, m, error, most, timed = (kind(arg) for kind, arg in zip([int, int, float, float, int, int], sys.argv[1:]))
cells = np.frombuffer(sys.stdin.buffer.read(), '<f4').reshape(-1, size, 3).astype(float)
chosen = cells[np.linspace(0, len(cells) - 1, timed).astype(int)]


def sweeps(cell):
    return skfuzzy.cmeans(cell.T, clusters, m, error, most, seed=0)[5]


sweeps(chosen[0])  # loads what is loaded on first use
start = time.perf_counter()
done = [sweeps(cell) for cell in chosen]
seconds = time.perf_counter() - start
print(json.dumps({'version': skfuzzy.__version__, 'cells': len(done), 'seconds': seconds, 'sweeps': float(np.mean(done))}))
