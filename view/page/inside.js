// What is inside the boundary at an instant: of a filling its section, of a hull the cap that is at this time.

/// Calls use(cell, x) for the simplices of dimension D inside, x their D + 1 corners of three coordinates.
function eachInside(instant, use) {
    if (head.filled) {
        eachCut(inside, instant, (cell, cut) => use(cell, cut.x));
        return;
    }
    const x = new Float64Array(3 * (D + 1));
    for (const slab of capSlabs(instant)) {
        inside.eachLasting(slab, instant.place, instant.place, (begin, end) => {
            for (let cell = begin; cell < end; ++cell) {
                if (isCapAt(cell, instant)) {
                    copyCorners(cell, x);
                    use(cell, x);
                }
            }
        });
    }
}

function isCapAt(cell, instant) {
    return timeOfVertex[inside.vertices[cell * (D + 1)]] === instant.place;
}

function copyCorners(cell, x) {
    for (let i = 0; i <= D; ++i) {
        const vertex = inside.vertices[cell * (D + 1) + i];
        for (let axis = 0; axis < D; ++axis) {
            x[3 * i + axis] = points[D * vertex + axis];
        }
    }
}

/// The slab whose cap is at the instant: one, or none between caps.
function capSlabs(instant) {
    const {first, last} = head.slabs[instant.slab];
    const atCap = [first, last].some(time => Math.abs(time - instant.time) <= head.tolerance);
    return atCap && inside.count > 0 ? [instant.slab] : [];
}

function knowsInside(instant) {
    return inside.count > 0 && (head.filled || capSlabs(instant).length > 0);
}

/// Measure of a simplex by its corners.
function simplexMeasure(x) {
    if (D === 2) {
        return Math.abs((x[3] - x[0]) * (x[7] - x[1]) - (x[4] - x[1]) * (x[6] - x[0])) / 2;
    }
    const e = [3, 6, 9].map(k => [x[k] - x[0], x[k + 1] - x[1], x[k + 2] - x[2]]);
    return Math.abs(determinant(e)) / 6;
}

/// Area or volume of all that is inside.
function measureInside(instant) {
    let cells = 0;
    let measure = 0;
    eachInside(instant, (_, x) => {
        cells += 1;
        measure += simplexMeasure(x);
    });
    return {cells, measure};
}

/// Cuts a tetrahedron by the plane on which normal . x = distance, hands the triangles to use(corners), 9 coordinates,
/// with `drawn`, whether each triangle's edge i (opposite to corner i) is one of the tetrahedron's faces.
class PlaneCut {
    constructor() {
        this.x = new Float64Array(9);
        this.heights = new Float64Array(4);
        this.drawn = [true, true, true];
    }

    cut(tetrahedron, normal, distance, use) {
        let mask = 0;
        for (let i = 0; i < 4; ++i) {
            this.heights[i] = normal.x * tetrahedron[3 * i] + normal.y * tetrahedron[3 * i + 1] +
                normal.z * tetrahedron[3 * i + 2] - distance;
            mask |= (this.heights[i] > 0) << i;
        }
        const corners = cutTables[3][mask];
        for (let at = 0; at < corners.length; at += 6) {
            for (let k = 0; k < 3; ++k) {
                this.setCorner(k, tetrahedron, corners[at + 2 * k], corners[at + 2 * k + 1]);
                this.drawn[k] = isOnFace(corners, at, (k + 1) % 3, (k + 2) % 3);
            }
            use(this.x, this.drawn);
        }
    }

    setCorner(k, tetrahedron, lower, upper) {
        const share = this.heights[lower] / (this.heights[lower] - this.heights[upper]);
        for (let axis = 0; axis < 3; ++axis) {
            const a = tetrahedron[3 * lower + axis];
            this.x[3 * k + axis] = a + share * (tetrahedron[3 * upper + axis] - a);
        }
    }
}

/// Whether two corners of a cut share a vertex of the cut simplex, so that the segment between them lies on a face.
function isOnFace(corners, at, i, j) {
    return corners[at + 2 * i] === corners[at + 2 * j] || corners[at + 2 * i + 1] === corners[at + 2 * j + 1];
}
