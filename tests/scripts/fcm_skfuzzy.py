"""Writes tests/fixtures/fcm_skfuzzy.txt: what scikit-fuzzy's cmeans makes of small clouds, from a given start.

  pip install numpy scipy scikit-fuzzy networkx packaging
  python tests/scripts/fcm_skfuzzy.py > tests/fixtures/fcm_skfuzzy.txt

Conventions of skfuzzy.cmeans (0.5): data is (features, samples); `init` is U(0), one row a cluster; a sweep computes
centres from U and then U from the centres, as the paper's steps (b) and (c), and stops by the Frobenius norm of the
change. `error=0` makes the sweep count exact, so that both programs do the same number.

Format: for each case a line `case n c m sweeps`, then n lines of x y z (exact in f32), c lines of U(0), c lines of U,
c lines of centres.
"""
import numpy as np
import skfuzzy

rng = np.random.default_rng(20140601)


def rows(a):
    for row in a:
        print(' '.join(f'{float(v):.17g}' for v in row))


for n, c, m, sweeps, scale in [(16, 3, 2.0, 12, 1.0), (18, 4, 1.5, 9, 0.01), (15, 3, 1.25, 7, 1.0), (16, 4, 3.0, 10, 1.0), (14, 3, 1.1, 6, 0.01)]:
    points = (rng.random((n, 3)) * scale).astype(np.float32).astype(np.float64)
    points[1] = points[0]  # a duplicate in every case
    start = rng.random((c, n))
    start /= start.sum(0)
    centers, u, *_ = skfuzzy.cmeans(points.T, c, m, error=0.0, maxiter=sweeps, init=start)
    print('case', n, c, m, sweeps)
    rows(points)
    rows(start)
    rows(u)
    rows(centers)
