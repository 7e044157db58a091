// What the page shows, as `slabhull view` wrote it: arrays in base64, each in a script element of its own.

const head = JSON.parse(document.getElementById("data-head").textContent);
const D = head.dimension;

function bytesOf(base64) {
    if (Uint8Array.fromBase64) {
        return Uint8Array.fromBase64(base64);
    }
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let k = 0; k < bytes.length; ++k) {
        bytes[k] = text.charCodeAt(k);
    }
    return bytes;
}

/// The array in the element, which is removed: its text would stay in memory, half as large again.
function takeArray(id) {
    const element = document.getElementById(`data-${id}`);
    const types = {Float32: Float32Array, Float64: Float64Array, Int32: Int32Array, Uint32: Uint32Array,
        Uint16: Uint16Array, Uint8: Uint8Array};
    const array = new types[element.dataset.type](bytesOf(element.textContent).buffer);
    element.remove();
    return array;
}

const points = takeArray("points");              // of vertices, D each, relative to head.centre
const times = takeArray("times");                // ascending
const timeOfVertex = takeArray("time_of_vertex"); // places in `times`
const ids = takeArray("ids");                    // of vertices; -1: none
const tracks = takeArray("tracks");
const sidePatch = takeArray("side_patch");       // places in head.patches

/// Cells in pieces of consecutive ones, each with its first and last time: an instant looks only at the pieces
/// that it meets. Cells come by ascending first time, so these are those of its layer.
class CellList {
    constructor(vertices, corners, slabs) {
        this.vertices = vertices;
        this.corners = corners; // vertices of a cell
        this.count = vertices.length / corners;
        this.pieces = slabs.map(([begin, end]) => this.piecesOf(begin, end)); // by slab
    }

    piecesOf(begin, end) {
        const pieces = [];
        for (let at = begin; at < end; at += CellList.pieceSize) {
            pieces.push(this.pieceOf(at, Math.min(end, at + CellList.pieceSize)));
        }
        return pieces;
    }

    pieceOf(begin, end) {
        let first = Infinity;
        let last = -Infinity;
        for (let k = begin * this.corners; k < end * this.corners; ++k) {
            const time = timeOfVertex[this.vertices[k]];
            first = time < first ? time : first;
            last = time > last ? time : last;
        }
        return {begin, end, first, last};
    }

    /// Calls visit(begin, end) for the pieces of a slab that may have a cell from time `first` or before to time
    /// `last` or after, both places in `times`.
    eachLasting(slab, first, last, visit) {
        for (const piece of this.pieces[slab]) {
            if (piece.first <= first && piece.last >= last) {
                visit(piece.begin, piece.end);
            }
        }
    }
}
CellList.pieceSize = 512;

const side = new CellList(takeArray("side"), D + 1, head.slabs.map(slab => slab.side));
const inside = new CellList(takeArray("inside"), D + (head.filled ? 2 : 1), head.slabs.map(slab => slab.inside));

const span = {first: head.slabs[0].first, last: Math.max(...head.slabs.map(slab => slab.last))};

/// Times at which tracks have vertices, so not those of centres; all times where there are no tracks.
function findLevels() {
    const seen = new Uint8Array(times.length);
    for (let v = 0; v < tracks.length; ++v) {
        if (tracks[v] >= 0) {
            seen[timeOfVertex[v]] = 1;
        }
    }
    const levels = Array.from(times).filter((_, k) => seen[k]);
    return levels.length > 1 ? levels : Array.from(times);
}
const levels = findLevels();
