// The one table of options. The crate makes its types, defaults and checks of it (`rows.rs`); `cargo xtask build` writes the
// package's types, checks and flags and the page's fields of it (`xtask/src/options/`).
//
// A row of options: kind name: type = default, facets;
// A row of an amount: kind Variant: type, "name", facets;
//   range(above|from LOW to|below HIGH)   what is accepted; `auto or` before it where 'auto' is, too
//   follows(Adaptive A, Paper B)          what `None` stands for, by method
//   default("…")                          the same, in words
//   start(A)                              where the page begins, of an amount
//   flag("…")                             the line in the command line's help; without it there is no such flag
//   field("label", "hint", LOW to HIGH)   the control on the page, and the ends of its slider; `percent` shows 100 times the value
// In the sentences stand options as they are called in Rust, and choices as they are called in JavaScript.

table! {
    /// How much a reduction keeps: exactly one of them.
    amount Target {
        /// Share of the points. The count is rounded to the nearest integer, at least 1, and met exactly.
        number Ratio: f64, "ratio", range(above 0 to 1), flag("keep this share of the points"),
            start(1.0 / 3.0), field("Share of the points", 0.005 to 1, percent);
        /// Exactly this many points; more than there are means all of them.
        integer Count: usize, "count", range(from 1), flag("keep exactly so many points"),
            start(10_000), field("Number of points", 64 to 1e6);
        /// The fewest points whose local surfaces have 99 % of the surface within this distance, a fraction of the diagonal.
        /// Takes mostly two to six reductions, at most eleven. Noise hides surfaces finer than 1.5 times itself: the report's
        /// `reason` then says what was taken.
        number Tolerance: f64, "tolerance", range(above 0 below 1),
            flag("keep the fewest points whose surface stays within this share of the diagonal"),
            start(1e-3), field("Tolerance", 1e-4 to 0.02, percent);
        /// The paper's λ: sub-domains whose surface variation is under it are reduced, the others keep their points.
        number Flatness: f64, "flatness", range(above 0 to 1),
            flag("the paper's lambda: reduce what is flatter, keep the rest"),
            start(6e-4), field("Flatness λ", 1e-5 to 0.01);
    }

    /// Which reduction.
    choice Method {
        /// Weighted clusters, density by curvature, centres placed on the surface.
        Adaptive "adaptive" "Adaptive",
        /// Sections 3.1-3.2 of the paper to the letter.
        Paper "paper" "As in the paper",
    }

    /// The norm-inducing matrix A of eq. 1.
    choice Norm {
        /// A = I (eq. 8).
        Euclidean "euclidean",
        /// A = diag(1/σx², 1/σy², 1/σz²) of the sub-domain.
        Diagonal "diagonal",
        /// A = the inverse covariance of the sub-domain.
        Mahalanobis "mahalanobis",
    }

    /// How the number of clusters c of a sub-domain is chosen.
    choice Clusters {
        /// In proportion to the target.
        Proportional "proportional",
        /// The best validity index (eq. 7) near the proportional number.
        Validity "validity",
    }

    /// Where a centre goes.
    choice Placement {
        /// On the surface: best for implicit fits.
        Implicit "implicit",
        /// Slightly outside of curved parts and on creases: best for triangles between the points.
        Mesh "mesh",
        /// The raw cluster centre (eq. 2).
        Center "center",
        /// The nearest input point.
        Sample "sample",
    }

    /// What becomes of isolated input points: stray returns, and clumps of up to eight far from the rest.
    choice Outliers {
        /// They are points like all others.
        Keep "keep" "Keep",
        /// They are left out, unless they are more than half of all; fractions are then of the diagonal of the others.
        Drop "drop" "Leave out",
    }

    /// How a scalar, or the colours, of the input points go to the reduced point that stands for them.
    choice Carry {
        /// The mean, weighted by membership: for measurements.
        Mean "mean",
        /// The value with the largest sum of memberships, of equals the smallest: for labels. A colour is one value.
        Majority "majority",
        /// The value of the nearest input point.
        Nearest "nearest",
    }

    /// Options of a reduction.
    options ReduceParams {
        /// How much to keep.
        amount target: Target = Target::Ratio(1.0 / 3.0);
        choice method: Method = Method::Adaptive, flag("how points are chosen"),
            field("Method", "Adaptive keeps more points where the surface bends. The other is fuzzy c-means to the letter.");
        /// m of eq. 1-5 (the paper also writes s).
        number fuzzifier: Option<f64> = None, range(above 1 to 100), follows(Adaptive 1.5, Paper 2.0), flag("m of fuzzy c-means"),
            field("Fuzzifier m", "How softly points belong to more than one cluster.", 1.05 to 4);
        /// ε of eq. 6. `paper` stops when no membership changes by more; `adaptive` when no centre moves by more than this share
        /// of the wanted spacing.
        number epsilon: Option<f64> = None, range(above 0 to 1), follows(Adaptive 1e-2, Paper 1e-3),
            flag("stop when less than this changes");
        /// At most this many iterations of steps (b) and (c).
        integer max_iterations: Option<usize> = None, range(from 1 to 100000), follows(Adaptive 5, Paper 100),
            flag("sweeps of fuzzy c-means, at most");
        /// Used by `paper`; `adaptive` has a matrix of its own for each point.
        choice norm: Norm = Norm::Euclidean, flag("the norm, for the paper's method");
        choice clusters: Clusters = Clusters::Proportional, flag("how many clusters a sub-domain gets");
        /// Concentration of the points: 0 is even spacing, 1 the strongest concentration on curved regions.
        number curvature_weight: f64 = 0.5, range(from 0 to 1), flag("from even spacing to concentration on curved regions");
        /// `paper` takes its raw centres whatever stands here, unless it is `sample`.
        choice placement: Placement = Placement::Implicit, flag("where a point goes");
        /// Seed of the random memberships of step (a), which `paper` starts from.
        integer seed: u64 = 0, range(from 0), flag("of the random start, for the paper's method");
        /// Most points of a sub-domain.
        integer cell_points: Option<usize> = None, range(from 8 to 65536),
            default("follows the target, 64 to 512 (`adaptive`), 256 (`paper`)"), flag("most points of a sub-domain");
        /// Deepest level of the octree.
        integer max_depth: u32 = 21, range(from 1 to 21), flag("deepest level of the octree");
        /// How the cloud's attributes are carried to the reduced points and on to a mesh, by name; `colors` names the colours.
        /// One that is not named is `mean`.
        named attributes: BTreeMap<String, Carry> = BTreeMap::new(),
            flag("how an attribute is carried to the result, can be repeated: NAME=mean, majority or nearest");
        /// Say of every input point which reduced point it belongs to most: `ReducedCloud.assignment`.
        switch assignment: bool = false;
        /// Say where the sub-domains of the octree are: `ReducedCloud.cells`.
        switch cells: bool = false;
        choice outliers: Outliers = Outliers::Keep, flag("whether isolated points are dropped first"),
            field("Stray points", "Isolated points far from all others, as dust and reflections leave them.");
    }

    /// φ of eq. 9.
    choice Kernel {
        /// φ(r) = r³, the triharmonic spline of 3D.
        Triharmonic "triharmonic",
        /// φ(r) = r, the biharmonic spline of 3D.
        Biharmonic "biharmonic",
        /// φ(r) = r² log r, the paper's thin plate.
        ThinPlate "thin-plate",
    }

    /// How much the local fits smooth.
    auto Smoothing {
        /// Follows the measured noise; none where there is none.
        Auto "auto",
        /// The ridge on the diagonal of eq. 11, in units of φ at the sub-domain's spacing.
        Ridge,
    }

    /// Edge length of the extraction grid.
    auto Resolution {
        /// Three quarters of the median spacing of the fitted points; then edges are collapsed where the surface is flat until
        /// at most three triangles a fitted point are left.
        Auto "auto",
        /// Fraction of the diagonal. The mesh is as dense as the grid everywhere.
        Edge,
    }

    /// Widest hole that is closed.
    auto MaxHole {
        /// A tenth of the diagonal; a fifth where the surface goes on smoothly across the hole.
        Auto "auto",
        /// Fraction of the diagonal. A hole is as wide as the largest disc in it; gaps of the sampling, up to four spacings
        /// wide, are closed anyway.
        Diameter,
    }

    /// What happens where there were no points.
    choice Boundary {
        /// Holes up to `max_hole` are closed, open sheets stay open.
        Auto "auto" "Close small ones",
        /// As `open`, and every rim is capped by a membrane, which is flat where the rim is.
        Closed "closed" "Close all",
        /// As `closed`, and where the surface stands on the floor it goes straight down to it and ends in a flat base, for a 3D
        /// print. The floor is the cloud's `floor`, which a step `plane` of `prepare` leaves; without it the lowest place, across
        /// `up` (z without).
        Base "base" "Flat base",
        /// The surface ends where the points end.
        Open "open" "Leave open",
    }

    /// What becomes of points through which there is no surface: foliage, dust, filled volumes.
    choice Scatter {
        /// The mesh has none of them. They stay in the reduced cloud, without a side, and the report's `scatter` counts them.
        Drop "drop",
        /// They are points of the surface like all others.
        Keep "keep",
    }

    /// Which inference chooses the signs of the local functions.
    choice Propagation {
        /// The signs of least energy over the whole graph, and every part by what is known of its outer side.
        Global "global",
        /// Algorithm 1: an advancing front with belief propagation on local graphs.
        Paper "paper",
    }

    /// What decides which side is out.
    choice Orientation {
        /// Everything that is known, as far as it holds when it is checked: the cloud's normals, its viewpoints, that it was seen
        /// from above, a depth camera at the origin; then closed shapes look outward and sheets up.
        Auto "auto" "As the scan tells",
        /// The cloud's own normals, unchecked; the error `bad-option` where it has none.
        Normals "normals",
        /// The cloud's viewpoints: what was seen looks to where it was seen from. The error `bad-option` where it has none.
        Viewpoints "viewpoints",
        /// Along the cloud's up axis, z where it has none.
        Up "up" "Up: land, floors",
        /// Away from the inside of what the surface encloses: objects.
        Outward "outward" "Outward: objects",
        /// Into it: rooms.
        Inward "inward" "Inward: rooms",
    }

    /// Options of a reconstruction.
    options SurfaceParams {
        /// How the cloud is reduced first. Without a reduction every point goes to the fit, and attributes are means on the mesh.
        nested reduce: Option<ReduceParams> = Some(ReduceParams::default()), flag("fit every point");
        /// Largest rms residual of a sub-domain at its input points, a fraction of the diagonal. The default is the paper's.
        number accuracy: f64 = 6e-4, range(above 0 below 1), flag("residual that the fit has to reach, a share of the diagonal"),
            field("Accuracy of the fit", "Patches are divided until they are this close to the points, in per cent of the diagonal.", 5e-5 to 5e-3, percent);
        choice kernel: Kernel = Kernel::Triharmonic, flag("of the radial basis functions");
        number smoothing: Smoothing = Smoothing::Auto, range(auto or from 0 to 1000000),
            flag("of the fit; auto follows the measured noise"),
            field("Smoothing", "Left empty, it follows the noise that was measured.", 1e-4 to 10);
        /// Infer which side is out; `false` takes the cloud's own normals as they are.
        switch orient: bool = true, flag("infer which side is out: the file's normals say it");
        /// `propagation: 'paper'` and `orient: false` have their own rules. The report's `orientation` says what did decide.
        choice orientation: Orientation = Orientation::Auto, flag("what says which side is out; auto takes all that is known"),
            field("Outer side", "What decides which side of the surface is out.");
        /// Turn the whole result to its other side in the end.
        switch flip: bool = false, flag("turn the result to its other side"),
            field("Flip", "The other side of everything is out.");
        choice propagation: Propagation = Propagation::Global, flag("how orientation spreads");
        number resolution: Resolution = Resolution::Auto, range(auto or from 0.0001 to 0.25),
            flag("edge length of the mesh, a share of the diagonal");
        /// The mesh has at most so many triangles, at least 98 % of them, and of the same topology: edges are collapsed by what that
        /// costs. The report's `simplified` says how far the mesh is then from what it was.
        integer triangles: Option<usize> = None, range(from 1), default("as many as the points need"),
            flag("most triangles of the mesh");
        /// Keep creases in the mesh.
        switch sharp: bool = true, flag("keep creases"),
            field("Keep creases sharp", "Edges and corners stay; without it they are rounded.");
        /// Take the grain that noise left out of the mesh. No vertex moves farther than twice the noise of the fitted points; creases
        /// stay, and so does relief that is more than noise.
        switch fairing: bool = true, flag("take the grain of noise out of the mesh"),
            field("Smooth the grain", "What noise left in the surface is smoothed away; edges stay.");
        choice boundary: Boundary = Boundary::Auto, flag("close the surface, or let it end where points do"),
            field("Holes", "What happens where nothing was scanned.");
        /// With `boundary: 'auto'`, the widest hole that is closed. The report's `holes` lists them.
        number max_hole: MaxHole = MaxHole::Auto, range(auto or from 0 to 1),
            flag("widest hole that is closed, a share of the diagonal");
        choice scatter: Scatter = Scatter::Drop, flag("what becomes of foliage, dust and filled volumes");
        /// Say of every input point and every vertex how far scan and mesh are apart there: `SurfaceMesh.distances`.
        switch distances: bool = false;
        /// Remember what was measured of this cloud, and its reduction: the next call with `keep` does not do again what would
        /// come out the same, and has no time for it in its report. The bytes are the same. Takes about 100 bytes a point until
        /// a call without it or another cloud. In Rust the caller holds the memory (`pipeline::reconstruct_again`); in
        /// JavaScript the engine's worker does: an abort keeps what was done before it where memory can be shared, and
        /// forgets all elsewhere.
        switch keep: bool = false;
    }
}
