// Normal speed of the boundary: of a side cell with outward normal (n, n_t) in space-time it is -n_t / |n|, positive
// where the boundary moves out of the domain. It is constant on a cell.

/// Edges of a side cell from its first vertex, D + 1 coordinates each with time last.
function edgesOf(cell) {
    const first = side.vertices[cell * (D + 1)];
    const edges = [];
    for (let i = 1; i <= D; ++i) {
        const vertex = side.vertices[cell * (D + 1) + i];
        const edge = [];
        for (let axis = 0; axis < D; ++axis) {
            edge.push(points[D * vertex + axis] - points[D * first + axis]);
        }
        edge.push(times[timeOfVertex[vertex]] - times[timeOfVertex[first]]);
        edges.push(edge);
    }
    return edges;
}

function determinant3(a, b, c, i, j, k) {
    return a[i] * (b[j] * c[k] - b[k] * c[j]) - a[j] * (b[i] * c[k] - b[k] * c[i]) + a[k] * (b[i] * c[j] - b[j] * c[i]);
}

/// The outward normal N: det[edges, N] > 0.
function normalOf(cell) {
    const [a, b, c] = edgesOf(cell);
    if (D === 2) {
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    }
    return [-determinant3(a, b, c, 1, 2, 3), determinant3(a, b, c, 0, 2, 3), -determinant3(a, b, c, 0, 1, 3),
        determinant3(a, b, c, 0, 1, 2)];
}

function normalSpeed(cell) {
    const normal = normalOf(cell);
    const inSpace = Math.hypot(...normal.slice(0, D));
    return inSpace > 0 ? -normal[D] / inSpace : 0;
}

/// Speeds of all cells and the largest, computed when they are first asked for.
const speeds = {
    of: null,
    largest: 0,
    need() {
        if (this.of) {
            return this;
        }
        this.of = new Float32Array(side.count);
        for (let cell = 0; cell < side.count; ++cell) {
            this.of[cell] = normalSpeed(cell);
            this.largest = Math.max(this.largest, Math.abs(this.of[cell]));
        }
        return this;
    },
};
