// The boundary at an instant, cut from the side as `slabhull slice` cuts it.

/// An instant as the cuts need it. A level that passes through vertices is the limit from above, at the end from
/// below: vertices from place `firstAbove` in `times` on are above.
class Instant {
    constructor(time) {
        this.place = Instant.placeOf(time);
        const near = times[this.place];
        this.onLevel = Math.abs(near - time) <= head.tolerance;
        this.time = this.onLevel ? near : time;
        this.slab = Instant.slabAt(this.time);
        const atEnd = this.onLevel && this.time >= head.slabs[this.slab].last - head.tolerance;
        this.firstAbove = atEnd ? this.place : this.place + 1;
    }

    /// The last of `times` that is not after the time, up to the tolerance.
    static placeOf(time) {
        let low = 0;
        let high = times.length;
        while (high - low > 1) {
            const middle = (low + high) >> 1;
            if (times[middle] <= time + head.tolerance) {
                low = middle;
            } else {
                high = middle;
            }
        }
        return low;
    }

    /// The last slab that has begun: a time that two slabs share belongs to the later one.
    static slabAt(time) {
        let slab = 0;
        head.slabs.forEach((other, k) => {
            slab = other.first <= time + head.tolerance ? k : slab;
        });
        return slab;
    }
}

/// Points of cut edges. `key` is the vertex where the instant passes through one, else -1.
class CutPoints {
    constructor(most) {
        this.x = new Float64Array(3 * most);
        this.key = new Int32Array(most);
        this.lower = new Int32Array(most);
        this.upper = new Int32Array(most);
    }

    set(k, lower, upper, instant) {
        const from = times[timeOfVertex[lower]];
        const to = times[timeOfVertex[upper]];
        const share = (instant.time - from) / (to - from);
        for (let axis = 0; axis < D; ++axis) {
            const a = points[D * lower + axis];
            this.x[3 * k + axis] = a + share * (points[D * upper + axis] - a);
        }
        this.key[k] = share <= 0 ? lower : share >= 1 ? upper : -1;
        this.lower[k] = lower;
        this.upper[k] = upper;
    }
}

/// Bit i for corner i of the cell that is above the instant.
function maskOf(list, cell, instant) {
    let mask = 0;
    for (let i = 0, at = cell * list.corners; i < list.corners; ++i, ++at) {
        mask |= (timeOfVertex[list.vertices[at]] >= instant.firstAbove) << i;
    }
    return mask;
}

/// Calls use(cell, points) for each simplex of the section of the cells in a list.
function eachCut(list, instant, use) {
    const table = cutTables[list.corners - 1];
    const most = list.corners - 1;
    const cut = new CutPoints(most);
    list.eachLasting(instant.slab, instant.firstAbove - 1, instant.firstAbove, (begin, end) => {
        for (let cell = begin; cell < end; ++cell) {
            const corners = table[maskOf(list, cell, instant)];
            for (let at = 0; at < corners.length;) {
                for (let k = 0; k < most; ++k, at += 2) {
                    cut.set(k, list.vertices[cell * list.corners + corners[at]],
                        list.vertices[cell * list.corners + corners[at + 1]], instant);
                }
                use(cell, cut);
            }
        }
    });
}

/// Whether two corners are one vertex of the hull: such a facet is none.
function hasCollapsed(key) {
    return (key[0] >= 0 && key[0] === key[1]) ||
        (D === 3 && key[2] >= 0 && (key[1] === key[2] || key[0] === key[2]));
}

/// Measures of boundaries, added up facet by facet.
class BoundaryMeasures {
    constructor(time) {
        this.time = time;
        this.facets = 0;
        this.measure = 0;  // length or area
        this.enclosed = 0; // area or volume
        this.patches = head.patches.map(() => 0);
    }

    add(x, patch) {
        const measure = D === 2 ? this.addSegment(x) : this.addTriangle(x);
        this.facets += 1;
        this.measure += measure;
        this.patches[patch] += measure;
    }

    addSegment(x) {
        const dx = x[3] - x[0];
        const dy = x[4] - x[1];
        this.enclosed += (x[1] * dx - x[0] * dy) / 2; // the domain is on the right
        return Math.sqrt(dx * dx + dy * dy);
    }

    addTriangle(x) {
        const ax = x[3] - x[0];
        const ay = x[4] - x[1];
        const az = x[5] - x[2];
        const bx = x[6] - x[0];
        const by = x[7] - x[1];
        const bz = x[8] - x[2];
        const nx = ay * bz - az * by;
        const ny = az * bx - ax * bz;
        const nz = ax * by - ay * bx;
        this.enclosed += (nx * x[0] + ny * x[1] + nz * x[2]) / 6;
        return Math.sqrt(nx * nx + ny * ny + nz * nz) / 2;
    }
}

/// Cuts the side, hands each facet to use(cell, points), and measures the whole.
function cutSide(instant, use) {
    const measures = new BoundaryMeasures(instant.time);
    eachCut(side, instant, (cell, cut) => {
        if (!hasCollapsed(cut.key)) {
            measures.add(cut.x, sidePatch[cell]);
            use(cell, cut);
        }
    });
    return measures;
}
