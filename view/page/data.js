// What the page shows, as `slabhull view` wrote it: base64 in script elements that are no scripts.

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

/// The bytes of a name, from all its elements. These are removed: their text would stay in memory.
function takeBytes(name) {
    const elements = [...document.querySelectorAll(`script[data-of="${name}"]`)];
    const parts = elements.map(element => bytesOf(element.textContent));
    elements.forEach(element => element.remove());
    const bytes = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of parts) {
        bytes.set(part, at);
        at += part.length;
    }
    return bytes;
}

// --- Numbers as view/packing.h has packed them

class Numbers {
    constructor(bytes) {
        this.bytes = bytes;
        this.at = 0;
    }

    next() {
        let byte = this.bytes[this.at++];
        let value = byte & 127;
        for (let scale = 128; byte > 127; scale *= 128) { // no shifts: ids may have more than 32 bits
            byte = this.bytes[this.at++];
            value += (byte & 127) * scale;
        }
        return value;
    }

    nextDifference() {
        const code = this.next();
        return code % 2 ? -(code + 1) / 2 : code / 2;
    }

    get done() {
        return this.at >= this.bytes.length;
    }
}

function unpackDifferences(bytes, array) {
    const numbers = new Numbers(bytes);
    let value = 0;
    for (let k = 0; k < array.length; ++k) {
        value += numbers.nextDifference();
        array[k] = value;
    }
    return array;
}

function unpackRuns(bytes, array) {
    const numbers = new Numbers(bytes);
    for (let at = 0; !numbers.done;) {
        const value = numbers.next();
        const end = at + numbers.next();
        array.fill(value, at, end);
        at = end;
    }
    return array;
}

function unpackCells(name, count) {
    const codes = takeBytes(name + "_codes");
    const far = new Numbers(takeBytes(name + "_far"));
    const vertices = new Uint32Array(count);
    const recent = new Uint32Array(16); // a ring
    let next = 0; // place in `recent`
    let end = 0;  // of the vertices so far
    for (let k = 0; k < count; ++k) {
        const code = k % 2 ? codes[k >> 1] >> 4 : codes[k >> 1] & 15;
        if (code < 15) {
            vertices[k] = recent[next - 1 - code & 15];
            continue;
        }
        const vertex = end - far.nextDifference();
        end = vertex < end ? end : vertex + 1;
        vertices[k] = vertex;
        recent[next] = vertices[k];
        next = next + 1 & 15;
    }
    return vertices;
}

const sideCount = head.slabs[head.slabs.length - 1].side[1];
const insideCount = head.slabs[head.slabs.length - 1].inside[1];
const insideCorners = D + (head.filled ? 2 : 1);

const points = new Float32Array(takeBytes("points").buffer); // of vertices, D each, relative to head.centre
const times = new Float64Array(takeBytes("times").buffer);   // ascending
const timeOfVertex = unpackDifferences(takeBytes("time_of_vertex"), new Uint32Array(head.vertices)); // places there
const ids = unpackDifferences(takeBytes("ids"), new Float64Array(head.vertices));
const tracks = unpackDifferences(takeBytes("tracks"), new Float64Array(head.vertices)); // -1: none
const sidePatch = unpackRuns(takeBytes("side_patch"), new Uint16Array(sideCount));      // places in head.patches

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

const side = new CellList(unpackCells("side", sideCount * (D + 1)), D + 1, head.slabs.map(slab => slab.side));
const inside = new CellList(unpackCells("inside", insideCount * insideCorners), insideCorners,
    head.slabs.map(slab => slab.inside));

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
