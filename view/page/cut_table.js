// How an instant cuts a simplex: the same tables as slab/slice/cut_table.h. Some vertices are below the instant, the
// others above. The section is the product of two simplices, with a point on each edge from below to above; staircase
// paths through the grid of these points divide it into simplices (Eilenberg and Zilber 1953).

/// Determinant of a small matrix of integers, by its first row.
function determinant(rows) {
    if (rows.length === 1) {
        return rows[0][0];
    }
    return rows[0].reduce((sum, entry, k) => entry === 0 ? sum : sum + (k % 2 ? -1 : 1) * entry *
        determinant(rows.slice(1).map(row => row.filter((_, column) => column !== k))), 0);
}

/// Sign of the simplex of a section and a point above it, in barycentric coordinates of the cut simplex.
function orientation(corners) {
    const rows = corners.map(([lower, upper]) => {
        const row = new Array(corners.length + 1).fill(0);
        row[lower] += 1;
        row[upper] += 1;
        return row;
    });
    rows.push(rows[0].map((_, k) => k === corners[0][1] ? 1 : 0));
    return determinant(rows);
}

/// The section of a simplex of dimension n: simplices of n corners, each [vertex below, vertex above].
function cutOf(n, above) {
    const vertices = [...Array(n + 1).keys()];
    const upper = vertices.filter(v => above >> v & 1);
    const lower = vertices.filter(v => !(above >> v & 1));
    const cut = [];
    for (let path = 0; path < 1 << (n - 1); ++path) { // bit k: step k goes on among the upper ones
        const steps = [...Array(n - 1).keys()].filter(k => path >> k & 1).length;
        if (lower.length === 0 || steps + 1 !== upper.length) {
            continue;
        }
        const corners = [];
        for (let k = 0, i = 0, j = 0; k < n; ++k) {
            corners.push([lower[i], upper[j]]);
            path >> k & 1 ? ++j : ++i;
        }
        if (orientation(corners) > 0) { // outward from the slab is outward from its section, see cut_table.h
            [corners[0], corners[1]] = [corners[1], corners[0]];
        }
        cut.push(corners);
    }
    return cut;
}

/// By the set of vertices above, bit i for vertex i: the corners of all simplices as one list lower, upper, ..
function cutTable(n) {
    return [...Array(1 << (n + 1)).keys()].map(above => Int32Array.from(cutOf(n, above).flat(2)));
}
const cutTables = {2: cutTable(2), 3: cutTable(3), 4: cutTable(4)};
